import numpy as np
import pytest

from pipeline.entities.files import load_asset
from pipeline.sources.meshes.inertials import Inertial, combine_inertials, inertia_flaw, mass_flaw
from tests.sources import test_plain_urdf as plain_urdf
from tests.sources.reading import read


def box(mass, size, at=(0, 0, 0)):
    """The inertial of a solid box."""
    size = np.array(size, float)
    return Inertial(mass, np.array(at, float), mass / 12 * (np.eye(3) * (size @ size) - np.diag(size**2)))


def turned(yaw):
    T = np.eye(4)
    T[:2, :2] = [[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]
    T[:3, 3] = 1, 2, 3
    return T


@pytest.mark.parametrize("cut", [0.1, 0.5, 0.7])
def test_pieces_of_a_box_are_the_box(cut):
    whole = box(10, (2, 1, 1))
    left = box(10 * cut, (2 * cut, 1, 1), (cut - 1, 0, 0))
    right = box(10 - 10 * cut, (2 - 2 * cut, 1, 1), (cut, 0, 0))
    made = combine_inertials([left, right])
    assert made.mass == pytest.approx(10)
    assert np.allclose(made.centre, 0)
    assert np.allclose(made.inertia, whole.inertia)


def test_joining_and_moving_commute():
    pieces = [box(3, (1, 2, 3), (1, 0, 0)), box(5, (2, 1, 1), (0, 2, 1))]
    T = turned(0.7)
    a, b = combine_inertials(pieces).moved(T), combine_inertials([p.moved(T) for p in pieces])
    assert np.allclose(a.centre, b.centre)
    assert np.allclose(a.inertia, b.inertia)


@pytest.mark.parametrize("factor", [0.01, 1.0, 3.0])
def test_scaling_keeps_the_mass(factor):
    made = box(4, (1, 2, 3), (1, 1, 1)).scaled(np.array([0.5, 0, 0]), factor)
    assert np.allclose(made.inertia, box(4, np.array([1, 2, 3]) * factor).inertia)
    assert np.allclose(made.centre, np.array([0.5, 1, 1]) * factor)


def flaw(stated, low, high, volume):
    return mass_flaw(stated.mass, volume) or inertia_flaw(stated, low, high)


LOW, HIGH, VOLUME = np.array([-0.5, -0.25, 0.0]), np.array([0.5, 0.25, 1.0]), 0.05
GOOD = box(30, (1, 0.5, 1), (0, 0, 0.5))


def changed(**more):
    return Inertial(**{"mass": GOOD.mass, "centre": GOOD.centre, "inertia": GOOD.inertia, **more})


@pytest.mark.parametrize("yaw", [0.0, 0.4, 3.0])
def test_a_solid_box_is_sane_however_it_is_turned(yaw):
    T = turned(yaw)
    T[:3, 3] = 0
    assert flaw(GOOD.moved(T), LOW - 0.3, HIGH + 0.3, VOLUME) == ""


@pytest.mark.parametrize(
    ("stated", "word"),
    [
        (changed(mass=np.nan), "finite"),
        (changed(inertia=np.full((3, 3), np.inf)), "finite"),
        (changed(mass=0.0), "mass"),
        (changed(mass=-1.0), "mass"),
        (changed(inertia=np.diag([1, 1, 0.0])), "moment of 0"),
        (changed(inertia=np.diag([1, 1, -0.1])), "moment of -0.1"),
        (changed(inertia=np.array([[1, 2, 0], [2, 1, 0], [0, 0, 1.0]])), "moment of -1"),
        (changed(inertia=np.diag([1, 1, 2.5])), "larger than the other two"),
        (changed(inertia=100 * GOOD.inertia), "within"),
        (changed(centre=np.array([0, 0, 3.0])), "outside"),
        (changed(mass=0.05, inertia=GOOD.inertia * 0.05 / 30), "kg/m3"),
        (changed(mass=1000.0), "kg/m3"),
    ],
)
def test_placeholders_and_nonsense_are_told(stated, word):
    assert word in flaw(stated, LOW, HIGH, VOLUME)


def weighed(mass, moments, at="0.3 0 0.4"):
    xx, yy, zz = moments
    zeros = 'ixy="0" ixz="0" iyz="0"'
    return f'<inertial><origin xyz="{at}"/><mass value="{mass}"/><inertia ixx="{xx}" iyy="{yy}" izz="{zz}" {zeros}/></inertial>'


def cupboard(inertial, **more):
    """A kitchen unit whose carcass, drawn with its front to +x, states an inertial."""
    return plain_urdf.cupboard(**more).replace('<link name="root">', f'<link name="root">{inertial}')


def test_a_stated_mass_is_used_in_our_frame(tmp_path):
    plain_urdf.write(tmp_path, cupboard(weighed(35, (3.0, 2.0, 4.0))))
    asset, made = plain_urdf.only(tmp_path)
    assert [r["reason"] for r in made.rejects] == ["inertial_used"]
    base = asset.links[0]
    assert base.mass == 35
    assert base.com == pytest.approx([0, 0.01, 0.4], abs=2e-3)  # its box reaches 0.62 m deep with the door
    assert base.inertia == pytest.approx(np.diag([2.0, 3.0, 4.0]), abs=1e-5)  # x of the file is our -y
    assert asset.links[1].mass != 35


def test_units_of_the_file_are_those_of_its_inertial(tmp_path):
    plain_urdf.write(tmp_path, cupboard(weighed(35, (3e6, 2e6, 4e6), "300 0 400"), unit=1000.0))
    asset, made = plain_urdf.only(tmp_path)
    assert made.reasons == {"inertial_used"}
    assert asset.links[0].inertia == pytest.approx(np.diag([2.0, 3.0, 4.0]), abs=1e-5)


@pytest.mark.parametrize(
    "inertial",
    [
        weighed(35, (1e-3, 1e-3, 1e-3)).replace('xyz="0.3 0 0.4"', 'xyz="9 0 0"'),
        weighed(35, (1000, 1000, 1000)),
        weighed(35, (0, 0, 0)),
        '<inertial><mass value="35"/></inertial>',
    ],
)
def test_a_mass_beside_a_placeholder_stays(inertial, tmp_path):
    """Its inertia is that of its volume, brought to the stated mass."""
    plain_urdf.write(tmp_path, cupboard(inertial))
    asset, made = plain_urdf.only(tmp_path)
    assert made.reasons == {"mass_used"}
    plain_urdf.write(tmp_path, plain_urdf.cupboard())
    plain = plain_urdf.only(tmp_path)[0].links[0]
    base = asset.links[0]
    assert base.mass == 35
    assert np.allclose(base.com, plain.com)
    assert np.allclose(base.inertia, plain.inertia * 35 / plain.mass, atol=2e-5)


@pytest.mark.parametrize(
    "inertial",
    [
        weighed(1, (1, 1, 1)),
        weighed(0, (0, 0, 0)),
        weighed("nan", (1, 1, 1)),
        weighed("heavy", (1, 1, 1)),
        "<inertial/>",
        weighed(35, (3.0, 2.0, 4.0), at="1 2"),
    ],
)
def test_a_wrong_one_is_made_anew(inertial, tmp_path):
    plain_urdf.write(tmp_path, cupboard(inertial))
    asset, made = plain_urdf.only(tmp_path)
    assert made.reasons == {"inertial_refused"}
    plain_urdf.write(tmp_path, plain_urdf.cupboard())
    plain, _ = plain_urdf.only(tmp_path)
    assert asset.links[0].mass == plain.links[0].mass
    assert np.array_equal(asset.links[0].inertia, plain.links[0].inertia)


def test_of_bodies_fixed_together_all_must_say(tmp_path):
    board = '<visual><geometry><box size="0.6 0.88 0.02"/></geometry></visual>'
    shelf = '<joint name="f" type="fixed"><parent link="root"/><child link="shelf"/><origin xyz="0.3 0 0.3"/></joint></robot>'
    for inertial, reason in (("", "inertial_refused"), (weighed(5, (0.3, 0.15, 0.45), "0 0 0"), "inertial_used")):
        text = cupboard(weighed(35, (3.0, 2.0, 4.0)))
        plain_urdf.write(tmp_path, text.replace("</robot>", f'<link name="shelf">{inertial}{board}</link>{shelf}'))
        asset, made = plain_urdf.only(tmp_path)
        assert made.reasons == {reason}
    assert asset.links[0].mass == 40
    assert load_asset(tmp_path / "assets" / made.assets[0]["file"]).links[0].mass == 40
    assert read(tmp_path).assets[0]["mass"] == pytest.approx(sum(link.mass for link in asset.links), abs=1e-3)
