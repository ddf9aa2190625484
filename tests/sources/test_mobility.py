"""Articulated objects in the way the real ones are: drawn open, along their depth, upright, without a frame, of very many parts."""

import time
import tracemalloc

import numpy as np
import pytest

from pipeline.entities.files import load_asset
from pipeline.sources.articulated import joint_rules
from pipeline.sources.articulated.shape import ShapeBody
from tests.sources import mobility
from tests.sources.reading import read


def assets(root, category, *objects, **more):
    for k, links in enumerate(objects):
        mobility.write(root / "partnet", f"{category}_{k}", category, links, k, **more)
    made = read(root)
    return [load_asset(root / "assets" / row["file"]) for row in made.assets], made


def rng():
    return np.random.default_rng(0)


@pytest.mark.parametrize("at", [1.2, 1.9, 2.3])
def test_a_laptop_that_is_drawn_open_is_shut(tmp_path, at):
    (asset,), made = assets(tmp_path, "Laptop", mobility.laptop(rng(), at=at))
    assert asset.size == pytest.approx([0.335, 0.235, 0.02], rel=0.15)
    (joint,) = asset.joints
    assert joint.part_class == "hinge_lid"
    assert joint.lower == pytest.approx(0, abs=0.02)
    assert joint.upper == pytest.approx(2.3, abs=0.03)
    assert "joint_rest_shifted" in made.reasons


def test_a_laptop_that_cannot_shut_keeps_its_width(tmp_path):
    (asset,), made = assets(tmp_path, "Laptop", mobility.laptop(rng(), closes=False))
    assert asset.size[0] == pytest.approx(0.335, rel=0.2)
    assert "refitted" in made.reasons


def test_a_toaster_that_runs_along_its_depth_keeps_its_front(tmp_path):
    (asset,), made = assets(tmp_path, "Toaster", mobility.toaster(rng()))
    assert asset.size[1] > 1.5 * asset.size[0]
    assert asset.size[1] == pytest.approx(0.3, rel=0.25)
    assert made.joints[0]["handle"][1] < -0.4 * asset.size[1]


@pytest.mark.parametrize("pulled", [0.0, 0.4])
def test_a_suitcase_with_its_handle_out(tmp_path, pulled):
    (asset, *_), _ = assets(tmp_path, "Suitcase", mobility.suitcase(rng(), pulled=pulled))
    assert asset.size[2] == pytest.approx(0.62, rel=0.25)
    assert asset.size[0] == pytest.approx(0.4, rel=0.25)


def test_a_remote_that_stands_upright_is_laid_down(tmp_path):
    (asset,), _ = assets(tmp_path, "Remote", mobility.remote(rng()))
    assert asset.size == pytest.approx([0.048, 0.18, 0.02], rel=0.25)
    for joint in asset.joints:
        assert joint.axis[2] < -0.99  # its buttons look up and are pressed down


@pytest.mark.parametrize(
    ("category", "links", "size"),
    [
        ("Door", lambda: mobility.door(rng(), frame=0.05), (1.0, 0.08, 2.05)),
        ("CoffeeMachine", lambda: mobility.coffee_machine(rng()), (0.32, 0.28, 0.26)),
        ("Bucket", lambda: mobility.bucket(rng(), height=0.4), (0.31, 0.31, 0.4)),
        ("Microwave", lambda: mobility.microwave(rng()), (0.62, 0.45, 0.27)),
    ],
)
def test_other_proportions_than_usual_are_no_reason_to_lose_a_thing(tmp_path, category, links, size):
    (asset, *_), made = assets(tmp_path, category, links())
    assert "no_metric_fit" not in made.reasons
    assert asset.size == pytest.approx(size, rel=0.45)


def test_objects_of_a_category_say_themselves_what_is_usual(tmp_path):
    """Doors whose depth is another than we think: from many of them it is learnt that depth tells nothing."""
    doors = [mobility.door(rng(), n=1, frame=frame) for frame in np.linspace(0.04, 0.16, 9)]
    found, _ = assets(tmp_path, "Door", *doors, clean=True)
    assert len(found) == 9
    for asset in found:
        assert asset.size[2] == pytest.approx(2.05, rel=0.12)


def test_what_is_nothing_of_the_kind_goes(tmp_path):
    needle = [mobility.Moving("body", [mobility.board((-9, 0, -0.1), (9, 0.1, 0.1))])]
    _, made = assets(tmp_path, "Toilet", needle)
    assert made.reasons == {"no_metric_fit"}


def inside(points, mesh):
    v, f = np.asarray(mesh.vertices, float), np.asarray(mesh.faces)
    normals = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])
    return ((normals @ points.T - (normals * v[f[:, 0]]).sum(1)[:, None]) < 0).all(0)


def test_drawers_of_sheets_stay_hollow_and_boards_are_boards(tmp_path):
    (asset, *_), made = assets(tmp_path, "StorageFurniture", mobility.cabinet(rng()))
    assert "hull_collider" not in made.reasons
    drawer = next(k for k, j in enumerate(asset.joints) if j.part_class == "slider_drawer")
    link = asset.links[asset.joints[drawer].child]
    points = np.concatenate([m.vertices for m in link.visuals]).astype(float)
    low, high = points.min(axis=0), points.max(axis=0)
    air = rng().uniform(low + (high - low) * (0.15, 0.35, 0.45), low + (high - low) * (0.85, 0.8, 0.8), (500, 3))
    assert not any(inside(air, m).any() for m in link.colliders)
    assert 3 <= len(link.colliders) <= 20


def test_a_bucket_holds_water(tmp_path):
    (asset,), _ = assets(tmp_path, "Bucket", mobility.bucket(rng(), n=6))
    air = rng().uniform((-0.04, -0.04, 0.1), (0.04, 0.04, 0.3), (500, 3))
    filled = np.any([inside(air, m) for m in asset.links[0].colliders], axis=0)
    assert filled.mean() < 0.01  # corners of pieces of the wall
    assert len(asset.links[0].colliders) >= 6


def test_the_same_bytes_again(tmp_path):
    for place in ("a", "b"):
        mobility.write(tmp_path / place / "partnet", "1", "Bucket", mobility.bucket(rng()))
        read(tmp_path / place)
    files = [sorted((tmp_path / place / "assets").iterdir()) for place in ("a", "b")]
    assert [p.read_bytes() for p in files[0]] == [p.read_bytes() for p in files[1]]


def test_what_fits_nothing_is_never_cut(tmp_path, monkeypatch):
    monkeypatch.setattr("pipeline.sources.meshes.colliders.cut", lambda *_: pytest.fail("cut"))
    wall = mobility.lathe([(0.0, 0.0), (0.1, 0.0), (0.1, 18.0)], 24)
    _, made = assets(tmp_path, "Laptop", [mobility.Moving("body", [wall])])
    assert made.reasons == {"no_metric_fit"}


def test_hundreds_of_parts_cost_seconds(tmp_path):
    mobility.write(tmp_path / "partnet", "1", "Keyboard", mobility.keyboard(rng()))
    start = time.process_time()
    made = read(tmp_path)
    assert made.assets
    assert time.process_time() - start < 30


@pytest.mark.parametrize(
    ("word", "kind", "part"),
    [
        ("slider", "prismatic", ""),
        ("solid_panel", "revolute", ""),
        ("slide_rail", "prismatic", ""),
        ("slider_lid", "prismatic", "slider_lid"),
        ("rotationLid", "revolute", "hinge_lid"),
        ("drawers", "prismatic", "slider_drawer"),
        ("solid_door", "revolute", "hinge_door"),
        ("keyboard_tray", "prismatic", "slider_drawer"),
    ],
)
def test_words_are_whole_words(word, kind, part):
    from pipeline.sources.articulated.part_classes import named_class

    assert named_class(kind, word) == part


def test_many_points_cost_little_memory():
    """To see whether a lid or handle is drawn open, the points are projected on a hundred directions: not on all of them at once."""
    points = rng().normal(size=(600_000, 3))
    body = ShapeBody("lid", collisions=[(points, np.arange(600_000).reshape(-1, 3))])
    tracemalloc.start()
    outline = joint_rules._outline(body)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 120 << 20  # all at once it is 1,168 MiB
    assert np.ptp(outline, axis=0) == pytest.approx(np.ptp(points, axis=0))
