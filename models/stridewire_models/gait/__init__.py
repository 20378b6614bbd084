"""Fitting the gait model that synthetic libraries are drawn from, with numpy and scipy alone.

`takes` says which takes of the capture are used, `measuring` turns clips into steps, `fitting`
turns steps into coefficients; the model itself lives in `stridewire_engine.building.gait`.
"""
