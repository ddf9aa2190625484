"""Frames: where prims are, and the way back."""

import numpy as np
from pxr import Usd, UsdGeom

from pipeline.export.model import Floats


def world(cache: UsdGeom.XformCache, prim: Usd.Prim) -> Floats:
    """Return T_world_prim (4, 4), scale included."""
    return np.array(cache.GetLocalToWorldTransform(prim), np.float64).T


def inverse(T: Floats) -> Floats:
    """Return T_child_parent of T_parent_child."""
    return np.asarray(np.linalg.inv(T), np.float64)
