"""The trial that every engine gives a stage: everything at rest, each joint pushed open, shut and left, then all joints at once.

An adaptor shows one engine as arrays in the order of the plan (see plan.py); what is done to it stands here once, so that
engines differ in nothing else. It knows numpy alone, for each engine runs in a Python of its own.
"""

import json
import sys
import time
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats

REST, OPEN, SHUT, LEFT = 5.0, 2.5, 2.0, 0.5  # [s] at rest; pushing; pushing back; left alone
AFTER = 1.5  # [s] by which a joint waits for those that must be open before it
SAMPLE = 0.25  # [s] between looks at what lies about
SETTLE, ALONE = 1.0, 2.0  # [s] left alone until what may sleep does; then for the speed of that
COAST = 1.0  # [s] in which what the hand lets go comes to rest, with what lies in it, before anything is watched
WIDE = 0.95  # share of its range from which on a joint is held open; what another blocks is let go, or it creeps on
PACE, LEAST = (
    1.0,
    0.2,
)  # [s] in which a hand that meets nothing moves a joint over its range, throwing no drawer open; [m/s, rad/s] its least


class Engine(Protocol):
    """One engine with one stage; joints and loose bodies are those of the plan, in its order."""

    dt: float

    def reset(self) -> None:
        """Put everything back where the stage has it."""

    def step(self, force: Floats) -> None:
        """Advance by `dt` under generalised forces (J,) [N m or N]."""

    def idle(self) -> None:
        """Advance by `dt` and touch nothing: what lies still may sleep, where an engine knows sleep."""

    def positions(self) -> Floats:
        """Return the joints' positions (J,) [rad or m]; nan for a joint that the engine does not have."""

    def poses(self) -> Floats:
        """Return the loose bodies' positions and quaternions (B, 7), x y z then x y z w."""


def run(make: Any) -> None:
    """Run the trial as `python ENGINE.py STAGE PLAN OUT`; `make` builds the adaptor from (stage, plan)."""
    stage, plan_file, out = map(Path, sys.argv[1:4])
    plan = json.loads(plan_file.read_text())
    start = time.process_time()
    engine = make(stage, plan)
    engine.reset()
    engine.step(np.zeros(len(plan["joints"])))
    measurements = {"load": time.process_time() - start, **_trial(engine, plan)}
    out.write_text(json.dumps(measurements))


def _trial(engine: Engine, plan: dict[str, Any]) -> dict[str, Any]:
    joints = plan["joints"]
    push = np.array([j["push"] for j in joints])
    upper = np.array([j["upper"] for j in joints])
    rest, speed = _rest(engine, np.zeros(len(joints)))
    drift = np.abs(engine.positions()) / np.maximum(upper, 1e-9)
    alone = _alone(engine)
    opened, closed, left = (np.full(len(joints), np.nan) for _ in range(3))
    for group in plan["groups"]:
        members, before = np.array(group["joints"], int), np.array(group["before"], int)
        reached, back, stays = _push(engine, push, np.maximum(upper / PACE, LEAST), members, before)
        opened[members], closed[members], left[members] = reached[members], back[members], stays[members]
    engine.reset()
    hand = _Hand(engine, np.maximum(upper / PACE, LEAST))
    together = np.zeros(len(joints))
    for _ in range(round((OPEN + AFTER) / engine.dt)):
        together = np.fmax(together, hand.push(push))
    held = np.where(engine.positions() >= WIDE * upper, push, 0.0)
    for _ in range(round(COAST / engine.dt)):
        engine.step(held)
    wide, _ = _rest(engine, held, fresh=False)
    return {
        "steps_per_second": speed,
        "alone_steps_per_second": alone,
        "drift": drift.tolist(),
        "opened": (opened / upper).tolist(),
        "closed": (closed / upper).tolist(),
        "left": (left / upper).tolist(),
        "together": (together / upper).tolist(),
        "moved_shut": rest,
        "moved_open": wide,
    }


class _Hand:
    """Pushes joints (J,) that move more slowly than `pace` (J,) [rad/s or m/s]."""

    def __init__(self, engine: Engine, pace: Floats) -> None:
        self.engine, self.pace, self.last = engine, pace, engine.positions()
        self.speed = np.zeros_like(pace)

    def push(self, force: Floats) -> Floats:
        """Advance by a step under what of forces (J,) is needed to keep pace; return the positions (J,)."""
        slow = ~(np.sign(force) * self.speed > self.pace)
        self.engine.step(np.where(slow, force, 0.0))
        now = self.engine.positions()
        self.speed, self.last = (now - self.last) / self.engine.dt, now
        return now


def _push(
    engine: Engine, push: Floats, pace: Floats, members: NDArray[np.int64], before: NDArray[np.int64]
) -> tuple[Floats, Floats, Floats]:
    """Return how far joints (J,) come under their push, how far from shut they are after the push back, and when left alone."""
    engine.reset()
    hand = _Hand(engine, pace)
    force = np.zeros(len(push))
    reached = np.zeros(len(push))
    if len(before):
        force[before] = push[before]
        for _ in range(round(AFTER / engine.dt)):
            hand.push(force)
    force[members] = push[members]
    for _ in range(round(OPEN / engine.dt)):
        reached = np.fmax(reached, hand.push(force))
    force[members] = -push[members]
    for _ in range(round(SHUT / engine.dt)):
        hand.push(force)
    back = engine.positions()
    force[members] = 0.0
    for _ in range(round(LEFT / engine.dt)):
        hand.push(force)
    return reached, back, engine.positions()


def _alone(engine: Engine) -> float:
    """Return the steps per second of a home that nobody touches."""
    engine.reset()
    for _ in range(round(SETTLE / engine.dt)):
        engine.idle()
    start = time.process_time()
    steps = round(ALONE / engine.dt)
    for _ in range(steps):
        engine.idle()
    return steps / max(time.process_time() - start, 1e-9)


def _rest(engine: Engine, force: Floats, *, fresh: bool = True) -> tuple[list[list[float]], float]:
    """Return how far each loose body moves [m] and turns [degrees] at most while it is watched, and steps per second."""
    if fresh:
        engine.reset()
    first = engine.poses()
    worst = np.zeros((len(first), 2))
    steps, spent = 0, 0.0
    for _ in range(round(REST / SAMPLE)):
        start = time.process_time()
        for _ in range(round(SAMPLE / engine.dt)):
            engine.step(force)
            steps += 1
        spent += time.process_time() - start
        now = engine.poses()
        if len(now):
            away = np.linalg.norm(now[:, :3] - first[:, :3], axis=1)
            turned = 2 * np.degrees(np.arccos(np.clip(np.abs((now[:, 3:] * first[:, 3:]).sum(axis=1)), 0, 1)))
            worst = np.fmax(worst, np.stack([away, turned], axis=1))
    return worst.tolist(), steps / max(spent, 1e-9)
