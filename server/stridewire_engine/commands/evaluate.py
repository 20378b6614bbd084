"""`stridewire evaluate`: figures of motion, beside the captured motion and a naive baseline."""

import click

from stridewire_engine.commands.evaluate_blend import blend
from stridewire_engine.commands.evaluate_critic import critic
from stridewire_engine.commands.evaluate_stitch import stitch
from stridewire_engine.commands.evaluate_stream import stream
from stridewire_engine.commands.evaluate_tune import tune


@click.group()
def evaluate() -> None:
    """Measure how good motion is."""


evaluate.add_command(blend)
evaluate.add_command(critic)
evaluate.add_command(stitch)
evaluate.add_command(stream)
evaluate.add_command(tune)
