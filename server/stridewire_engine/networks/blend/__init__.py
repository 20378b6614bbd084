"""The posture-blending network: postures, pairs, features, corrections and the session."""

from stridewire_engine.networks.blend.network import BlendNetwork, blend_network
from stridewire_engine.networks.blend.postures import PairFrame, Postures

__all__ = ["BlendNetwork", "PairFrame", "Postures", "blend_network"]
"""What serving needs; training also imports the modules."""
