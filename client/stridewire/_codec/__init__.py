"""Between the wire's protobuf messages and the dataclasses of `_messages`, both ways.

Client and server use the same functions. Shapes and ranges are not judged here: what cannot be
shaped stays flat and the runtime refuses it, so that in process and over the wire the same errors
come.
"""
