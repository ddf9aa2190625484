"""Files made to harm or to confuse: refused with a typed reason, in 2 s and 256 MiB, and nothing outside the folder is touched.

Every file is read in a process of its own (`sandbox`) that measures itself and lists what it opened.
"""

import json
import os
import sys
from pathlib import Path

import pytest

from pipeline.sources import guarded
from pipeline.sources.guarded import Folder, parse_json
from pipeline.sources.reasons import REASONS, SourceError
from tests.sources import hostile_contents as contents
from tests.sources import making, sandbox
from tests.sources.making import BED
from tests.sources.sandbox import Sandbox

ROOT = Path(__file__).parents[2]
CODE = (
    *(os.path.realpath(p) for p in (ROOT, sys.prefix, sys.base_prefix)),
    "/usr",
    "/lib",
    "/proc",
    "/sys/devices",
    "/dev/null",
)  # programs


@pytest.fixture(scope="module")
def box():
    made = Sandbox()
    yield made
    made.close()


@pytest.fixture
def hostile(box, tmp_path):
    """Return a function that reads tmp_path in the sandbox, holds it to the limits, and returns what came of it."""
    root = tmp_path / "root"
    (tmp_path / "secret.obj").write_text(contents.BOX)
    (tmp_path / "secret.png").write_bytes(making.png())
    root.mkdir()

    def read(**options):
        before = listing(tmp_path)
        made = box.read(root, **options)
        assert "died" not in made, made
        assert made["cpu"] < sandbox.SECONDS
        assert made["memory"] < sandbox.MEMORY
        assert listing(tmp_path) == before
        for path, mode in made["opened"]:
            real = os.path.realpath(path)
            if set(mode) & set("wax+"):
                assert real.startswith((f"{root}/assets", f"{root}/cache", "/dev/null")), (path, mode)
            else:
                assert real.startswith((str(root), *CODE)), path
        reasons = {r["reason"] for r in made["rejects"]}
        assert reasons <= set(REASONS) - {"internal"}, made["rejects"]
        assert all(r["detail"].isprintable() for r in made["rejects"])
        return made, reasons

    return root, read


def listing(tmp_path):
    """Return all files below, but for those that reading is there to write."""
    found = []
    for base, folders, files in os.walk(tmp_path):
        if Path(base) == tmp_path / "root":
            folders[:] = [f for f in folders if f not in {"assets", "cache"}]
        found += [(str(Path(base, f)), Path(base, f).lstat().st_size) for f in files]
    return sorted(found)


def model(root):
    """Write a library of one model; return its folder."""
    making.write_library(root / "front", (BED,))
    return root / "front" / "3D-FUTURE-model" / BED


def house(root, data, name="house-a"):
    making.write_library(root / "front", (BED,))
    (root / "front" / "3D-FRONT").mkdir()
    (root / "front" / "3D-FRONT" / f"{name}.json").write_bytes(data)


@pytest.mark.parametrize("name", sorted(contents.HOUSES))
def test_house(name, hostile):
    root, read = hostile
    data, reason = contents.HOUSES[name]
    house(root, data)
    made, reasons = read()
    assert reasons == {reason}
    assert [r["where"] for r in made["rejects"]] == ["house-a"]
    assert made["scenes"] == 0


@pytest.mark.parametrize("name", sorted(contents.URDFS))
@pytest.mark.parametrize("alone", [False, True])
def test_urdf(name, alone, hostile):
    """In an object's folder, and by itself."""
    root, read = hostile
    text, reason = contents.URDFS[name]
    folder = making.write_partnet(root / "partnet", urdf=text or " ")
    if alone:
        (folder / "meta.json").unlink()
        (folder / "mobility_annotation_gapartnet.urdf").rename(folder / "cabinet.urdf")
    made, reasons = read()
    assert reasons == {reason}
    assert [(r["what"], r["where"]) for r in made["rejects"]] == [("model", "cabinet" if alone else "40000")]
    assert made["assets"] == 0


@pytest.mark.parametrize("name", sorted(contents.OBJS))
def test_model(name, hostile):
    """A model that was cut off may be read as far as it goes, never beyond."""
    root, read = hostile
    data, reason = contents.OBJS[name]
    (model(root) / "raw_model.obj").write_bytes(data)
    made, reasons = read()
    if reason:
        assert reasons == {reason}
        assert made["assets"] == 0
    else:
        assert read(limits={"cut": "none"})[1]  # cut, what lacks a side is the sides that it has
        assert reasons <= {"not_obj", "hull_collider", "missing_texture", "bad_size"}


@pytest.mark.parametrize("name", sorted(contents.MTLS))
def test_materials(name, hostile):
    root, read = hostile
    data, reason = contents.MTLS[name]
    (model(root) / "model.mtl").write_bytes(data)
    made, reasons = read()
    assert reasons == {reason} if reason else reasons <= {"missing_texture", "unsafe_path"}
    assert made["assets"] == (0 if "unsafe_path" in reasons else 1)


@pytest.mark.parametrize("name", sorted(contents.TEXTURES))
def test_texture(name, hostile):
    root, read = hostile
    (model(root) / "texture.png").write_bytes(contents.TEXTURES[name])
    made, reasons = read()
    assert reasons == {"missing_texture"} or name == "truncated_at_90_percent"  # all of the image, not all of the file
    assert made["assets"] == 1


@pytest.mark.parametrize("name", sorted(contents.DAES))
def test_collada(name, hostile):
    root, read = hostile
    data, reason = contents.DAES[name]
    (root / "partnet").mkdir()
    (root / "partnet" / "body.dae").write_bytes(data)
    text = '<robot name="r"><link name="a"><visual><geometry><mesh filename="body.dae"/></geometry></visual></link></robot>'
    (root / "partnet" / "cabinet.urdf").write_text(text)
    made, reasons = read()
    assert reasons == {reason}
    assert made["assets"] == 0


@pytest.mark.parametrize("name", sorted(contents.STLS))
def test_collision_mesh(name, hostile):
    root, read = hostile
    data, reason = contents.STLS[name]
    urdf = contents.URDF.replace('<collision name="door-1"', '<collision name="x"', 1)
    head, tail = urdf.split('<collision name="x"')
    folder = making.write_partnet(root / "partnet", urdf=head + '<collision name="x"' + tail.replace("door.obj", "door.obj.convex.stl", 1))
    (folder / "textured_objs" / "door.obj.convex.stl").write_bytes(data)
    made, reasons = read()
    assert reasons == {reason}
    assert made["assets"] == 0


@pytest.mark.parametrize("file", ["meta.json", "link_annotation_gapartnet.json", "mobility_v2.json"])
@pytest.mark.parametrize("name", sorted(contents.NO_JSON))
def test_json_of_an_object(name, file, hostile):
    root, read = hostile
    data, reason = contents.NO_JSON[name]
    folder = making.write_partnet(root / "partnet", gapartnet=file == "link_annotation_gapartnet.json")
    (folder / file).write_bytes(data)
    made, reasons = read()
    assert reasons == {reason}
    assert made["assets"] == 0


@pytest.mark.parametrize("name", sorted(contents.NO_JSON))
def test_the_list_of_models(name, hostile):
    root, read = hostile
    data, reason = contents.NO_JSON[name]
    (model(root).parent / "model_info.json").write_bytes(data)
    assert read()[1] == {reason}


@pytest.mark.parametrize(
    "data", [b"\x00" * 100_000, b"a b\n" * 200_000, bytes(range(256)) * 100, b"x" * 900_000, "link_0 hinge door\n".encode("utf-16")]
)
@pytest.mark.parametrize("file", ["semantics.txt", "semantics_gapartnet.txt", "../categories.csv"])
def test_words_that_are_none(data, file, hostile):
    """Words help; nonsense does not hurt."""
    root, read = hostile
    folder = making.write_partnet(root / "partnet", gapartnet=False)
    (folder / file).write_bytes(data)
    made, reasons = read()
    assert reasons == set()
    assert made["assets"] >= 1


@pytest.mark.parametrize("name", contents.NAMES)
def test_names_that_are_no_ids(name, hostile):
    """Of houses, rooms, joints, links, materials and groups: read under an id of their own, or refused."""
    root, read = hostile
    model(root)
    making.write_house(root / "front", {**making.two_rooms(), "uid": name}, "house-a")
    text = contents.BOX.replace("plain", name.replace("\n", " ") or "x").replace("solid_001", name.replace("\n", " ") or "x")
    (root / "front" / "3D-FUTURE-model" / BED / "raw_model.obj").write_text(text)
    plain = name.replace("&", "").replace('"', "&quot;").replace("\x00", "&#0;").replace("\n", "&#10;")
    making.write_partnet(root / "partnet", urdf=contents.URDF.replace("link_0", plain).replace("joint_0", plain))
    (root / "partnet" / "40000" / "meta.json").write_text(json.dumps({"model_cat": "StorageFurniture", "anno_id": name, "model_id": name}))
    made, reasons = read()
    assert reasons <= {
        "uid_mismatch",
        "missing_model",
        "not_urdf",
        "missing_texture",
        "not_obj",
        "dangling_ref",
        "no_objects",
        "built_in",
        "unknown_category",
    }
    assert made["scenes"] <= 1


@pytest.mark.parametrize("name", ["a\nb", 'a"b', "a b", "a'b", "\u202eb", "a" * 200, "$(x)", "-rf", "\U0001f600", "..."])
def test_files_of_any_name(name, hostile):
    root, read = hostile
    making.write_library(root / "front", (BED,))
    making.write_house(root / "front", making.two_rooms(), name)
    making.write_partnet(root / "partnet", name)
    made, reasons = read()
    if "\n" in name:  # no path of ours
        assert "unsafe_path" in reasons
        return
    assert reasons <= {"uid_mismatch", "missing_model", "built_in", "unknown_category"}
    assert made["scenes"] == 1
    assert made["assets"] >= 2


@pytest.mark.parametrize("link", ["file", "folder", "loop", "house", "mtl", "texture", "urdf", "object", "mesh", "meshes", "meta", "zero"])
def test_links_out_of_the_folder(link, hostile):
    root, read = hostile
    outside = root.parent / "secret.obj"
    if link in {"file", "folder", "loop", "house", "mtl", "texture", "zero"}:
        folder = model(root)
        target = {
            "file": "raw_model.obj",
            "loop": "raw_model.obj",
            "zero": "raw_model.obj",
            "mtl": "model.mtl",
            "texture": "texture.png",
        }.get(link)
        if link == "house":
            (root / "front" / "3D-FRONT").mkdir()
            path = root / "front" / "3D-FRONT" / "house-a.json"
        else:
            path = folder / target if target else folder
    else:
        folder = making.write_partnet(root / "partnet")
        names = {
            "urdf": "mobility_annotation_gapartnet.urdf",
            "mesh": "textured_objs/back.obj",
            "meshes": "textured_objs",
            "meta": "meta.json",
        }
        path = folder / names[link] if link in names else folder
    if path.is_dir():
        path.rename(root.parent / "elsewhere")
        outside = root.parent / "elsewhere"
    elif path.exists():
        path.unlink()
    path.symlink_to({"loop": path, "zero": Path("/dev/zero")}.get(link, outside))
    assert read()[1] == {"unsafe_path"}


@pytest.mark.parametrize(
    "file", ["house", "raw_model.obj", "model.mtl", "texture.png", "model_info.json", "urdf", "meta.json", "mesh", "semantics.txt"]
)
def test_a_pipe_does_not_hang(file, hostile):
    root, read = hostile
    folder, body = model(root), making.write_partnet(root / "partnet")
    (root / "front" / "3D-FRONT").mkdir()
    path = {
        "house": root / "front" / "3D-FRONT" / "house-a.json",
        "model_info.json": folder.parent / file,
        "urdf": body / "mobility_annotation_gapartnet.urdf",
        "meta.json": body / file,
        "semantics.txt": body / file,
        "mesh": body / "textured_objs" / "door.obj",
    }.get(file, folder / file)
    path.unlink(missing_ok=True)
    os.mkfifo(path)
    reasons = read()[1]
    assert reasons <= {"missing_file", "missing_texture", "missing_mesh", "unknown_category"}
    assert reasons or file in {"meta.json", "semantics.txt"}  # there are others that tell


def test_a_file_beyond_the_limit_is_not_read(tmp_path):
    path = tmp_path / "large.json"
    path.write_bytes(b"[")
    os.truncate(path, guarded.MAX_JSON + 1)  # sparse: no disk is used
    with pytest.raises(SourceError) as caught:
        Folder.at(tmp_path).read("large.json", guarded.MAX_JSON)
    assert caught.value.code == "too_large"


@pytest.mark.parametrize("file", ["raw_model.obj", "model.mtl", "texture.png"])
def test_a_sparse_file_of_a_gigabyte(file, hostile):
    root, read = hostile
    os.truncate(model(root) / file, 1 << 30)
    assert read()[1] <= {"too_large", "missing_texture"}


def test_meshes_that_are_named_again_and_again(hostile):
    """A small file is a large object when it is drawn a thousand times."""
    root, read = hostile
    mesh = making.element("visual", "back")
    folder = making.write_partnet(root / "partnet", urdf=contents.URDF.replace(mesh, mesh * 4000, 1))
    grid = "".join(f"v {k % 50} {k // 50} 0\n" for k in range(2500))
    grid += "".join(f"f {k + 1} {k + 2} {k + 52}\n" for k in range(2400))
    (folder / "textured_objs" / "back.obj").write_text(grid)
    made, reasons = read()
    assert reasons == {"too_large"}
    assert made["assets"] == 0


def test_a_floor_of_absurdly_many_triangles_costs_its_room_only(hostile):
    root, read = hostile
    making.write_library(root / "front")
    spread = making.floor("f9", 10, 0, 14, 4)
    spread = {**spread, "xyz": spread["xyz"] * 12_000, "faces": list(range(72_000))}
    tree = making.two_rooms(more_meshes=[spread])
    tree["scene"]["room"].append({"type": "Bedroom", "instanceid": "Bedroom-9", "children": [making.child("f9", "mesh/9")]})
    making.write_house(root / "front", tree)
    made, _ = read()
    assert [(r["what"], r["where"], r["reason"]) for r in made["rejects"]] == [("room", "house-a/Bedroom-9", "too_large")]


def test_of_duplicate_keys_the_last_wins():
    assert parse_json(b'{"a": 1, "a": 2}', "x") == {"a": 2}


def test_one_broken_file_does_not_stop_the_others(hostile):
    root, read = hostile
    making.write_library(root / "front")
    for name in ("house-a", "house-b"):
        making.write_house(root / "front", making.two_rooms(name))
    (root / "front" / "3D-FRONT" / "house-aa.json").write_text("{")
    for number in ("1", "2", "3"):
        making.write_partnet(root / "partnet", number)
    (root / "partnet" / "2" / "mobility_annotation_gapartnet.urdf").write_text("<robot")
    made, reasons = read()
    assert made["scenes"] == 2
    assert made["assets"] >= 7
    assert reasons == {"not_json", "not_urdf"}


def test_the_limits_catch_what_they_should(box, tmp_path, monkeypatch):
    """The sandbox notices memory: reading without the limit on values costs more than is allowed."""
    (tmp_path / "root").mkdir()
    house(tmp_path / "root", b"[" + b"[]," * 290_000 + b"[]]")
    made = box.read(tmp_path / "root")
    assert made["memory"] > 10 * sandbox.MIB
    assert any(path.endswith("house-a.json") for path, _ in made["opened"])
