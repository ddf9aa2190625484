"""Homes that robots can use, read from a dataset that sfgen made.

    import sfgen
    for home in sfgen.load("data/shards"):
        print(home.scene_id, len(home.rooms), len(home.objects))

World frame: metres, Z up, right-handed; yaw in radians about +Z; at yaw 0 the front of an object faces -Y.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sfgen.dataset import Dataset, load
    from sfgen.homes import Home, Joint, Opening, PlacedObject, Room
    from sfgen.place import DatasetError

__all__ = ["Dataset", "DatasetError", "Home", "Joint", "Opening", "PlacedObject", "Room", "load"]
__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    """Import what is asked for when it is asked for, so that `sfgen --help` need not wait for numpy and pyarrow."""
    if name not in __all__:
        msg = f"module 'sfgen' has no attribute {name!r}"
        raise AttributeError(msg)
    module = import_module("sfgen.dataset" if name in {"Dataset", "load"} else "sfgen.homes")
    return getattr(module, name)
