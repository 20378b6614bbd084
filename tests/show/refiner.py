"""`make show-refiner`: what stitching and the network that guides it must show."""

import sys

import refiner_live
import refiner_paper
import refiner_remedies
import refiner_sheets
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
                refiner_live.live,
                refiner_live.live_critic,
                refiner_remedies.remedies,
                refiner_remedies.tick_cost,
                refiner_sheets.sheets,
            ],
        )
    )
