"""Load a home's USD stage into Newton and let it rest, such as `python examples/newton_home.py data/shards`.

Needs `pip install "newton[sim,importers]"` in an environment of its own (its MuJoCo is older than ours).
"""

import sys

import newton
import numpy as np

import sfgen


def main(folder: str, seconds: float = 1.0) -> None:
    """Step the first home."""
    home = next(h for h in sfgen.load(folder) if h.usd)
    builder = newton.ModelBuilder()
    newton.solvers.SolverMuJoCo.register_custom_attributes(builder)  # several contacts a pair of meshes, as the scene asks
    builder.add_usd(str(home.usd))
    model = builder.finalize(device="cpu")
    solver = newton.solvers.SolverMuJoCo(model, use_mujoco_cpu=True)  # on a GPU leave both out
    now, then, control = model.state(), model.state(), model.control()
    newton.eval_fk(model, model.joint_q, model.joint_qd, now)
    start = now.body_q.numpy()[:, :3]
    for _ in range(round(120 * seconds)):
        now.clear_forces()
        solver.step(now, then, control, None, 1 / 120)
        now, then = then, now
    moved = np.linalg.norm(now.body_q.numpy()[:, :3] - start, axis=1).max()
    print(
        f"{home.scene_id}: {model.body_count} bodies, {model.joint_count} joints; after {seconds:g} s nothing has moved more than {moved:.3f} m"
    )


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "data/shards")
