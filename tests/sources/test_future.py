import json

import numpy as np
import pytest
from PIL import Image
from scipy.spatial import ConvexHull

from pipeline.entities.files import encode, load_asset
from pipeline.sources.guarded import Folder
from pipeline.sources.meshes.mesh_solids import distances_outside
from pipeline.sources.reasons import SourceError
from pipeline.sources.rows import split_of
from pipeline.sources.settings import ModelLimits
from pipeline.sources.threed_front.future import ModelInfo, read_model, read_model_info
from tests.sources import making
from tests.sources.making import BED, STAND
from tests.sources.reading import read

INFO = ModelInfo(BED, "King-size Bed", "Bed", "Modern", "", "Wood")


def model(root, text=None, entry=INFO, **more):
    making.write_model(root, BED, text, **more)
    return read_model(Folder.at(root / "3D-FUTURE-model"), entry, ModelLimits(), "CC0-1.0")


def test_frame_and_size(tmp_path):
    """A bump at the file's front (+z), on top, right of the middle ends at our front (-y), top, right."""
    bump = making.box_obj((0.2, 0.1, 0.2), at=(0.5, 1.1, 1.05), group="bump").splitlines()
    bump = [" ".join(f"{int(w.split('/')[0]) + 8}" for w in line.split()[1:]) for line in bump if line.startswith("f ")]
    vertices = [v for v in making.box_obj((0.2, 0.1, 0.2), at=(0.5, 1.1, 1.05)).splitlines() if v.startswith("v ")]
    base = making.box_obj((1.8, 2.2, 1.1)).splitlines()
    text = "\n".join(
        [base[0], *(v for v in base if v.startswith("v ")), *vertices, "usemtl plain", *(v for v in base if v[:2] in {"vt", "f "})]
    )
    text += "\ng bump\n" + "\n".join(f"f {line}" for line in bump) + "\n"
    made = model(tmp_path, text).asset
    assert made.size.tolist() == [1.8, 2.2, 1.3]
    front = next(m for m in made.links[0].visuals if m.vertices[:, 2].min() > 1.05)
    assert np.allclose(front.vertices.mean(axis=0), [0.5, -1.05, 1.2], atol=1e-5)
    box = np.concatenate([m.vertices for m in made.meshes()])
    assert np.allclose([box.min(axis=0), box.max(axis=0)], [[-0.9, -1.1, 0], [0.9, 1.1, 1.3]], atol=1e-5)


def test_faces_stay_outward(tmp_path):
    from pipeline.sources.meshes.mesh_solids import signed_volume

    (mesh,) = model(tmp_path, making.box_obj((1.8, 2.2, 1.1), uv=False)).asset.links[0].visuals
    (collider,) = model(tmp_path).asset.links[0].colliders
    assert abs(signed_volume(mesh.vertices, mesh.faces)) == pytest.approx(1.8 * 2.2 * 1.1, rel=1e-5)
    assert signed_volume(collider.vertices, collider.faces) == pytest.approx(1.8 * 2.2 * 1.1, rel=1e-5)


def test_off_centre_model_is_centred(tmp_path):
    made = model(tmp_path, making.box_obj((1.8, 2.2, 1.1), at=(3, 1, -2)))
    points = np.concatenate([m.vertices for m in made.asset.meshes()])
    assert np.allclose(points.min(axis=0), [-0.9, -1.1, 0], atol=1e-5)
    assert made.box.low == (2.1, 1.0, -3.1)


def test_centimetre_model(tmp_path):
    made = model(tmp_path, making.box_obj((1.8, 2.2, 1.1), scale=100))
    assert made.asset.size.tolist() == [1.8, 2.2, 1.1]
    assert made.box.unit == 0.01


def test_centimetre_model_in_a_house(tmp_path):
    making.write_library(tmp_path / "front")
    making.write_model(tmp_path / "front", STAND, making.box_obj(making.SIZES[STAND], scale=100))
    making.write_house(tmp_path / "front", making.two_rooms())
    stand = next(o for o in read(tmp_path).objects if o["category"] == "nightstand")
    assert stand["size"] == [0.5, 0.4, 0.5]
    assert stand["scale"] == [1, 1, 1]
    assert stand["position"] == [3.4, -0.3, 0]


def test_textures(tmp_path):
    small = model(tmp_path).asset
    assert list(small.textures.values()) == [making.png()]
    assert small.materials[0].texture in small.textures
    large = model(tmp_path, texture=making.png(1200, 600)).asset
    import io

    assert Image.open(io.BytesIO(next(iter(large.textures.values())))).size == (512, 256)
    assert encode(large) == encode(model(tmp_path, texture=making.png(1200, 600)).asset)


@pytest.mark.parametrize("broken", [b"", b"no image", making.png()[:40], b"GIF89a"])
def test_broken_texture_leaves_a_plain_colour(tmp_path, broken):
    making.write_model(tmp_path, BED)
    (tmp_path / "3D-FUTURE-model" / BED / "texture.png").write_bytes(broken)
    made = read_model(Folder.at(tmp_path / "3D-FUTURE-model"), INFO, ModelLimits(), "CC0-1.0")
    assert made.asset.textures == {}
    assert [r["reason"] for r in made.rejects] == ["missing_texture"]


@pytest.mark.parametrize("path", ["/etc/passwd", "../../secret.png", "file:///etc/passwd", "http://x/y.png", "~/x.png"])
def test_texture_outside_the_folder_is_refused(tmp_path, path):
    with pytest.raises(SourceError) as caught:
        model(tmp_path, mtl=f"newmtl plain\nmap_Kd {path}\n")
    assert caught.value.code == "unsafe_path"


def test_drive_letter_means_the_file_beside(tmp_path):
    assert len(model(tmp_path, mtl="newmtl plain\nmap_Kd C:\\work\\texture.png\n").asset.textures) == 1


def test_model_info(tmp_path):
    entries = [making.info(BED), making.info(BED, "Desk"), {"model_id": 3}, 7, making.info(STAND, style=None)]
    (tmp_path / "info.json").write_text(json.dumps(entries))
    found, rejects = read_model_info(Folder.at(tmp_path), "info.json")
    assert found[BED].category == "King-size Bed"
    assert found[STAND].style == ""
    assert sorted(r["reason"] for r in rejects) == ["bad_structure", "bad_structure", "duplicate"]


def test_asset_files_are_deterministic_and_load(tmp_path):
    first, second = tmp_path / "a", tmp_path / "b"
    rows = []
    for root in (first, second):
        making.write_library(root / "front")
        rows.append(read(root).assets)
    assert rows[0] == rows[1]
    for row in rows[0]:
        assert (first / "assets" / row["file"]).read_bytes() == (second / "assets" / row["file"]).read_bytes()
        assert load_asset(first / "assets" / row["file"]).category == row["category"]
        assert row["split"] == split_of(row["source_id"])


def test_splits_are_about_eighty_ten_ten():
    counts = {"train": 0, "val": 0, "test": 0}
    for k in range(4000):
        counts[split_of(f"house-{k}")] += 1
    assert counts["train"] == pytest.approx(3200, abs=100)
    assert counts["val"] == pytest.approx(400, abs=60)


def test_a_sofa_of_one_mesh_collides_as_its_seats_and_not_in_its_corner(tmp_path):
    """Real 3D-FUTURE sofas are often one connected surface."""
    outline = [(0, 0), (2.6, 0), (2.6, 0.9), (0.9, 0.9), (0.9, 1.6), (0, 1.6)]  # x, z of the file
    n = len(outline)
    text = "mtllib model.mtl\n" + "".join(f"v {x} {y} {z}\n" for y in (0, 0.42) for x, z in outline)
    text += "vt 0 0\nusemtl plain\n" + "".join(f"f {k + 1}/1 {(k + 1) % n + 1}/1 {(k + 1) % n + n + 1}/1 {k + n + 1}/1\n" for k in range(n))
    text += "".join("f " + " ".join(f"{k + 1 + up}/1" for k in face) + "\n" for up in (0, n) for face in ((0, 1, 2, 3), (0, 3, 4, 5)))
    made = model(tmp_path, text, ModelInfo(BED, "L-shaped Sofa", "Sofa", "Modern", "", "Cloth"))
    assert "hull_collider" not in {r["reason"] for r in made.rejects}
    colliders = [ConvexHull(m.vertices).equations for m in made.asset.links[0].colliders]
    at = np.array([[x, y, 0.2] for x in (-0.8, 0.8) for y in (0.6, -0.6)])  # the last is in the corner
    distances = np.min([distances_outside(at, planes) for planes in colliders], axis=0)
    assert (distances[:3] <= 0).all()
    assert distances[3] > 0.3
