import json
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.corpus.future_writer import info, write_future

CHOSEN = ("double_bed", "dining_chair", "wardrobe", "pendant_lamp", "plant", "sink_cabinet", "l_shaped_sofa")
STYLES = {
    "Modern", "Chinoiserie", "Kids", "European", "Japanese", "Southeast Asia", "Industrial", "American Country", "Vintage/Retro",
    "Light Luxury", "Mediterranean", "Korean", "New Chinese", "Nordic", "European Classic", "Others", "Ming Qing", "Neoclassical",
    "Minimalist",
}  # fmt: skip
MATERIALS = {
    "Cloth", "Leather", "Glass", "Metal", "Solid Wood", "Stone", "Plywood", "Others", "Suede", "Bamboo Rattan", "Rough Cloth", "Wood",
    "Composite Board", "Marble", "Smooth Leather",
}  # fmt: skip
SUPERS = {"Cabinet/Shelf/Desk", "Bed", "Chair", "Table", "Sofa", "Pier/Stool", "Lighting", "Others"}


@pytest.fixture(scope="module")
def chosen():
    models = catalogue(0).future
    return tuple(next(m for m in models if m.category == c) for c in CHOSEN)


@pytest.fixture(scope="module")
def folder(chosen, tmp_path_factory):
    root = tmp_path_factory.mktemp("future") / "3D-FUTURE-model"
    write_future(chosen, root)
    return root


def read(path):
    """Positions, uvs, faces as lists of (v, vt, vn), group names, material names and library of an OBJ."""
    v, vt, faces, groups, materials, library = [], [], [], [], [], None
    for line in path.read_text().splitlines():
        key, _, rest = line.partition(" ")
        if key == "v":
            v.append([float(x) for x in rest.split()])
        elif key == "vt":
            vt.append([float(x) for x in rest.split()])
        elif key == "f":
            faces.append([[int(i) for i in corner.split("/")] for corner in rest.split()])
        elif key == "g":
            groups.append(rest)
        elif key == "usemtl":
            materials.append(rest)
        elif key == "mtllib":
            library = rest
    return np.array(v), np.array(vt), faces, groups, materials, library


def test_model_info_is_a_list_of_records(chosen, folder):
    records = json.loads((folder / "model_info.json").read_text())
    assert [r["model_id"] for r in records] == [m.model_id for m in chosen]
    assert all(set(r) == {"model_id", "super-category", "category", "style", "theme", "material"} for r in records)


def test_vocabularies_of_all_models():
    for model in catalogue(0).future:
        record = info(model)
        assert record["super-category"] in SUPERS
        assert record["style"] in STYLES
        assert record["material"] in MATERIALS


def test_folder_holds_what_the_real_one_holds(chosen, folder):
    for model in chosen:
        names = {p.name for p in (folder / model.model_id).iterdir()}
        assert names == {"raw_model.obj", "normalized_model.obj", "model.mtl", "texture.png"}


def test_raw_model_is_metric_y_up_and_stands_on_the_origin(chosen, folder):
    for model in chosen:
        v, *_ = read(folder / model.model_id / "raw_model.obj")
        w, d, h = model.size
        assert np.allclose(np.ptp(v, axis=0), (w, h, d), atol=5e-5)
        assert np.allclose([v[:, 0].max() + v[:, 0].min(), v[:, 1].min(), v[:, 2].max() + v[:, 2].min()], 0, atol=5e-5)


def test_the_front_looks_along_plus_z(chosen, folder):
    """A bed's headboard, its highest part, is at the back."""
    bed = next(m for m in chosen if m.category == "double_bed")
    v, *_ = read(folder / bed.model_id / "raw_model.obj")
    assert v[v[:, 1] > 0.9 * bed.size[2], 2].max() < 0


def test_faces_mix_triangles_and_quads_and_use_one_texture(chosen, folder):
    for model in chosen:
        v, vt, faces, groups, materials, library = read(folder / model.model_id / "raw_model.obj")
        assert {len(f) for f in faces} == {3, 4}
        index = np.array([corner for f in faces for corner in f])
        assert index.min() == 1
        assert index[:, 0].max() <= len(v)
        assert index[:, 1].max() <= len(vt)
        assert (vt >= 0).all()
        assert (vt <= 1).all()
        assert library == "model.mtl"
        assert groups == [f"solid_{k + 1:03d}" for k in range(len(groups))]
        text = (folder / model.model_id / "model.mtl").read_text()
        assert all(f"newmtl {name}\n" in text for name in materials)
        assert {line.split()[1] for line in text.splitlines() if line.startswith("map_Kd")} == {"./texture.png"}


def test_faces_look_outwards(chosen, folder):
    for model in chosen:
        v, _, faces, *_ = read(folder / model.model_id / "raw_model.obj")
        volume = 0.0
        for face in faces:
            p = v[[c[0] - 1 for c in face]]
            volume += sum(np.dot(p[0], np.cross(p[i], p[i + 1])) for i in range(1, len(p) - 1)) / 6
        assert volume > 0


def test_normalized_model_is_the_centred_scaled_copy(chosen, folder):
    for model in chosen:
        raw, *_ = read(folder / model.model_id / "raw_model.obj")
        unit, *_ = read(folder / model.model_id / "normalized_model.obj")
        assert np.allclose(np.ptp(unit, axis=0).max(), 1, atol=1e-4)
        assert np.allclose(unit.max(axis=0) + unit.min(axis=0), 0, atol=1e-4)
        assert np.allclose(np.ptp(unit, axis=0) * max(model.size), np.ptp(raw, axis=0), atol=1e-3)


def test_texture_is_a_small_png_with_the_materials_colours(chosen, folder):
    for model in chosen:
        data = (folder / model.model_id / "texture.png").read_bytes()
        assert data[:8] == b"\x89PNG\r\n\x1a\n"
        assert len(data) < 40_000
        image = np.asarray(Image.open(BytesIO(data)).convert("RGB"))
        first = next(line for line in (folder / model.model_id / "model.mtl").read_text().splitlines() if line.startswith("Kd"))
        tile = image[-5:-2, 2:5].reshape(-1, 3).mean(axis=0) / 255  # inside the lower left field
        assert np.allclose(tile, [float(x) for x in first.split()[1:]], atol=0.12)


def test_same_bytes_again_and_other_bytes_of_another_seed(chosen, folder, tmp_path):
    write_future(chosen, tmp_path)
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        assert (tmp_path / path.relative_to(folder)).read_bytes() == path.read_bytes()
    other = next(m for m in catalogue(1).future if m.category == "wardrobe")
    write_future([other], tmp_path / "other")
    mine = next(m for m in chosen if m.category == "wardrobe")
    assert (tmp_path / "other" / other.model_id / "raw_model.obj").read_bytes() != (folder / mine.model_id / "raw_model.obj").read_bytes()
