"""3D-FUTURE models to assets: one folder with raw_model.obj, model.mtl and texture.png each, and model_info.json; and their mirror images."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from pipeline import taxonomy
from pipeline.arrays import Floats, Ints
from pipeline.entities.asset import Asset, Link, Mesh
from pipeline.entities.files import load_asset, save_asset
from pipeline.sources.densities import density
from pipeline.sources.guarded import Folder, read_json
from pipeline.sources.meshes.colliders import POCKET, build_link, solids
from pipeline.sources.meshes.obj_file import MAX_OBJ, parse_obj
from pipeline.sources.meshes.touching import touch_tolerances
from pipeline.sources.meshes.visual_meshes import Palette, visual_mesh
from pipeline.sources.reasons import Row, SourceError, reject
from pipeline.sources.settings import ModelLimits
from pipeline.sources.sizes import LONGEST, MIN_SIZE, likeliest_category, unit_factor
from pipeline.sources.threed_front.furniture import mirrored_id
from pipeline.sources.threed_front.model_hints import Hint
from pipeline.sources.threed_front.poses import Box, to_ours

Notes = list[tuple[str, str]]
NAMES = ("category", "super-category", "style", "theme", "material")
FLIP = np.array([-1.0, 1.0, 1.0])


@dataclass(frozen=True, slots=True)
class ModelInfo:
    """An entry of model_info.json; names as written, "" for null."""

    model_id: str
    category: str = ""
    super_category: str = ""
    style: str = ""
    theme: str = ""
    material: str = ""


def read_model_info(folder: Folder, file: str) -> tuple[dict[str, ModelInfo], list[Row]]:
    """Read model_info.json: entries by model id, the first of each; and a reject row per surplus or broken entry."""
    tree = read_json(folder, file)
    if not isinstance(tree, list):
        other = "; the ToolBox's file of that name is another: take the one beside the models" if isinstance(tree, dict) else ""
        raise SourceError("bad_structure", file, f"is no list of models{other}")
    by_id: dict[str, ModelInfo] = {}
    rejects: list[Row] = []
    for number, entry in enumerate(tree):
        model_id = entry.get("model_id") if isinstance(entry, dict) else None
        if not isinstance(model_id, str) or not model_id:
            rejects.append(reject("model", f"{file}#{number}", "bad_structure", "no model_id"))
        elif model_id in by_id:
            rejects.append(reject("model", model_id, "duplicate", "a second entry in model_info.json"))
        else:
            by_id[model_id] = ModelInfo(model_id, *(n if isinstance(n := entry.get(k), str) else "" for k in NAMES))
    return by_id, rejects


@dataclass(frozen=True, slots=True)
class FutureModel:
    """An asset, the box of its file, and what was repaired."""

    asset: Asset
    box: Box
    rejects: tuple[Row, ...]


def read_model(models: Folder, info: ModelInfo, limits: ModelLimits, licence: str, hint: Hint | None = None) -> FutureModel:
    """Read the model of `info` from its folder in `models`; `hint` is what scene records say of it.

    The mesh is turned into our frame, (x, y, z) -> (x, -z, y), scaled to metres, and its box set bottom-centred at the
    origin. Raises SourceError for what cannot be an asset.
    """
    folder, words = models.sub(info.model_id), taxonomy.load()
    file = parse_obj(folder.read("raw_model.obj", MAX_OBJ), "raw_model.obj")
    used = np.unique(np.concatenate([g.faces.ravel() for g in file.groups]))
    low, high = file.vertices[used].min(axis=0), file.vertices[used].max(axis=0)
    extent = (high - low)[[0, 2, 1]]
    category, unit, notes = identify_category(info, hint or Hint(), extent)
    size = np.round(extent * unit, 4)
    if size.max() > LONGEST or size.min() < MIN_SIZE:
        raise SourceError("bad_size", info.model_id, f"size {size.tolist()}")
    middle = np.array([(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2])
    points = to_ours((file.vertices - middle) * unit)
    palette = Palette(folder, limits.max_texture)
    visuals: list[Mesh] = []
    collisions: list[tuple[Floats, Ints]] = []
    for group in file.groups:
        mesh = visual_mesh(group, file, points, f"mesh_{len(visuals):03d}", palette.named(file.library, "", group.material))
        if mesh:
            visuals.append(mesh)
            collisions.append((points, group.faces))
    known = words.categories[category]
    kind, how = known.super, touch_tolerances(known, opens=False)
    matter = solids("base", collisions, limits, POCKET * float(np.linalg.norm(size)) if limits.cut == "all" else None)
    base = build_link("base", visuals, matter, density(kind, info.material, category), kind, how=how)
    if not base.visuals or not base.colliders:
        raise SourceError("not_obj", info.model_id, "has no face with an area")
    asset_id = f"ff_{''.join(c if c.isalnum() and c.isascii() else '_' for c in info.model_id.lower())}"
    asset = Asset(
        asset_id, category, size, (base,), (), tuple(palette.materials), "3d-future", info.model_id, licence,
        words.styles.get(info.style.lower(), ""), kind, dict(palette.textures),
    )  # fmt: skip
    rejects = tuple(reject("model", info.model_id, *note) for note in (*notes, *matter.notes, *palette.notes))
    return FutureModel(asset, Box(tuple(low.tolist()), tuple(high.tolist()), unit), rejects)


def identify_category(info: ModelInfo, hint: Hint, extent: Floats) -> tuple[str, float, Notes]:
    """Return the category of a model of `extent` (w, d, h) [its own units], the factor to metres, and what had to be inferred.

    The category is that of model_info.json, else of the scenes' records; where both name a super-category at most, the
    member of it whose sizes fit best. Raises SourceError `unknown_category` where nothing is known.
    """
    notes: Notes = []
    words, declared = taxonomy.load(), hint.box()
    named = f"category {info.category!r}, super-category {info.super_category!r}"
    category = words.from_future(info.category)
    if category is None:
        members = words.of_kind(info.category, info.super_category, hint.kind())
        mounted = [m for m in members if words.categories[m].mount in hint.mounts()] or members
        category = hint.category() or likeliest_category(extent * unit_factor(extent, declared, None), mounted)
        if category is None:
            raise SourceError("unknown_category", info.model_id, named)
        notes.append(("category_inferred", f"{category}, for {named}"))
    unit = unit_factor(extent, declared, category)
    if unit != 1.0:
        against = f"declared {np.round(declared, 3).tolist()}" if declared is not None else f"as {category}"
        notes.append(("centimetres", f"extent {np.round(extent, 4).tolist()}, {against}: times {unit:g}"))
    for kind, name, known in (("style", info.style, words.styles), ("material", info.material, words.materials)):
        if name and name.lower() not in known:
            notes.append(("unknown_name", f"{kind} {name!r}"))
    return category, unit, notes


def add_mirrored(folder: Path, assets: list[Row], used: Iterable[str]) -> list[Row]:
    """Write the mirror images that are among the `used` asset ids, and return their rows of the assets table.

    3D-FRONT places some furniture with a negative scale, such as an L-shaped sofa of the other hand. `assets` are the rows of the
    models themselves, whose files lie in `folder`.
    """
    origin = {mirrored_id(row["asset_id"]): row for row in assets}
    rows = []
    for asset_id in sorted(set(used) & origin.keys()):
        row, file = origin[asset_id], f"{asset_id}.safetensors"
        asset = load_asset(folder / row["file"])
        digest = save_asset(folder / file, replace(asset, asset_id=asset_id, links=tuple(map(_mirror, asset.links))))
        rows.append({**row, "asset_id": asset_id, "file": file, "sha256": digest})
    return rows


def _mirror(link: Link) -> Link:
    """Return the mirror image of a link across its width (x), faces turned so that they still look outwards."""
    visuals, colliders = (
        tuple(replace(m, vertices=m.vertices * FLIP.astype(np.float32) + np.float32(0), faces=m.faces[:, ::-1].copy()) for m in meshes)
        for meshes in (link.visuals, link.colliders)
    )
    turn = np.outer(FLIP, FLIP)
    return replace(link, visuals=visuals, colliders=colliders, com=link.com * FLIP + 0.0, inertia=link.inertia * turn + 0.0)
