"""PhysX by `ovphysx` (the engine of Isaac Sim), on the CPU."""

from pathlib import Path
from typing import Any

import numpy as np
import trial
from ovphysx import PhysX
from ovphysx.types import TensorType

DT = 1 / 120


class PhysXEngine:
    """An articulation at a time: joints of unlike articulations do not share an array."""

    dt = DT

    def __init__(self, stage: Path, plan: dict[str, Any]) -> None:
        import ovphysx.api
        import ovstage
        from ovphysx.samples.python_samples.schema_support import physx_schema_paths

        PhysX.set_cpu_mode(True)
        ovphysx.api.set_global_config(ovphysx.GlobalConfigKey.NUM_THREADS, 0)  # one thread: threads cost more than they bring here
        self.physx = PhysX()
        ovstage.population.register_usd_schemas([*map(str, physx_schema_paths()), str(ovphysx.newton_schema_root())])
        self.stage = ovstage.Stage("trial")
        ovstage.population.open_usd(self.stage, str(stage), ordinal=1, domains=ovstage.PopulationDomain.ALL)
        self.stage.advance_write_floor(ordinal=1).wait()
        self.physx.wait_task(self.physx.attach_ovstage(self.stage, read_ordinal=1))
        self.physx.step_sync(1e-6)
        self.count = len(plan["joints"])
        index = {joint["path"]: k for k, joint in enumerate(plan["joints"])}
        self.arms = [self._arm(root, index) for root in sorted({j["root"] for j in plan["joints"]})]
        self.arms = [arm for arm in self.arms if arm is not None]
        self.bodies = self._bodies(plan["bodies"])

    def _arm(self, root: str, index: dict[str, int]) -> dict[str, Any] | None:
        kinds = {
            "q": TensorType.ARTICULATION_DOF_POSITION,
            "v": TensorType.ARTICULATION_DOF_VELOCITY,
            "f": TensorType.ARTICULATION_DOF_ACTUATION_FORCE,
            "root": TensorType.ARTICULATION_ROOT_POSE,
            "rootv": TensorType.ARTICULATION_ROOT_VELOCITY,
        }
        # A root API on an asset's Xform is seen as its base link.
        arm: dict[str, Any] = {}
        for kind, tensor in kinds.items():
            binding = self.physx.create_tensor_binding(prim_paths=[root], tensor_type=tensor)
            if not binding.count:
                binding = self.physx.create_tensor_binding(pattern=f"{root}/*", tensor_type=tensor)
            if not binding.count:
                print("no articulation", root)
                return None
            arm[kind] = binding
        names = arm["q"].dof_names
        arm["index"] = np.array([index.get(f"{root}/joints/{name.rsplit('/', 1)[-1]}", -1) for name in names])
        for kind in kinds:
            arm[f"{kind}0"] = np.zeros(arm[kind].shape, np.float32)
            if kind != "f":
                arm[kind].read(arm[f"{kind}0"])
        arm["buffer"] = np.zeros(arm["q"].shape, np.float32)
        arm["q0"][:] = 0
        arm["v0"][:] = 0
        arm["rootv0"][:] = 0
        return arm

    def _bodies(self, bodies: list[dict[str, str]]) -> list[tuple[Any, Any, Any, Any]]:
        """Bind each loose body: a rigid body of its own, or the root of a loose articulation."""
        bindings = []
        arms = {str(arm["root"].prim_paths[0]): arm for arm in self.arms}
        for body in bodies:
            arm = next((a for path, a in arms.items() if path.startswith(body["root"])), None)
            if arm is not None:
                pose, speed = arm["root"], arm["rootv"]
            else:
                pose, speed = (
                    self.physx.create_tensor_binding(prim_paths=[body["path"]], tensor_type=t, raise_if_empty=True)
                    for t in (TensorType.RIGID_BODY_POSE, TensorType.RIGID_BODY_VELOCITY)
                )
            at = np.zeros(pose.shape, np.float32)
            pose.read(at)
            bindings.append((pose, speed, at.copy(), at))
        return bindings

    def reset(self) -> None:
        """Put everything back."""
        for arm in self.arms:
            for kind in ("root", "rootv", "q", "v"):
                arm[kind].write(arm[f"{kind}0"])
        for pose, speed, first, _ in self.bodies:
            pose.write(first)
            speed.write(np.zeros(speed.shape, np.float32))

    def step(self, force: np.ndarray) -> None:
        """Advance by DT under forces (J,)."""
        for arm in self.arms:
            arm["f0"][0] = np.where(arm["index"] >= 0, force[arm["index"]], 0.0)
            arm["f"].write(arm["f0"])
        self.physx.step_sync(DT)

    def idle(self) -> None:
        """Advance by DT; forces that are written, zeros too, would wake their articulations."""
        self.physx.step_sync(DT)

    def positions(self) -> np.ndarray:
        """Return the joints' positions (J,)."""
        joint_positions = np.full(self.count, np.nan)
        for arm in self.arms:
            arm["q"].read(arm["buffer"])
            known = arm["index"] >= 0
            joint_positions[arm["index"][known]] = arm["buffer"][0][known]
        return joint_positions

    def poses(self) -> np.ndarray:
        """Return the poses (B, 7) of what lies about."""
        for pose, _, _, at in self.bodies:
            pose.read(at)
        return np.array([at[0] for *_, at in self.bodies], float).reshape(-1, 7)


if __name__ == "__main__":
    trial.run(PhysXEngine)
