"""3D-FUTURE models to assets: one folder with raw_model.obj, model.mtl and texture.png each, and model_info.json."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import Asset, Mesh
from pipeline.sources.densities import density
from pipeline.sources.guarded import Folder, read_json
from pipeline.sources.meshes.colliders import POCKET, Ints, link, solids
from pipeline.sources.meshes.touching import touch_tolerances
from pipeline.sources.meshes.visual_meshes import Palette, read_obj, visual
from pipeline.sources.reasons import Row, SourceError, reject
from pipeline.sources.settings import ModelLimits
from pipeline.sources.threed_front.furniture import MIN_SIZE
from pipeline.sources.threed_front.future_scale import LONGEST, likeliest, unit_factor
from pipeline.sources.threed_front.model_hints import Hint
from pipeline.sources.threed_front.poses import Box, to_ours
from pipeline.taxonomy import Taxonomy

Floats = NDArray[np.float64]
Notes = list[tuple[str, str]]


@dataclass(frozen=True, slots=True)
class ModelInfo:
    """An entry of model_info.json; names as written, "" for null."""

    model_id: str
    category: str
    super_category: str
    style: str
    theme: str
    material: str


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
            names = (entry.get(k) for k in ("category", "super-category", "style", "theme", "material"))
            by_id[model_id] = ModelInfo(model_id, *(n if isinstance(n, str) else "" for n in names))
    return by_id, rejects


def asset_id(jid: str) -> str:
    """Return the asset id of a model."""
    return f"ff_{''.join(c if c.isalnum() and c.isascii() else '_' for c in jid.lower())}"


@dataclass(frozen=True, slots=True)
class FutureModel:
    """An asset, the box of its file, and what was repaired."""

    asset: Asset
    box: Box
    rejects: tuple[Row, ...]


def read_model(
    models: Folder,
    info: ModelInfo,
    taxonomy: Taxonomy,
    limits: ModelLimits,
    licence: str,
    hint: Hint | None = None,
    *,
    cut: bool = False,
) -> FutureModel:
    """Read the model of `info` from its folder in `models`; `hint` is what scene records say of it.

    With `cut` parts that are not convex are cut. The mesh is turned into our frame, (x, y, z) -> (x, -z, y), scaled to metres, and its box set bottom-centred at the
    origin. Raises SourceError for what cannot be an asset.
    """
    folder = models.sub(info.model_id)
    file = read_obj(folder, "raw_model.obj")
    used = np.unique(np.concatenate([g.faces.ravel() for g in file.groups]))
    low, high = file.vertices[used].min(axis=0), file.vertices[used].max(axis=0)
    extent = (high - low)[[0, 2, 1]]
    category, unit, notes = identify_category(info, hint or Hint(), extent, taxonomy)
    size = np.round(extent * unit, 4)
    if size.max() > LONGEST or size.min() < MIN_SIZE:
        raise SourceError("bad_size", info.model_id, f"size {size.tolist()}")
    box = Box(tuple(low.tolist()), tuple(high.tolist()), unit)
    middle = np.array([(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2])
    points = to_ours((file.vertices - middle) * unit)
    palette = Palette(folder, limits.max_texture)
    visuals: list[Mesh] = []
    collisions: list[tuple[Floats, Ints]] = []
    for group in file.groups:
        mesh = visual(group, file, points, f"mesh_{len(visuals):03d}", palette.index(file.library, "", group.material))
        if mesh:
            visuals.append(mesh)
            collisions.append((points, group.faces))
    known = taxonomy.categories[category]
    kind, how = known.super, touch_tolerances(known, opens=False)
    matter = solids("base", collisions, limits, POCKET * float(np.linalg.norm(size)) if cut else None)
    base = link("base", visuals, matter, density(kind, info.material, category), kind, how=how)
    if not base.visuals or not base.colliders:
        raise SourceError("not_obj", info.model_id, "has no face with an area")
    asset = Asset(
        asset_id(info.model_id), category, size, (base,), (), tuple(palette.materials), "3d-future", info.model_id, licence,
        taxonomy.styles.get(info.style.lower(), ""), kind, dict(palette.textures),
    )  # fmt: skip
    notes += [*matter.notes, *palette.notes]
    return FutureModel(asset, box, tuple(reject("model", info.model_id, reason, detail) for reason, detail in notes))


def identify_category(info: ModelInfo, hint: Hint, extent: Floats, taxonomy: Taxonomy) -> tuple[str, float, Notes]:
    """Return the category of a model of `extent` (w, d, h) [its own units], the factor to metres, and what had to be inferred.

    The category is that of model_info.json, else of the scenes' records; where both name a super-category at most, the
    member of it whose sizes fit best. Raises SourceError `unknown_category` where nothing is known.
    """
    notes: Notes = []
    category = taxonomy.from_future(info.category)
    declared = hint.box()
    if category is None:
        category = hint.category()
        if category is None:
            size = extent * unit_factor(extent, declared, None)
            members = taxonomy.of_kind(info.category, info.super_category, hint.kind())
            category = likeliest(size, [m for m in members if taxonomy.categories[m].mount in hint.mounts()] or members)
        if category is None:
            named = f"category {info.category!r}, super-category {info.super_category!r}"
            raise SourceError("unknown_category", info.model_id, named)
        notes.append(("category_inferred", f"{category}, for category {info.category!r}, super-category {info.super_category!r}"))
    unit = unit_factor(extent, declared, category)
    if unit != 1.0:
        against = f"declared {np.round(declared, 3).tolist()}" if declared is not None else f"as {category}"
        notes.append(("centimetres", f"extent {np.round(extent, 4).tolist()}, {against}: times {unit:g}"))
    for kind, name, known in (("style", info.style, taxonomy.styles), ("material", info.material, taxonomy.materials)):
        if name and name.lower() not in known:
            notes.append(("unknown_name", f"{kind} {name!r}"))
    return category, unit, notes
