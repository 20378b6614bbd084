"""What live output on another rig costs: ticks with and without it, in turn, in one run.

python tests/show/rig_cost.py
"""

import json
import time

import numpy as np

from rigs import mixamo
from stridewire import Client
from stridewire._session import Session

_BLOCKS = 40
_STEPS = 30


def ratios(client: Client, characters: int) -> dict[str, float]:
    """Time steps of two sessions by turns; seconds a step are medians over blocks."""
    with (
        client.open_session(characters, seed=1) as plain,
        client.open_session(characters, seed=1, output_skeleton=mixamo()) as posed,
    ):
        times = np.array([(_time(plain), _time(posed)) for _ in range(_BLOCKS)])
    by_block = times[:, 1] / times[:, 0]
    return {
        "characters": characters,
        "without_ms": 1e3 * float(np.median(times[:, 0])),
        "with_ms": 1e3 * float(np.median(times[:, 1])),
        "ratio": float(np.median(by_block)),
        "ratio_p10": float(np.percentile(by_block, 10)),
        "ratio_p90": float(np.percentile(by_block, 90)),
    }


def _time(session: Session) -> float:
    began = time.process_time()
    for _ in range(_STEPS):
        session.step(velocity=(0.0, 1.3))
    return (time.process_time() - began) / _STEPS


if __name__ == "__main__":
    with Client.in_process() as runtime:
        for count in (1, 16, 256):
            print(json.dumps(ratios(runtime, count)))
