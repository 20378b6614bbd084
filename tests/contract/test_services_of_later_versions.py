"""Methods that a later version fills are there and say so, however they are called."""

import asyncio
import json
from collections.abc import Callable

import grpc
import pytest

from external import grpcurl_refusal, needs_grpcurl, needs_node, node_script
from stridewire import AsyncClient, Client
from stridewire.v1 import stitch_pb2, stitch_pb2_grpc

SAYS = "StitchService.Stitch is not implemented yet"
NODE = """
import grpc from "@grpc/grpc-js";
import loader from "@grpc/proto-loader";
const options = { includeDirs: ["../../proto"] };
const definition = loader.loadSync("stridewire/v1/stitch.proto", options);
const { StitchService } = grpc.loadPackageDefinition(definition).stridewire.v1;
const client = new StitchService("ADDRESS", grpc.credentials.createInsecure());
client.Stitch({}).on("data", () => {}).on("error", (error) => {
  console.log(JSON.stringify([error.code === grpc.status.UNIMPLEMENTED, error.details]));
  client.close();
});
"""


def by_stub(address: str) -> str:
    """Call with the blocking stub."""
    with grpc.insecure_channel(address) as channel:
        stub = stitch_pb2_grpc.StitchServiceStub(channel)
        with pytest.raises(grpc.RpcError) as raised:
            list(stub.Stitch(stitch_pb2.StitchRequest(), timeout=10.0))
    assert raised.value.code() is grpc.StatusCode.UNIMPLEMENTED
    return str(raised.value.details())


def by_asyncio_stub(address: str) -> str:
    """Call with the stub of asyncio."""

    async def call() -> grpc.aio.AioRpcError:
        async with grpc.aio.insecure_channel(address) as channel:
            stub = stitch_pb2_grpc.StitchServiceStub(channel)
            with pytest.raises(grpc.aio.AioRpcError) as raised:
                await stub.Stitch(stitch_pb2.StitchRequest(), timeout=10.0).read()
            return raised.value

    error = asyncio.run(call())
    assert error.code() is grpc.StatusCode.UNIMPLEMENTED
    return str(error.details())


def in_process(_address: str) -> str:
    """Look for a method; clients have none before there is what it calls."""
    for client in (Client, AsyncClient):
        with pytest.raises(AttributeError):
            client.stitch  # type: ignore[attr-defined]  # noqa: B018
    return SAYS


def by_grpcurl(address: str) -> str:
    """Call with grpcurl."""
    refusal = grpcurl_refusal(address, "stridewire.v1.StitchService/Stitch", "{}")
    assert "Code: Unimplemented" in refusal
    return refusal


def by_node(address: str) -> str:
    """Call with grpc-js."""
    unimplemented, details = json.loads(node_script(NODE.replace("ADDRESS", address)))
    assert unimplemented
    return str(details)


@pytest.mark.parametrize(
    "call",
    [
        pytest.param(by_stub, id="blocking"),
        pytest.param(by_asyncio_stub, id="asyncio"),
        pytest.param(in_process, id="in process"),
        pytest.param(by_grpcurl, id="grpcurl", marks=needs_grpcurl),
        pytest.param(by_node, id="Node", marks=needs_node),
    ],
)
def test_stitch_is_not_implemented_yet(address: str, call: Callable[[str], str]) -> None:
    """StitchService.Stitch is UNIMPLEMENTED and says so by name."""
    assert SAYS in call(address)
