import math

import numpy as np
import pytest

from pipeline import taxonomy
from pipeline.entities.files import load_asset
from pipeline.geometry.kinematics import link_transforms
from pipeline.sources import metric_scale
from pipeline.sources.calibration import sizes
from pipeline.sources.guarded import Folder
from pipeline.sources.partnet import read_shape
from tests.sources import making
from tests.sources.reading import read


def first(root, **more):
    making.write_partnet(root / "partnet", **more)
    made = read(root)
    assert made.assets, made.rejects
    return load_asset(root / "assets" / made.assets[0]["file"]), made


def moved(asset, joint, part=None):
    """Return the middle of what a joint moves, at rest and fully open."""
    j = next(k for k, v in enumerate(asset.joints) if v.part_class == joint)
    positions = np.zeros(len(asset.joints))
    link = asset.links[asset.joints[j].child]
    points = np.concatenate([m.vertices for m in link.visuals if part is None or m.part == part]).astype(float)
    positions[j] = asset.joints[j].upper
    T = link_transforms(asset, positions)[asset.joints[j].child]
    return points.mean(axis=0), (points @ T[:3, :3].T + T[:3, 3]).mean(axis=0)


@pytest.mark.parametrize("gapartnet", [True, False])
def test_door_and_drawer_open_towards_the_front(tmp_path, gapartnet):
    asset, made = first(tmp_path, gapartnet=gapartnet)
    assert [j.part_class for j in asset.joints] == ["hinge_door", "slider_drawer"]
    for kind in ("hinge_door", "slider_drawer"):
        rest, opened = moved(asset, kind)
        assert opened[1] < rest[1] - 0.1
    assert asset.joints[0].type == "revolute"
    assert asset.joints[0].upper == pytest.approx(1.57)
    assert asset.joints[1].lower == 0
    for row in made.joints:
        assert row["sweep_min"][1] < -0.5 * asset.size[1] < row["handle"][1] + 0.2
        assert row["handle"][1] < 0


def test_frame(tmp_path):
    """Mesh (x, y up, z front) is ours (x, -z, y): the hinge is left and in front, the drawer below the door."""
    asset, made = first(tmp_path)
    w, d, h = asset.size
    scale = made.assets[0]["unit_scale"]
    assert np.allclose([w, h], np.array([making.W, making.H]) * scale, atol=1e-3)
    hinge = asset.joints[0]
    assert hinge.origin[0] == pytest.approx(-w / 2, abs=1e-3)
    assert hinge.origin[1] < 0
    assert np.allclose(np.abs(hinge.axis), [0, 0, 1])
    drawer, door = moved(asset, "slider_drawer")[0], moved(asset, "hinge_door")[0]
    assert drawer[2] < door[2]
    points = np.concatenate([m.vertices for m in asset.meshes()])
    assert np.allclose([points.min(axis=0), points.max(axis=0)], [[-w / 2, -d / 2, 0], [w / 2, d / 2, h]], atol=1e-3)
    mass = sum(link.mass for link in asset.links)
    assert 5 < mass < 1000


def test_fixed_handle_is_merged_and_keeps_its_name(tmp_path):
    asset, _ = first(tmp_path)
    assert len(asset.links) == 3
    door = asset.links[asset.joints[0].child]
    assert [m.part for m in door.visuals] == ["", "line_fixed_handle"]
    rest, opened = moved(asset, "hinge_door", "line_fixed_handle")
    assert opened[1] < rest[1] - 0.3


@pytest.mark.parametrize(
    ("axis", "limit", "upper"),
    [
        ("0 -1 0", 'lower="0" upper="1.5"', 1.5),
        ("0 1 0", 'lower="-1.5" upper="0"', 1.5),
        ("0 1 0", 'lower="-0.0" upper="-1.5"', 1.5),
        ("0 -1 0", 'lower="0.3" upper="1.5"', 1.2),
        ("0 1 0", 'lower="-1.5" upper="-0.3"', 1.2),
        ("0 -1 0", 'lower="-0.2" upper="1.5"', 1.5),
    ],
)
def test_limits_and_signs_all_open_outwards(tmp_path, axis, limit, upper):
    hinge = f"{-making.W / 2} 0 {making.D / 2}"
    xml = (
        f'<joint name="joint_0" type="revolute"><child link="link_0"/><parent link="link_2"/><origin xyz="{hinge}"/>'
        f'<axis xyz="{axis}"/><limit {limit}/></joint>'
        '<joint name="joint_1" type="fixed"><child link="link_1"/><parent link="link_2"/></joint>'
    )
    asset, _ = first(tmp_path, joints=xml)
    (joint,) = asset.joints
    assert joint.lower <= 0 <= joint.upper == pytest.approx(upper)
    rest, opened = moved(asset, "hinge_door")
    assert opened[1] < rest[1]


def test_continuous_and_screw(tmp_path):
    turn = '<joint name="joint_0" type="continuous"><child link="link_0"/><parent link="link_2"/><axis xyz="0 1 0"/></joint>'
    slide = (
        '<joint name="slide" type="prismatic"><child link="helper"/><parent link="link_2"/><axis xyz="0 0 1"/><limit lower="0" upper="0.2"/></joint>'
        '<joint name="turn" type="continuous"><child link="link_1"/><parent link="helper"/><axis xyz="0 0 1"/></joint>'
    )
    urdf = making.partnet_urdf((0, 0, 0), turn + slide).replace("</robot>", '<link name="helper"/></robot>')
    asset, made = first(tmp_path, urdf=urdf)
    assert [(j.type, j.part_class) for j in asset.joints] == [("continuous", "hinge_door"), ("prismatic", "slider_drawer")]
    assert math.isinf(asset.joints[0].upper)
    assert {r["reason"] for r in made.rejects} == {"screw_collapsed"}


def test_several_categories_share_object_and_split(tmp_path):
    _, made = first(tmp_path)
    assert 1 <= len(made.assets) <= 3
    assert len({a["split"] for a in made.assets}) == 1
    assert {a["asset_id"] for a in made.assets} == {f"ga_40000_{a['category']}" for a in made.assets}
    for row in made.assets:
        mean, std = sizes()[row["category"]].mean, sizes()[row["category"]].std
        assert (np.abs(np.array(row["size"]) - mean) < 4 * std + 0.3).all()


@pytest.mark.parametrize("category", sorted(c.name for c in taxonomy.load().categories.values() if c.partnet))
def test_metric_scale_recovers_a_mean_object(category):
    """An object of a category's mean proportions, normalised to any size, gets that category's mean size back."""
    mean = sizes()[category].mean
    fit = metric_scale.fit(mean / 3.7, category)
    assert np.allclose(mean / 3.7 * fit.scale, mean, rtol=0.15)
    assert fit.rms < 1
    assert metric_scale.best(np.array([1.0, 0.001, 30.0]), (category,), rms=2.5, keep=3, margin=2.0) == ()


def test_nested_folders_are_found(tmp_path):
    making.write_partnet(tmp_path / "partnet" / "annotation" / "set")
    assert len({a["source_id"] for a in read(tmp_path).assets}) == 1


def test_texture_beside_the_meshes_folder(tmp_path):
    folder = making.write_partnet(tmp_path / "p")
    (folder / "images").mkdir()
    (folder / "images" / "texture_0.png").write_bytes(making.png())
    (folder / "textured_objs" / "original-0.mtl").write_text("newmtl plain\nmap_Kd ../images/texture_0.png\n")
    shape = read_shape(Folder.at(folder), "40000", 512)
    assert list(shape.palette.textures) == ["texture_0.png"]
    assert shape.palette.notes == []
