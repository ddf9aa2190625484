"""A robot drives through a home to a certified standing pose and pulls a drawer open, in MuJoCo.

sfgen export data/shards --to mjcf --out exported/mjcf
python examples/mujoco_robot.py data/shards exported/mjcf

The robot is the one of the certificate, an upright cylinder of 25 cm radius and 1.4 m, with an arm that slides up and out. Its hand
closes as a ball joint at the handle: grasping is another subject. Doors stand open; the way is planned on the colliders themselves.
"""

import heapq
import sys
from pathlib import Path

import mujoco
import numpy as np
from scipy.ndimage import distance_transform_edt
from scipy.spatial import ConvexHull

import sfgen
from sfgen.homes import Home, Joint

RADIUS, HEIGHT, STEP = 0.25, 1.4, 0.02  # of the robot, and what it drives over [m]
CLEAR = 0.03  # that its way keeps from things beside, for it lags behind its target and cuts corners [m]
CELL, SPEED = 0.05, 0.6  # of the map [m], of the robot [m/s]
START, PARKED = 0.35, 0.9  # how far its arm is out, and how high, while it drives [m]


def add_robot(spec: mujoco.MjSpec, handle: str) -> None:
    """Add base, arm and hand, a servo for each of x, y, yaw, lift and reach, and the grip, which is off."""
    parent = spec.worldbody
    slide, hinge = mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE
    for name, kind, axis, mass, stiff in (
        ("x", slide, (1, 0, 0), 1.0, 2e4),
        ("y", slide, (0, 1, 0), 1.0, 2e4),
        ("yaw", hinge, (0, 0, 1), 30.0, 2e3),
        ("lift", slide, (0, 0, 1), 3.0, 1e4),
        ("reach", slide, (1, 0, 0), 2.0, 5e3),
    ):
        parent = parent.add_body(name=f"robot/{name}", mass=mass, inertia=[0.5, 0.5, 0.5], explicitinertial=True, gravcomp=1)
        parent.add_joint(name=f"robot/{name}", type=kind, axis=axis, damping=1.0)
        servo = spec.add_actuator(name=f"robot/{name}", target=f"robot/{name}", trntype=mujoco.mjtTrn.mjTRN_JOINT)
        servo.set_to_position(kp=stiff, kv=2 * (stiff * 40) ** 0.5)
        if name == "yaw":
            size = [RADIUS - 0.01, (HEIGHT - STEP) / 2 - 0.005, 0]
            parent.add_geom(
                name="robot", type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=size, pos=[0, 0, (HEIGHT + STEP) / 2 + 0.005], density=0
            )
    parent.add_site(name="robot/hand", size=[0.02, 0.02, 0.02])
    grip = spec.add_equality(name="grip", type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_SITE, active=False)
    grip.name1, grip.name2 = "robot/hand", handle


def obstacles(model: mujoco.MjModel, data: mujoco.MjData, origin: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Draw what stands between the robot's foot and head into a map of the floor, from the outlines of the colliders."""
    blocked = np.zeros(shape, bool)
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    for g in np.flatnonzero(model.geom_contype):
        mesh = model.geom_dataid[g]
        local = corners * model.geom_size[g]
        if mesh >= 0:
            local = model.mesh_vert[model.mesh_vertadr[mesh] : model.mesh_vertadr[mesh] + model.mesh_vertnum[mesh]]
        points = local @ data.geom_xmat[g].reshape(3, 3).T + data.geom_xpos[g]
        if model.geom(g).name == "robot" or points[:, 2].max() < STEP or points[:, 2].min() > HEIGHT:
            continue
        low = np.maximum(((points[:, :2].min(axis=0) - origin) / CELL).astype(int) - 1, 0)
        high = ((points[:, :2].max(axis=0) - origin) / CELL).astype(int) + 2
        i, j = np.meshgrid(*(np.arange(a, min(b, n)) for a, b, n in zip(low, high, shape, strict=True)), indexing="ij")
        sides = ConvexHull(points[:, :2]).equations
        centers = origin + (np.stack([i, j], axis=-1) + 0.5) * CELL
        blocked[i, j] |= np.all(centers @ sides[:, :2].T + sides[:, 2] < CELL / 2, axis=-1)
    return blocked


def shortest(free: np.ndarray, goal: tuple[int, int]) -> tuple[np.ndarray, dict[tuple[int, int], tuple[int, int]]]:
    """Return the length of the way to the goal from every cell, and the next cell on it (Dijkstra, eight neighbours)."""
    length, onward = np.full(free.shape, np.inf), {}
    length[goal] = 0.0
    queue = [(0.0, goal)]
    while queue:
        far, (i, j) = heapq.heappop(queue)
        for di, dj in ((a, b) for a in (-1, 0, 1) for b in (-1, 0, 1) if a or b):
            to, total = (i + di, j + dj), far + CELL * np.hypot(di, dj)
            if 0 <= to[0] < free.shape[0] and 0 <= to[1] < free.shape[1] and free[to] and total < length[to]:
                length[to], onward[to] = total, (i, j)
                heapq.heappush(queue, (total, to))
    return length, onward


def drawer(home: Home, model: mujoco.MjModel) -> tuple[Joint, str]:
    """Return the first drawer on the ground floor that has a handle and a standing pose, and the name of its handle's site."""
    sites = {model.site(s).name for s in range(model.nsite)}
    ground = {o.object_id for o in home.objects for room in home.rooms if room.room_id == o.room_id and room.level == 0}
    for joint in home.joints:
        if (
            joint.part_class == "slider_drawer"
            and joint.stand is not None
            and joint.clear
            and not joint.after
            and joint.object_id in ground
        ):
            body = model.body(model.joint(f"{joint.object_id}/{joint.joint_id}").bodyid[0]).name
            if f"{body}/handle" in sites:
                return joint, f"{body}/handle"
    raise SystemExit(f"{home.scene_id} has no drawer with a handle that the robot can stand before")


def route(home: Home, joint: Joint, model: mujoco.MjModel, data: mujoco.MjData) -> list[np.ndarray]:
    """Return points (2,) from inside the entrance to the standing pose, by way of floor on which the robot touches nothing."""
    floor = np.concatenate([room.polygon for room in home.rooms])
    origin = floor.min(axis=0) - 0.5
    shape = tuple(np.ceil((np.ptp(floor, axis=0) + 1.0) / CELL).astype(int))
    free = distance_transform_edt(~obstacles(model, data, origin, shape)) * CELL > RADIUS + CLEAR

    def nearest(point: np.ndarray, cells: np.ndarray) -> tuple[int, int]:
        return tuple(cells[np.linalg.norm(origin + (cells + 0.5) * CELL - point, axis=1).argmin()].tolist())

    length, onward = shortest(free, nearest(joint.stand[:2], np.argwhere(free)))
    entrance = next((o for o in home.openings if o.kind == "entrance"), home.openings[0])
    inside = next(room for room in home.rooms if room.room_id in entrance.rooms).polygon.mean(axis=0)
    way = [nearest(0.8 * entrance.segment.mean(axis=0) + 0.2 * inside, np.argwhere(np.isfinite(length)))]
    while way[-1] in onward:
        way.append(onward[way[-1]])
    return [*(origin + (np.array(cell) + 0.5) * CELL for cell in way), joint.stand[:2]]


class Robot:
    """The servos of the robot in a home, and how many steps its base has touched something."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, at: np.ndarray) -> None:
        self.model, self.data, self.touched = model, data, 0
        self.servos = {name: data.actuator(f"robot/{name}") for name in ("x", "y", "yaw", "lift", "reach")}
        for name, value in zip(("x", "y", "lift", "reach"), (*at, PARKED, START), strict=True):
            data.joint(f"robot/{name}").qpos = self.servos[name].ctrl = value

    def drive(self, there: np.ndarray, seconds: float) -> None:
        """Move the base towards a point."""
        self.servos["x"].ctrl, self.servos["y"].ctrl = there
        self.step(seconds)

    def hold(self, hand: np.ndarray, seconds: float) -> None:
        """Turn, lift and stretch the arm until the hand is at a point (3,)."""
        away = hand[:2] - [self.servos["x"].ctrl[0], self.servos["y"].ctrl[0]]
        yaw = self.servos["yaw"].ctrl[0]
        self.servos["yaw"].ctrl = yaw + (np.arctan2(away[1], away[0]) - yaw + np.pi) % (2 * np.pi) - np.pi
        self.servos["reach"].ctrl, self.servos["lift"].ctrl = np.linalg.norm(away), hand[2]
        self.step(seconds)

    def step(self, seconds: float) -> None:
        """Let time pass."""
        base = self.model.geom("robot").id
        for _ in range(max(1, round(seconds / self.model.opt.timestep))):
            mujoco.mj_step(self.model, self.data)
            self.touched += bool((self.data.contact.geom == base).any())


def main(dataset: str, exported: str, scene_id: str = "") -> None:
    """Drive from the entrance to the drawer, take its handle, pull."""
    home = next(h for h in sfgen.load(dataset) if scene_id in {"", h.scene_id})
    path = str(Path(exported) / "homes" / home.scene_id / f"{home.scene_id}.xml")
    joint, handle = drawer(home, mujoco.MjModel.from_xml_path(path))
    spec = mujoco.MjSpec.from_file(path)
    add_robot(spec, handle)
    model = spec.compile()
    data = mujoco.MjData(model)
    for opening in home.openings:
        if opening.swing_angle is not None:
            data.joint(f"{opening.opening_id}/hinge").qpos = opening.swing_angle
    mujoco.mj_forward(model, data)

    points = route(home, joint, model, data)
    robot = Robot(model, data, points[0])
    legs = np.linalg.norm(np.diff(points, axis=0), axis=1)
    for there, leg in zip(points[1:], legs, strict=True):
        robot.drive(there, leg / SPEED)
    grip, stand = data.site(handle).xpos.copy(), np.array([*joint.stand[:2], data.site(handle).xpos[2]])
    parked = stand + START * (grip - stand) / np.linalg.norm(grip - stand)
    robot.hold(parked, 1.0)
    for share in np.linspace(0, 1, 50):
        robot.hold(parked + share * (grip - parked), 0.02)
    robot.hold(grip, 0.5)
    missed = 1e3 * np.linalg.norm(data.site("robot/hand").xpos - grip)
    data.eq_active[model.equality("grip").id] = 1
    for opened in np.linspace(0, joint.upper, 150):
        robot.hold(grip + opened * joint.axis, 0.02)
    robot.hold(grip + joint.upper * joint.axis, 0.5)

    print(f"{home.scene_id}: drove {legs.sum():.1f} m, touched something in {robot.touched} steps, took the handle within {missed:.1f} mm")
    print(
        f"{joint.object_id}/{joint.joint_id} is open by {data.joint(f'{joint.object_id}/{joint.joint_id}').qpos[0]:.3f} of {joint.upper:.3f} m"
    )


if __name__ == "__main__":
    main(*(sys.argv[1:] or ("data/shards", "exported/mjcf")))
