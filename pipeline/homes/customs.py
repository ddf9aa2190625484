"""What made homes hold beside their furniture: manifests/calibration/things.yaml."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

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
class WallCustom:
    """How a category hangs: height of its middle [m], chance of one more in a row, furniture that it hangs over or beside."""

    middle: float
    row: float
    over: tuple[str, ...] = ()
    beside: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Customs:
    """Shares and expected numbers by layout type; `furniture` by category of furniture."""

    rugs: Mapping[str, RugCustom]
    windows: Rates
    walls: Rates
    hanging: Mapping[str, WallCustom]
    furniture: Rates
    centred: frozenset[str]
    facing: frozenset[str]
    backed: frozenset[str]

    def categories(self) -> frozenset[str]:
        """Return all categories that homes may hold by these customs."""
        rates = (self.windows, self.walls, self.furniture)
        return frozenset(name for by in rates for wanted in by.values() for name in wanted) | {r.category for r in self.rugs.values()}


@functools.cache
def load() -> Customs:
    """Read the manifest."""
    raw = yaml.safe_load(PATH.read_text(encoding="utf-8"))
    rugs = {kind: _rug(entry) for kind, entry in raw["rugs"].items()}
    hanging = {
        name: WallCustom(entry["middle"], entry["row"], tuple(entry.get("over", ())), tuple(entry.get("beside", ())))
        for name, entry in raw["hanging"].items()
    }
    places = (frozenset(raw[name]) for name in ("centred", "facing", "backed"))
    return Customs(rugs, raw["windows"], raw["walls"], hanging, raw["furniture"], *places)


def _rug(entry: Mapping[str, Any]) -> RugCustom:
    under, across, before = (tuple(entry.get(k, ())) for k in ("under", "across", "before"))
    return RugCustom(entry["category"], entry["share"], under, across, before, entry.get("middle", False))
