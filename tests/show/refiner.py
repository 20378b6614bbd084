"""`make show-refiner`: what stitching and the network that guides it must show."""

import sys

import refiner_paper
import refiner_tables
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
                refiner_tables.cmu,
                refiner_tables.cmu_smoothed,
                refiner_tables.lafan1,
                refiner_tables.lafan1_smoothed,
                refiner_tables.cost,
                refiner_paper.paper,
            ],
        )
    )
