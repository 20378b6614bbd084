"""`make show-refiner`: what stitching and the network that guides it must show."""

import sys

import stitch_service
from points import show

if __name__ == "__main__":
    sys.exit(
        show(
            "refiner",
            [
                stitch_service.pace,
                stitch_service.untouched,
                stitch_service.refused,
                stitch_service.models,
            ],
        )
    )
