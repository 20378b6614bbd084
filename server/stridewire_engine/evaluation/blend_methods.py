"""Ways to blend that are measured beside linear blending, and how long they take."""

import time

import numpy as np

from stridewire.motion.skeleton import REFERENCE
from stridewire_engine.blending.feet import keep_feet
from stridewire_engine.evaluation.blending import Method
from stridewire_engine.networks.blend import BlendNetwork, Postures
from stridewire_engine.networks.blend.correction import linear
from stridewire_engine.networks.blend.network import PaperNetwork, joint_weights
from stridewire_engine.networks.blend.pairs import Pairs

BATCHES = (1, 32, 1024)
_ROUNDS = 30


def by_network(network: BlendNetwork | PaperNetwork, tell_duration: bool = True) -> Method:
    """Return blends by a network alone.

    Args:
        network: Of either variant.
        tell_duration: Whether it is told how long a pair takes.
    """

    def blend(pairs: Pairs) -> Postures:
        duration = pairs.duration if tell_duration else np.zeros_like(pairs.duration)
        weights = joint_weights(pairs.weights)
        return network.between(pairs.start, pairs.end, weights, duration).postures

    return blend


def as_served(network: BlendNetwork, tell_duration: bool = True) -> Method:
    """Return blends as the service makes them: the network where it is sure, then the feet.

    Args:
        network: To blend by.
        tell_duration: Whether it is told how long a pair takes.
    """

    def blend(pairs: Pairs) -> Postures:
        duration = pairs.duration if tell_duration else np.zeros_like(pairs.duration)
        weights = joint_weights(pairs.weights)
        between, distance = network.between(pairs.start, pairs.end, weights, duration)
        kept = _with_feet(between, pairs)
        straight = linear(pairs.start[:, None], pairs.end[:, None], weights)
        sure = (distance <= network.furthest)[:, None]
        return Postures(
            np.where(sure[..., None], kept.hips, straight.hips),
            np.where(sure[..., None, None], kept.rotations, straight.rotations),
        )

    return blend


def share_by_network(network: BlendNetwork, pairs: Pairs) -> float:
    """Return the share of pairs that are near enough to the training data for the network."""
    _, distance = network.coefficients(pairs.start, pairs.end, pairs.duration)
    return float(np.mean(distance <= network.furthest))


def _with_feet(between: Postures, pairs: Pairs) -> Postures:
    shape, joints = pairs.weights.shape, len(REFERENCE)
    of = np.arange(shape[0]).repeat(shape[1])
    flat = Postures(between.hips.reshape(-1, 3), between.rotations.reshape(-1, joints, 4))
    weights = joint_weights(pairs.weights.reshape(-1))
    kept = keep_feet(flat, pairs.start[of], pairs.end[of], weights)
    return Postures(kept.hips.reshape(*shape, 3), kept.rotations.reshape(*shape, joints, 4))


def microseconds(method: Method, pairs: Pairs) -> dict[int, float]:
    """Return the median time per posture at batch sizes: that many pairs, one weight each.

    The time that the thread worked, so that other work on the machine counts little.

    Args:
        method: To time, on one thread.
        pairs: At least as many as the largest batch, at one weight.
    """
    return {batch: _microseconds(method, pairs[:batch]) / batch for batch in BATCHES}


def _microseconds(method: Method, pairs: Pairs) -> float:
    times = []
    for _ in range(_ROUNDS):
        began = time.thread_time()
        method(pairs)
        times.append(time.thread_time() - began)
    return 1e6 * float(np.median(times))
