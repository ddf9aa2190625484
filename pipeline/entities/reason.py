"""What a reason code says: nothing is left out, changed or tried again without one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Effect = Literal["quarantined", "dropped", "repaired", "tried again", "left empty"]


@dataclass(frozen=True, slots=True)
class Reason:
    """One code: which kinds of thing it strikes, what becomes of them, and what it means."""

    what: str
    effect: Effect
    doc: str
