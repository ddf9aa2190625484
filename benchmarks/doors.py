"""How much room a home's doors have as they swing: `python benchmarks/doors.py [--dataset DIR] [--count N]`.

Each room door is turned through its range in MuJoCo 4 (`pip install "mujoco[usd]>=4"`), all else shut and at rest, and the least way from its
leaf and handles to anything that stands or lies in the home is taken by MuJoCo's own distance of convex bodies, and that to the
building; negative where one enters the other. A door that meets nothing within REACH has that much.
"""

import argparse
from pathlib import Path

import mujoco
import mujoco._usd
import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
REACH = 0.3  # [m] beyond which nothing is looked at
STEP = np.radians(2.0)
KINDS = ("Objects", "Walls")


def main() -> None:
    """Measure, print a line for each door that comes within a centimetre of a thing or enters the building, and the whole."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--dataset", type=Path, default=ROOT / "data" / "shards")
    options.add_argument("--count", type=int, default=1_000_000)
    given = options.parse_args()
    stages = sorted((given.dataset / "usd").glob("*/*.mujoco.usda"))[: given.count]
    found = {f"{stage.name.split('.')[0]} {door}": least for stage in stages for door, least in swings(stage).items()}
    for door, least in found.items():
        if least[0] < 0.01 or least[1] < 0.0:
            print(f"{door}: {1000 * least[0]:.0f} mm from things, {1000 * least[1]:.0f} from the building")
    every = 1000 * np.array(list(found.values()))
    print(
        f"{len(stages)} homes, {len(every)} doors; least way [mm] of each door: worst, 5th percentile, median; doors that enter something"
    )
    for kind, least in zip(("things", "building"), every.T, strict=True):
        print(f"{kind:10s} {least.min():6.1f} {np.quantile(least, 0.05):6.1f} {np.median(least):6.1f}   {(least < -0.1).sum()}")


def swings(stage: Path) -> dict[str, tuple[float, float]]:
    """Return by door the least ways [m] to things and to the building, over its range."""
    model = mujoco.MjSpec.from_file(str(stage)).compile()
    data = mujoco.MjData(model)
    names = [model.geom(g).name or model.body(model.geom_bodyid[g]).name for g in range(model.ngeom)]
    collides = (model.geom_contype | model.geom_conaffinity) != 0
    others = [np.array([g for g in np.flatnonzero(collides) if names[g].startswith(f"/World/{kind}/")], int) for kind in KINDS]
    least = {}
    for joint in range(model.njnt):
        name = model.joint(joint).name
        if name.startswith("/World/Doors/"):
            mujoco.mj_resetData(model, data)
            mujoco.mj_kinematics(model, data)
            leaf = np.flatnonzero(collides & (model.geom_bodyid == model.jnt_bodyid[joint]))
            low, high = model.jnt_range[joint]
            ways = [REACH, REACH]
            for angle in np.linspace(low, high, 1 + int(np.ceil((high - low) / STEP))):
                data.qpos[model.jnt_qposadr[joint]] = angle
                mujoco.mj_kinematics(model, data)
                ways = [min(way, _least(model, data, leaf, kind)) for way, kind in zip(ways, others, strict=True)]
            least[name.split("/")[3]] = (ways[0], ways[1])
    return least


def _least(model: mujoco.MjModel, data: mujoco.MjData, leaf: NDArray[np.int64], others: NDArray[np.int64]) -> float:
    """Return the least way [m] between geoms of a leaf and others, REACH at most."""
    least = REACH
    for geom in leaf:
        apart = np.linalg.norm(data.geom_xpos[others] - data.geom_xpos[geom], axis=1) - model.geom_rbound[others] - model.geom_rbound[geom]
        for other in others[apart < REACH]:
            least = min(least, mujoco.mj_geomDistance(model, data, int(geom), int(other), REACH, None))
    return least


if __name__ == "__main__":
    main()
