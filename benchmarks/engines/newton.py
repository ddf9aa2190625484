"""Newton, with its MuJoCo solver on the CPU."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.pop(0)  # this folder: this file is named as the engine is
import newton
import numpy as np
import warp as wp

sys.path.insert(0, str(Path(__file__).parent))
import trial

DT = 1 / 240
FREE = (newton.JointType.FREE, newton.JointType.DISTANCE)


class NewtonEngine:
    """Joint positions, velocities and forces are arrays of the model; a loose body has a free joint."""

    dt = DT

    def __init__(self, stage: Path, plan: dict[str, Any]) -> None:
        builder = newton.ModelBuilder(up_axis=newton.Axis.Z)
        newton.solvers.SolverMuJoCo.register_custom_attributes(builder)  # several contacts a pair of meshes: the scene asks for them
        maps = builder.add_usd(str(stage), load_visual_shapes=False)
        self.model = builder.finalize(device="cpu")
        self.solver = newton.solvers.SolverMuJoCo(self.model, use_mujoco_cpu=True, njmax=8000, nconmax=8000)
        self.control = self.model.control()
        self.states = self.model.state(), self.model.state()
        start = self.model.joint_qd_start.numpy()
        place = self.model.joint_q_start.numpy()
        joints = [maps["path_joint_map"].get(j["path"], -1) for j in plan["joints"]]
        self.known = np.array([k >= 0 for k in joints], bool)
        self.dofs = np.array([start[k] if k >= 0 else 0 for k in joints], int)
        self.places = np.array([place[k] if k >= 0 else 0 for k in joints], int)
        self.bodies = np.array([maps["path_body_map"][b["path"]] for b in plan["bodies"]], int)
        self.force = np.zeros(self.model.joint_dof_count, np.float32)
        newton.eval_fk(self.model, self.model.joint_q, self.model.joint_qd, self.states[0])

    def reset(self) -> None:
        """Put everything back."""
        for state in self.states:
            wp.copy(state.joint_q, self.model.joint_q)
            wp.copy(state.joint_qd, self.model.joint_qd)
            newton.eval_fk(self.model, state.joint_q, state.joint_qd, state)
        self.solver.reset(self.states[0]) if hasattr(self.solver, "reset") else None

    def step(self, force: np.ndarray) -> None:
        """Advance by DT under forces (J,)."""
        self.force[:] = 0
        self.force[self.dofs[self.known]] = force[self.known]
        self.control.joint_f.assign(self.force)
        first, second = self.states
        first.clear_forces()
        self.solver.step(first, second, self.control, None, DT)
        self.states = second, first

    def idle(self) -> None:
        """Advance by DT; on a CPU nothing sleeps in Newton."""
        self.step(np.zeros(len(self.dofs)))

    def positions(self) -> np.ndarray:
        """Return the joints' positions (J,)."""
        return np.where(self.known, self.states[0].joint_q.numpy()[self.places], np.nan)

    def poses(self) -> np.ndarray:
        """Return the poses (B, 7) of what lies about."""
        return self.states[0].body_q.numpy()[self.bodies].astype(float).reshape(-1, 7)


if __name__ == "__main__":
    wp.config.quiet = True
    newton.solvers.SolverMuJoCo.import_mujoco()  # packages are loaded once a process, not once a home
    trial.run(NewtonEngine)
