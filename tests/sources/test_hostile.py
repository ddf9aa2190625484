"""Files made to harm or to confuse: refused with a typed reason, quickly, and nothing outside the folder is read."""

import gzip
import json
import os
import resource
import time

import pytest

from pipeline.sources import guarded
from pipeline.sources.guarded import Folder, parse_json
from pipeline.sources.reasons import SourceError
from tests.sources import making
from tests.sources.making import BED
from tests.sources.reading import read

GOOD = json.dumps(making.two_rooms())
HOUSES = {  # content of a house file -> reason
    "zero_bytes": (b"", "not_json"),
    "blank": (b" \n\t ", "not_json"),
    "truncated": (GOOD[: len(GOOD) // 2].encode(), "not_json"),
    "gzip": (gzip.compress(GOOD.encode()), "not_json"),
    "html": (b"<!DOCTYPE html><html><body>404</body></html>", "not_json"),
    "xml": (b"<?xml version='1.0'?><a/>", "not_json"),
    "binary": (bytes(range(256)) * 64, "not_json"),
    "utf16": (GOOD.encode("utf-16"), "not_json"),
    "latin1": (b'{"uid": "\xe9"}', "not_json"),
    "nan": (GOOD.replace("2.8", "NaN", 1).encode(), "not_json"),
    "infinity": (GOOD.replace("2.8", "-Infinity", 1).encode(), "not_json"),
    "deep_lists": (b"[" * 100_000, "not_json"),
    "deep_objects": (b'{"a":' * 100_000 + b"1" + b"}" * 100_000, "not_json"),
    "many_lists": (b"[" + b"[]," * 3_000_000 + b"[]]", "too_large"),
    "many_numbers": (b"[" + b"0," * 12_000_000 + b"0]", "too_large"),
    "long_integer": (b'{"uid": ' + b"9" * 100_000 + b"}", "not_json"),
    "list": (b"[1, 2]", "bad_structure"),
    "number": (b"7", "bad_structure"),
    "null": (b"null", "bad_structure"),
    "no_scene": (b'{"uid": "house-a"}', "bad_structure"),
    "scene_text": (b'{"scene": "x"}', "bad_structure"),
    "trailing": (GOOD.encode() + b"}", "not_json"),
    "two_documents": (GOOD.encode() + GOOD.encode(), "not_json"),
    "nul_bytes": (b"\x00" * 4096, "not_json"),
}


def crowded(**more):
    tree = making.two_rooms()
    tree |= {k: tree[k] + v for k, v in more.items() if k in tree}
    tree["scene"]["room"] += more.get("rooms", [])
    tree["scene"]["room"][0]["children"] += more.get("children", [])
    return json.dumps(tree).encode()


LONG_HOLE = making.slab("", "Window", (0, 1, 0), (1, 2, 0.1))
HOUSES |= {
    "many_rooms": (crowded(rooms=[{"type": "Bedroom", "instanceid": f"Bedroom-{k}"} for k in range(5000)]), "too_large"),
    "many_children": (crowded(children=[{"ref": "x", "instanceid": ""}] * 30_000), "too_large"),
    "many_holes": (crowded(mesh=[{**LONG_HOLE, "uid": f"h{k}"} for k in range(3000)]), "too_large"),
}

HEAD = '<robot name="r">'
BILLION = "".join(f'<!ENTITY l{k} "{f"&l{k - 1};" * 10}">' for k in range(1, 10))
URDFS = {  # content of a URDF -> reason
    "zero_bytes": ("", "not_urdf"),
    "truncated": (making.partnet_urdf((0, 0, 0))[:500], "not_urdf"),
    "html": ("<!DOCTYPE html><html></html>", "not_urdf"),
    "other_root": ("<sdf/>", "not_urdf"),
    "billion_laughs": (f'<!DOCTYPE r [<!ENTITY l0 "lol">{BILLION}]><robot>&l9;</robot>', "not_urdf"),
    "external_entity": ('<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><robot name="&x;"/>', "not_urdf"),
    "external_dtd": ('<!DOCTYPE r SYSTEM "http://localhost/x.dtd"><robot/>', "not_urdf"),
    "parameter_entity": ('<!DOCTYPE r [<!ENTITY % x SYSTEM "file:///etc/passwd"> %x;]><robot/>', "not_urdf"),
    "undefined_entity": ("<robot>&nothing;</robot>", "not_urdf"),
    "many_elements": (HEAD + "<link/>" * 200_000 + "</robot>", "too_large"),
    "deep_elements": ("<robot>" + "<a>" * 90_000, "not_urdf"),
    "no_geometry": ("<robot><link name='a'/></robot>", "no_base"),
    "nan_origin": (making.partnet_urdf((float("nan"), 0, 0)), "bad_number"),
    "absurd_limit": (making.partnet_urdf((0, 0, 0)).replace('upper="1.57"', 'upper="1e400"'), "bad_number"),
    "nan_axis": (making.partnet_urdf((0, 0, 0)).replace("0 -1 0", "nan 0 0"), "bad_number"),
    "loop": (making.partnet_urdf((0, 0, 0)).replace('<parent link="base"/>', '<parent link="link_0"/>'), "not_urdf"),
    "package": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "package://x/back.obj"), "unsafe_path"),
    "file_scheme": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "file:///etc/passwd"), "unsafe_path"),
    "http": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "http://localhost/x.obj"), "unsafe_path"),
    "absolute": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "/etc/passwd"), "unsafe_path"),
    "absolute_obj": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "/tmp/x.obj"), "unsafe_path"),
    "parent": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "../../secret.obj"), "unsafe_path"),
    "backslash_parent": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "..\\..\\secret.obj"), "unsafe_path"),
    "home": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "~/secret.obj"), "unsafe_path"),
    "long_path": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "a" * 5000 + ".obj"), "unsafe_path"),
    "huge_scale": (making.partnet_urdf((0, 0, 0)).replace('back.obj"', 'back.obj" scale="1e300 1 1"'), "bad_number"),
}

BOX = making.box_obj((1.8, 2.2, 1.1))
OBJS = {  # content of raw_model.obj -> reason
    "zero_bytes": (b"", "not_obj"),
    "truncated": (BOX[:100].encode(), "not_obj"),
    "gzip": (gzip.compress(BOX.encode()), "not_obj"),
    "html": (b"<html></html>", "not_obj"),
    "nan": (BOX.replace("0.900000", "nan", 1).encode(), "bad_number"),
    "1e400": (BOX.replace("0.900000", "1e400", 1).encode(), "bad_number"),
    "index_beyond": (BOX.encode() + b"f 1 2 99999999\n", "not_obj"),
    "index_zero": (BOX.encode() + b"f 0 1 2\n", "not_obj"),
    "index_huge": (BOX.encode() + b"f 1 2 " + b"9" * 400 + b"\n", "not_obj"),
    "many_vertices": (b"v 0 0 0\n" * 1_500_000 + b"f 1 2 3\n", "too_large"),
    "many_groups": (BOX.encode() + b"".join(b"g %d\nf 1 2 3\n" % k for k in range(5000)), "too_large"),
    "one_long_face": (BOX.encode() + b"f" + b" 1" * 4_000_000 + b"\n", "too_large"),
    "binary": (bytes(range(256)) * 64, "not_obj"),
    "library_outside": (BOX.replace("model.mtl", "../../../etc/passwd").encode(), "unsafe_path"),
    "library_absolute": (BOX.replace("model.mtl", "/etc/passwd").encode(), "unsafe_path"),
}


@pytest.fixture
def secret(tmp_path):
    """A file outside every source folder, which nothing may open."""
    path = tmp_path / "secret.obj"
    path.write_text(BOX)
    os.utime(path, (0, 0))
    return path


def timed(read_all):
    before, start = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
    made = read_all()
    assert time.process_time() - start < 2.0
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 256 * 1024
    return made


@pytest.mark.parametrize("name", sorted(HOUSES))
def test_house(name, tmp_path, secret):
    data, reason = HOUSES[name]
    making.write_library(tmp_path / "front", (BED,))
    (tmp_path / "front" / "3D-FRONT").mkdir()
    (tmp_path / "front" / "3D-FRONT" / "house-a.json").write_bytes(data)
    made = timed(lambda: read(tmp_path))
    assert [(r["what"], r["where"], r["reason"]) for r in made.rejects] == [("house", "house-a", reason)]
    assert made.scenes == []


@pytest.mark.parametrize("name", sorted(URDFS))
def test_urdf(name, tmp_path, secret):
    text, reason = URDFS[name]
    making.write_partnet(tmp_path / "partnet", urdf=text or " ")
    made = timed(lambda: read(tmp_path))
    assert [(r["what"], r["where"], r["reason"]) for r in made.rejects] == [("model", "40000", reason)]
    assert made.assets == []


@pytest.mark.parametrize("name", sorted(OBJS))
def test_model(name, tmp_path, secret):
    data, reason = OBJS[name]
    making.write_library(tmp_path / "front", (BED,))
    (tmp_path / "front" / "3D-FUTURE-model" / BED / "raw_model.obj").write_bytes(data)
    made = timed(lambda: read(tmp_path))
    assert [(r["where"], r["reason"]) for r in made.rejects] == [(BED, reason)]
    assert made.assets == []


@pytest.mark.parametrize("link", ["file", "folder", "loop", "house"])
def test_links_out_of_the_folder(link, tmp_path, secret):
    making.write_library(tmp_path / "front", (BED,))
    model = tmp_path / "front" / "3D-FUTURE-model" / BED
    if link == "house":
        (tmp_path / "front" / "3D-FRONT").mkdir()
        (tmp_path / "front" / "3D-FRONT" / "house-a.json").symlink_to(secret)
    elif link == "folder":
        model.rename(tmp_path / "elsewhere")
        model.symlink_to(tmp_path / "elsewhere")
    else:
        (model / "raw_model.obj").unlink()
        (model / "raw_model.obj").symlink_to(secret if link == "file" else model / "raw_model.obj")
    made = timed(lambda: read(tmp_path))
    assert [r["reason"] for r in made.rejects] == ["unsafe_path"]


def test_a_pipe_does_not_hang(tmp_path):
    making.write_library(tmp_path / "front", (BED,))
    path = tmp_path / "front" / "3D-FUTURE-model" / BED / "raw_model.obj"
    path.unlink()
    os.mkfifo(path)
    assert timed(lambda: read(tmp_path)).reasons == {"missing_file"}


def test_a_file_beyond_the_limit_is_not_read(tmp_path, monkeypatch):
    path = tmp_path / "large.json"
    path.write_bytes(b"[")
    os.truncate(path, guarded.MAX_JSON + 1)  # sparse: no disk is used
    with pytest.raises(SourceError) as caught:
        Folder.at(tmp_path).read("large.json", guarded.MAX_JSON)
    assert caught.value.code == "too_large"


def test_a_floor_of_absurdly_many_triangles_costs_its_room_only(tmp_path):
    making.write_library(tmp_path / "front")
    spread = making.floor("f9", 10, 0, 14, 4)
    spread = {**spread, "xyz": spread["xyz"] * 12_000, "faces": list(range(72_000))}
    tree = making.two_rooms(more_meshes=[spread])
    tree["scene"]["room"].append({"type": "Bedroom", "instanceid": "Bedroom-9", "children": [making.child("f9", "mesh/9")]})
    making.write_house(tmp_path / "front", tree)
    made = timed(lambda: read(tmp_path))
    assert [(r["what"], r["where"], r["reason"]) for r in made.rejects] == [("room", "house-a/Bedroom-9", "too_large")]
    assert len(made.rooms) == 2


def test_an_image_that_unfolds_is_not_unfolded(tmp_path):
    import struct
    import zlib

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    bomb = (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", 60_000, 60_000, 8, 2, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(b"\0" * 99))
    )
    making.write_library(tmp_path / "front", (BED,))
    (tmp_path / "front" / "3D-FUTURE-model" / BED / "texture.png").write_bytes(bomb)
    made = timed(lambda: read(tmp_path))
    assert made.reasons == {"missing_texture"}
    assert len(made.assets) == 1


def test_of_duplicate_keys_the_last_wins():
    assert parse_json(b'{"a": 1, "a": 2}', "x") == {"a": 2}


def test_one_broken_house_does_not_stop_the_others(tmp_path):
    making.write_library(tmp_path / "front")
    for name in ("house-a", "house-b"):
        making.write_house(tmp_path / "front", making.two_rooms(name))
    (tmp_path / "front" / "3D-FRONT" / "house-aa.json").write_text("{")
    made = read(tmp_path)
    assert [s["scene_id"] for s in made.scenes] == ["h_house_a", "h_house_b"]
    assert made.reasons == {"not_json"}
