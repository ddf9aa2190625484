"""MuJoCo 4 with its own reader of USD; it loads the overlay beside the stage."""

from pathlib import Path
from typing import Any

import mujoco
import mujoco._usd
import numpy as np
import trial

DT = 1 / 240


class MuJoCoEngine:
    """One model, one data."""

    dt = DT

    def __init__(self, stage: Path, plan: dict[str, Any]) -> None:
        spec = mujoco.MjSpec.from_file(str(stage.with_name(f"{stage.stem}.mujoco.usda")))
        self.model = spec.compile()
        self.model.opt.timestep = DT
        self.data = mujoco.MjData(self.model)
        named = {self.model.joint(k).name: k for k in range(self.model.njnt)}
        joints = [named.get(j["path"], -1) for j in plan["joints"]]
        self.known = np.array([k >= 0 for k in joints], bool)
        self.dofs = np.array([self.model.jnt_dofadr[k] if k >= 0 else 0 for k in joints], int)
        self.places = np.array([self.model.jnt_qposadr[k] if k >= 0 else 0 for k in joints], int)
        self.bodies = np.array([self.model.body(b["path"]).id for b in plan["bodies"]], int)

    def reset(self) -> None:
        """Put everything back."""
        mujoco.mj_resetData(self.model, self.data)
        mujoco.mj_forward(self.model, self.data)

    def step(self, force: np.ndarray) -> None:
        """Advance by DT under forces (J,)."""
        self.data.qfrc_applied[:] = 0
        self.data.qfrc_applied[self.dofs[self.known]] = force[self.known]
        mujoco.mj_step(self.model, self.data)

    def idle(self) -> None:
        """Advance by DT."""
        mujoco.mj_step(self.model, self.data)

    def positions(self) -> np.ndarray:
        """Return the joints' positions (J,)."""
        return np.where(self.known, self.data.qpos[self.places], np.nan)

    def poses(self) -> np.ndarray:
        """Return the poses (B, 7) of what lies about."""
        return np.concatenate([self.data.xpos[self.bodies], self.data.xquat[self.bodies][:, [1, 2, 3, 0]]], axis=1).reshape(-1, 7)


if __name__ == "__main__":
    trial.run(MuJoCoEngine)
