"""What holds a joint back: damping, dry friction, the inertia of its works, the spring behind a button.

Nothing here needs a drive's largest force, which PhysX does not keep to in articulations: a detent made of one holds a
door half open there. What gravity would pull open is held by friction, which PhysX, Newton and MuJoCo read alike.
"""

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
BUTTON = 0.6  # [N] of a button's spring when it is pressed down, ...
SAG = 0.03  # ... and at most this share of its way down it lies by its own weight; springs rest at 0: Newton takes no target beyond a limit


@dataclass(frozen=True, slots=True)
class Resistance:
    """`damping` [N m s/rad or N s/m], `friction` [N m or N], `armature` [kg m2 or kg], a spring's `stiffness` [N/m]; `inertia` is what all of it holds, works included."""

    damping: float
    friction: float
    armature: float
    inertia: float
    stiffness: float = 0.0


def resistance(asset: Asset, joint_index: int) -> Resistance:
    """Choose what holds a joint back, after what it moves."""
    joint = asset.joints[joint_index]
    links = [asset.links[i] for i in moved_links(asset, joint_index)]
    mass = sum(link.mass for link in links)
    load = max(0.0, gravity_load(asset, joint_index))
    if joint.type == "prismatic":
        if joint.part_class == "slider_button" and 0 < joint.upper < np.inf:
            stiffness = max(BUTTON, load / SAG) / joint.upper
            # As fast as may be without swinging: a lever that bobs for two seconds keeps a whole kitchen awake.
            damping = 2 * float(np.sqrt(stiffness * (mass + SLIDE_ARMATURE)))
            return Resistance(damping, 0.0, SLIDE_ARMATURE, mass + SLIDE_ARMATURE, stiffness)
        damping = min(SLIDE_DAMPING, DECAY * (mass + SLIDE_ARMATURE))
        return Resistance(damping, min(SLIDE_FRICTION, SLIDE_DRAG * GRAVITY * mass) + HOLD * load, SLIDE_ARMATURE, mass + SLIDE_ARMATURE)
    away = [link.com - joint.origin for link in links]
    arms = [r - (r @ joint.axis) * joint.axis for r in away]
    inertia = sum(float(joint.axis @ k.inertia @ joint.axis + k.mass * (r @ r)) for k, r in zip(links, arms, strict=True))
    torque = GRAVITY * float(np.linalg.norm(sum((k.mass * r for k, r in zip(links, arms, strict=True)), np.zeros(3))))
    inertia += HINGE_ARMATURE
    damping = min(HINGE_DAMPING, DECAY * inertia)
    return Resistance(damping, min(HINGE_FRICTION, HINGE_DRAG * torque) + HOLD * load, HINGE_ARMATURE, inertia)
