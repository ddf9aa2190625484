"""Live metrics of a training run: plots/loss.csv always, DVCLive where it is installed. Neither git nor network is touched."""

import csv
import importlib.util
import os
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from pipeline.diffusion.training import Step

COLUMNS = ("step", "loss", "geometry", "shape", "rate")


class LiveLog:
    """Appends to plots/loss.csv, and tells DVCLive. A resumed run keeps the rows up to the step it goes on from."""

    def __init__(self, root: Path, resume: int = 0) -> None:
        self.path, self.resume, self.folder = root / "plots" / "loss.csv", resume, root / "dvclive"
        self.live: Any = None

    def __enter__(self) -> Self:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        kept = [row for row in _rows(self.path) if int(row[0]) <= self.resume] if self.resume else []
        self.file = self.path.open("w", newline="", encoding="utf-8")
        self.writer = csv.writer(self.file, lineterminator="\n")
        self.writer.writerows([COLUMNS, *kept])
        if importlib.util.find_spec("dvclive"):
            from dvclive.live import Live

            os.environ.setdefault("DVC_NO_ANALYTICS", "1")
            self.live = Live(
                str(self.folder), resume=bool(self.resume), save_dvc_exp=False, dvcyaml=None, report=None, monitor_system=False
            )
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.file.close()
        if self.live is not None:
            self.live.end()

    def step(self, step: Step, by_level: dict[str, dict[str, float]]) -> None:
        """Write one row, and the validation losses as they stand."""
        values = [step.done, round(step.loss, 6), round(step.geometry, 6), round(step.shape, 6), round(step.rate, 8)]
        self.writer.writerow(values)
        self.file.flush()
        if self.live is None:
            return
        self.live.step = step.done
        for name, value in zip(COLUMNS[1:], values[1:], strict=True):
            self.live.log_metric(f"train/{name}", value, plot=True)
        for level, terms in by_level.items():
            for name, value in terms.items():
                self.live.log_metric(f"val/{name}/{level}", value, plot=False)


def _rows(path: Path) -> list[list[str]]:
    if not path.is_file():
        return []
    with path.open(newline="", encoding="utf-8") as handle:
        return [row for row in csv.reader(handle) if row and row[0].isdigit()]
