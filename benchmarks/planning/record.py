"""Figures that are too dear for `make run`: kept under benchmarks/records/ with the command and the commit that made them, for the report to show."""

import json
import subprocess
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
RECORDS = ROOT / "benchmarks" / "records"


@cache
def commit() -> str:
    """Return the commit whose code is measured, with "-dirty" behind it where tracked files differ; "unknown" without git."""
    command = ["git", "describe", "--always", "--dirty", "--abbrev=12", "--exclude=*"]
    try:
        return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def read(name: str) -> dict[str, Any]:
    """Return what stands in benchmarks/records/`name`, nothing where there is no such file."""
    path = RECORDS / name
    record: dict[str, Any] = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    return record


def write(name: str, figures: Mapping[str, Any]) -> None:
    """Write benchmarks/records/`name`."""
    (RECORDS / name).write_text(json.dumps(figures, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def with_provenance(what: str, count: int, figures: Any) -> dict[str, Any]:
    """Return figures of one measurement with the command and the commit that made them."""
    return {"command": f"python -m benchmarks.plan {what} --count {count}", "commit": commit(), "figures": figures}


def keep(what: str, count: int, figures: Any) -> None:
    """Put the figures of one measurement into benchmarks/records/planning.json, beside those of the others."""
    write("planning.json", read("planning.json") | {what: with_provenance(what, count, figures)})
