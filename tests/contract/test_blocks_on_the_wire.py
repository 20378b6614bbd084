"""Blocks are byte for byte what the plain protobuf encoder writes, and are read back whole."""

import numpy as np
import pytest

from stridewire._codec.blocks import read_block, write_blocks
from stridewire._codec.requests import decode_request
from stridewire._messages import Step
from stridewire.v1 import animation_pb2 as pb


@pytest.mark.parametrize("count", [0, 1, 3, 31, 32, 5000, 600_000])
def test_a_block_is_what_the_plain_encoder_writes(rng: np.random.Generator, count: int) -> None:
    """Tag, length and values agree for lengths of one to four varint bytes."""
    values = rng.normal(size=count).astype(np.float32)
    as_block, plain = pb.Frame(frame=7), pb.Frame(frame=7)
    write_blocks(as_block, root=values, foot_targets=values)
    plain.root.extend(values.tolist())
    plain.foot_targets.extend(values.tolist())
    assert as_block.SerializeToString() == plain.SerializeToString()


def test_a_block_of_the_plain_encoder_is_read(rng: np.random.Generator) -> None:
    """A stock client that fills the field number by number is understood."""
    values = rng.normal(size=(4, 3)).astype(np.float32)
    frame = pb.Frame(frame=1, hips=values.ravel().tolist(), characters=[1, 2, 3, 4])
    read = read_block(frame, "hips", 4, 3)
    np.testing.assert_array_equal(read, values)
    assert not read.flags.writeable


def test_an_unpacked_field_is_read() -> None:
    """A writer that does not pack, as proto2 ones do, is understood too."""
    unpacked = b"".join(b"\x35" + np.float32(v).tobytes() for v in (1.5, -2.0, 3.25, 4.0))
    message = pb.AnimateRequest(step=pb.Step.FromString(unpacked))
    step = decode_request(message)
    assert isinstance(step, Step)
    np.testing.assert_array_equal(step.velocity_xz, [[1.5, -2.0], [3.25, 4.0]])


def test_what_cannot_be_shaped_stays_flat() -> None:
    """Three numbers are no pairs: they reach the runtime as they are, which refuses them."""
    step = decode_request(pb.AnimateRequest(step=pb.Step(velocity_xz=[1.0, 2.0, 3.0])))
    assert isinstance(step, Step)
    np.testing.assert_array_equal(step.velocity_xz, [1.0, 2.0, 3.0])
