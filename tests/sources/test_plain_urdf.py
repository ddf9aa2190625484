"""Other people's URDFs: quirks, frames, units and categories."""

import numpy as np
import pytest

from pipeline.entities.files import load_asset
from pipeline.geometry.kinematics import facing, link_transforms, opening_direction
from tests.sources import making
from tests.sources.reading import read

UNIT = {
    "z_up": np.eye(3),
    "y_up": np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]),
}  # x front, y left, z up to the file's axes


def vec(v):
    return " ".join(f"{x:.6g}" for x in v)


def board(kind, low, high, R, unit):
    """A box primitive between two corners of a frame with x front, y left, z up."""
    low, high = np.array(low) * unit, np.array(high) * unit
    size = np.abs(R @ (high - low))
    return f'<{kind} group="static"><origin xyz="{vec(R @ (low + high) / 2)}"/><geometry><box size="{vec(size)}"/></geometry></{kind}>'


def cupboard(R=UNIT["z_up"], unit=1.0, *, robot="fridge", quirks=False, drawer="-0.4,0"):
    """A kitchen unit of 0.9 x 0.6 x 0.85 m: a carcass, a door hinged at its right, a drawer that opens towards the negative side."""
    w, d, h = 0.9, 0.6, 0.85
    carcass = [
        ((0, -w / 2, 0), (0.02, w / 2, h)),
        ((0, -w / 2, 0), (d, -w / 2 + 0.02, h)),
        ((0, w / 2 - 0.02, 0), (d, w / 2, h)),
        ((0, -w / 2, 0), (d, w / 2, 0.02)),
    ]
    door = [((d, -w / 2, 0.02), (d + 0.02, w / 2, 0.6))]
    front = [((d, -w / 2, 0.62), (d + 0.02, w / 2, h)), ((0.1, -w / 2 + 0.03, 0.64), (d, w / 2 - 0.03, 0.66))]
    hinge = np.array([d, -w / 2, 0.0]) * unit

    def link(name, boards, shift=(0, 0, 0)):
        moved = [(np.array(a) - np.array(shift) / unit, np.array(b) - np.array(shift) / unit) for a, b in boards]
        return f'<link name="{name}">' + "".join(board(k, a, b, R, unit) for k in ("visual", "collision") for a, b in moved) + "</link>"

    lower, upper = drawer.split(",")
    rpy = ' rpy="1.565 0 0"' if quirks else ""
    text = (
        f'<robot name="{robot}">{link("root", carcass)}{link("door_left", door, hinge)}{link("drawer_top", front)}'
        f'<joint name="door_joint" type="revolute"><parent link="root"/><child link="door_left"/><origin xyz="{vec(R @ hinge)}"/>'
        f'<axis xyz="{vec(R @ [0, 0, -1])}"/><limit lower="0" upper="1.5" effort="10" velocity="1"/><dynamics damping="0.1"/></joint>'
        f'<joint name="drawer_joint" type="prismatic"><parent link="root"/><child link="drawer_top"/>'
        f'<axis xyz="{vec(R @ [-1, 0, 0])}"/><limit lower="{float(lower) * unit}" upper="{float(upper) * unit}"/></joint></robot>'
    )
    if quirks:  # the whole thing stands on a link that is turned by about a right angle
        text = text.replace(
            "</robot>",
            f'<link name="world"/><joint name="stand" type="fixed"><origin{rpy}/><parent link="world"/><child link="root"/></joint></robot>',
        )
    return text


def write(root, text, file="kitchen_cabinet/kitchen_cabinet.urdf"):
    path = root / "partnet" / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def only(root, **more):
    made = read(root, **more)
    assert made.assets, made.rejects
    return load_asset(root / "assets" / made.assets[0]["file"]), made


@pytest.mark.parametrize("axes", sorted(UNIT))
@pytest.mark.parametrize("unit", [1.0, 100.0, 1000.0])
def test_frame_unit_and_front(tmp_path, axes, unit):
    """Up along z or y, in metres, centimetres or millimetres: it stands upright, its front to -y, at its real size."""
    write(tmp_path, cupboard(UNIT[axes], unit))
    asset, made = only(tmp_path)
    assert asset.category == "kitchen_cabinet"
    assert made.assets[0]["unit_scale"] == pytest.approx(1 / unit)
    assert asset.size == pytest.approx([0.9, 0.62, 0.85], abs=1e-3)
    assert {j.part_class for j in asset.joints} == {"hinge_door", "slider_drawer"}
    for k, joint in enumerate(asset.joints):
        assert joint.lower == 0
        assert np.allclose(facing(asset, k), [0, -1], atol=0.15)
        assert opening_direction(asset, k)[1] < -0.9
    drawer = next(k for k, j in enumerate(asset.joints) if j.part_class == "slider_drawer")
    assert asset.joints[drawer].upper == pytest.approx(0.4)
    opened = np.zeros(len(asset.joints))
    opened[drawer] = 0.4
    assert link_transforms(asset, opened)[asset.joints[drawer].child][1, 3] == pytest.approx(-0.4)


@pytest.mark.parametrize("quarter", range(4))
def test_whichever_way_it_looks(tmp_path, quarter):
    c, s = np.round(np.cos(quarter * np.pi / 2)), np.round(np.sin(quarter * np.pi / 2))
    write(tmp_path, cupboard(np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])))
    asset, _ = only(tmp_path)
    assert asset.size == pytest.approx([0.9, 0.62, 0.85], abs=1e-3)
    assert all(opening_direction(asset, k)[1] < -0.9 for k in range(2))


def test_an_angle_of_1565_is_a_right_one(tmp_path):
    R = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])  # undone by the turn about x
    write(tmp_path, cupboard(R, quirks=True))
    asset, made = only(tmp_path)
    assert made.reasons == {"angle_snapped"}
    assert asset.size == pytest.approx([0.9, 0.62, 0.85], abs=1e-3)
    assert all((np.abs(j.axis) > 1 - 1e-9).any() for j in asset.joints)


def test_the_robots_name_is_not_believed(tmp_path):
    write(tmp_path, cupboard(robot="microwave"), "things/kitchenCounter.urdf")
    assert only(tmp_path)[0].category == "kitchen_cabinet"


def test_without_a_word_the_size_and_the_fronts_tell(tmp_path):
    write(tmp_path, cupboard(), "b/x1.urdf")
    asset, _ = only(tmp_path)
    assert asset.category in {"kitchen_cabinet", "cabinet", "sideboard", "shoe_cabinet"}
    assert asset.size == pytest.approx([0.9, 0.62, 0.85], abs=1e-3)


def test_what_is_no_furniture_is_rejected(tmp_path):
    text = '<robot name="r"><link name="a"><visual><geometry><box size="900 0.01 0.01"/></geometry></visual></link></robot>'
    write(tmp_path, text, "b/x1.urdf")
    assert read(tmp_path).reasons == {"no_metric_fit"}


def test_a_door_whose_root_joint_turns_gets_a_post(tmp_path):
    """ReplicaCAD's doors: nothing hangs in the root link."""
    text = (
        '<robot name="r"><link name="root"/><link name="leaf"><visual><origin xyz="0.45 0 1"/><geometry><box size="0.9 0.04 2"/></geometry></visual></link>'
        '<joint name="j" type="revolute"><parent link="root"/><child link="leaf"/><axis xyz="0 0 1"/><limit lower="-1.57" upper="0"/></joint></robot>'
    )
    write(tmp_path, text, "wardrobe/door1.urdf")
    asset, made = only(tmp_path, limits={"fit_rms": 30.0})
    assert made.reasons == {"base_made"}
    (joint,) = asset.joints
    assert (joint.lower, joint.upper) == pytest.approx((0, 1.57), abs=1e-6)
    post, leaf = (np.concatenate([m.vertices for m in link.visuals]) for link in asset.links)
    assert abs(np.abs(joint.axis[2]) - 1) < 1e-9
    outside = [k for k in (0, 1) if post[:, k].min() >= leaf[:, k].max() - 1e-4 or post[:, k].max() <= leaf[:, k].min() + 1e-4]
    assert outside  # beside the leaf, not in it


def test_meshes_beside_the_urdfs_folder(tmp_path):
    """../meshes is inside the source; above the source it is refused."""
    (tmp_path / "partnet" / "meshes").mkdir(parents=True)
    (tmp_path / "partnet" / "meshes" / "box.obj").write_text(making.box_obj((0.9, 0.6, 0.85), mtl="box.mtl"))
    (tmp_path / "partnet" / "meshes" / "box.mtl").write_text("newmtl plain\nKd 1 0 0\n")
    text = (
        '<robot name="r"><link name="a"><visual><geometry><mesh filename="../meshes/box.obj" scale="1.0, 1.0, 1.0"/>'
        "</geometry></visual></link></robot>"
    )
    write(tmp_path, text, "urdf/cabinet.urdf")
    asset, made = only(tmp_path)
    assert made.rejects == []
    assert sorted(asset.size) == pytest.approx([0.6, 0.85, 0.9], abs=1e-3)
    assert asset.materials[0].base_color == (1.0, 0.0, 0.0)
    write(tmp_path, text.replace("../meshes", "../../meshes"), "urdf/cabinet.urdf")
    assert read(tmp_path).reasons == {"unsafe_path"}


@pytest.mark.parametrize("mesh", ["package://store/meshes/box.obj", "package://meshes/box.obj", "package://other_name/meshes/box.obj"])
@pytest.mark.parametrize("file", ["store/urdf/cabinet.urdf", "store/cabinet.urdf"])
def test_a_package_is_looked_up_beside_the_file_and_above(tmp_path, mesh, file):
    """package://<name>/... as ROS writes it, the name that of the package's folder or of one that is not there."""
    meshes = tmp_path / "partnet" / "store" / "meshes"
    meshes.mkdir(parents=True)
    (meshes / "box.obj").write_text(making.box_obj((0.9, 0.6, 0.85), mtl="box.mtl"))
    (meshes / "box.mtl").write_text("newmtl plain\nKd 1 0 0\n")
    text = f'<robot name="r"><link name="a"><visual><geometry><mesh filename="{mesh}"/></geometry></visual></link></robot>'
    write(tmp_path, text, file)
    asset, made = only(tmp_path)
    assert made.rejects == []
    assert asset.materials[0].base_color == (1.0, 0.0, 0.0)


def test_a_package_that_leaves_the_folder_is_refused(tmp_path):
    text = '<robot name="r"><link name="a"><visual><geometry><mesh filename="package://../../../secret.obj"/></geometry></visual></link></robot>'
    write(tmp_path, text, "store/urdf/cabinet.urdf")
    assert read(tmp_path).reasons == {"unsafe_path"}


def test_a_chest_as_high_as_a_room_is_not_to_scale(tmp_path):
    """Drawn 3.2 m high, to be placed at .4 of that."""
    write(tmp_path, cupboard(unit=3.2 / 0.85), "chest/chest.urdf")
    asset, made = only(tmp_path)
    assert asset.size[2] < 2.0
    assert made.assets[0]["scale_from"] != "file"


def test_meshes_of_a_kind_that_is_not_read_show_their_colliders(tmp_path):
    text = cupboard().replace("<visual", '<visual name="x"')
    for kind in ("visual",):
        start = text.index(f"<{kind}")
        end = text.index(f"</{kind}>") + len(f"</{kind}>")
        text = text[:start] + '<visual><geometry><mesh filename="body.fbx"/></geometry></visual>' + text[end:]
    head, tail = text.split('<link name="door_left">')
    body = '<link name="root"><visual><geometry><mesh filename="body.fbx"/></geometry></visual>' + head[head.index("<collision") :]
    write(tmp_path, head[: head.index('<link name="root">')] + body + '<link name="door_left">' + tail)
    (tmp_path / "partnet" / "kitchen_cabinet" / "body.fbx").write_text("Kaydara")
    asset, made = only(tmp_path)
    assert made.reasons == {"missing_mesh", "looks_from_colliders"}
    assert len(asset.links[0].visuals) == 4
