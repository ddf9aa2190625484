import numpy as np
import pytest

from pipeline.entities.files import load_asset
from pipeline.sources.meshes.collada_file import parse_dae
from pipeline.sources.meshes.mesh_solids import signed_volume
from pipeline.sources.meshes.obj_file import linear
from pipeline.sources.reasons import SourceError
from tests.sources import collada, making
from tests.sources.reading import read


def read_file(**more):
    file, materials = parse_dae(collada.dae(**more), "x.dae")
    (group,) = file.groups
    return file, group, materials


@pytest.mark.parametrize("kind", ["triangles", "polylist", "polygons", "trifans", "tristrips"])
def test_every_primitive_is_the_same_box(kind):
    file, group, _ = read_file(kind=kind)
    assert np.allclose(file.vertices, collada.corners())
    assert len(group.faces) == 12
    assert signed_volume(file.vertices, group.faces) == pytest.approx(signed_volume(collada.corners(), np.array(collada.TRIANGLES)))
    if kind in {"polylist", "polygons", "trifans"}:
        assert sorted(map(tuple, group.faces.tolist())) == sorted(collada.TRIANGLES)
        assert file.uvs[group.uv_faces[0]].tolist() == [[0, 0], [1, 0], [1, 1]]


@pytest.mark.parametrize(
    ("asset", "extent"),
    [
        ("<up_axis>Z_UP</up_axis>", (1, 2, 3)),
        ('<unit name="inch" meter="0.0254"/><up_axis>Z_UP</up_axis>', (0.0254, 0.0508, 0.0762)),
        ("<up_axis>Y_UP</up_axis>", (1, 3, 2)),
        ("", (1, 3, 2)),  # y is up where nothing is said
        ("<up_axis>X_UP</up_axis>", (2, 3, 1)),
    ],
)
def test_units_and_the_axis_that_is_up(asset, extent):
    file, group, _ = read_file(asset=asset, size=(1, 2, 3))
    assert np.ptp(file.vertices, axis=0) == pytest.approx(extent)
    assert abs(signed_volume(file.vertices, group.faces)) == pytest.approx(np.prod(extent))


def test_what_is_up_stays_up():
    """The box stands on the origin along the file's z: with y up that is towards the viewer, which is -y with z up."""
    file, _, _ = read_file(asset="<up_axis>Y_UP</up_axis>", size=(1, 2, 3))
    assert (file.vertices[:, 1].min(), file.vertices[:, 1].max()) == pytest.approx((-3, 0))


def test_transforms_apply_in_their_order():
    node = "<translate>1 2 3</translate><rotate>0 0 2 90</rotate><scale>2 4 6</scale>"
    file, _, _ = read_file(node=node)
    x, y, z = collada.corners().T
    assert np.allclose(file.vertices, np.stack([1 - 4 * y, 2 + 2 * x, 3 + 6 * z], axis=1))
    matrix = "<matrix>0 -4 0 1  2 0 0 2  0 0 6 3  0 0 0 1</matrix>"
    assert np.allclose(read_file(node=matrix)[0].vertices, file.vertices)


def test_a_mirrored_node_turns_its_faces():
    plain, group, _ = read_file()
    file, mirrored, _ = read_file(node="<scale>-1 1 1</scale>")
    assert signed_volume(file.vertices, mirrored.faces) == pytest.approx(signed_volume(plain.vertices, group.faces))


def test_nodes_that_are_used_twice_are_there_twice():
    shown = '<instance_geometry url="#box"/>'
    nodes = f'<node id="a"><translate>5 0 0</translate><instance_node url="#b"/></node><node id="b">{shown}</node>'
    file, _ = parse_dae(collada.dae(nodes=nodes), "x.dae")
    assert [np.round(g.mean(axis=0), 3).tolist() for g in np.split(file.vertices, 2)] == [[5, 0, 0.5], [0, 0, 0.5]]


@pytest.mark.parametrize(
    ("diffuse", "more", "color", "opacity", "image"),
    [
        (collada.RED, "", (1, 0, 0), 1, ""),
        (
            collada.RED,
            "<transparent><color>1 1 1 1</color></transparent><transparency><float>0.4</float></transparency>",
            (1, 0, 0),
            0.4,
            "",
        ),
        (
            collada.RED,
            '<transparent opaque="RGB_ZERO"><color>1 1 1 1</color></transparent><transparency><float>0.7</float></transparency>',
            (1, 0, 0),
            0.3,
            "",
        ),
        (collada.RED, "<transparent><color>0 0 0 0</color></transparent>", (1, 0, 0), 1, ""),
        ("<color>1 nan 0 1</color>", "", (0.8, 0.8, 0.8), 1, ""),
        (collada.TEXTURE, "", (0.8, 0.8, 0.8), 1, "old wood.png"),
        ('<texture texture="picture"/>', "", (0.8, 0.8, 0.8), 1, "old wood.png"),
        ('<texture texture="nothing"/>', "", (0.8, 0.8, 0.8), 1, ""),
    ],
)
def test_materials(diffuse, more, color, opacity, image):
    _, group, materials = read_file(diffuse=diffuse, more=more, image="old%20wood.png")
    assert group.material == "red"
    assert materials["red"].color == pytest.approx(linear(color))
    assert materials["red"].opacity == pytest.approx(opacity)
    assert materials["red"].map == image


def urdf(folder, data):
    (folder / "meshes").mkdir(parents=True)
    (folder / "meshes" / "body.dae").write_bytes(data)
    (folder / "meshes" / "wood.png").write_bytes(making.png())
    text = '<robot name="r"><link name="a"><visual><geometry><mesh filename="meshes/body.dae"/></geometry></visual></link></robot>'
    (folder / "cabinet.urdf").write_text(text)


def test_in_a_urdf_with_its_texture(tmp_path):
    urdf(tmp_path / "partnet", collada.dae(size=(0.9, 0.6, 0.85), diffuse=collada.TEXTURE, image="./wood.png"))
    made = read(tmp_path)
    assert made.rejects == []
    asset = load_asset(tmp_path / "assets" / made.assets[0]["file"])
    assert asset.size == pytest.approx([0.9, 0.6, 0.85], abs=1e-3)
    assert asset.materials[0].texture in asset.textures
    assert asset.links[0].visuals[0].uv is not None
    assert len(asset.links[0].colliders) == 1


def test_a_texture_outside_the_folder_is_refused(tmp_path):
    urdf(tmp_path / "partnet", collada.dae(diffuse=collada.TEXTURE, image="..%2F..%2Fsecret.png"))
    assert read(tmp_path).reasons == {"unsafe_path"}


LOOP = '<node id="a"><instance_node url="#a"/></node>'
BOMB = "".join(f'<node id="n{k}"><instance_node url="#n{k + 1}"/><instance_node url="#n{k + 1}"/></node>' for k in range(60))


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"", "not_obj"),
        (b"<robot/>", "not_obj"),
        (b"<COLLADA/>", "not_obj"),
        (b'<!DOCTYPE a [<!ENTITY b "c">]>' + collada.dae()[38:], "not_obj"),
        (collada.dae(nodes=LOOP), "not_obj"),
        (collada.dae(nodes=BOMB + '<node id="n60"/>'), "too_large"),
        (collada.dae(nodes='<node><instance_geometry url="#box"/></node>' * 3000), "too_large"),
        (collada.dae(nodes='<node><instance_geometry url="#gone"/></node>'), "not_obj"),
        (collada.dae().replace(b'semantic="POSITION"', b'semantic="PLACE"'), "not_obj"),
        (collada.dae(node="<matrix>1 2 3</matrix>"), "not_obj"),
        (collada.dae(node="<scale>1e400 1 1</scale>"), "bad_number"),
        (collada.dae(node="<scale>1e30 1 1</scale>"), "bad_number"),
        (collada.dae(node="<translate>x 1 1</translate>"), "bad_number"),
        (collada.dae(asset="<up_axis>W_UP</up_axis>"), "not_obj"),
        (collada.dae(asset='<unit meter="nan"/>'), "bad_number"),
        (collada.dae().replace(b'stride="3"', b'stride="0"', 1), "not_obj"),
        (collada.dae().replace(b'count="8"', b'count="80000000"', 1), "not_obj"),
        (collada.dae().replace(b'count="8"', b'count="-8"', 1), "not_obj"),
        (collada.dae().replace(b'offset="2"', b'offset="2000000000000"', 1), "not_obj"),
        (collada.dae().replace(b"<p>0 ", b"<p>99 "), "not_obj"),
        (collada.dae().replace(b"<p>0 ", b"<p>-2 "), "not_obj"),
        (collada.dae().replace(b"<p>0 ", b"<p>99999999999999999999 "), "not_obj"),
        (collada.dae(kind="polylist").replace(b"<vcount>4", b"<vcount>400000000"), "not_obj"),
        (collada.dae(kind="polylist").replace(b"<vcount>4", b"<vcount>-4"), "not_obj"),
        (collada.dae().replace(b"-0.5 ", b"nan "), "bad_number"),
        (b"<a>" * 100_000, "not_obj"),
        (b"<a/>" * 300_000, "too_large"),
    ],
)
def test_what_lies_is_refused(data, code):
    with pytest.raises(SourceError) as caught:
        parse_dae(data, "x.dae")
    assert caught.value.code == code


@pytest.mark.parametrize("tenth", range(10))
def test_truncated(tenth):
    data = collada.dae()
    with pytest.raises(SourceError) as caught:
        parse_dae(data[: len(data) * tenth // 10], "x.dae")
    assert caught.value.code == "not_obj"
