"""Ways to hide seams that are measured beside each other."""

from collections.abc import Callable, Mapping

import numpy as np

from stridewire.motion import quaternion
from stridewire.motion.skeleton import CONTACT_JOINTS, REFERENCE
from stridewire_engine.evaluation.seams import Poses, Windows, stitched
from stridewire_engine.networks.rmr import Guidance, Refiner
from stridewire_engine.networks.rmr.assembly import assemble
from stridewire_engine.networks.rmr.plans import FRAME_RATE
from stridewire_engine.runtime import feet
from stridewire_engine.runtime.characters import Characters
from stridewire_engine.runtime.settings import TickSettings
from stridewire_engine.stitchers import STITCHERS, Stitcher
from stridewire_engine.stitchers.stance import Stance

Method = Callable[[Windows], Poses]

_PAPER_FRAMES = 30
_TOES = [1, 3]


def plain_methods() -> Mapping[str, Method]:
    """Return the ways without a network, by name, the truth and the bare seam among them."""
    return {
        "truth": truth,
        "raw": lambda windows: windows.raw,
        "paper-ib": paper_inertialization,
        "spring": by_stitcher(_named("spring")),
        "spring-lock": spring_and_lock,
        "quintic": by_stitcher(_named("quintic")),
        "dead-blend": by_stitcher(_named("dead-blend")),
        "stance": by_stitcher(_named("stance")),
        "refine-silent": silent,
    }


def by_stitcher(stitcher: Stitcher) -> Method:
    """Return the way of a stitcher of the live runtime."""
    return lambda windows: stitched(windows, stitcher)


def refined(refiner: Refiner) -> Method:
    """Return stance, guided by a network."""

    def method(windows: Windows) -> Poses:
        plans = assemble(windows.takes, windows.pairs, (windows.root, windows.yaw)).plans
        return stitched(windows, Stance(), refiner.refine(plans))

    return method


def silent(windows: Windows) -> Poses:
    """Return guided stance whose network says nothing: what is left without its answer."""
    feet_shape = (*windows.contacts.shape, 3)
    said = Guidance(
        windows.contacts.astype(np.float64),
        np.zeros(feet_shape),
        np.zeros(feet_shape),
        np.zeros(len(windows)),
    )
    return stitched(windows, Stance(), said)


def truth(windows: Windows) -> Poses:
    """Return the takes' own poses."""
    takes, rows = windows.takes, windows.pairs.truth
    return Poses(takes.hips[rows], takes.rotations[rows])


def paper_inertialization(windows: Windows) -> Poses:
    """Fade the offset of each seam out over 30 frames, no velocity (Kim et al. 2023, 7.5)."""
    raw = windows.raw
    made = Poses(raw.hips.copy(), raw.rotations.copy())
    starts = windows.pairs.starts
    frames = np.arange(starts.shape[1])
    for at in np.unique(np.nonzero(starts)[1]):
        rows = np.flatnonzero(starts[:, at])
        share = np.clip(1.0 - (frames[at:] - at) / _PAPER_FRAMES, 0.0, 1.0).astype(np.float32)
        move = made.hips[rows, at - 1] - raw.hips[rows, at]
        away = quaternion.multiply(
            made.rotations[rows, at - 1], quaternion.conjugate(raw.rotations[rows, at])
        )
        turn = quaternion.to_scaled_axis(away)[:, None] * share[:, None, None]
        made.hips[rows, at:] = raw.hips[rows, at:] + move[:, None] * share[:, None]
        made.rotations[rows, at:] = quaternion.multiply(
            quaternion.from_scaled_axis(turn), raw.rotations[rows, at:]
        )
    return made


def spring_and_lock(windows: Windows) -> Poses:
    """Return springs, then the runtime's foot lock from the first frame on."""
    sprung = stitched(windows, _named("spring"))
    state = Characters.allocate(len(windows), len(REFERENCE), 1)
    dt = np.full(len(windows), 1.0 / FRAME_RATE)
    stands, settings = np.zeros(len(windows), bool), TickSettings()
    planted = np.zeros((*windows.contacts.shape[:2], len(CONTACT_JOINTS)), bool)
    planted[..., _TOES] = windows.contacts
    made = Poses(sprung.hips, sprung.rotations.copy())
    for frame in range(windows.yaw.shape[1]):
        state.time += dt
        state.root_position[...] = windows.root[:, frame]
        state.root_yaw[...] = windows.yaw[:, frame]
        made.rotations[:, frame] = feet.plant(
            state, windows.legs, sprung.hips[:, frame], sprung.rotations[:, frame],
            planted[:, frame], stands, dt, settings,
        )  # fmt: skip
    return made


def _named(name: str) -> Stitcher:
    return next(stitcher for stitcher in STITCHERS if stitcher.name == name)
