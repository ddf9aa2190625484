"""A home of four rooms and the furniture in it, made by code; nothing stands in the way of anything that moves."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from pipeline.entities.asset import Asset, Joint, Material
from pipeline.entities.home import Home, Placement
from pipeline.entities.plan import Opening, Plan, Room, Swing
from pipeline.rendering.boxes import box, solid_link

OAK, WHITE, STEEL = (
    Material("oak", (0.45, 0.3, 0.17), 0.5),
    Material("white", (0.8, 0.8, 0.78), 0.4),
    Material("steel", (0.6, 0.6, 0.6), 0.2, 1.0),
)


def make_cabinet(asset_id: str = "cabinet_a", w: float = 0.9, d: float = 0.5, h: float = 1.0) -> Asset:
    """A cabinet with a drawer above a door, and a knob on the side; all panels are boxes."""
    t, foot, shelf = 0.018, 0.06, 0.6 * h
    panels = (
        box("left", (-w / 2, -d / 2 + 0.02, 0), (-w / 2 + t, d / 2, h)),
        box("right", (w / 2 - t, -d / 2 + 0.02, 0), (w / 2, d / 2, h)),
        box("bottom", (-w / 2 + t, -d / 2 + 0.02, foot), (w / 2 - t, d / 2 - t, foot + t)),
        box("top", (-w / 2 + t, -d / 2 + 0.02, h - t), (w / 2 - t, d / 2, h)),
        box("back", (-w / 2 + t, d / 2 - t, foot), (w / 2 - t, d / 2, h - t)),
        box("shelf", (-w / 2 + t, -d / 2 + 0.02, shelf), (w / 2 - t, d / 2 - t, shelf + t)),
    )
    x0, x1, y0, y1, z0, z1 = -w / 2 + t + 0.004, w / 2 - t - 0.004, -d / 2 + 0.018, d / 2 - t - 0.03, shelf + t + 0.004, h - t - 0.004
    drawer = (
        box("front", (-w / 2, -d / 2, shelf + t), (w / 2, -d / 2 + 0.018, h), 1),
        box("floor", (x0, y0, z0), (x1, y1, z0 + 0.01)),
        box("side_l", (x0, y0, z0 + 0.01), (x0 + 0.01, y1, z1)),
        box("side_r", (x1 - 0.01, y0, z0 + 0.01), (x1, y1, z1)),
        box("handle", (-0.08, -d / 2 - 0.03, 0.8 * h), (0.08, -d / 2, 0.8 * h + 0.015), 2, "line_fixed_handle"),
    )
    door = (
        box("panel", (-w / 2, -d / 2, foot), (w / 2, -d / 2 + 0.018, shelf + t - 0.003), 1),
        box("handle", (w / 2 - 0.06, -d / 2 - 0.03, 0.3 * h), (w / 2 - 0.045, -d / 2, 0.3 * h + 0.14), 2, "line_fixed_handle"),
    )
    knob = (box("knob", (w / 2, -0.02, 0.5 * h), (w / 2 + 0.02, 0.02, 0.5 * h + 0.04), 2),)
    joints = (
        Joint("drawer_slide", "prismatic", 0, 1, np.array([0, -1.0, 0]), np.array([0, 0, 0.8 * h]), 0.0, 0.7 * d, "slider_drawer"),
        Joint("door_hinge", "revolute", 0, 2, np.array([0, 0, -1.0]), np.array([-w / 2, -d / 2, 0.3 * h]), 0.0, 1.6, "hinge_door"),
        Joint(
            "knob_turn", "continuous", 0, 3, np.array([1.0, 0, 0]), np.array([w / 2, 0, 0.5 * h + 0.02]), -math.inf, math.inf, "hinge_knob"
        ),
    )
    links = (
        solid_link("base", panels, panels, 22.0),
        solid_link("drawer", drawer, drawer, 3.0),
        solid_link("door", door, door, 4.0),
        solid_link("knob", knob, knob, 0.1),
    )
    return Asset(
        asset_id, "cabinet", np.array([w, d, h]), links, joints, (OAK, WHITE, STEEL), "test", "7", "Apache-2.0", "modern", "cabinet"
    )


def make_chair(asset_id: str = "chair_a") -> Asset:
    """A static chair whose colliders are not what one sees: a box below, a box behind."""
    seen = (
        *(box(f"leg {i}", (x - 0.02, y - 0.02, 0), (x + 0.02, y + 0.02, 0.45)) for i, (x, y) in enumerate(((-0.2, -0.2), (0.2, -0.2), (-0.2, 0.2), (0.2, 0.2)))),
        box("seat", (-0.22, -0.22, 0.45), (0.22, 0.22, 0.49), 1),
        box("back", (-0.22, 0.18, 0.49), (0.22, 0.22, 0.9)),
    )  # fmt: skip
    felt = (box("below", (-0.22, -0.22, 0), (0.22, 0.22, 0.49)), box("behind", (-0.22, 0.18, 0.49), (0.22, 0.22, 0.9)))
    link = solid_link("base", seen, felt, 6.0)
    return Asset(asset_id, "dining_chair", np.array([0.44, 0.44, 0.9]), (link,), (), (OAK, WHITE), "test", "8", "Apache-2.0", "", "chair")


def make_plan() -> Plan:
    """Hall, L-shaped living room, bedroom, bathroom; every kind of opening."""

    def rectangle(x0: float, y0: float, x1: float, y1: float) -> np.ndarray:
        return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], float)

    def segment(*ends: tuple[float, float]) -> np.ndarray:
        return np.array(ends, float)

    living = np.array([[0, 1.52], [5, 1.52], [5, 6.0], [2.5, 6.0], [2.5, 7.5], [0, 7.5]])
    rooms = (
        Room("hall", "hallway", rectangle(0, 0, 5, 1.4)),
        Room("living", "living_room", living),
        Room("bed", "bedroom", rectangle(5.12, 0, 9, 4.0)),
        Room("bath", "bathroom", rectangle(5.12, 4.12, 7.4, 6.0)),
    )
    openings = (
        Opening("entrance_0", "entrance", ("hall",), segment((-0.12, 0.3), (-0.12, 1.3)), 2.1, 0.0, Swing("hall", 0, 1.5)),
        Opening("open_0", "open", ("hall", "living"), segment((3.9, 1.46), (2.1, 1.46)), 2.2),
        Opening("door_1", "door", ("hall", "bed"), segment((5.06, 0.25), (5.06, 1.15)), 2.05, 0.0, Swing("bed", 1, 1.5)),
        Opening("door_2", "door", ("bed", "bath"), segment((6.0, 4.06), (6.8, 4.06)), 2.05, 0.0, Swing("bath", 0, 1.5)),
        Opening("door_3", "door", ("living", "bath"), segment((5.06, 5.7), (5.06, 4.9)), 2.05, 0.0, Swing("living", 1, 1.5)),
        Opening("window_0", "window", ("living",), segment((-0.12, 5.5), (-0.12, 3.5)), 1.4, 0.9),
        Opening("window_1", "window", ("bed",), segment((9.12, 1.0), (9.12, 3.0)), 1.4, 0.9),
    )
    return Plan(rooms, openings, "hall")


def make_home() -> tuple[Home, dict[str, Asset]]:
    """The plan with three cabinets, two of them one asset, and two chairs, one of them scaled."""
    assets = {a.asset_id: a for a in (make_cabinet(), make_cabinet("cabinet_b", 1.4, 0.45, 0.8), make_chair())}

    def put(
        object_id: str, room: str, asset_id: str, x: float, y: float, yaw: float, scale: tuple[float, float, float] = (1, 1, 1)
    ) -> Placement:
        asset = assets[asset_id]
        return Placement(object_id, room, asset.category, asset_id, np.array([x, y, 0.0]), yaw, asset.size * scale, np.array(scale, float))

    placements = (
        put("cabinet_0", "living", "cabinet_a", 0.3, 3.0, math.pi / 2),
        put("cabinet_1", "bed", "cabinet_a", 7.0, 0.3, math.pi),
        put("cabinet_2", "living", "cabinet_b", 1.2, 7.25, 0.0),
        put("chair_0", "living", "chair_a", 3.0, 4.0, 0.3),
        put("chair_1", "living", "chair_a", 3.8, 4.0, -0.4, (1.1, 1.0, 0.95)),
    )
    return Home("s0_00000000", 0, 0, "a flat for tests", "{}", make_plan(), placements), assets


@pytest.fixture(scope="session")
def cabinet() -> Asset:
    return make_cabinet()


@pytest.fixture(scope="session")
def chair() -> Asset:
    return make_chair()


@pytest.fixture(scope="session")
def home() -> tuple[Home, dict[str, Asset]]:
    return make_home()


@pytest.fixture
def textured(chair: Asset) -> Asset:
    """The chair with a texture on its oak; the blob need not be a picture for what is tested."""
    return replace(
        chair, asset_id="chair_t", materials=(replace(OAK, texture="textures/oak.png"), WHITE), textures={"textures/oak.png": b"png"}
    )
