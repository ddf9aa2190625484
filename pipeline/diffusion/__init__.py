"""The layout model: a diffusion over sets of objects, conditioned on the room's walls, doors and windows."""

import importlib
import sys
from types import ModuleType
from typing import Any


class LateModule(ModuleType):
    """Stands in `sys.modules` for a module that is read when a name in it is first looked up; `inspect` looks up dunders in all modules."""

    def __getattr__(self, name: str) -> Any:
        """Read the module, and look there."""
        if name.startswith("__"):
            raise AttributeError(name)
        if sys.modules.get(self.__name__) is self:
            del sys.modules[self.__name__]
        return getattr(importlib.import_module(self.__name__), name)


# What tensors without data and compiled graphs need: nothing here has any, and reading it takes a quarter of torch's start, and 12 MiB.
sys.modules.setdefault("torch._meta_registrations", LateModule("torch._meta_registrations"))  # before anything here imports torch
importlib.import_module("torch._prims.rng_prims")  # makes torch's generators what they are; else the late module would
