"""Warming: what costs the first caller time is done before anybody calls.

`python -m stridewire_server.warming` builds the embedded library and compiles what is compiled, for
images and for tests that start many servers.
"""

import numpy as np

from stridewire._messages import CharacterSpec, Open, Step
from stridewire_engine.networks.blend import blend_network
from stridewire_engine.runtime import Runtime
from stridewire_engine.stitchers import STITCHER_NAMES

_FRAMES, _TURN_EVERY = 120, 30
"""So long that every stitcher, the network included, has hidden a transition."""


def warm_up(runtime: Runtime) -> None:
    """Drive every library for a while, so that no caller pays for pages, caches and compiling.

    Raises:
        ModelError: If a network that comes with the package is damaged.
    """
    blend_network()
    for name in runtime.libraries:
        specs = [CharacterSpec(i, stitcher=stitcher) for i, stitcher in enumerate(STITCHER_NAMES)]
        session = runtime.open(Open(specs, library=name))
        for number in range(_FRAMES):
            way = np.array([0.0, 1.5] if number // _TURN_EVERY % 2 else [1.5, 0.0], np.float32)
            ways = np.tile(way, (len(specs), 1))
            facing = np.full(len(specs), np.nan, np.float32)
            step = Step(number, 1 / 60, velocity_xz=ways, facing_yaw=facing)
            runtime.advance([(session, step)])
        runtime.close(session)


if __name__ == "__main__":
    from stridewire_engine.building import embedded_library

    warm_up(Runtime([embedded_library()]))
