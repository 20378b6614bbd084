"""Rigs: skeletons of any origin, which of their joints play which part, and how they stand."""
