"""The layout model: a diffusion over sets of objects, conditioned on the room's walls, doors and windows."""
