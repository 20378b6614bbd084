"""`stridewire health`: is a server there and ready? Needs gRPC alone, so a container can ask."""

import json

import click

_SERVING = 1
_STATES = {0: "unknown", 1: "serving", 2: "not serving", 3: "service unknown"}


@click.command()
@click.option("--address", default="127.0.0.1:50051", show_default=True, help="Server to ask.")
@click.option("--timeout", default=2.0, show_default=True, help="Longest wait in seconds.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
@click.pass_context
def health(ctx: click.Context, address: str, timeout: float, as_json: bool) -> None:
    """Tell whether a server is ready; exits with 1 where it is not."""
    state = _check(address, timeout)
    if as_json:
        click.echo(json.dumps({"address": address, "state": state}))
    else:
        click.echo(f"{address}: {state}")
    ctx.exit(0 if state == _STATES[_SERVING] else 1)


def _check(address: str, timeout_s: float) -> str:
    """Ask `grpc.health.v1.Health/Check`; its messages are so small that raw bytes do."""
    import grpc

    with grpc.insecure_channel(address) as channel:
        try:
            check = channel.unary_unary("/grpc.health.v1.Health/Check", bytes, bytes)
            answer = check(b"", timeout=timeout_s)
        except grpc.RpcError as error:
            return f"no answer ({error.code().name.lower().replace('_', ' ')})"
    # HealthCheckResponse: field 1, a varint, left out where it is 0.
    return _STATES.get(answer[1] if len(answer) > 1 else 0, "unknown")
