"""Load a home into SAPIEN from its URDFs.

sfgen export data/shards --to urdf --out exported/urdf
python examples/sapien_home.py exported/urdf

maniskill_home.py makes an environment of ManiSkill from the same `builders`. SAPIEN draws with Vulkan; where there is none, leave what is
seen out, as `main` does.
"""

import json
import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import sapien
from sapien.wrapper.urdf_loader import URDFLoader

GRAVITY = 9.81  # [m/s2]
SAME = 3  # of a collider's four groups, that in which two must agree if their common bits in the group before shall let them pass


class Unseen(URDFLoader):
    """Leaves out what is seen, which needs a graphics device."""

    def _parse_urdf(self, urdf_string: str) -> Any:
        return super()._parse_urdf(re.sub(r"(?s)<visual.*?</visual>", "", urdf_string))


def builders(home: Path, loader: Callable[[], Any]) -> Iterator[tuple[str, Any]]:
    """Yield the builder of each thing in a home (its home.json) by name, the building first; `loader` makes loaders that have their scene.

    Builders have their poses [m, (w, x, y, z)]. Pairs that pass each other do so within one thing alone: SAPIEN would otherwise let a
    cupboard's drawer pass all bases that pass drawers of their own.
    """
    about = json.loads(home.read_text(encoding="utf-8"))
    building = {"name": "building", "urdf": about["building"], "fixed": True, "position": [0, 0, 0], "orientation": [1, 0, 0, 0]}
    for number, thing in enumerate([building, *about["placed"]]):
        reader = loader()
        reader.fix_root_link = thing["fixed"]
        parsed = reader.parse(str(home.parent / thing["urdf"]))
        articulations, actors, _ = parsed.values() if isinstance(parsed, dict) else parsed  # ManiSkill's loader answers with a dict
        (builder,) = [*articulations, *actors]
        builder.initial_pose = sapien.Pose(thing["position"], thing["orientation"])
        for part in getattr(builder, "link_builders", [builder]):
            part.collision_groups[SAME] = number
        yield thing["name"], builder


def set_friction(builder: Any, find: Callable[[str], Any]) -> None:
    """Give the joints of an articulation that `builder` has built their dry friction; `find` answers with a joint by its name.

    SAPIEN's builders drop the URDF's, and then PhysX takes a twentieth of all that a joint carries. It knows shares alone: here that of the
    weight, which is what the URDF says [N, N m] where the joint carries no more than that.
    """
    masses = [link._mass if link.parent else 0.0 for link in builder.link_builders]  # noqa: SLF001
    for link in reversed(builder.link_builders[1:]):  # children stand behind their parents
        masses[link.parent.index] += masses[link.index]
        if link.joint_record.joint_type != "fixed":
            find(link.joint_record.name).set_friction(link.joint_record.friction / (GRAVITY * masses[link.index]))


def load(scene: sapien.Scene, home: Path, loader: type[URDFLoader] = URDFLoader) -> dict[str, Any]:
    """Put a home (its home.json) into a scene; returns what can move, by name: articulations, and entities of one body."""

    def reader() -> URDFLoader:
        made = loader()
        made.set_scene(scene)
        return made

    placed = {}
    for name, builder in builders(home, reader):
        placed[name] = builder.build()
        if name != "building" and isinstance(placed[name], sapien.physx.PhysxArticulation):
            set_friction(builder, placed[name].find_joint_by_name)
            placed[name].set_qpos(placed[name].qpos)  # or its links but the root stand about the origin until the first step
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
