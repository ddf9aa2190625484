"""Load a home into SAPIEN, and through it into ManiSkill, from its URDFs.

sfgen export data/shards --to urdf --out exported/urdf
python examples/sapien_home.py exported/urdf

In ManiSkill call `load` from `_load_scene` of an environment with `self.scene.sub_scenes[i]`. SAPIEN draws with Vulkan; where there is
none, leave what is seen out, as `main` does.
"""

import json
import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import sapien
from sapien.wrapper.urdf_loader import URDFLoader


class Unseen(URDFLoader):
    """Leaves out what is seen, which needs a graphics device."""

    def _parse_urdf(self, urdf_string: str) -> Any:
        return super()._parse_urdf(re.sub(r"(?s)<visual.*?</visual>", "", urdf_string))


def load(scene: sapien.Scene, home: Path, loader: type[URDFLoader] = URDFLoader) -> dict[str, Any]:
    """Put a home (its home.json) into a scene; returns what can move, by name: articulations, and entities of one body."""
    about = json.loads(home.read_text())
    placed = {}
    building = {"name": "building", "urdf": about["building"], "fixed": True, "position": [0, 0, 0], "orientation": [1, 0, 0, 0]}
    for thing in [building, *about["placed"]]:
        reader = loader()
        reader.set_scene(scene)
        reader.fix_root_link = thing["fixed"]
        articulations, entities = reader.load_multiple(str(home.parent / thing["urdf"]))
        (model,) = [*articulations, *entities]
        model.set_pose(sapien.Pose(thing["position"], thing["orientation"]))
        placed[thing["name"]] = model
    return placed


def main(folder: str, seconds: float = 1.0) -> None:
    """Load the first home, let it rest, open every joint to its limit, one object after the other."""
    scene = sapien.Scene([sapien.physx.PhysxCpuSystem()])
    scene.set_timestep(1 / 240)
    placed = load(scene, min(Path(folder).glob("homes/*/home.json")), Unseen)
    for _ in range(round(seconds * 240)):
        scene.step()
    moving = {name: thing for name, thing in placed.items() if isinstance(thing, sapien.physx.PhysxArticulation) and thing.dof}
    resting = max(float(np.abs(thing.qpos).max()) for thing in moving.values())
    print(
        f"{len(placed)} things, {sum(thing.dof for thing in moving.values())} joints; after {seconds:g} s none has moved more than {resting:.4f}"
    )
    for name, thing in moving.items():
        thing.set_qpos([upper if np.isfinite(upper) else 0.0 for _, upper in thing.qlimits])
        print(f"  {name}: {', '.join(f'{joint.name} {q:.2f}' for joint, q in zip(thing.active_joints, thing.qpos, strict=True))}")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "exported/urdf")
