"""The engine: matching, stitching, the tick. No gRPC and no torch here.

Floors, top to bottom; imports run down only: evaluation, in_process, replaying; building, runtime,
stitching; matching, stitchers, blending; library, networks, rigs; the client's motion kernel.
"""
