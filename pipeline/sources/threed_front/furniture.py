"""Furniture of a 3D-FRONT room as placed boxes, each kept or left out with a reason; and what stands on or in what, for scene files say nothing of it."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely.geometry import Polygon

from pipeline.arrays import Floats
from pipeline.entities.home import Placement
from pipeline.sources.settings import FrontFilters
from pipeline.sources.sizes import LONGEST, MIN_SIZE, likeliest_category
from pipeline.sources.threed_front.house_file import FARTHEST, Child, Furniture
from pipeline.sources.threed_front.notches import overlap_share
from pipeline.sources.threed_front.poses import Box, Pose, place, yaw_and_tilt
from pipeline.taxonomy import Taxonomy

ON = 0.03  # [m] what starts within this height of another's top stands on it
RAISED = 0.003  # [m] what starts no higher stands on the floor
LEAST = 0.7  # share of a thing's footprint that must be over its support's
STANDING, TALL = 0.1, 1.0  # [m] a lamp whose foot is lower and that is higher hangs from no ceiling
BELOW = 0.05  # [m] under the floor: rounding of the source


@dataclass(frozen=True, slots=True)
class Model:
    """What a house needs to know of a model: its box, its category, whether an asset was made of it, and what of its box it fills."""

    box: Box
    category: str
    asset_id: str
    asset_size: tuple[float, float, float]
    openable: bool = False
    shape: bytes = b""


@dataclass(frozen=True, slots=True)
class Placed:
    """An accepted object: `scale` (3,) on the asset's size; `notes` are (reason, detail) of what was repaired.

    `shape` is what of its box it fills, see `front_shapes`; `filed` the room under which the file has it, where that is another.
    """

    child: Child
    jid: str
    category: str
    asset_id: str
    pose: Pose
    scale: Floats
    openable: bool
    notes: tuple[tuple[str, str], ...]
    shape: bytes = b""
    filed: str = ""

    def footprint(self) -> Polygon:
        """Return the box in plan."""
        return Polygon(Placement("", "", "", "", self.pose.position, self.pose.yaw, self.pose.size).footprint())

    @property
    def span(self) -> tuple[float, float]:
        """Return bottom and top [m]."""
        return float(self.pose.position[2]), float(self.pose.position[2] + self.pose.size[2])


def mirrored_id(asset_id: str) -> str:
    """Return the id of the asset that is the mirror image, across its width, of another."""
    return f"{asset_id}_mirrored"


def stated_category(record: Furniture, taxonomy: Taxonomy) -> str | None:
    """Return the category that a scene's record names, by the kind in its title where by nothing else."""
    return taxonomy.from_future(record.category) or taxonomy.from_title(record.title)


def category_of(record: Furniture, taxonomy: Taxonomy) -> str | None:
    """Return the category that the scene's own record gives.

    Where no more is said than a super-category or the title's group, the member whose sizes fit the declared box best.
    """
    named = stated_category(record, taxonomy)
    if named or record.box is None:
        return named
    return likeliest_category(np.array(record.box), taxonomy.of_kind(*record.kinds))


def place_furniture(  # noqa: PLR0911 - one return per reason
    child: Child, record: Furniture, models: Mapping[str, Model], taxonomy: Taxonomy, limits: FrontFilters
) -> Placed | tuple[str, str]:
    """Return the object, whatever room it lies in, or (reason, detail) for leaving it out."""
    if record.valid is not True:
        return "invalid_flag", f"valid is {record.valid}, category {record.category!r}"
    jid = child.replaced_by or record.jid
    model = models.get(jid)
    category = model.category if model else category_of(record, taxonomy)
    if category is None:
        return "unknown_category", f"category {record.category!r}, title {record.title!r}"
    if model is None and not (limits.keep_without_model and record.box):
        return "missing_model", f"no asset of model {jid}"
    if np.abs(child.position).max() > FARTHEST:
        return "bad_number", f"stands {np.abs(child.position).max():.3g} m from the origin"
    magnitude = np.abs(child.scale)
    if magnitude.min() < 1e-5 or magnitude.max() > limits.max_scale:
        return "bad_scale", f"scale {child.scale.tolist()}"
    yaw, tilt = yaw_and_tilt(child.rotation)
    if tilt > limits.max_tilt or child.scale[1] < 0:
        return "tilted", f"by {tilt:.3f} rad, scale {child.scale.tolist()}"
    pose, scale, notes = _pose(child, record, model, yaw)
    if pose.size.max() > LONGEST or pose.size.min() < MIN_SIZE:
        return "bad_size", f"size {np.round(pose.size, 3).tolist()}"
    asset_id = "" if model is None else mirrored_id(model.asset_id) if pose.mirrored else model.asset_id
    piece = Placed(child, jid, category, asset_id, pose, scale, bool(model and model.openable), notes, model.shape if model else b"")
    low, top = piece.span
    if taxonomy.categories[category].mount == "ceiling" and low < STANDING and top - low > TALL:
        note = ("category_inferred", f"floor_lamp, for a {category} of {top - low:.2f} m that stands on the floor")
        piece = replace(piece, category="floor_lamp", notes=(*notes, note))
    if low < -BELOW or top > limits.max_top:
        return "bad_height", f"from {low:.2f} to {top:.2f} m"
    return piece


def share_inside(piece: Placed, floor: Polygon) -> float:
    """Return the share of an object's footprint that lies on a floor, in whole per cent: what is said of it is what counts."""
    footprint = piece.footprint()
    return round(float(footprint.intersection(floor).area / footprint.area), 2)


def _pose(child: Child, record: Furniture, model: Model | None, yaw: float) -> tuple[Pose, Floats, tuple[tuple[str, str], ...]]:
    """Return pose, scale on the asset, and notes; position and size rounded to 0.1 mm."""
    w, d, h = record.box or (0.0, 0.0, 0.0)
    raw = place(model.box if model else Box((-w / 2, 0.0, -d / 2), (w / 2, h, d / 2)), child.position, yaw, child.scale)
    pose = Pose(np.round(raw.position, 4) + 0.0, raw.yaw, np.round(raw.size, 4), raw.mirrored)
    scale = np.round(pose.size / np.array(model.asset_size), 6) if model else np.ones(3)
    bare = () if model else (("size_from_bbox", f"model {record.jid}"),)
    return pose, scale, (*bare, ("mirrored", f"scale {child.scale.tolist()}")) if pose.mirrored else bare


def shared_volume(a: Placed, b: Placed) -> float:
    """Return the volume that two boxes share, as a share of the smaller one's."""
    height = min(a.span[1], b.span[1]) - max(a.span[0], b.span[0])
    if height <= 0:
        return 0.0
    area = float(a.footprint().intersection(b.footprint()).area)
    return area * height / float(min(np.prod(a.pose.size), np.prod(b.pose.size)))


def shared_shape(a: Placed, b: Placed) -> float:
    """Return what `shared_volume` does for the shapes in the boxes, as far as the models tell: the lower of the two figures."""
    boxes = shared_volume(a, b)
    if not (a.shape or b.shape) or boxes == 0.0:
        return boxes
    first, second = sorted((a, b), key=lambda o: float(np.prod(o.pose.size)))
    return min(boxes, overlap_share((first.pose, first.shape), (second.pose, second.shape)))


def find_overlaps(objects: list[Placed], limits: FrontFilters, taxonomy: Taxonomy) -> dict[int, tuple[int, float]]:
    """Return {index of the object to drop: (index of what it is in, share)}.

    Rule: largest box first, an object is dropped when it shares more than `max_overlap` of the smaller one's volume
    with one that was kept; a seat at a table may share up to `max_overlap_tucked`, for its box reaches under the top. What counts is
    the models' shapes, where they are known. Lamps come last: they evict nobody. Small things lie in furniture's boxes by right.
    """
    large = [i for i, o in enumerate(objects) if o.category not in taxonomy.small]
    lamps = {c.name for c in taxonomy.categories.values() if c.super == "lighting"}
    order = sorted(large, key=lambda i: (objects[i].category in lamps, -float(np.prod(objects[i].pose.size)), i))
    shapes = np.array([o.footprint() for o in objects], dtype=object)
    near: dict[int, list[int]] = defaultdict(list)
    for i, j in zip(*shapely.STRtree(shapes).query(shapes, predicate="intersects"), strict=True):
        near[int(i)].append(int(j))
    dropped: dict[int, tuple[int, float]] = {}
    kept: set[int] = set()
    for i in order:
        for j in filter(kept.__contains__, near[i]):
            tucked = sum(taxonomy.categories[objects[k].category].tuck_role for k in (i, j)) == 3
            most = limits.max_overlap_tucked if tucked else limits.max_overlap
            share = round(shared_volume(objects[i], objects[j]), 2)
            share = round(shared_shape(objects[i], objects[j]), 2) if share > most else share
            if share > most:
                dropped[i] = (j, share)
                break
        else:
            kept.add(i)
    return dropped


def supports(objects: Sequence[Placed], taxonomy: Taxonomy) -> list[int]:
    """Return for each object of a room the index of what it stands on or in, -1 for the floor, a wall, the ceiling.

    A thing stands on the highest box whose top it starts at; else it is in the smallest box around its foot.
    """
    bearers = [-1] * len(objects)
    shapes = np.array([o.footprint() for o in objects])
    raised = [i for i, o in enumerate(objects) if o.span[0] > RAISED and taxonomy.categories[o.category].mount != "ceiling"]
    if not raised:
        return bearers
    areas = shapely.area(shapes)
    for i in raised:
        z = objects[i].span[0]
        over = shapely.area(shapely.intersection(shapes[i], shapes)) >= LEAST * areas[i]
        below = [
            j
            for j in np.flatnonzero(over).tolist()
            if j != i and objects[j].span[0] < z - RAISED / 2 and z <= objects[j].span[1] + ON and areas[j] > areas[i]
        ]
        on = [j for j in below if z >= objects[j].span[1] - ON]
        if on:
            bearers[i] = max(on, key=lambda j: objects[j].span[1])
        elif below:
            bearers[i] = min(below, key=lambda j: areas[j] * (objects[j].span[1] - objects[j].span[0]))
    return bearers


def hangs_in_air(piece: Placed, support: int, taxonomy: Taxonomy) -> bool:
    """Whether a small thing hangs in the air: its support was left out."""
    category = taxonomy.categories[piece.category]
    return not category.layout and category.mount == "floor" and support < 0 and piece.span[0] > ON
