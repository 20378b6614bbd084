"""A look inside: the ways ahead and the poses before stitching, for those who watch the runtime.

Worked out after the tick and only for sessions that ask; the tick itself pays nothing for it.
"""

import numpy as np

from stridewire._messages import Inside
from stridewire.motion.array_types import Floats, Indices
from stridewire_engine.runtime import intent, sampling
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.crowd import Crowd

AHEAD_S = np.arange(1, 11) / 10.0
"""Times that the ways ahead are told at."""


def look(crowd: Crowd, rows: Indices, scales: Floats) -> Inside:
    """Return what lies behind the frame that was just made.

    Args:
        crowd: Whose tick is done.
        rows: `(N,)` of the session.
        scales: `(N,)` sizes of the characters in the reference's.
    """
    state = crowd.state.take(rows)
    predicted, captured = _predicted(crowd, state), _captured(crowd, state)
    for way in (predicted, captured):
        way[..., :2] *= scales[:, None, None]
    at = sampling.moments(crowd.library, state.clip, state.clip_time)
    hips, rotations = sampling.sample_pose(crowd.library, at)
    return Inside(
        AHEAD_S.astype(np.float32),
        predicted.astype(np.float32),
        captured.astype(np.float32),
        hips * np.asarray(scales, np.float32)[:, None],
        rotations,
    )


def _predicted(crowd: Crowd, state: Characters) -> Floats:
    """Return `(N, K, 3)` x, z, yaw of the simulated root, if the control stays as it is."""
    goal = intent.set_goals(state, crowd.max_speed)
    prediction = intent.predict(state, goal, AHEAD_S, crowd.settings)
    return np.concatenate([prediction.positions, prediction.yaws[..., None]], axis=-1)


def _captured(crowd: Crowd, state: Characters) -> Floats:
    """Return `(N, K, 3)` x, z, yaw of the root, if nothing but the clip moved it."""
    count = len(AHEAD_S)
    clip = np.repeat(state.clip, count)
    now = sampling.moments(crowd.library, clip, np.repeat(state.clip_time, count))
    then = sampling.moments(crowd.library, clip, (state.clip_time[:, None] + AHEAD_S).ravel())
    motion = sampling.root_delta(crowd.library, now, then).reshape(-1, count, 3)
    sine, cosine = np.sin(state.root_yaw)[:, None], np.cos(state.root_yaw)[:, None]
    left, front, turn = np.moveaxis(motion, -1, 0)
    x = state.root_position[:, :1] + left * cosine + front * sine
    z = state.root_position[:, 2:] - left * sine + front * cosine
    return np.stack([x, z, state.root_yaw[:, None] + turn], axis=-1)
