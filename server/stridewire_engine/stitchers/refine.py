"""The stitcher `refine`: `stance`, its feet guided by a network where that knows the transition.

The runtime asks the network when a character jumps and gives its guide with each sample; a
character without one is stitched as by `stance`.
"""

from stridewire_engine.stitchers.stance import Stance


class Refine(Stance):
    """Springs for the body, footing for the feet, a guide for where they go."""

    name = "refine"
    always_reaches = True
