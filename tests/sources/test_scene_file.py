import json
import struct

import numpy as np
import pytest

from pipeline.entities.files import load_asset
from pipeline.sources.meshes.scene_file import parse_scene
from pipeline.sources.reasons import SourceError
from tests.sources import making
from tests.sources.reading import read

CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)], "<f4")
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
FACES = np.array([f for a, b, c, d in SIDES for f in ((a, b, c), (a, c, d))], "<u2")


def glb(*, image=b"", node=None, change=None):
    """A file of one cube with uvs, of the material `red` or of an image."""
    uvs = np.tile([[0.0, 0.25]], (8, 1)).astype("<f4")
    blobs = [CORNERS.tobytes(), FACES.tobytes(), uvs.tobytes(), image]
    starts = np.cumsum([0, *map(len, blobs)])
    surface = {"baseColorFactor": [1, 0, 0, 0.5], "roughnessFactor": 0.4} | ({"baseColorTexture": {"index": 0}} if image else {})
    tree = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, **(node or {})}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1, "material": 0}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"},
            {"bufferView": 2, "componentType": 5126, "count": 8, "type": "VEC2"},
        ],
        "bufferViews": [{"buffer": 0, "byteOffset": int(s), "byteLength": len(b)} for s, b in zip(starts, blobs, strict=False)],
        "buffers": [{"byteLength": int(starts[-1])}],
        "materials": [{"pbrMetallicRoughness": surface, "alphaMode": "BLEND"}],
        "textures": [{"source": 0}],
        "images": [{"bufferView": 3, "mimeType": "image/png"}],
    }
    if change:
        change(tree)
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    body = b"".join(blobs)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(body), b"BIN\0") + body
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def test_a_cube_with_its_material():
    file, materials = parse_scene(glb(), "glb", "x.glb")
    assert np.allclose(file.vertices, CORNERS)
    assert file.groups[0].faces.tolist() == FACES.tolist()
    assert file.uvs[0].tolist() == [0.0, 0.75]
    assert materials == {"0": materials["0"]}
    assert (*materials["0"].color, materials["0"].opacity) == pytest.approx((1.0, 0.0, 0.0, 0.5), abs=1 / 255)
    assert materials["0"].image == b""


def test_nodes_move_turn_scale_and_mirror():
    s = np.sqrt(0.5)
    file, _ = parse_scene(glb(node={"translation": [1, 2, 3], "rotation": [0, 0, s, s], "scale": [2, 4, 6]}), "glb", "x.glb")
    assert np.ptp(file.vertices, axis=0) == pytest.approx([4, 2, 6])
    assert file.vertices.mean(axis=0) == pytest.approx([1, 2, 3])
    matrix = np.diag([-1.0, 1, 1, 1])
    matrix[:3, 3] = 5, 0, 0
    mirrored, _ = parse_scene(glb(node={"matrix": matrix.T.ravel().tolist()}), "glb", "x.glb")
    assert mirrored.vertices.mean(axis=0) == pytest.approx([5, 0, 0])
    assert mirrored.groups[0].faces.tolist() == FACES[:, ::-1].tolist()


def test_in_a_urdf_with_its_texture(tmp_path):
    folder = tmp_path / "partnet"
    folder.mkdir()
    (folder / "body.glb").write_bytes(glb(image=making.png()))
    (folder / "cabinet.urdf").write_text(
        '<robot name="r"><link name="a"><visual><geometry><mesh filename="body.glb" scale="0.6, 0.9, 0.85"/></geometry></visual></link></robot>'
    )
    made = read(tmp_path)
    assert made.rejects == []
    asset = load_asset(tmp_path / "assets" / made.assets[0]["file"])
    assert sorted(asset.size) == pytest.approx([0.6, 0.85, 0.9], abs=1e-3)
    assert asset.materials[0].texture in asset.textures
    assert asset.links[0].visuals[0].uv is not None


def put(*path, also=None):
    *keys, last, value = path

    def change(tree):
        if also:
            also(tree)
        for key in keys:
            tree = tree[key]
        tree[last] = value

    return change


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (put("accessors", 0, "count", 10**9), "not_obj"),
        (put("accessors", 0, "byteOffset", -4), "not_obj"),
        (put("accessors", 0, "bufferView", 99), "not_obj"),
        (put("accessors", 1, "componentType", 7), "not_obj"),
        (put("bufferViews", 0, "byteLength", 10**12), "not_obj"),
        (put("bufferViews", 0, "byteOffset", -1), "not_obj"),
        (put("buffers", 0, "uri", "../../secret.bin"), "not_obj"),
        (put("nodes", [{}] * 30_000), "not_obj"),
        (put("meshes", 0, "primitives", [{"mode": 0}] * 30_000), "not_obj"),
        (put("nodes", [{"mesh": 0}] * 3000 + [{"children": list(range(3000))}], also=put("scenes", 0, "nodes", [3000])), "too_large"),
        (put("nodes", 0, "scale", [1e30, 1, 1]), "bad_number"),
        (put("nodes", 0, "translation", "abc"), "not_obj"),
        (put("nodes", 0, "mesh", "x"), "not_obj"),
        (put("scene", 5), "not_obj"),
        (put("scenes", 0, "nodes", []), "not_obj"),
        (put("meshes", 0, "primitives", 0, "extensions", {"KHR_draco_mesh_compression": {}}), "not_obj"),
        (put("meshes", 0, "primitives", [{"attributes": {"POSITION": 0}}] * 3000), "not_obj"),
        (put("materials", 0, "pbrMetallicRoughness", 7), "not_obj"),
        (put("materials", []), "not_obj"),
    ],
)
def test_what_lies_is_refused(change, code):
    with pytest.raises(SourceError) as caught:
        parse_scene(glb(change=change), "glb", "x.glb")
    assert caught.value.code == code


@pytest.mark.parametrize(
    "change",
    [
        put("accessors", 1, "count", -3),
        put("bufferViews", 0, "byteStride", 1),
        put("nodes", 0, "children", [0]),
        put("nodes", [{"children": [k + 1, k + 1]} for k in range(60)] + [{"mesh": 0}]),
    ],
)
def test_a_lie_that_does_no_harm(change):
    """A node has one parent: nodes in a loop, or a few that name each other again and again, are shown once."""
    file, _ = parse_scene(glb(change=change), "glb", "x.glb")
    assert len(file.vertices) == 8
    assert len(file.groups[0].faces) <= 12


@pytest.mark.parametrize("tenth", range(10))
def test_truncated(tenth):
    data = glb(image=making.png())
    with pytest.raises(SourceError) as caught:
        parse_scene(data[: len(data) * tenth // 10], "glb", "x.glb")
    assert caught.value.code == "not_obj"
