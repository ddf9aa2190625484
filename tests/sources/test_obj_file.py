import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pipeline.sources.meshes.obj_file import linear, parse_mtl, parse_obj
from pipeline.sources.reasons import SourceError
from tests.sources.making import box_obj

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"


def area(file):
    total = 0.0
    for g in file.groups:
        a, b, c = (file.vertices[g.faces[:, k]] for k in range(3))
        total += float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)
    return total


@pytest.mark.parametrize(
    "faces",
    [
        "f 1 2 3 4",
        "f  1 2  3 4",
        "f 1/1 2/2 3/3 4/4",
        "f 1//1 2//1 3//1 4//1",
        "f 1/1/1 2/2/1 3/3/1 4/4/1",
        "f -4 -3 -2 -1",
        "f -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1",
        "f -4//-1 -3//-1 -2//-1 -1//-1",
        "f 1 2 3\nf 1 3 4",
        "f 1/1/1 2/2/1 3/3/1\nf 1//1 3//1 4//1",
        "f 1 2 \\\n3 4",
        "f 1 2 3 4\r",
        "f\t1 2 3 4",
    ],
)
def test_forms_of_faces(faces):
    file = parse_obj((SQUARE + faces + "\n").encode(), "x")
    assert area(file) == pytest.approx(1)
    assert sum(len(g.faces) for g in file.groups) == 2


def test_uv_follow_the_vertices():
    file = parse_obj((SQUARE + "f 1/1/1 2/2/1 3/3/1 4/4/1\n").encode(), "x")
    (group,) = file.groups
    assert np.allclose(file.uvs[group.uv_faces], file.vertices[group.faces][..., :2])


def test_groups_and_materials():
    text = SQUARE + "mtllib a b.mtl\no one\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\ng two\nf 2 3 4\nusemtl red\no one\nf 2 4 1\n"
    file = parse_obj(text.encode(), "x")
    assert [(g.name, g.material, len(g.faces)) for g in file.groups] == [("one", "red", 2), ("one", "blue", 1), ("two", "blue", 1)]
    assert file.library == "a b.mtl"


def test_vertex_colours_and_w_are_passed_over():
    file = parse_obj(b"v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n", "x")
    assert file.vertices.shape == (3, 3)


@given(st.integers(3, 9), st.integers(0, 3))
def test_polygons_become_fans(corners, more):
    turn = np.arange(corners) * 2 * np.pi / corners
    text = "".join(f"v {np.cos(t):.9f} {np.sin(t):.9f} 0\n" for t in turn)
    text += "f " + " ".join(map(str, range(1, corners + 1))) + "\n" + "f 1 2 3\n" * more
    file = parse_obj(text.encode(), "x")
    assert len(file.groups[0].faces) == corners - 2 + more


@pytest.mark.parametrize("quads", [True, False])
def test_box(quads):
    assert area(parse_obj(box_obj((1, 2, 3), quads=quads).encode(), "x")) == pytest.approx(22)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("", "not_obj"),
        ("# nothing\n", "not_obj"),
        ("v 0 0\nf 1 1 1\n", "not_obj"),
        ("v 0 0 zero\nf 1 1 1\n", "not_obj"),
        ("v 0 0 0\n", "not_obj"),
        ("v 0 0 0\nf 1 2 3\n", "not_obj"),
        ("v 0 0 0\nf 0 0 0\n", "not_obj"),
        ("v 0 0 0\nf -2 -2 -2\n", "not_obj"),
        ("v 0 0 0\nf a b c\n", "not_obj"),
        ("v 0 0 0\nf 1/ 1/ 1/\n", "not_obj"),
        ("v 0 0 0\nf 1/1 1/1 1/1\n", "not_obj"),
        ("v 0 0 0\nf 1 1 99999999999999999999999\n", "not_obj"),
        ("v nan 0 0\nf 1 1 1\n", "bad_number"),
        ("v 1e400 0 0\nf 1 1 1\n", "bad_number"),
        ("v 1e30 0 0\nv 0 0 0\nv 1 1 1\nf 1 2 3\n", "bad_number"),
        ("<!DOCTYPE html>", "not_obj"),
        ("\x1f\x8b\x08\x00", "not_obj"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt\nf 1 2 3\n", "not_obj"),
    ],
)
def test_refused(text, code):
    with pytest.raises(SourceError) as caught:
        parse_obj(text.encode("latin-1"), "x.obj")
    assert caught.value.code == code


def test_mtl():
    text = b"newmtl a\nKd 0.1 0.2 2\nmap_Kd -s 1 1 1 my tex.png\nd 0.5\nKe 1 1 1\nNs nan\nnewmtl b\nKd x\nTr 0.25\nmap_Kd\n"
    found = parse_mtl(text)
    assert found["a"].color == linear((0.1, 0.2, 1.0))
    assert found["a"].map == "my tex.png"
    assert (found["a"].opacity, found["b"].opacity) == (0.5, 0.75)
    assert found["b"].map == ""


@pytest.mark.parametrize(
    "text", ["  " + SQUARE.replace("\n", "\n  ") + "f 1 2 3 4\n", SQUARE + "f 1 2 3 4 # a quad\n", SQUARE + "F 1 2 3 4\n"]
)
def test_indented_and_commented_lines(text):
    """Written by hand or by careless exporters; an upper-case F is no face of the format."""
    if "\nF " in text:
        with pytest.raises(SourceError):
            parse_obj(text.encode(), "x")
    else:
        assert area(parse_obj(text.encode(), "x")) == pytest.approx(1)


def test_negative_indices_count_from_where_they_stand():
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 0 5\nv 1 0 5\nv 1 1 5\nf -3 -2 -1\n"
    file = parse_obj(text.encode(), "x")
    assert sorted(file.vertices[file.groups[0].faces][:, :, 2].ravel().tolist()) == [0, 0, 0, 5, 5, 5]
