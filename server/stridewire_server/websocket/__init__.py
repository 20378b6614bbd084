"""The WebSocket door: the messages of Animate for browsers and for engines without gRPC."""
