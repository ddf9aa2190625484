"""How far colliders' surfaces are from what one sees, where a robot touches: `python benchmarks/surfaces.py [--count N]`.

Both ways, on assets of data/assets, each kind in turn: points on the colliders that lie in no other collider of their link, to the
nearest triangle that is seen; and points that are seen on handles, moving parts, tops and small things, to the colliders (how far
outside of all they are). Seen from above, no collider may stand where one sees the floor: those that do are named. Where nothing comes from outside (pipeline/sources/meshes/reach.py), nor above 2 m, there is nothing to touch. Largest and 95th percentile [mm] by what is touched; build/surfaces.json keeps every asset's.
"""

import argparse
import json
import sys
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, cKDTree
from trimesh.triangles import closest_point

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from pipeline import taxonomy
from pipeline.arrays import Floats
from pipeline.card import Category
from pipeline.entities.asset import Asset, Link
from pipeline.entities.files import load_asset
from pipeline.sources.meshes.mesh_solids import distances_outside
from pipeline.sources.meshes.reach import make_reach_test
from pipeline.sources.meshes.touching import OVER
from pipeline.usd.articulation import is_visual_only

Reached = Callable[[Floats], NDArray[np.bool_]]
POINTS = 1500  # on a link, each way
UP = 0.7  # upward part of the normal of a top
WITHIN = 5e-4  # [m] inside of another piece: no surface
HAND, BODY = 0.01, 0.02  # [m] gaps into which no hand, no body comes
OFF = 0.002  # [m] before a surface
BESIDE, HIDDEN, TINY = 0.03, 0.01, 1e-8  # [m], [m2], [m2]
RIM = 0.01  # [m] below the top of a small thing: what looks up there is its inside


def main() -> None:
    """Measure, print the table."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--count", type=int, default=100)
    options.add_argument("--assets", type=Path, default=ROOT / "data" / "assets")
    given = options.parse_args()
    by_kind: dict[str, list[Floats]] = defaultdict(list)
    every = {}
    for path in _pick_assets(given.assets, given.count):
        asset = load_asset(path)
        measured = errors(asset, np.random.default_rng(0))
        every[asset.asset_id] = {
            k: [round(1000 * float(v.max()), 2), round(1000 * float(np.quantile(v, 0.95)), 2)] for k, v in measured.items()
        }
        for kind, values in measured.items():
            by_kind[kind].append(values)
        if not is_visual_only(asset) and (area := hidden_floor(asset)) > HIDDEN:
            print(f"{asset.asset_id}: {area:.2f} m2 of colliders where one sees the floor")
    (ROOT / "build").mkdir(exist_ok=True)
    (ROOT / "build" / "surfaces.json").write_text(json.dumps(every, indent=1))
    print(f"{len(every)} assets; mm: 95th percentile of all points, worst asset's 95th percentile, largest")
    for kind, parts in sorted(by_kind.items()):
        together = 1000 * np.concatenate(parts)
        worst = 1000 * max(float(np.quantile(v, 0.95)) for v in parts)
        print(f"{kind:40s} {np.quantile(together, 0.95):5.1f} {worst:6.1f} {together.max():6.1f}   ({len(parts)} assets)")


def _pick_assets(folder: Path, count: int) -> list[Path]:
    import pyarrow.parquet as pq

    kinds: dict[str, list[str]] = {}
    for row in pq.read_table(folder.parent / "tables" / "assets.parquet", columns=["asset_id", "category", "articulated"]).to_pylist():
        kinds.setdefault(f"{row['category']} {row['articulated']}", []).append(row["asset_id"])
    turns = range(max(map(len, kinds.values())))
    names = [ids[turn] for turn in turns for _, ids in sorted(kinds.items()) if turn < len(ids)]
    return [folder / f"{name}.safetensors" for name in names[:count]]


def errors(asset: Asset, rng: np.random.Generator) -> dict[str, Floats]:
    """Return by what is touched how far [m] points of colliders are from what is seen, and what is seen from colliders."""
    card = taxonomy.load().categories[asset.category]
    moved = {joint.child for joint in asset.joints}
    by_kind: dict[str, list[Floats]] = defaultdict(list)
    for k, link in enumerate(asset.links):
        if not link.colliders or not link.visuals:
            continue
        at, normals, parts = _seen_points(link, rng)
        away = np.maximum(_outside(at, link), 0.0)
        points, outwards = _collider_points(link, rng)
        distance, nearest = _nearest(points, link)
        comes = make_reach_test(
            [c.vertices.astype(np.float64) for c in link.colliders], _planes(link), HAND if asset.articulated or card.loose else BODY
        )
        for way, kinds, values in (
            ("seen, from colliders", _surface_kinds(card, k in moved, at, normals, parts, comes), away),
            ("colliders, from what is seen", _surface_kinds(card, k in moved, points, outwards, nearest, comes), distance),
        ):
            for kind in set(kinds) - {""}:
                by_kind[f"{kind}: {way}"].append(values[kinds == kind])
    return {kind: np.concatenate(values) for kind, values in by_kind.items()}


def hidden_floor(asset: Asset) -> float:
    """Return the area [m2], from above, of colliders beyond BESIDE of what is seen."""
    links = [link for link in asset.links if link.colliders]
    triangles = np.concatenate([_visual_triangles(link)[0][:, :, :2] for link in links] or [np.zeros((0, 3, 2))])
    areas = shapely.area(shapely.polygons(triangles))
    seen = shapely.union_all(shapely.polygons(triangles[areas > TINY])).buffer(BESIDE)
    felt = shapely.union_all([shapely.convex_hull(shapely.multipoints(c.vertices[:, :2])) for link in links for c in link.colliders])
    return float(felt.difference(seen).area)


def _surface_kinds(
    card: Category, moves: bool, points: Floats, normals: Floats, parts: NDArray[np.str_], comes: Reached
) -> NDArray[np.str_]:
    """Return (P,) what each point of a link is of."""
    plain = "small things" if card.loose else "moving parts" if moves else ""
    kinds = np.full(len(normals), plain, "<U16")
    if not plain:
        kinds[(normals[:, 2] > UP)] = "tops"
    if card.loose and not card.felt:
        low, high = points.min(axis=0), points.max(axis=0)
        inwards = ((points - (low + high) / 2)[:, :2] * normals[:, :2]).sum(axis=1) < 0
        kinds[inwards | (normals[:, 2] > UP) & (points[:, 2] < high[2] - RIM)] = "insides"
    kinds[np.char.endswith(parts, "handle")] = "handles"
    kinds[~comes(points + OFF * normals)] = ""
    if card.mount == "floor" and not card.loose:
        kinds[points[:, 2] > OVER] = ""
    return kinds


def _spread(triangles: Floats, count: int, rng: np.random.Generator) -> tuple[Floats, Floats, NDArray[np.int64]]:
    """Return points (count, 3) spread evenly over triangles (F, 3, 3), unit normals there, and whose they are."""
    cross = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    areas = np.linalg.norm(cross, axis=1)
    which = rng.choice(len(triangles), count, p=areas / areas.sum())
    u, v = rng.random((2, count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    a, b, c = (triangles[which, k] for k in range(3))
    return a + u * (b - a) + v * (c - a), cross[which] / areas[which, None], which


def _visual_triangles(link: Link) -> tuple[Floats, NDArray[np.str_]]:
    """Return the triangles (F, 3, 3) that are seen of a link, and of which part each is."""
    triangles = np.concatenate([m.vertices[m.faces] for m in link.visuals]).astype(np.float64)
    return triangles, np.concatenate([np.full(len(m.faces), m.part, "<U24") for m in link.visuals])


def _seen_points(link: Link, rng: np.random.Generator) -> tuple[Floats, Floats, NDArray[np.str_]]:
    triangles, parts = _visual_triangles(link)
    points, normals, which = _spread(triangles, POINTS, rng)
    return points, normals, parts[which]


def _planes(link: Link) -> list[Floats]:
    return [ConvexHull(c.vertices.astype(np.float64)).equations for c in link.colliders]


def _outside(points: Floats, link: Link) -> Floats:
    """Return how far points (P, 3) are outside of all colliders, by the planes of their faces; negative within."""
    away: Floats = np.min([distances_outside(points, e) for e in _planes(link)], axis=0)
    return away


def _collider_points(link: Link, rng: np.random.Generator) -> tuple[Floats, Floats]:
    """Return points on the surface of all colliders together, and normals."""
    triangles = np.concatenate([c.vertices[c.faces] for c in link.colliders]).astype(np.float64)
    owner = np.concatenate([np.full(len(c.faces), k) for k, c in enumerate(link.colliders)])
    points, normals, which = _spread(triangles, POINTS, rng)
    free = np.ones(len(points), bool)
    for k, e in enumerate(_planes(link)):
        free &= (distances_outside(points, e) > -WITHIN) | (owner[which] == k)
    return points[free], normals[free]


def _nearest(points: Floats, link: Link) -> tuple[Floats, NDArray[np.str_]]:
    """Return how far points (P, 3) are from the nearest triangle that is seen, and of which part it is."""
    triangles, parts = _visual_triangles(link)
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    corner, _ = cKDTree(triangles.reshape(-1, 3)).query(points)  # no nearest triangle is farther than that
    distance, which = np.empty(len(points)), np.empty(len(points), np.int64)
    for i, (point, far) in enumerate(zip(points, corner + 1e-9, strict=True)):
        near = np.flatnonzero(((low <= point + far) & (point - far <= high)).all(axis=1))
        away = np.linalg.norm(closest_point(triangles[near], np.broadcast_to(point, (len(near), 3))) - point, axis=1)
        distance[i], which[i] = away.min(), near[away.argmin()]
    return distance, parts[which]


if __name__ == "__main__":
    main()
