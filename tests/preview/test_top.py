from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from pipeline.entities.asset import Asset, Joint, Material
from pipeline.entities.home import Home, Placement
from pipeline.entities.plan import Opening, Plan, Room, Swing
from pipeline.errors import UsageError
from pipeline.preview.denoise import Guides, denoise
from pipeline.preview.sheet import contact_sheet
from pipeline.preview.top import top_view
from pipeline.preview.trace import path_trace
from pipeline.rendering.boxes import box, solid_link

MARGIN, OUTER = 0.45, 0.24


def chest():
    body, front = (box("body", (-0.5, -0.28, 0), (0.5, 0.3, 0.5)),), (box("front", (-0.5, -0.3, 0.02), (0.5, -0.28, 0.48)),)
    joint = Joint("slide", "prismatic", 0, 1, np.array([0, -1.0, 0]), np.zeros(3), 0.0, 0.4, "slider_drawer")
    links = (solid_link("base", body, body, 10.0), solid_link("drawer", front, front, 2.0))
    return Asset("chest", "cabinet", np.array([1, 0.6, 0.5]), links, (joint,), (Material("red", (0.7, 0.02, 0.02)),), "t", "1", "x")


def make_home(levels=1):
    rooms = [Room("a", "bedroom", np.array([[0, 0], [4, 0], [4, 3], [0, 3]], float), level) for level in range(levels)]
    rooms = [Room(f"a{r.level}", r.type, r.polygon, r.level) for r in rooms]
    rooms.append(Room("b", "bathroom", np.array([[4.12, 0], [6, 0], [6, 3], [4.12, 3]], float)))
    opening = Opening("d", "door", ("a0", "b"), np.array([[4.06, 1.0], [4.06, 1.9]]), 2.05, 0.0, Swing("b", 0, 1.5))
    placement = Placement("chest_0", "a0", "cabinet", "chest", np.array([1.0, 2.0, 0.0]), 0.0, np.array([1, 0.6, 0.5]))
    return Home("s0_00000000", 0, 0, "", "{}", Plan(tuple(rooms), (opening,), "b"), (placement,)), {"chest": chest()}


def pixel(image, x, y):
    scale = image.width / (6 + 2 * (OUTER + MARGIN))
    return np.array(image.getpixel((int((x + OUTER + MARGIN) * scale), int(image.height - (y + OUTER + MARGIN) * scale)))).astype(int)


@pytest.fixture(scope="module")
def image():
    return top_view(*make_home(), size=640)


def test_walls_are_dark_floors_light_and_doorways_open(image):
    assert image.width == 640
    assert pixel(image, 4.06, 2.6).max() < 80  # the wall between
    assert pixel(image, 4.06, 1.45).min() > 100  # the doorway in it
    assert pixel(image, 3.0, 0.5).min() > 140  # a bedroom's floor
    assert np.abs(pixel(image, 3.0, 0.5) - pixel(image, 5.0, 2.5)).max() > 10  # a bathroom's is another


def test_furniture_stands_where_it_is_placed(image):
    red, green, _ = pixel(image, 1.0, 2.0)
    assert red > green + 60
    red, green, _ = pixel(image, 1.0, 2.45)
    assert abs(red - green) < 60


def test_the_drawer_s_reach_is_marked_in_front(image):
    strip = np.array([pixel(image, 1.0, y) for y in np.linspace(1.25, 1.35, 40)])
    assert ((strip[:, 0] - strip[:, 2]) > 90).any()  # orange, 0.4 m before the front at y = 1.7


def test_the_door_leaf_stands_open_in_its_room(image):
    closed = pixel(image, 4.06, 1.6)
    strip = np.array([pixel(image, 4.5, y) for y in np.linspace(0.9, 1.2, 60)])
    assert (strip.max(axis=1) < 140).any()
    assert closed.min() > 100


def test_it_is_the_same_every_time(image):
    assert top_view(*make_home(), size=640).tobytes() == image.tobytes()


def test_storeys_lie_side_by_side():
    home, assets = make_home(levels=2)
    wide = top_view(home, assets, size=512)
    assert wide.width == pytest.approx(512, abs=2)
    assert wide.width > 2.5 * wide.height


def test_a_home_without_furniture_is_drawn():
    home, _ = make_home()
    assert top_view(home, {}, size=128).size[0] == 128


def test_contact_sheets_hold_every_picture():
    pictures = [(f"home {k}", Image.new("RGB", (300, 200), (k * 40, 0, 0))) for k in range(5)]
    sheet = contact_sheet(pictures, columns=3, cell=100)
    seen = {sheet.getpixel((60 + 110 * (k % 3), 60 + (100 + 19 + 10) * (k // 3)))[0] for k in range(5)}
    assert seen == {0, 40, 80, 120, 160}


def test_without_mitsuba_the_remedy_is_named(monkeypatch, tmp_path):
    monkeypatch.setitem(__import__("sys").modules, "mitsuba", None)
    with pytest.raises(UsageError, match="pip install mitsuba"):
        path_trace(*make_home(), tmp_path / "view.png")
    assert not (tmp_path / "view.png").exists()


def test_path_traced_views_are_lit_and_framed(tmp_path):
    pytest.importorskip("mitsuba")
    home, assets = make_home()
    path = path_trace(home, assets, tmp_path / "deep/view.png", size=(96, 72), spp=4)
    picture = np.asarray(Image.open(path)).astype(int)
    assert picture.shape == (72, 96, 3)
    paper = picture[0, 0]
    assert np.abs(picture[[0, -1]] - paper).max() < 12  # a margin above and below
    inside = np.abs(picture - paper).max(axis=2) > 12
    assert 0.2 < inside.mean() < 0.9
    assert ((picture[..., 0] - picture[..., 1]) > 60).any()  # the red chest


def test_denoising_smooths_within_surfaces_and_keeps_their_edges():
    rng = np.random.Generator(np.random.Philox(5))
    albedo = np.where(np.arange(64)[None, :, None] < 32, 0.2, 0.8) * np.ones((48, 64, 3))
    noisy = (albedo * rng.exponential(1.0, (48, 64, 1))).astype(np.float32)
    normal = np.broadcast_to(np.float32([0, 0, 1]), (48, 64, 3))
    clean = denoise(noisy, Guides(albedo.astype(np.float32), normal, np.full((48, 64), 5.0, np.float32)))
    assert clean[:, :32].std() < 0.35 * noisy[:, :32].std()
    assert clean[:, 34:].mean() / clean[:, :30].mean() == pytest.approx(4.0, rel=0.1)
