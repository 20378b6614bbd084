"""Where a tick's processor time goes: stages of the tick timed from outside, each without the rest.

A stage is some functions; what they call of other stages counts there, and what belongs to none is
the tick's own. Nothing in the tick knows of it.
"""

import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from stridewire._codec.responses import response_bytes
from stridewire._messages import CharacterSpec, Detail, Open, Step
from stridewire.scripts import script
from stridewire_engine.library import Library
from stridewire_engine.runtime import Runtime

_RUNTIME = "stridewire_engine.runtime"
_PASSES = f"{_RUNTIME}.passes"
STAGES = {
    "controls": [
        (f"{_RUNTIME}.session", "Session.begin_tick"),
        (f"{_RUNTIME}.runtime", "Runtime._apply_plain"),
    ],
    "look: goals, predictions, who searches": [(_PASSES, "Passes.look")],
    "ask: queries": [(f"{_RUNTIME}.query", "ask")],
    "search: the index": [("stridewire_engine.matching.candidates", "CandidateSet.nearest")],
    "search: ranking and choice": [(f"{_RUNTIME}.choice", "choose")],
    "handing over at a jump": [(f"{_RUNTIME}.tick", "Tick._jump")],
    "refine: plans": [(f"{_RUNTIME}.refining", "Refining.plan")],
    "refine: the network": [("stridewire_engine.networks.onnx_model", "OnnxModel.run")],
    "play: clips, poses, roots": [(_PASSES, "Passes.play")],
    "stitch: springs, footing, legs, look-ahead": [(f"{_RUNTIME}.tick", "Tick._stitch")],
    "plant: locks, memory for the next query": [(_PASSES, "Passes.plant")],
    "output": [(f"{_RUNTIME}.session", "Session.end_tick"), (f"{_RUNTIME}.tick", "Tick._block")],
}
_WARM, _FRAMES = 120, 240
FRAME_S = 1.0 / 60.0


class Clocks:
    """Exclusive processor time by stage."""

    def __init__(self) -> None:
        self.seconds: Counter[str] = Counter()
        self._inner = [0.0]

    def timed(self, stage: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return the function, its time added to a stage."""

        def call(*args: Any, **kwargs: Any) -> Any:
            self._inner.append(0.0)
            begin = time.thread_time()
            try:
                return function(*args, **kwargs)
            finally:
                passed = time.thread_time() - begin
                self.seconds[stage] += passed - self._inner.pop()
                self._inner[-1] += passed

        return call


@contextmanager
def watched(clocks: Clocks) -> Iterator[None]:
    """Time the stages while the block runs."""
    undo = []
    for stage, functions in STAGES.items():
        for module, name in functions:
            owner: Any = import_module(module)
            *path, last = name.split(".")
            for part in path:
                owner = getattr(owner, part)
            undo.append((owner, last, getattr(owner, last)))
            setattr(owner, last, clocks.timed(stage, getattr(owner, last)))
    try:
        yield
    finally:
        for owner, last, function in reversed(undo):
            setattr(owner, last, function)


def driven(library: Library, characters: int, stitcher: str) -> Iterator[Callable[[], Any]]:
    """Yield what advances a crowd by a frame, for each frame of some seconds of `random-stick`."""
    runtime = Runtime([library])
    specs = tuple(CharacterSpec(i, stitcher=stitcher) for i in range(characters))
    session = runtime.open(Open(characters=specs, detail=Detail.EVENTS))
    controls = script("random-stick").controls
    for number in range(_WARM + _FRAMES):
        asked = controls(number * FRAME_S, characters, 0)
        step = Step(number + 1, FRAME_S, velocity_xz=asked.velocity, facing_yaw=asked.facing)

        def advance(step: Step = step) -> Any:
            return runtime.advance([(session, step)])[0][0]

        yield advance


def tick_us(library: Library, characters: int, stitcher: str) -> float:
    """Return the processor time of a tick a character, in microseconds, encoding included."""
    spent = 0.0
    for number, advance in enumerate(driven(library, characters, stitcher)):
        begin = time.thread_time()
        response_bytes(advance())
        if number >= _WARM:
            spent += time.thread_time() - begin
    return 1e6 * spent / _FRAMES / characters


def budget_us(library: Library, characters: int, stitcher: str) -> dict[str, float]:
    """Return microseconds a character-frame by stage; `rest` belongs to none."""
    clocks = Clocks()
    encode = clocks.timed("encode", response_bytes)
    with watched(clocks):
        for number, advance in enumerate(driven(library, characters, stitcher)):
            if number == _WARM:
                clocks.seconds.clear()
            encode(clocks.timed("rest", advance)())
    return {stage: 1e6 * s / _FRAMES / characters for stage, s in clocks.seconds.items()}
