"""Asset files: one safetensors file per asset, meshes as tensors, the rest as JSON in its header."""

import json
import math
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import save

from pipeline.entities.asset import Asset, Joint, Link, Material, Mesh, PartBox
from pipeline.errors import ContentError
from pipeline.manifest import canonical, sha256, write_bytes

FORMAT = "sfgen-asset-1"
PLAIN = ("asset_id", "category", "source", "source_id", "licence", "style", "super_category")
RECORDS: dict[str, type[Any]] = {"joints": Joint, "materials": Material, "parts": PartBox}
ARRAYS = frozenset({"axes", "axis", "centre", "com", "inertia", "origin", "size"})
LIMITS = {"lower": -math.inf, "upper": math.inf}  # of a joint that has none, null in the file


def save_asset(path: Path, asset: Asset) -> str:
    """Write an asset file (atomically) and return its sha256. The bytes depend on nothing but the asset."""
    data = encode(asset)
    write_bytes(path, data, flush=False)
    return sha256(data)


def encode(asset: Asset) -> bytes:
    """Serialise an asset to safetensors bytes."""
    tensors: dict[str, np.ndarray[Any, Any]] = {}
    links = []
    for i, link in enumerate(asset.links):
        entry = _entry(link)
        for kind in ("visuals", "colliders"):
            entry[kind] = []
            for j, mesh in enumerate(getattr(link, kind)):
                key = f"{i:03d}.{kind}.{j:04d}"
                tensors[f"{key}.v"] = np.ascontiguousarray(mesh.vertices, np.float32)
                tensors[f"{key}.f"] = np.ascontiguousarray(mesh.faces, np.int32)
                if mesh.uv is not None:
                    tensors[f"{key}.t"] = np.ascontiguousarray(mesh.uv, np.float32)
                entry[kind].append({"name": mesh.name, "material": mesh.material, "part": mesh.part})
        links.append(entry)
    for name, blob in sorted(asset.textures.items()):
        tensors[f"texture.{name}"] = np.frombuffer(blob, np.uint8)
    header = {"format": FORMAT, **{k: getattr(asset, k) for k in PLAIN}, "size": asset.size.tolist(), "links": links}
    header |= {kind: [_entry(record) for record in getattr(asset, kind)] for kind in RECORDS}
    # One metadata key only: safetensors keeps them in a hash map whose order changes from run to run.
    return save(tensors, {"asset": canonical(header).decode()})


def load_asset(path: Path) -> Asset:
    """Read an asset file. Raises ContentError when it is missing, truncated or of another format."""
    try:
        with safe_open(path, "numpy") as handle:
            header = json.loads((handle.metadata() or {})["asset"])
            if header["format"] != FORMAT:
                raise ContentError(f"{path} is not an asset file ({FORMAT})", "delete it and run `dvc repro` again")
            tensors = {k: handle.get_tensor(k) for k in handle.keys()}  # noqa: SIM118 - not a dict
        return _decode(header, tensors)
    except (OSError, SafetensorError, KeyError, TypeError, ValueError) as error:
        msg = f"cannot read the asset file {path} ({str(error).splitlines()[0]})"
        raise ContentError(msg, "delete it and run `dvc repro` again") from error


def _decode(header: dict[str, Any], tensors: dict[str, np.ndarray[Any, Any]]) -> Asset:
    def meshes(i: int, kind: str, entries: list[dict[str, Any]]) -> tuple[Mesh, ...]:
        keys = [f"{i:03d}.{kind}.{j:04d}" for j in range(len(entries))]
        arrays = [(tensors[f"{key}.v"], tensors[f"{key}.f"], tensors.get(f"{key}.t")) for key in keys]
        return tuple(Mesh(vertices=v, faces=f, uv=uv, **entry) for entry, (v, f, uv) in zip(entries, arrays, strict=True))

    links = [
        _record(Link, {**e, **{kind: meshes(i, kind, e[kind]) for kind in ("visuals", "colliders")}}) for i, e in enumerate(header["links"])
    ]
    records: dict[str, Any] = {kind: tuple(_record(cls, entry) for entry in header.get(kind, ())) for kind, cls in RECORDS.items()}
    textures = {k.removeprefix("texture."): v.tobytes() for k, v in tensors.items() if k.startswith("texture.")}
    return Asset(size=np.array(header["size"]), links=tuple(links), textures=textures, **records, **{k: header[k] for k in PLAIN})


def _entry(record: Link | Joint | Material | PartBox) -> dict[str, Any]:
    """Return a record as JSON has it: arrays as lists, no limit as null."""
    values = {f.name: getattr(record, f.name) for f in fields(record)}
    return {k: v.tolist() if isinstance(v, np.ndarray) else None if v == LIMITS.get(k) else v for k, v in values.items()}


def _record(cls: type[Any], entry: dict[str, Any]) -> Any:
    known = {**entry, **{k: LIMITS[k] for k in LIMITS.keys() & entry.keys() if entry[k] is None}}
    return cls(**{k: np.array(v) if k in ARRAYS else tuple(v) if isinstance(v, list) else v for k, v in known.items()})
