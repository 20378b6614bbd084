"""The recurrent motion refiner: plans, features, guidance, pairs and the session.

After Kim et al. 2023 (*Recurrent Motion Refiner for Locomotion Stitching*). Instead of poses it
gives contacts and the targets of swings to the stance-aware stitcher.
"""

from stridewire_engine.networks.rmr.guidance import Guidance
from stridewire_engine.networks.rmr.plans import Plans, seams_of
from stridewire_engine.networks.rmr.refiner import Refiner, shipped_refiner

__all__ = ["Guidance", "Plans", "Refiner", "seams_of", "shipped_refiner"]
