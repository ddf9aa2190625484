from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from pxr import Usd, UsdGeom, UsdPhysics
from trimesh.triangles import closest_point

from pipeline.entities.home import Placement
from pipeline.geometry.walls import Prism
from pipeline.rendering.boxes import box, solid_link
from pipeline.sources.meshes import touching
from pipeline.usd import shared_boards, write_home, write_library
from pipeline.usd.articulation import hidden_colliders
from pipeline.usd.shared_boards import BESIDE, OVER, boards_felt_elsewhere
from tests.usd.conftest import make_cabinet, make_plan

SIDES = {"left": "base/left_collider", "right": "base/right_collider"}
BACK = "base/back_collider"
WALL = Prism("wall", np.array([[-5.0, 0.0], [5.0, 0.0], [5.0, 0.2], [-5.0, 0.2]]), 0.0, 2.7)
FLOOR = Prism("floor", np.array([[-5.0, -5.0], [5.0, -5.0], [5.0, 0.2], [-5.0, 0.2]]), -0.1, 0.0)


@pytest.fixture(scope="module")
def cupboard():
    return make_cupboard()


def make_cupboard(asset_id="cabinet_a", h=1.0):
    """The cabinet of the other tests with the thin back and the top over its sides that furniture has, and nothing on its side."""
    made = make_cabinet(asset_id, h=h)
    w, d, t = *made.size[:2], 0.018
    own = {
        "left": box("left", (-w / 2, -d / 2 + 0.02, 0), (-w / 2 + t, d / 2, h - t)),
        "right": box("right", (w / 2 - t, -d / 2 + 0.02, 0), (w / 2, d / 2, h - t)),
        "top": box("top", (-w / 2, -d / 2 + 0.02, h - t), (w / 2, d / 2, h)),
        "back": box("back", (-w / 2 + t, d / 2 - 0.008, 0.06), (w / 2 - t, d / 2, h - t)),
    }
    panels = [own.get(mesh.name, mesh) for mesh in made.links[0].visuals]
    return replace(made, links=(solid_link("base", panels, panels, 22.0), *made.links[1:3]), joints=made.joints[:2])


def put(name, asset, x, y, z=0.0, yaw=0.0, scale=1.0, support=""):
    at = np.array([x, y, z])
    return Placement(name, "living", asset.category, asset.asset_id, at, yaw, asset.size * scale, np.full(3, scale), support=support)


def felt_elsewhere(placements, *assets):
    return boards_felt_elsewhere(make_plan(), placements, {a.asset_id: a for a in assets}, [WALL, FLOOR])


def test_a_surface_may_be_as_far_off_as_colliders_are_made():
    said = shared_boards.TOP, shared_boards.BELOW, shared_boards.UP, shared_boards.OVER
    assert said == (touching.TOUCHED, touching.LEFT_ALONE, touching.UP, touching.OVER)


def test_the_back_of_a_cupboard_is_the_wall_where_that_is_close(cupboard):
    depth = cupboard.size[1]
    assert felt_elsewhere([put("one", cupboard, 0, -depth / 2 - 0.003)], cupboard) == {"one": [BACK]}
    assert felt_elsewhere([put("one", cupboard, 0, -depth / 2 - 0.035)], cupboard) == {}  # 43 mm behind its inside
    assert felt_elsewhere([put("one", cupboard, 0, -2.0)], cupboard) == {}
    turned = put("one", cupboard, 0, -depth / 2 - 0.003, yaw=math.pi)
    assert felt_elsewhere([turned], cupboard) == {}  # its doors open to the wall


def test_of_two_sides_that_meet_one_stays(cupboard):
    width = cupboard.size[0]
    gone = felt_elsewhere([put("one", cupboard, 0, -2), put("two", cupboard, width + 0.001, -2)], cupboard)
    assert [sorted(paths) for paths in gone.values()] in ([[SIDES["right"]]], [[SIDES["left"]]])
    assert felt_elsewhere([put("one", cupboard, 0, -2), put("two", cupboard, width + 0.025, -2)], cupboard) == {}
    lower = make_cupboard("lower", 0.7)  # stands in for nothing of what is higher, and is stood in for
    gone = felt_elsewhere([put("one", cupboard, 0, -2), put("two", lower, width + 0.001, -2)], cupboard, lower)
    assert gone == {"two": [SIDES["left"]]}


def test_above_reach_only_what_bears_something_is_felt(cupboard):
    high = put("one", cupboard, 0, -2, z=OVER - 0.5)
    gone = felt_elsewhere([high], cupboard)["one"]
    assert "base/top_collider" in gone
    assert not {"base/bottom_collider", *SIDES.values(), BACK} & {*gone}  # they reach down to where one is
    cup = replace(cupboard, asset_id="cup_a", category="cup", links=cupboard.links[:1], joints=())
    borne = put("cup", cup, 0, -2, z=OVER - 0.5 + cupboard.size[2], support="one")
    assert felt_elsewhere([high, borne], cupboard, cup) == {}


def test_small_and_scaled_things_stand_in_for_nothing(cupboard, chair):
    width = cupboard.size[0]
    still = replace(cupboard, asset_id="still", links=cupboard.links[:1], joints=())
    beside = put("one", cupboard, 0, -2)
    assert felt_elsewhere([beside, put("two", still, width + 0.001, -2)], cupboard, still)
    assert felt_elsewhere([beside, put("two", still, 1.05 * width, -2, scale=1.1)], cupboard, still) == {}
    small = replace(still, category="cup")
    assert felt_elsewhere([beside, put("two", small, width + 0.001, -2)], cupboard, small) == {}


def test_a_home_feels_the_same_within_what_sides_may_be_off(cupboard, home, tmp_path):
    """A run of two before a wall: each surface point of what was left out is that near to a collider that is there, by the triangles."""
    scene, _ = home
    width, depth = cupboard.size[:2]
    run = [put(f"unit_{k}", cupboard, 2.9 + k * (width + 0.002), 6.0 - depth / 2 - 0.003) for k in range(2)]
    write_library([cupboard], tmp_path / "assets")
    path = write_home(replace(scene, placements=tuple(run)), {cupboard.asset_id: cupboard}, tmp_path / "usd/shard-00000/home.usdc")
    stage = Usd.Stage.Open(str(path))
    cache = UsdGeom.XformCache()
    there = [hull_of(prim, cache) for prim in stage.Traverse() if prim.HasAPI(UsdPhysics.CollisionAPI)]
    gone = []
    for placed in run:
        root = stage.GetPrimAtPath(f"/World/Objects/{placed.object_id}/base")
        for name, mesh in hidden_colliders(cupboard.links[0]).items():
            if not root.GetChild(name).IsActive():
                gone.append(trimesh.convex.convex_hull(mesh.vertices + placed.position))
    assert len(gone) == 3  # two backs and a side
    for k, board in enumerate(gone):
        points = trimesh.sample.sample_surface(board, 500, seed=k)[0]
        assert np.min([distance(points, hull) for hull in there], axis=0).max() < BESIDE + 0.001  # at an edge past two planes


def distance(points, hull):
    """Return how far points (P, 3) are from a convex hull, 0 within, by its triangles."""
    within = (np.einsum("pfk,fk->pf", points[:, None] - hull.triangles[None, :, 0], hull.face_normals) <= 0).all(axis=1)
    away = [np.linalg.norm(closest_point(np.broadcast_to(t, (len(points), 3, 3)), points) - points, axis=1) for t in hull.triangles]
    return np.where(within, 0.0, np.min(away, axis=0))


def hull_of(prim, cache):
    """Return a collider's hull in the world."""
    if prim.IsA(UsdGeom.Cube):
        half = prim.GetAttribute("size").Get() / 2
        points = np.array([[x, y, z] for x in (-half, half) for y in (-half, half) for z in (-half, half)])
    else:
        points = np.array(prim.GetAttribute("points").Get())
    matrix = np.array(cache.GetLocalToWorldTransform(prim))
    return trimesh.convex.convex_hull(points @ matrix[:3, :3] + matrix[3, :3])
