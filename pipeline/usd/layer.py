"""Layers, prims, attributes: the small vocabulary that the converters are written in."""

import os
import re
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Sdf, Vt, Work

Work.SetConcurrencyLimit(1)  # a layer is written in some milliseconds: handing them to threads costs more than it brings


def new_layer(default_prim: str, suffix: str, data: Mapping[str, Any] | None = None) -> Sdf.Layer:
    """Start a layer: Z up, metres, kilograms. `suffix` is ".usda" or ".usdc"."""
    layer = Sdf.Layer.CreateAnonymous(suffix)
    layer.defaultPrim = default_prim
    root = layer.pseudoRoot
    root.SetInfo("upAxis", "Z")
    root.SetInfo("metersPerUnit", 1.0)
    root.SetInfo("kilogramsPerUnit", 1.0)
    if data:
        layer.customLayerData = dict(data)
    return layer


def read_layer(text: str, default_prim: str, suffix: str, data: Mapping[str, Any] | None = None) -> Sdf.Layer:
    """Return a layer as `new_layer` does, with the prims of a text."""
    layer = Sdf.Layer.CreateAnonymous(suffix)
    if not layer.ImportFromString(new_layer(default_prim, ".usda", data).ExportToString() + text):
        raise ValueError("USD does not read the prims that were written for it")
    return layer


def save(layer: Sdf.Layer, path: Path) -> Path:
    """Write the layer under a temporary name, then rename it, so that no half file is ever seen."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.stem}.part{path.suffix}")
    if not layer.Export(str(temporary)):
        raise OSError(f"cannot write {path}")
    os.replace(temporary, path)  # noqa: PTH105 - same call, and atomic
    return path


def crate(layer: Sdf.Layer) -> bytes:
    """Return the layer as the bytes of a .usdc file. USD writes those to paths only; they do not depend on where."""
    with tempfile.NamedTemporaryFile(suffix=".usdc") as scratch:
        if not layer.Export(scratch.name):
            raise OSError(f"cannot write {scratch.name}")
        return Path(scratch.name).read_bytes()


def prim(parent: Sdf.PrimSpec | Sdf.Layer, name: str, kind: str = "Xform", apis: Sequence[str] = ()) -> Sdf.PrimSpec:
    """Define a prim of schema `kind` with applied API schemas."""
    spec = Sdf.PrimSpec(parent, name, Sdf.SpecifierDef, kind)
    if apis:
        apply(spec, apis)
    return spec


def over(parent: Sdf.PrimSpec | Sdf.Layer, name: str) -> Sdf.PrimSpec:
    """Refer to a prim that another layer defines."""
    return Sdf.PrimSpec(parent, name, Sdf.SpecifierOver)


def apply(spec: Sdf.PrimSpec, apis: Iterable[str]) -> None:
    """Prepend API schemas to those that are applied already."""
    current = spec.GetInfo("apiSchemas")
    listed = [*current.prependedItems] if current else []
    operation = Sdf.TokenListOp()
    operation.prependedItems = listed + [a for a in apis if a not in listed]
    spec.SetInfo("apiSchemas", operation)


def attribute(spec: Sdf.PrimSpec, name: str, kind: str, value: Any = None, *, uniform: bool = False) -> Sdf.AttributeSpec:
    """Write an attribute of a type that USD knows by the name `kind`: "float", "point3f[]"."""
    variability = Sdf.VariabilityUniform if uniform else Sdf.VariabilityVarying
    attribute_spec = Sdf.AttributeSpec(spec, name, Sdf.ValueTypeNames.Find(kind), variability, False)
    if value is not None:
        attribute_spec.default = value
    return attribute_spec


def relationship(spec: Sdf.PrimSpec, name: str, targets: Iterable[Sdf.Path | str]) -> Sdf.RelationshipSpec:
    """Write a relationship with explicit targets (none: explicitly empty)."""
    relationship_spec = Sdf.RelationshipSpec(spec, name, False)
    relationship_spec.targetPathList.ClearEditsAndMakeExplicit()
    relationship_spec.targetPathList.explicitItems = [Sdf.Path(str(t)) for t in targets]
    return relationship_spec


def place(spec: Sdf.PrimSpec, position: Sequence[float], yaw: float = 0.0, scale: Sequence[float] | None = None) -> None:
    """Write translate, orient and scale, the three operations that physics engines expect."""
    attribute(spec, "xformOp:translate", "double3", Gf.Vec3d(*map(float, position)))
    attribute(spec, "xformOp:orient", "quatd", Gf.Quatd(float(np.cos(yaw / 2)), 0.0, 0.0, float(np.sin(yaw / 2))))
    attribute(spec, "xformOp:scale", "float3", Gf.Vec3f(*(map(float, scale) if scale is not None else (1.0, 1.0, 1.0))))
    order = ["xformOp:translate", "xformOp:orient", "xformOp:scale"]
    attribute(spec, "xformOpOrder", "token[]", Vt.TokenArray(order), uniform=True)


def label(spec: Sdf.PrimSpec, taxonomy: str, labels: Sequence[str]) -> None:
    """Label a prim, and what it holds, in a taxonomy: "class", "part", "wikidata_qcode" ..."""
    apply(spec, [f"SemanticsLabelsAPI:{taxonomy}"])
    attribute(spec, f"semantics:labels:{taxonomy}", "token[]", Vt.TokenArray(list(labels)))


def vec3s(points: NDArray[Any]) -> Vt.Vec3fArray:
    """Convert (n, 3) to an array of float3."""
    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(points, np.float32))


def identifiers(names: Iterable[str], taken: Iterable[str] = ()) -> list[str]:
    """Turn names into distinct USD identifiers, keeping those that are fine already."""
    used, distinct_names = set(taken), []
    for name in names:
        stem = re.sub(r"\W", "_", name, flags=re.ASCII) or "part"
        stem = stem if not stem[0].isdigit() else f"_{stem}"
        candidate, number = stem, 1
        while candidate in used:
            number += 1
            candidate = f"{stem}_{number}"
        used.add(candidate)
        distinct_names.append(candidate)
    return distinct_names
