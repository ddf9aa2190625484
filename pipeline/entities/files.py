"""Asset files: one safetensors file per asset, meshes as tensors, the rest as JSON in its header."""

import json
import math
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import save

from pipeline.entities.asset import Asset, Joint, Link, Material, Mesh, PartBox
from pipeline.errors import ContentError
from pipeline.manifest import canonical, sha256, write_bytes

FORMAT = "sfgen-asset-1"


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
        entry: dict[str, Any] = {"name": link.name, "mass": link.mass, "com": link.com.tolist(), "inertia": link.inertia.tolist()}
        for kind, meshes in (("visuals", link.visuals), ("colliders", link.colliders)):
            entry[kind] = []
            for j, mesh in enumerate(meshes):
                key = f"{i:03d}.{kind}.{j:04d}"
                tensors[f"{key}.v"] = np.ascontiguousarray(mesh.vertices, np.float32)
                tensors[f"{key}.f"] = np.ascontiguousarray(mesh.faces, np.int32)
                if mesh.uv is not None:
                    tensors[f"{key}.t"] = np.ascontiguousarray(mesh.uv, np.float32)
                entry[kind].append({"name": mesh.name, "material": mesh.material, "part": mesh.part})
        links.append(entry)
    for name, blob in sorted(asset.textures.items()):
        tensors[f"texture.{name}"] = np.frombuffer(blob, np.uint8)
    header = {
        "format": FORMAT,
        **{k: getattr(asset, k) for k in ("asset_id", "category", "source", "source_id", "licence", "style", "super_category")},
        "size": asset.size.tolist(),
        "links": links,
        "joints": [
            {
                **asdict(j),
                "axis": j.axis.tolist(),
                "origin": j.origin.tolist(),
                "lower": _encode_limit(j.lower),
                "upper": _encode_limit(j.upper),
            }
            for j in asset.joints
        ],
        "materials": [asdict(m) for m in asset.materials],
        "parts": [{**asdict(p), "centre": p.centre.tolist(), "axes": p.axes.tolist(), "size": p.size.tolist()} for p in asset.parts],
    }
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
    except (OSError, SafetensorError, KeyError, ValueError) as error:
        msg = f"cannot read the asset file {path} ({str(error).splitlines()[0]})"
        raise ContentError(msg, "delete it and run `dvc repro` again") from error


def _decode(header: dict[str, Any], tensors: dict[str, np.ndarray[Any, Any]]) -> Asset:
    def meshes(i: int, kind: str, entries: list[dict[str, Any]]) -> tuple[Mesh, ...]:
        pieces = []
        for j, entry in enumerate(entries):
            key = f"{i:03d}.{kind}.{j:04d}"
            pieces.append(
                Mesh(entry["name"], tensors[f"{key}.v"], tensors[f"{key}.f"], entry["material"], tensors.get(f"{key}.t"), entry["part"])
            )
        return tuple(pieces)

    links = tuple(
        Link(
            e["name"],
            meshes(i, "visuals", e["visuals"]),
            meshes(i, "colliders", e["colliders"]),
            e["mass"],
            np.array(e["com"]),
            np.array(e["inertia"]),
        )
        for i, e in enumerate(header["links"])
    )
    joints = tuple(
        Joint(
            **{
                **j,
                "axis": np.array(j["axis"]),
                "origin": np.array(j["origin"]),
                "lower": _decode_limit(j["lower"], -1),
                "upper": _decode_limit(j["upper"], 1),
                "after": tuple(j.get("after", ())),
            }
        )
        for j in header["joints"]
    )
    materials = tuple(Material(**{**m, "base_color": tuple(m["base_color"])}) for m in header["materials"])
    parts = tuple(
        PartBox(**{**p, "centre": np.array(p["centre"]), "axes": np.array(p["axes"]), "size": np.array(p["size"])})
        for p in header.get("parts", ())
    )
    textures = {k.removeprefix("texture."): v.tobytes() for k, v in tensors.items() if k.startswith("texture.")}
    plain = {k: header[k] for k in ("asset_id", "category", "source", "source_id", "licence", "style", "super_category")}
    return Asset(size=np.array(header["size"]), links=links, joints=joints, materials=materials, textures=textures, parts=parts, **plain)


def _encode_limit(value: float) -> float | None:
    return None if math.isinf(value) else value


def _decode_limit(value: float | None, sign: int) -> float:
    return sign * math.inf if value is None else value
