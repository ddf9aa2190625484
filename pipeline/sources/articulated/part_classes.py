"""What PartNet's and GAPartNet's own files say of links: part classes, else guessed from names, joint and shape; and what a joint is where the URDF does not say."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from pipeline.arrays import Floats
from pipeline.entities.asset import PART_CLASSES
from pipeline.sources.guarded import MIB, Folder, finite_array, read_json
from pipeline.sources.reasons import SourceError

NAME = "mobility_v2.json"
ANNOTATION = "link_annotation_gapartnet.json"
FIXED_PARTS = frozenset({"line_fixed_handle", "round_fixed_handle", "slider_button", "hinge_handle", "hinge_knob"})
# Words of PartNet's part names, first match wins; (word, class of a turning part, class of a sliding one).
WORDS = (
    ("drawer", "other", "slider_drawer"),
    ("lid", "hinge_lid", "slider_lid"),
    ("cover", "hinge_lid", "slider_lid"),
    ("seat", "hinge_lid", "slider_lid"),
    ("door", "hinge_door", "other"),
    ("knob", "hinge_knob", "other"),
    ("dial", "hinge_knob", "other"),
    ("switch", "hinge_knob", "slider_button"),
    ("button", "other", "slider_button"),
    ("key", "other", "slider_button"),
    ("lever", "hinge_handle", "other"),
    ("handle", "hinge_handle", "other"),
    ("tray", "other", "slider_drawer"),
    ("shelf", "other", "slider_drawer"),
    ("rack", "other", "slider_drawer"),
    ("screen", "hinge_lid", "other"),
)
_WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")
SMALL = 0.15  # share of the object's largest extent up to which a moving part is a button or a knob
LINE = 1.6  # a handle this much longer than wide is a line, else it is round


@dataclass(frozen=True, slots=True)
class Annotation:
    """What GAPartNet says of a link: its part class, and the box's corners (8, 3) in PartNet's world at rest, or None."""

    part_class: str
    corners: Floats | None


def annotated_links(folder: Folder) -> tuple[dict[str, Annotation], list[str]]:
    """Return {link: annotation} of the links that are parts, and the links whose box is none.

    Without link_annotation_gapartnet.json the classes come from semantics_gapartnet.txt, without boxes; {} without both.
    """
    if not folder.has(ANNOTATION):
        words = semantics(folder, "semantics_gapartnet.txt")
        return {link: Annotation(word, None) for link, (_, word) in words.items() if word in PART_CLASSES}, []
    tree = read_json(folder, ANNOTATION, 16 * MIB)
    if not isinstance(tree, list):
        raise SourceError("bad_structure", ANNOTATION, "is no list of links")
    by_link, odd = {}, []
    for entry in tree:
        name = text_field(entry, "link_name")
        if name and entry.get("category") in PART_CLASSES:
            corners = _corners(entry.get("bbox"))
            by_link[name] = Annotation(str(entry["category"]), corners)
            if corners is None and entry.get("bbox"):
                odd.append(name)
    return by_link, odd


def _corners(value: Any) -> Floats | None:
    """Return corners (8, 3) that are a box's in GAPartNet's order, right-handed, else None.

    The order, in the part's own axes: (-,+,+) (+,+,+) (+,-,+) (-,-,+) and the same four with z -.
    """
    corners = finite_array(value, 8, 3)
    if corners is None:
        return None
    centre, axes, size = box_of(corners)
    away = np.abs(box_corners(centre, axes, size) - corners).max()
    return corners if size.min() > 0 and np.linalg.det(axes) > 0.99 and away < 0.01 * size.max() else None


SIGNS = np.array([(-1, 1, 1), (1, 1, 1), (1, -1, 1), (-1, -1, 1), (-1, 1, -1), (1, 1, -1), (1, -1, -1), (-1, -1, -1)], np.float64) / 2


def box_of(corners: Floats) -> tuple[Floats, Floats, Floats]:
    """Return centre (3,), axes (3, 3) rows x, y, z and size (3,) of corners (8, 3): x = b1 - b0, y = b1 - b2, z = b0 - b4."""
    edges = np.stack([corners[1] - corners[0], corners[1] - corners[2], corners[0] - corners[4]])
    size = np.linalg.norm(edges, axis=1)
    return corners.mean(axis=0), edges / np.maximum(size, 1e-12)[:, None], size


def box_corners(centre: Floats, axes: Floats, size: Floats) -> Floats:
    """Return the corners (8, 3) of a box, in GAPartNet's order."""
    return np.asarray((SIGNS * size) @ axes + centre)


def semantics(folder: Folder, name: str = "semantics.txt") -> dict[str, tuple[str, str]]:
    """Return {link: (joint word, semantic name)} of a file whose lines are "<link> <joint> <semantic>", {} without it."""
    if not folder.has(name):
        return {}
    text = folder.read(name, MIB).decode("utf-8-sig", "replace")
    lines = (line.split() for line in text.splitlines())
    return {words[0]: (words[1], words[2]) for words in lines if len(words) >= 3}


def text_field(tree: Any, key: str) -> str:
    """Return a text of a JSON object, "" where there is none."""
    value = tree.get(key) if isinstance(tree, dict) else None
    return value if isinstance(value, str) else ""


def words_of(name: str) -> list[str]:
    """Return the words of a name such as "slider_lid-2" or "topDrawers", in lower case and the singular.

    Whole words only: there is a "lid" in "slide", "slider" and "solid".
    """
    return [word.lower().removesuffix("s") for word in _WORD.findall(name)]


def named_class(kind: str, name: str) -> str:
    """Return the part class that a semantic name tells of what a joint of `kind` moves, "" where it tells none."""
    words = words_of(name)
    return next(((sliding if kind == "prismatic" else turning) for word, turning, sliding in WORDS if word in words), "")


def shaped_class(kind: str, axis: Floats, low: Floats, high: Floats, whole: Floats) -> str:
    """Return the part class that joint and shape suggest of a part whose box runs from `low` to `high`.

    The object's box is `whole` (w, d, h), bottom centre at the origin, front -y. A button or knob is small; a lid moves
    up, or lies flat in the upper half and turns about a level axis; a drawer slides level; what else turns is a door.
    """
    extent = high - low
    small = float(extent.max()) <= SMALL * float(whole.max())
    upright = abs(float(axis[2])) > 0.8
    if kind == "prismatic":
        return "slider_button" if small else "slider_lid" if upright else "slider_drawer"
    if small:
        return "hinge_knob"
    if kind == "continuous":
        return "other"
    flat = extent[2] <= extent[:2].min() and (low[2] + high[2]) / 2 > whole[2] / 2
    return "hinge_door" if upright or not flat else "hinge_lid"


def fixed_class(link: str, visual: str, annotated: Mapping[str, Annotation], extent: Floats, *, moves: bool) -> str:
    """Return the part class of a visual of `extent` (3,) that is fixed to its body: a handle or a button, "" for the rest.

    `moves` says that the link hangs on a moving joint of its own; its class is then the joint's.
    """
    if not moves and link in annotated and annotated[link].part_class in FIXED_PARTS:
        return annotated[link].part_class
    if link in annotated or words_of(visual)[:1] not in (["handle"], ["knob"]):
        return ""
    long, wide, _ = sorted(extent.tolist(), reverse=True)
    return "line_fixed_handle" if long > LINE * wide else "round_fixed_handle"


@dataclass(frozen=True, slots=True)
class Mobility:
    """One entry of mobility_v2.json: PartNet's word for the joint and the part, the axis, limits [rad or units] about it, whether it has none.

    The file is a list of {id, parent, joint, name, jointData}; entry k is link_k of the URDF. Degrees for hinges, the mesh's units for
    sliders; the direction is along the mesh's axes, as the URDF's axes are; b may be less than a.
    """

    joint: str
    name: str
    direction: Floats | None
    limits: tuple[float, float] | None
    free: bool


def mobility(folder: Folder) -> dict[str, Mobility]:
    """Return {link: entry}, {} where there is no such file; entries that make no sense are left out."""
    if not folder.has(NAME):
        return {}
    tree = read_json(folder, NAME, 16 * MIB)
    entries = tree if isinstance(tree, list) else []
    return {f"link_{e['id']}": _entry(e) for e in entries if isinstance(e, dict) and type(e.get("id")) is int}


def _entry(entry: dict[str, Any]) -> Mobility:
    joint, data = text_field(entry, "joint"), entry.get("jointData")
    data = data if isinstance(data, dict) else {}
    axis, limit = data.get("axis"), data.get("limit")
    direction = finite_array(axis.get("direction"), 3) if isinstance(axis, dict) else None
    limit = limit if isinstance(limit, dict) else {}
    ends = finite_array([limit.get("a"), limit.get("b")], 2)
    scale = math.pi / 180 if joint == "hinge" else 1.0
    limits = None if ends is None else (float(ends[0]) * scale, float(ends[1]) * scale)
    return Mobility(joint, text_field(entry, "name"), direction, limits, limit.get("noLimit") is True)
