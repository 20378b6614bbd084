"""Synthetic gait: from scripted speeds and turns to clips with exact contacts.

A script says how the body travels (`script`), `cycle` runs the phase of the steps along it, a model
fitted on capture says how bodies move at each phase (`model`, `body`), `planting` puts the feet
down in the world, `figure` bends the legs to them and makes the clip; `draw` is all in one call.
"""
