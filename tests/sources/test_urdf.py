import numpy as np
import pytest

from pipeline.sources.articulated.urdf import parse_urdf
from pipeline.sources.reasons import SourceError

LINKS = '<link name="a"/><link name="b"/>'


def robot(body, head='<?xml version="1.0"?>'):
    return f'{head}<robot name="r">{body}</robot>'.encode()


def joint(inside='<parent link="a"/><child link="b"/>', kind="revolute"):
    return f'<joint name="j" type="{kind}">{inside}</joint>'


def test_quirks_of_other_people():
    """Commas in scale, extra attributes and elements, no effort, child before parent, limit without lower."""
    text = (
        '<link name="b"><visual><geometry><mesh filename="x.obj" scale="1.0, 2.0, 1.0"/></geometry></visual>'
        '<collision group="static"><geometry><box size="1,2,3"/></geometry></collision><drake:thing xmlns:drake="d"/></link><link name="a"/>'
        + joint('<child link="b"/><parent link="a"/><axis xyz="0 0 2"/><limit upper="1.5"/><origin rpy="1.565 0 0" xyz="1, 2, 3"/>')
    )
    made = parse_urdf(robot(text), "x")
    assert made.root == "a"
    assert made.links["b"].visuals[0].scale.tolist() == [1, 2, 1]
    assert made.links["b"].collisions[0].primitive == ("box", (1, 2, 3))
    (j,) = made.joints
    assert j.limits == (0.0, 1.5)
    assert j.axis.tolist() == [0, 0, 1]
    assert j.T[:3, 3].tolist() == [1, 2, 3]


def test_rpy_is_fixed_axes_xyz():
    rpy = (0.3, -0.7, 1.9)
    made = parse_urdf(robot(LINKS + joint('<parent link="a"/><child link="b"/><origin rpy="0.3 -0.7 1.9"/>')), "x")

    def turn(k, angle):
        R = np.eye(3)
        i, j = (k + 1) % 3, (k + 2) % 3
        R[i, i] = R[j, j] = np.cos(angle)
        R[i, j], R[j, i] = -np.sin(angle), np.sin(angle)
        return R

    assert np.allclose(made.joints[0].T[:3, :3], turn(2, rpy[2]) @ turn(1, rpy[1]) @ turn(0, rpy[0]))


def test_joints_come_parents_first():
    links = "".join(f'<link name="{n}"/>' for n in "dcba")
    joints = "".join(f'<joint name="{p}{c}" type="fixed"><parent link="{p}"/><child link="{c}"/></joint>' for p, c in ("cd", "ab", "bc"))
    assert [j.name for j in parse_urdf(robot(links + joints), "x").joints] == ["ab", "bc", "cd"]


@pytest.mark.parametrize(
    "body",
    [
        "",
        '<link name=""/>',
        '<link name="a"/><link name="a"/>',
        LINKS,
        LINKS + joint('<parent link="a"/><child link="z"/>'),
        LINKS + joint() + joint(),
        LINKS + joint() + joint('<parent link="b"/><child link="a"/>'),
        '<link name="r"/>' + LINKS + joint() + joint('<parent link="b"/><child link="a"/>'),
    ],
)
def test_no_tree(body):
    with pytest.raises(SourceError) as caught:
        parse_urdf(robot(body), "x")
    assert caught.value.code == "not_urdf"


@pytest.mark.parametrize("value", ["nan 0 0", "0 0", "1e400 0 0", "a b c", "0 0 0 0", "", "1e9 0 0"])
def test_bad_numbers(value):
    with pytest.raises(SourceError) as caught:
        parse_urdf(robot(LINKS + joint(f'<parent link="a"/><child link="b"/><origin xyz="{value}"/>')), "x")
    assert caught.value.code == "bad_number"
