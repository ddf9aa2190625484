"""What holds a joint back: damping, dry friction, the inertia of its works, the spring behind a button.

Nothing here needs a drive's largest force, which PhysX does not keep to in articulations: a detent made of one holds a
door half open there. What gravity would pull open is held by friction, which PhysX, Newton and MuJoCo read alike.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pipeline.entities.asset import Asset
from pipeline.geometry.kinematics import moved_links
from pipeline.usd.physics import GRAVITY, gravity_load

DECAY = 4.0  # [1/s] by which a light part left to itself slows down
HINGE_DAMPING, SLIDE_DAMPING = 1.15, 12.0  # at most: a cupboard door's [N m s/rad], a drawer's on its rails [N s/m]
HINGE_DRAG, SLIDE_DRAG = 0.1, 0.05  # dry friction: shares of what weight does to the arm of a hinge, of the weight on a rail
HINGE_FRICTION, SLIDE_FRICTION = 0.1, 1.5  # ... at most [N m, N]: a push opens a door, a touch does not
HOLD = 1.3  # dry friction on top, in multiples of what gravity does to a closed flap or lid, so that it stays closed
# Inertia of the works behind knobs and buttons [kg m2, kg]: nothing beside a door's own, but it keeps feathers from racing.
HINGE_ARMATURE, SLIDE_ARMATURE = 0.002, 0.05
BUTTON = 0.3  # [N] with which a button's spring lies at its stop; twice as much when it is pressed down


@dataclass(frozen=True, slots=True)
class Resistance:
    """`damping` [N m s/rad or N s/m], `friction` [N m or N], `armature` [kg m2 or kg]; a spring of `stiffness` [N/m] at rest at `target` [m]."""

    damping: float
    friction: float
    armature: float
    stiffness: float = 0.0
    target: float = 0.0


def resistance(asset: Asset, joint_index: int) -> Resistance:
    """Choose what holds a joint back, after what it moves."""
    joint = asset.joints[joint_index]
    links = [asset.links[i] for i in moved_links(asset, joint_index)]
    mass = sum(link.mass for link in links)
    held = HOLD * max(0.0, gravity_load(asset, joint_index))
    if joint.type == "prismatic":
        damping = min(SLIDE_DAMPING, DECAY * (mass + SLIDE_ARMATURE))
        if joint.part_class == "slider_button" and 0 < joint.upper < np.inf:
            return Resistance(damping, 0.0, SLIDE_ARMATURE, (BUTTON + held) / joint.upper, -joint.upper)
        return Resistance(damping, min(SLIDE_FRICTION, SLIDE_DRAG * GRAVITY * mass) + held, SLIDE_ARMATURE)
    away = [link.com - joint.origin for link in links]
    arms = [r - (r @ joint.axis) * joint.axis for r in away]
    inertia = sum(float(joint.axis @ k.inertia @ joint.axis + k.mass * (r @ r)) for k, r in zip(links, arms, strict=True))
    torque = GRAVITY * float(np.linalg.norm(sum((k.mass * r for k, r in zip(links, arms, strict=True)), np.zeros(3))))
    damping = min(HINGE_DAMPING, DECAY * (inertia + HINGE_ARMATURE))
    return Resistance(damping, min(HINGE_FRICTION, HINGE_DRAG * torque) + held, HINGE_ARMATURE)
