"""What a reason code says, from manifests/reasons.yaml: nothing is left out, changed or tried again without one."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from pipeline import params, yaml_text

PATH = Path(__file__).resolve().parents[2] / "manifests" / "reasons.yaml"
Effect = Literal["quarantined", "dropped", "repaired", "tried again", "shipped", "left empty"]


@dataclass(frozen=True, slots=True)
class Reason:
    """One code: which kinds of thing it strikes, what becomes of them, and what it means."""

    what: str
    effect: Effect
    doc: str


def reasons(of: Literal["sources", "homes"]) -> Mapping[str, Reason]:
    """Return the reasons by code that readers of sources have, or the making of homes."""
    rows = yaml_text.parse(PATH.read_text(encoding="utf-8"))[of]
    return {code: params.build(Reason, row, f"{of}.{code}", "manifests/reasons.yaml") for code, row in rows.items()}
