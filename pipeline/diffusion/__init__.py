"""The layout model: a diffusion over sets of objects, conditioned on the room's walls, doors and windows."""

import importlib

from pipeline.diffusion.late import postpone

postpone()  # before anything here imports torch
importlib.import_module("torch._prims.rng_prims")  # makes torch's generators what they are; else a late module of LATE would
