"""Programs that share no code with us take the exported files: MuJoCo steps them, yourdfpy, SAPIEN and trimesh load them, Khronos's validator reads them."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import sfgen
from pipeline.export import ExportFolder, export_home
from tests.export.readings import steps


@pytest.fixture(scope="module")
def export(furnished, tmp_path_factory):
    home = sfgen.load(furnished)[0]
    place = tmp_path_factory.mktemp("engines")
    return lambda form: export_home(ExportFolder(place / form, form, "d", "CC0-1.0"), home.usd, home.scene_id)


def test_mujoco_steps_a_home_and_nothing_moves(export):
    pytest.importorskip("mujoco")
    _, turned, moved = steps(export("mjcf"), 1.0)
    assert turned < 0.005
    assert moved < 0.005


KHRONOS = """
const fs = require("fs"), path = require("path"), [folder, file] = process.argv.slice(1);
const validator = require(path.join(folder, "node_modules", "gltf-validator"));
validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {maxIssues: 0}).then(said => console.log(JSON.stringify(said)));
"""


def khronos(path):
    """Return what the Khronos glTF validator reports of a file; skips where it is not to be had."""
    folder = os.environ.get("SFGEN_GLTF_VALIDATOR", "")
    if not shutil.which("node") or not Path(folder, "node_modules", "gltf-validator").is_dir():
        pytest.skip("SFGEN_GLTF_VALIDATOR names no folder in which `npm install gltf-validator@2.0.0-dev.3.10` ran, or there is no node")
    done = subprocess.run(["node", "-e", KHRONOS, str(Path(folder).resolve()), str(path)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_khronos_finds_no_error_and_no_warning_in_a_glb(export):
    said = khronos(export("glb"))
    assert said["info"]["totalTriangleCount"] > 1000  # it has read the home
    issues = said["issues"]
    assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues["messages"]


def test_khronos_finds_what_is_wrong(export, tmp_path):
    """A home whose first triangle points beyond its vertices."""
    data = bytearray(export("glb").read_bytes())
    length = int.from_bytes(data[12:16], "little")
    document = json.loads(data[20 : 20 + length])
    accessor = document["accessors"][document["meshes"][0]["primitives"][0]["indices"]]
    start = 28 + length + document["bufferViews"][accessor["bufferView"]]["byteOffset"]
    data[start : start + 4] = (10**6).to_bytes(4, "little")
    (tmp_path / "broken.glb").write_bytes(data)
    issues = khronos(tmp_path / "broken.glb")["issues"]
    assert issues["numErrors"] > 0
    assert "ACCESSOR_INDEX_OOB" in {message["code"] for message in issues["messages"]}


DECODED = """
import json, sys
import mujoco, mujoco._usd
import numpy as np
found = []
for path in sys.argv[1:]:
    model = mujoco.MjSpec.from_file(path).compile()
    joints = [j for j in range(model.njnt) if model.jnt_type[j] != mujoco.mjtJoint.mjJNT_FREE]
    dofs = model.jnt_dofadr[joints]
    values = [model.dof_damping[dofs], model.dof_frictionloss[dofs], model.dof_armature[dofs], model.jnt_stiffness[joints, 0]
              if model.jnt_stiffness.ndim > 1 else model.jnt_stiffness[joints], model.qpos_spring[model.jnt_qposadr[joints]],
              *model.jnt_solref[joints].T, *model.jnt_solimp[joints].T, *model.jnt_range[joints].T]
    bodies = [model.body(model.jnt_bodyid[j]).name.removeprefix("/World/Objects/").removeprefix("/World/Doors/") for j in joints]
    frictions = sorted(model.geom_friction[model.geom_contype > 0, 0].round(6).tolist())
    asleep = [bool(model.opt.enableflags & int(mujoco.mjtEnableBit.mjENBL_SLEEP)), model.opt.sleep_tolerance]
    found.append([dict(zip(bodies, np.transpose(values).tolist())), model.nexclude, frictions, asleep])
print(json.dumps(found))
"""


def test_mujoco_finds_in_mjcf_what_it_finds_in_usd(export, furnished):
    """Damping, friction, springs, stops of every joint, which bodies pass, what sleeps: MuJoCo's own reading of the stage beside ours."""
    pytest.importorskip("mujoco")
    home = sfgen.load(furnished)[0]
    overlay = home.usd.with_name(f"{home.scene_id}.mujoco.usda")
    done = subprocess.run([sys.executable, "-c", DECODED, str(export("mjcf")), str(overlay)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    mine, theirs = json.loads(done.stdout.splitlines()[-1])
    assert len(mine[0]) == 14
    assert mine[0].keys() == theirs[0].keys()
    for name, values in mine[0].items():
        assert np.allclose(values, theirs[0][name], rtol=1e-6, atol=1e-9), name
    assert mine[1] == theirs[1] > 0
    assert mine[2] == theirs[2]
    assert mine[3] == theirs[3] == [True, pytest.approx(1e-4)]


def test_mujoco_loads_each_asset_alone(export):
    mujoco = pytest.importorskip("mujoco")
    assets = export("mjcf").parents[2] / "assets"
    models = {path.parent.name: mujoco.MjModel.from_xml_path(str(path)) for path in assets.glob("*/*.xml")}
    assert {name: model.njnt for name, model in models.items()} == {"book": 1, "cabinet_a": 3, "cabinet_b": 3, "chair_a": 0, "flip": 2}


def test_a_scaled_chair_is_scaled(export):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_path(str(export("mjcf")))
    sizes = {}
    for name in ("chair_0", "chair_1"):
        body = model.body(f"{name}/base").id
        geoms = [g for g in range(model.ngeom) if model.geom_bodyid[g] == body and model.geom_type[g] == mujoco.mjtGeom.mjGEOM_BOX]
        sizes[name] = model.geom_size[geoms]
    assert np.allclose(sizes["chair_1"], sizes["chair_0"] * [1.1, 1.0, 0.95])


def test_yourdfpy_loads_every_urdf(export):
    yourdfpy = pytest.importorskip("yourdfpy")
    home = export("urdf").parent
    for path in [*home.glob("*.urdf"), *home.parents[1].glob("assets/*/*.urdf")]:
        robot = yourdfpy.URDF.load(str(path), build_collision_scene_graph=True, load_collision_meshes=True)
        assert robot.validate(), path
        assert len(robot.scene.geometry) > 0


def test_a_glb_is_well_formed_and_trimesh_reads_it(export):
    trimesh = pytest.importorskip("trimesh")
    path = export("glb")
    scene = trimesh.load(path)
    data = path.read_bytes()
    assert data[:4] == b"glTF"
    assert int.from_bytes(data[8:12], "little") == len(data)
    document = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    low, high = scene.bounds
    assert np.allclose([low[1], high[1]], [-0.1, 2.7], atol=0.2)  # Y up: from under the floor to above the ceiling
    assert np.allclose([high[0] - low[0], high[2] - low[2]], [9 + 2 * 0.24, 7.5 + 2 * 0.24], atol=0.03)  # with the outer walls
    meshes = {node["name"]: node.get("mesh") for node in document["nodes"]}
    assert {"floor", "ceiling", "handle", "drawer_slide", "book_0"} <= meshes.keys()
    named = [document["nodes"][i]["name"] for i in document["nodes"][document["scenes"][0]["nodes"][0]]["children"]]
    assert named.count("cabinet_0") == 1
    assert len(document["meshes"]) == len({mesh["name"] for mesh in document["meshes"]})  # what two cabinets share is there once
    for accessor in document["accessors"]:
        view = document["bufferViews"][accessor["bufferView"]]
        size = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]] * 4
        assert view["byteLength"] == accessor["count"] * size
        assert view["byteOffset"] % 4 == 0
    for mesh in document["meshes"]:
        for part in mesh["primitives"]:
            assert document["accessors"][part["indices"]]["count"] % 3 == 0
