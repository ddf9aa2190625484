"""Prims as text: what a home consists of is converted once, and then written again and again under other names, at other places.

Writing through Sdf costs some ten microseconds an attribute, and a home has four thousand; its text is read in one go.
"""

import functools
import json
from collections.abc import Callable, Iterable, Sequence

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf

from pipeline.usd.layer import prim

Convert = Callable[[Sdf.Layer], object]


def template_of(convert: Convert, without: Iterable[str] = ()) -> str:
    """Return the prim /Template that `convert` writes into a layer as text, less the properties that each instance has of its own."""
    layer = Sdf.Layer.CreateAnonymous(".usda")
    convert(layer)
    spec = layer.GetPrimAtPath("/Template")
    for name in without:
        spec.RemoveProperty(spec.properties[name])
    text: str = layer.ExportToString()
    return text[text.index("def ") :]


def instantiate(template: str, path: str, own: str = "") -> str:
    """Return the prim of a template as it stands at `path`, with properties and children of its `own`."""
    parent, name = path.rsplit("/", 1)
    text = template.replace('"Template"', f'"{name}"', 1).replace("</Template", f"<{parent}/{name}")
    return text.replace("{\n", f"{{\n{own}", 1)


@functools.cache
def group(kind: str = "", schema: str = "Xform") -> str:
    """Return the template of a prim that holds others, of a model kind or "" for none."""

    def convert(layer: Sdf.Layer) -> None:
        spec = prim(layer, "Template", schema)
        if kind:
            spec.kind = kind

    return template_of(convert)


def transform_ops(position: Sequence[float], yaw: float = 0.0, scale: Sequence[float] = (1.0, 1.0, 1.0)) -> str:
    """Return translate, orient and scale, as `layer.place` writes them."""
    return (
        f"double3 xformOp:translate = {numbers(position)}\n"
        f"quatd xformOp:orient = {_turn(yaw)}\n"
        f"float3 xformOp:scale = {numbers(scale)}\n"
        'uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:orient", "xformOp:scale"]\n'
    )


@functools.lru_cache(maxsize=1024)
def _turn(yaw: float) -> str:
    """Return the quaternion of a turn about +Z; most of what stands in a home is turned by quarters."""
    return numbers((np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)))


def mesh_attributes(points: NDArray[np.floating], normals: NDArray[np.floating], interpolation: str = "uniform") -> str:
    """Return the points (n, 3) [m] of a mesh, their extent, and normals, one a face ("uniform") or a point ("vertex")."""
    rows = np.asarray(points, np.float32)
    ends = np.array([rows.min(axis=0), rows.max(axis=0)])
    shading = f'normal3f[] normals = {rows_of(np.asarray(normals, np.float32))} (interpolation = "{interpolation}")'
    return f"point3f[] points = {rows_of(rows)}\nfloat3[] extent = {rows_of(ends)}\n{shading}\n"


def numbers(values: Sequence[float]) -> str:
    """Return a tuple of numbers that reads back to the same bits."""
    return str((*map(float, values),))


def rows_of(values: NDArray[np.float32]) -> str:
    """Return an array (n, k) as tuples."""
    return str([*map(tuple, values.tolist())])


def quote(text: str) -> str:
    """Return a string in quotes."""
    return json.dumps(text, ensure_ascii=False)
