"""What made homes hold beside their furniture: by room in manifests/calibration/things.yaml, by thing on the categories' cards."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pipeline import yaml_text
from pipeline.card import Hangs, cards

PATH = Path(__file__).resolve().parents[2] / "manifests" / "calibration" / "things.yaml"
Rates = Mapping[str, Mapping[str, float]]


@dataclass(frozen=True, slots=True)
class RugCustom:
    """A rug of `category` lies in a `share` of rooms: under, across the foot of, or before one of these; or in the middle."""

    category: str
    share: float
    under: tuple[str, ...] = ()
    across: tuple[str, ...] = ()
    before: tuple[str, ...] = ()
    middle: bool = False


@dataclass(frozen=True, slots=True)
class Customs:
    """Shares and expected numbers by layout type; `furniture` by category of furniture."""

    rugs: Mapping[str, RugCustom]
    windows: Rates
    walls: Rates
    hanging: Mapping[str, Hangs]
    furniture: Rates

    def categories(self) -> frozenset[str]:
        """Return all categories that homes may hold by these customs."""
        rates = (self.windows, self.walls, self.furniture)
        return frozenset(name for by in rates for wanted in by.values() for name in wanted) | {r.category for r in self.rugs.values()}


@functools.cache
def load() -> Customs:
    """Read the manifest and the cards."""
    raw, known = yaml_text.parse(PATH.read_text(encoding="utf-8")), cards()
    rugs = {kind: _rug(entry) for kind, entry in raw["rugs"].items()}
    hanging = {name: c.hangs for name, c in known.items() if c.hangs}
    furniture = {name: c.holds for name, c in known.items() if c.holds}
    return Customs(rugs, raw["windows"], raw["walls"], hanging, furniture)


def _rug(entry: Mapping[str, Any]) -> RugCustom:
    under, across, before = (tuple(entry.get(k, ())) for k in ("under", "across", "before"))
    return RugCustom(entry["category"], entry["share"], under, across, before, entry.get("middle", False))
