"""USD export: assets as components with payloads, homes as thin stages of references; one `convert_x` per family.

Written with Sdf, layer by layer, because authoring through Usd composes the stage at every call. Layers are metres,
kilograms, Z up; hinges in degrees; relative paths only; the bytes depend on nothing but the arguments. Reading
is apart, in `usd.check`: it loads much more of USD.
"""

from pipeline.usd.home import write_home
from pipeline.usd.library import write_library
from pipeline.usd.mujoco import write_mujoco_overlay

__all__ = ["write_home", "write_library", "write_mujoco_overlay"]
