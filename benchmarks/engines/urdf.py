"""How SAPIEN and yourdfpy read an exported home, beside its USD stage.

sfgen export data/shards --to urdf --home s0_00000000 --out exported/urdf
python benchmarks/engines/urdf.py data/shards/usd/shard-00000/s0_00000000.usdc exported/urdf/homes/s0_00000000/home.json

Needs sapien, yourdfpy, usd-core, scipy and defusedxml, in an environment of its own. SAPIEN's floats have 24 bits: at ten metres from the
origin they tell a micrometre.
"""

import json
import math
import runpy
import sys
from pathlib import Path

import numpy as np
import sapien
import yourdfpy
from scipy.spatial.transform import Rotation

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from tests.export.readings import Body, Joint, Reading, deviations, from_usd


def from_sapien(home: Path) -> Reading:
    """Read what SAPIEN has made of home.json."""
    example = runpy.run_path(str(ROOT / "examples" / "sapien_home.py"))
    scene = sapien.Scene([sapien.physx.PhysxCpuSystem()])  # things live as long as it does
    placed = example["load"](scene, home, example["Unseen"])
    joints, bodies = {}, {}
    for name, thing in placed.items():
        parts = [] if name == "building" else [("base", thing)]
        if isinstance(thing, sapien.physx.PhysxArticulation):
            parts = [(link.name, link.entity) for link in thing.links if name != "building"]
            for joint in thing.active_joints:
                T = (joint.child_link.entity.pose * joint.pose_in_child).to_transformation_matrix()
                joints[name, joint.name] = Joint(T[:3, 3], T[:3, 0], *map(float, joint.limits[0]))
        for part, entity in parts:
            body = entity.find_component_by_type(sapien.physx.PhysxRigidBodyComponent)
            T = (entity.pose * body.cmass_local_pose).to_transformation_matrix()
            bodies[name, part] = Body(body.mass, T[:3, 3], T[:3, :3] @ np.diag(body.inertia) @ T[:3, :3].T)
    return Reading(joints, bodies)


def from_yourdfpy(home: Path) -> Reading:
    """Read what yourdfpy makes of the files that home.json names."""
    joints, bodies = {}, {}
    for placed in json.loads(home.read_text(encoding="utf-8"))["placed"]:
        robot = yourdfpy.URDF.load(str(home.parent / placed["urdf"]), load_meshes=False)
        if not robot.validate():
            raise SystemExit(f"{placed['urdf']}: {robot.errors}")
        T_world_robot = np.eye(4)
        T_world_robot[:3, :3] = Rotation.from_quat(placed["orientation"], scalar_first=True).as_matrix()
        T_world_robot[:3, 3] = placed["position"]
        for name, joint in robot.joint_map.items():
            if joint.type != "fixed":
                T = T_world_robot @ robot.get_transform(joint.child, robot.base_link)
                limits = (-math.inf, math.inf) if joint.type == "continuous" else (joint.limit.lower, joint.limit.upper)
                joints[placed["name"], name] = Joint(T[:3, 3], T[:3, :3] @ joint.axis, *limits)
        for name, link in robot.link_map.items():
            if link.inertial is not None:
                T = T_world_robot @ robot.get_transform(name, robot.base_link) @ link.inertial.origin
                bodies[placed["name"], name] = Body(link.inertial.mass, T[:3, 3], T[:3, :3] @ link.inertial.inertia @ T[:3, :3].T)
    return Reading(joints, bodies)


def main(stage: Path, home: Path) -> None:
    """Print the largest differences."""
    truth = from_usd(stage)
    for name, reading in (("SAPIEN", from_sapien(home)), ("yourdfpy", from_yourdfpy(home))):
        differences = ", ".join(f"{key} {value:.1e}" for key, value in deviations(truth, reading).items())
        print(f"{name}: {len(truth.bodies)} bodies, {len(truth.joints)} joints; largest difference from USD: {differences}")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
