"""A home as an environment of ManiSkill 3: its rooms, all of its furniture, and one joint that is to be opened.

pip install mani_skill
sfgen export data/shards --to urdf --out exported/urdf
python examples/maniskill_home.py data/shards exported/urdf

In a program of your own, with this folder on PYTHONPATH:

    import gymnasium, maniskill_home
    env = gymnasium.make("SfgenOpen-v1", home="exported/urdf/homes/s0_00000000/home.json", joint="kitchen_cabinet_0/joint_0", stand=(x, y, yaw))

`stand` is where a robot stands to open the joint, from sfgen's table of joints. One home an environment; with `num_envs` every sub-scene
holds it. The reward is none: `evaluate` says how far the joint is open. Another home or joint comes with
`env.reset(options={"reconfigure": True, "home": ..., "joint": ..., "stand": ...})`.
"""

import sys
from pathlib import Path
from typing import Any

import gymnasium
import sapien
import torch
from mani_skill.agents.robots.fetch import FETCH_WHEELS_COLLISION_BIT
from mani_skill.envs.sapien_env import BaseEnv
from mani_skill.sensors.camera import CameraConfig
from mani_skill.utils import sapien_utils
from mani_skill.utils.building.urdf_loader import URDFLoader
from mani_skill.utils.registration import register_env
from mani_skill.utils.structs import Articulation, Pose
from mani_skill.utils.structs.types import SceneConfig, SimConfig
from sapien_home import Unseen, builders, set_friction

import sfgen
from sfgen.homes import Home, Joint

OPEN = 0.9  # of a joint's range, from which on it is open
PUSH = {"prismatic": 20.0, "revolute_unwrapped": 4.0}  # what a hand gives: [N] on a drawer, [N m] on a door


class UnseenLoader(Unseen, URDFLoader):
    """ManiSkill's loader, which leaves out what is seen."""


@register_env("SfgenOpen-v1", max_episode_steps=200)
class OpenInHome(BaseEnv):
    """Open `joint`, "<object>/<joint>", of the home whose home.json is `home`; the robot's base starts at `stand` (x, y, yaw) [m, rad].

    Raises KeyError where the home has no such joint.
    """

    SUPPORTED_ROBOTS = ("fetch",)
    SUPPORTED_REWARD_MODES = ("none", "sparse")

    def __init__(self, *args: Any, home: str, joint: str, stand: tuple[float, float, float] = (0, 0, 0), **kwargs: Any) -> None:
        self.asked = {"home": home, "joint": joint, "stand": stand}
        super().__init__(*args, **{"robot_uids": "fetch", **kwargs})

    @property
    def _default_sim_config(self) -> SimConfig:
        return SimConfig(spacing=40, sim_freq=240, scene_config=SceneConfig(contact_offset=0.002))  # seams are as narrow as 2 mm

    @property
    def _default_human_render_camera_configs(self) -> CameraConfig:
        x, y, _ = self.asked["stand"]
        return CameraConfig("render_camera", sapien_utils.look_at([x - 2, y - 2, 2], [x, y, 0.8]), 512, 512, 1, 0.01, 100)

    def _load_agent(self, options: dict[str, Any]) -> None:
        if not self.scene.can_render():  # the loader makes materials all the same, and SAPIEN has none without a graphics device
            self.scene.create_urdf_loader = self._unseen_loader
        super()._load_agent(options, sapien.Pose())

    def _unseen_loader(self) -> UnseenLoader:
        loader = UnseenLoader()
        loader.set_scene(self.scene)
        return loader

    def _load_scene(self, options: dict[str, Any]) -> None:
        """Build a static actor for each thing that stands still, and what moves under its name; find the joint."""
        self.asked |= {key: options[key] for key in self.asked if key in options}
        self.moving: dict[str, Any] = {}
        for name, builder in builders(Path(self.asked["home"]), self.scene.create_urdf_loader):
            if name == "building":
                self._load_building(builder)
            else:
                self.moving[name] = builder.build(name)
                if isinstance(self.moving[name], Articulation):
                    set_friction(builder, self.moving[name].joints_map.__getitem__)
        thing, joint = self.asked["joint"].split("/")
        self.target = self.moving[thing].active_joints_map[joint]

    def _load_building(self, building: Any) -> None:
        for link in building.link_builders[1:]:
            T_world_link = link.joint_record.pose_in_parent * link.joint_record.pose_in_child.inv()
            if not (link.collision_records or link.visual_records):
                continue
            still = self.scene.create_actor_builder()
            still.initial_pose = T_world_link
            still.collision_records = link.collision_records
            still.visual_records = link.visual_records
            actor = still.build_static(f"building/{link.name}")
            if link.name.startswith("wall_"):  # walls and floors: Fetch's wheels have no contacts, its base rolls by joints
                actor.set_collision_group_bit(group=2, bit_idx=FETCH_WHEELS_COLLISION_BIT, bit=1)

    def _initialize_episode(self, env_idx: torch.Tensor, options: dict[str, Any]) -> None:  # noqa: ARG002
        """Shut everything, put what lies about back, and the robot to where it stands."""
        count = len(env_idx)
        with torch.device(self.device):
            for thing in self.moving.values():
                thing.set_pose(Pose.create(thing.initial_pose))
                if isinstance(thing, Articulation):
                    thing.set_qpos(torch.zeros(count, thing.max_dof))
                    thing.set_qvel(torch.zeros(count, thing.max_dof))
                    thing.set_qf(torch.zeros(count, thing.max_dof))
                else:
                    thing.set_linear_velocity(torch.zeros(count, 3))
                    thing.set_angular_velocity(torch.zeros(count, 3))
            qpos = torch.tensor(self.agent.keyframes["rest"].qpos, dtype=torch.float32)
            qpos[:3] = torch.tensor(self.asked["stand"])
            self.agent.robot.set_qpos(qpos.repeat(count, 1))
            self.agent.robot.set_pose(sapien.Pose())

    def opened(self) -> torch.Tensor:
        """Return how far the joint is open (num_envs,): 0 shut, 1 at the end of its range."""
        return self.target.qpos / self.target.limits.reshape(-1, 2)[:, 1].to(self.device)

    def evaluate(self) -> dict[str, torch.Tensor]:
        """Return `opened` and `success` (num_envs,)."""
        opened = self.opened()
        return {"opened": opened, "success": opened >= OPEN}

    def _get_obs_extra(self, info: dict[str, Any]) -> dict[str, torch.Tensor]:
        return {"opened": info["opened"]}


def drawer(home: Home) -> Joint:
    """Return the first drawer on the ground floor before which a robot can stand."""
    ground = {o.object_id for o in home.objects for room in home.rooms if room.room_id == o.room_id and room.level == 0}
    for joint in home.joints:
        if joint.part_class == "slider_drawer" and joint.stand is not None and not joint.after and joint.object_id in ground:
            return joint
    raise SystemExit(f"{home.scene_id} has no drawer before which a robot can stand")


def main(dataset: str, exported: str) -> None:
    """Let the first home rest for a second with the robot before a drawer, then pull the drawer as a hand would."""
    home = sfgen.load(dataset)[0]
    joint = drawer(home)
    env = gymnasium.make(
        "SfgenOpen-v1",
        home=str(Path(exported) / "homes" / home.scene_id / "home.json"),
        joint=f"{joint.object_id}/{joint.joint_id}",
        stand=tuple(joint.stand),
        obs_mode="state",
        render_backend="none",
    )
    env.reset(seed=0)
    world = env.unwrapped
    idle = torch.zeros(world.action_space.shape)
    for _ in range(20):
        _, _, _, _, info = env.step(idle)
    print(f"{home.scene_id}: {len(world.moving)} things; after 1 s {world.asked['joint']} is open by {float(info['opened'][0]):.3f}")
    force = torch.zeros(1, world.target.articulation.max_dof)
    force[:, world.target.active_index] = PUSH[world.target.type[0]]
    for _ in range(60):
        world.target.articulation.set_qf(force)
        _, _, _, _, info = env.step(idle)
    print(f"pulled for 3 s it is open by {float(info['opened'][0]):.3f}, success {bool(info['success'][0])}")
    env.reset(seed=0)
    print(f"after a reset it is open by {float(world.opened()[0]):.3f}")
    env.close()


if __name__ == "__main__":
    main(*(sys.argv[1:] or ("data/shards", "exported/urdf")))
