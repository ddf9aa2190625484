"""Masses and inertias that other people's URDFs state, and what is wrong with them: many are placeholders."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pipeline.arrays import Floats
from pipeline.sources.densities import KINDS, MATERIALS

LIGHTEST = min(*MATERIALS.values(), *KINDS.values()) / 4  # [kg/m3] of matter: the volumes are estimates as well
DENSEST = max(*MATERIALS.values(), *KINDS.values()) * 3
AWAY = 0.1  # share of its body's diagonal by which a centre of mass may lie outside of its box
ROUNDED = 1.01  # factor by which rounded moments may miss what they are bound by


@dataclass(frozen=True, slots=True)
class Inertial:
    """`mass` [kg], `centre` (3,) of mass, `inertia` (3, 3) [kg units2] about it along the frame's axes; nan where none can be read."""

    mass: float
    centre: Floats
    inertia: Floats

    def moved(self, T: Floats) -> Inertial:
        """Return the same under the rigid motion T (4, 4)."""
        R = T[:3, :3]
        return Inertial(self.mass, R @ self.centre + T[:3, 3], R @ self.inertia @ R.T)

    def scaled(self, shift: Floats, factor: float) -> Inertial:
        """Return the same moved by -`shift` (3,), then of a body scaled by `factor`, its mass kept."""
        return Inertial(self.mass, (self.centre - shift) * factor, self.inertia * factor**2)


def combine_inertials(pieces: Sequence[Inertial]) -> Inertial:
    """Return what bodies that are fixed to each other are together (parallel axis theorem)."""
    mass = sum(p.mass for p in pieces)
    centre = np.asarray(sum(p.mass * p.centre for p in pieces) / (mass or np.nan))
    inertia = np.zeros((3, 3))
    for piece in pieces:
        r = piece.centre - centre
        inertia = inertia + piece.inertia + piece.mass * (float(r @ r) * np.eye(3) - np.outer(r, r))
    return Inertial(mass, centre, inertia)


def mass_flaw(mass: float, volume: float) -> str:
    """Return what is wrong with the mass [kg] of a body of `volume` [m3] of matter, "" for nothing."""
    if not np.isfinite(mass):
        return "is not finite, or no number"
    if mass <= 0:
        return f"has a mass of {mass:g} kg"
    density = mass / max(volume, 1e-12)
    return "" if LIGHTEST <= density <= DENSEST else f"means {density:.4g} kg/m3"


def inertia_flaw(stated: Inertial, low: Floats, high: Floats) -> str:
    """Return what is wrong with centre and moments of a body [m] whose box runs from `low` to `high` (3,), "" for nothing.

    Moments must be positive, none larger than the other two together, and no larger than those of the same mass in the
    corners of the box.
    """
    if not (np.isfinite(stated.centre).all() and np.isfinite(stated.inertia).all()):
        return "is not finite, or no number"
    moments = np.linalg.eigvalsh(stated.inertia)
    span = float(np.linalg.norm(high - low))
    outside = (stated.centre < low - AWAY * span).any() or (stated.centre > high + AWAY * span).any()
    checks = (
        (moments[0] <= 0, f"has a moment of {moments[0]:.3g} kg m2"),
        (moments[2] > ROUNDED * (moments[0] + moments[1]), f"has moments {np.round(moments, 6).tolist()}, one larger than the other two"),
        (
            moments[2] > ROUNDED * stated.mass * span**2 / 4,
            f"has a moment of {moments[2]:.3g} kg m2, {stated.mass:g} kg within {span:.2f} m",
        ),
        (outside, "has its centre outside of the body"),
    )
    return next((what for wrong, what in checks if wrong), "")
