"""Live metrics of a training run: plots/loss.csv and DVCLive. Neither git nor network is touched."""

import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from pipeline.diffusion.training import Step

COLUMNS = ("step", "loss", "geometry", "shape", "rate")
Log = Callable[[Step, Mapping[str, Mapping[str, float]]], None]


@contextmanager
def live_log(root: Path, resume: int) -> Iterator[Log]:
    """Yield what writes down a step, and the validation losses as they stand. A resumed run keeps the rows up to the step it goes on from."""
    from dvclive.live import Live

    os.environ.setdefault("DVC_NO_ANALYTICS", "1")
    path = root / "plots" / "loss.csv"
    path.parent.mkdir(parents=True, exist_ok=True)
    before = path.read_text(encoding="utf-8").splitlines() if resume and path.is_file() else []
    kept = [row for row in before if row[:1].isdigit() and int(row.split(",")[0]) <= resume]
    with (
        path.open("w", encoding="utf-8") as file,
        Live(str(root / "dvclive"), resume=bool(resume), save_dvc_exp=False, dvcyaml=None, report=None, monitor_system=False) as live,
    ):

        def log(step: Step, by_level: Mapping[str, Mapping[str, float]]) -> None:
            values = [step.done, round(step.loss, 6), round(step.geometry, 6), round(step.shape, 6), round(step.rate, 8)]
            print(*values, sep=",", file=file, flush=True)
            live.step = step.done
            for name, value in zip(COLUMNS[1:], values[1:], strict=True):
                live.log_metric(f"train/{name}", value, plot=True)
            for level, terms in by_level.items():
                for name, value in terms.items():
                    live.log_metric(f"val/{name}/{level}", value, plot=False)

        print(",".join(COLUMNS), *kept, sep="\n", file=file)
        yield log
