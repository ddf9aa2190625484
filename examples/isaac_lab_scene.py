"""A scene configuration for Isaac Lab: a home in every environment, its furniture as articulations that a policy can read and drive.

./isaaclab.sh -p examples/isaac_lab_scene.py data/shards --num_envs 16

Runs inside Isaac Lab 2; `articulations` alone, which says what is where, needs only sfgen's loaders and pxr. Bases are fixed to their own
Xform in the stage, so `fix_root_link` stays unset; `spawn=None` takes what the home's stage has brought. Poses are given once more,
because Isaac Lab puts an articulation where its `init_state` says when it resets.
"""

import argparse
from typing import NamedTuple

from pxr import Usd, UsdGeom

import sfgen
from sfgen.homes import Home


class Article(NamedTuple):
    """Something with joints: its prim within the home's stage, position [m], orientation (w, x, y, z), the names of its joints."""

    prim: str
    position: tuple[float, ...]
    orientation: tuple[float, ...]
    joints: list[str]


def articulations(home: Home) -> dict[str, Article]:
    """Return everything in a home that has joints."""
    stage, cache = Usd.Stage.Open(str(home.usd)), UsdGeom.XformCache()
    objects = {o.object_id for o in home.objects}
    articles = {}
    for name in dict.fromkeys(joint.object_id for joint in home.joints):
        prim = f"{'Objects' if name in objects else 'Doors'}/{name}"
        matrix = cache.GetLocalToWorldTransform(stage.GetDefaultPrim().GetPrimAtPath(prim))
        turned = matrix.ExtractRotationQuat()
        orientation = (turned.GetReal(), *turned.GetImaginary())
        articles[name] = Article(prim, tuple(matrix.ExtractTranslation()), orientation, [j.joint_id for j in home.joints_of(name)])
    return articles


def scene_cfg(home: Home, num_envs: int, spacing: float) -> object:
    """Return the InteractiveSceneCfg of a home."""
    from isaaclab import sim
    from isaaclab.actuators import ImplicitActuatorCfg
    from isaaclab.assets import ArticulationCfg, AssetBaseCfg
    from isaaclab.scene import InteractiveSceneCfg

    cfg = InteractiveSceneCfg(num_envs=num_envs, env_spacing=spacing, replicate_physics=True)
    cfg.home = AssetBaseCfg(prim_path="{ENV_REGEX_NS}/Home", spawn=sim.UsdFileCfg(usd_path=str(home.usd)))
    for name, article in articulations(home).items():
        # the stage's own drives (damping, springs) stay: None leaves them as they are
        passive = ImplicitActuatorCfg(joint_names_expr=article.joints, stiffness=None, damping=None)
        state = ArticulationCfg.InitialStateCfg(pos=article.position, rot=article.orientation, joint_pos={".*": 0.0})
        prim = f"{{ENV_REGEX_NS}}/Home/{article.prim}"
        setattr(cfg, name, ArticulationCfg(prim_path=prim, spawn=None, init_state=state, actuators={"passive": passive}))
    return cfg


def main() -> None:
    """Start Isaac Sim, build the scene, step it."""
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", nargs="?", default="data/shards")
    parser.add_argument("--num_envs", type=int, default=4)
    arguments = parser.parse_args()
    from isaaclab.app import AppLauncher

    app = AppLauncher(headless=True).app
    from isaaclab import sim
    from isaaclab.scene import InteractiveScene

    context = sim.SimulationContext(sim.SimulationCfg(dt=1 / 120))
    home = next(h for h in sfgen.load(arguments.folder) if h.usd)
    scene = InteractiveScene(scene_cfg(home, arguments.num_envs, spacing=25.0))
    context.reset()
    for _ in range(120):
        context.step()
        scene.update(1 / 120)
    for name, article in scene.articulations.items():
        print(f"{name}: {article.joint_names} at {article.data.joint_pos[0].tolist()}")
    app.close()


if __name__ == "__main__":
    main()
