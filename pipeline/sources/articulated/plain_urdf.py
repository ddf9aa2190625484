"""Other people's furniture: a URDF by itself, in metres more often than not, whose frame and category have to be found.

Read beside what `urdf` tolerates: angles that are nearly right, meshes in folders beside the URDF's own, a door without
a frame. The robot's name is not believed, for it is often that of another piece; a category comes from the
file's name and those of its folders, else from the size.
"""

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import PurePosixPath
from typing import TypeVar

import numpy as np

from pipeline.arrays import Floats
from pipeline.sources.articulated import metric_scale
from pipeline.sources.articulated.metric_scale import UNITS
from pipeline.sources.articulated.part_boxes import complete_shape
from pipeline.sources.articulated.shape import ArticulatedShape
from pipeline.sources.articulated.shape_reader import Hints, ShapeReader
from pipeline.sources.articulated.urdf import MAX_URDF, Shape, Urdf, UrdfJoint, parse_urdf
from pipeline.sources.guarded import Folder
from pipeline.taxonomy import Taxonomy

Posed = TypeVar("Posed", Shape, UrdfJoint)
UPRIGHT = {2: np.eye(3), 1: np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])}  # rotations that bring an axis to z
SNAP = 0.01  # [rad] an angle this near to a right one is one
FURNITURE = "StorageFurniture"
# Words of everyday language for PartNet's model categories; those for ours stand on their cards.
SYNONYMS = {
    "fridge": "Refrigerator", "freezer": "Refrigerator", "washer": "WashingMachine", "bin": "TrashCan", "trashcan": "TrashCan",
    "cupboard": FURNITURE, "cabinet": FURNITURE, "drawers": FURNITURE, "drawer": FURNITURE, "dresser": FURNITURE, "chest": FURNITURE,
    "stove": "Oven", "cooker": "Oven", "wc": "Toilet",
}  # fmt: skip


def read_plain_urdf(root: Folder, file: str, source_id: str, texture_limit: int) -> ArticulatedShape:
    """Read the URDF at `file` (relative to `root`), in the frame that it is drawn in. Raises SourceError."""
    base = PurePosixPath(file).parent.as_posix()
    urdf, snapped = _snap_rotations(parse_urdf(root.read(file, MAX_URDF), file))
    # a link's name and its joint's say what it is: "drawer_top"
    words = {name: name for name in urdf.links} | {joint.child: f"{joint.child} {joint.name}" for joint in urdf.joints}
    reader = ShapeReader(root, "" if base == "." else base, urdf, np.eye(3), Hints(named=words), texture_limit)
    if snapped:
        reader.notes.append(("model", "angle_snapped", f"{snapped} angles"))
    return reader.shape("urdf", source_id, "")


def candidates(file: str, taxonomy: Taxonomy) -> tuple[str, ...]:
    """Return the categories that a file may be by its path, the file's own name first; without a word that tells, these are all that open."""
    for word in _tokens(file):
        categories = _word_categories(word, taxonomy)
        if categories:
            return categories
    return tuple(c.name for c in taxonomy.categories.values() if c.names.partnet)


def _tokens(file: str) -> list[str]:
    path = PurePosixPath(file)
    parts = [path.stem, *reversed(path.parent.parts)]
    return [t for part in parts for t in (part, *re.split(r"[^A-Za-z]+|(?<=[a-z])(?=[A-Z])", part)) if t]


def _word_categories(word: str, taxonomy: Taxonomy) -> tuple[str, ...]:
    plain = re.sub(r"[^a-z]+", "_", word.lower()).strip("_")
    by_name = {c: c for c in taxonomy.names} | {m.lower(): m for e in taxonomy.categories.values() for m in e.names.partnet}
    meant = SYNONYMS | {w: c.name for c in taxonomy.categories.values() for w in c.names.files}
    wanted = by_name.get(plain) or by_name.get(plain.replace("_", "")) or meant.get(plain) or meant.get(plain.removesuffix("s"))
    if wanted is None:
        return ()
    return (wanted,) if wanted in taxonomy.categories else taxonomy.from_partnet(wanted)


def orient_shape(shape: ArticulatedShape, categories: Sequence[str]) -> ArticulatedShape:
    """Return the shape turned so that up is z and the front -y, its parts and classes inferred.

    Up is z, or y where that makes a likelier piece of furniture; the front is where drawers and doors open to, else a
    long side.
    """
    tried = []
    for up in (2, 1):
        turned = shape.turned(UPRIGHT[up])
        turned = turned.turned(_about(_heading(turned)))
        scores = [f.likelihood for unit in UNITS for c in categories if (f := metric_scale.fit_metric(turned.extent, c, None, unit))]
        tried.append((_level(turned) + (0.5 if up == 2 else 0.0) + 0.2 * max(scores, default=-20.0), turned))
    return complete_shape(max(tried, key=lambda t: t[0])[1])


def _about(heading: int) -> Floats:
    """Return the turn about z, by quarters, that brings direction `heading` (0 +x, 1 +y, 2 -x, 3 -y) to the front -y."""
    quarters = (3 - heading) % 4
    c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[quarters]
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _ways(shape: ArticulatedShape) -> list[Floats]:
    """Return the directions (3,) in which doors and drawers set off, the small ones such as knobs left out."""
    largest = shape.extent.max()
    ways = []
    for joint in shape.joints:
        points = shape.points_below(joint.child)
        if np.ptp(points, axis=0).max() < 0.15 * largest or joint.type == "continuous":
            continue
        way = joint.axis if joint.type == "prismatic" else np.cross(joint.axis, points.mean(axis=0) - joint.origin)
        length = float(np.linalg.norm(way))
        if length > 1e-9:
            ways.append(way / length)
    return ways


def _heading(shape: ArticulatedShape) -> int:
    """Return where the front is: 0 +x, 1 +y, 2 -x, 3 -y."""
    flat = np.sum([np.zeros(2), *(way[:2] for way in _ways(shape))], axis=0)
    if np.abs(flat).max() > 0.3:
        return int(np.argmax([*flat, *-flat]))
    return 0 if shape.extent[1] > 1.05 * shape.extent[0] else 3


def _level(shape: ArticulatedShape) -> float:
    """Return how well the joints suit their being upright: drawers and doors set off level, and hinges stand more often than not."""
    standing = sum(joint.type == "revolute" and abs(joint.axis[2]) > 0.9 for joint in shape.joints)
    return sum(1.0 if abs(float(way[2])) < 0.3 else -1.0 for way in _ways(shape)) + 0.3 * float(standing)


def _snap_rotations(urdf: Urdf) -> tuple[Urdf, int]:
    """Return the URDF with rotations that are within SNAP of quarter turns made exact, and how many were off."""
    count = 0

    def exact(things: tuple[Posed, ...]) -> tuple[Posed, ...]:
        return tuple(replace(thing, T=snapped(thing.T)) for thing in things)

    def snapped(pose: Floats) -> Floats:
        nonlocal count
        near = np.round(pose[:3, :3])
        off = float(np.abs(pose[:3, :3] - near).max())
        if np.abs(near @ near.T - np.eye(3)).max() > 1e-9 or not 0 < off <= SNAP:
            return pose
        count += off > 1e-4
        right = pose.copy()
        right[:3, :3] = near
        return right

    links = {k: replace(link, visuals=exact(link.visuals), collisions=exact(link.collisions)) for k, link in urdf.links.items()}
    return replace(urdf, links=links, joints=exact(urdf.joints)), count
