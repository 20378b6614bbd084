"""The server: gRPC around one runtime, streams, flow control, health, commands."""
