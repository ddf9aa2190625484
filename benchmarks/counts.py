"""SR(N) for N = 1 to 24: rooms of the held-out split that are asked for exactly N objects.

    python benchmarks/counts.py [rooms]

Needs what `make run` leaves: data/ and models/. For each N so many rooms, evenly spread over those in which N things find floor. Plain: the
layout model told nothing. Guided: told N, its first drafts. First: the same finished. Shipped: the share of rooms that ship, after as many
tries as a room of a home has, and of these the share that holds N.
"""

import os
import sys

os.environ.setdefault("OMP_NUM_THREADS", "1")

from rooms import ROOT, SPLIT, jobs_of

from pipeline import params
from pipeline.experiments.baselines import FLOOR
from pipeline.experiments.settings import spread
from pipeline.experiments.trials import Condition, Drafts, trial
from pipeline.homes.factory import load_factory
from pipeline.metrics.control import quantity

COUNTS = range(1, 25)


def main(rooms: int) -> None:
    """Furnish, count, print."""
    factory = load_factory(ROOT, params.read(ROOT / "params.yaml"), 0)
    jobs = list(jobs_of(SPLIT).values())
    guided, plain = Drafts(factory, factory.sampler.settings.articulation), Drafts(factory, "none")
    print("N     plain  guided  first  shipped  rooms")
    for count in COUNTS:
        asked = spread([job for job in jobs if job.room.area >= FLOOR * count], rooms)
        alone = trial(factory, asked, Condition("plain", "none", count, finished=False), plain)
        made = trial(factory, asked, Condition("guided", count=count), guided)
        sets = (alone.drafted, made.drafted, made.first, made.shipped)
        rates = [quantity(rows["rooms"]).get(str(count), {"rate": 0.0})["rate"] for rows in sets]
        print(f"{count:<5d} " + "  ".join(f"{rate:5.3f}" for rate in rates) + f" of {len(made.shipped['rooms'])}  {len(asked)}", flush=True)


if __name__ == "__main__":
    if not (ROOT / "models" / "denoiser.safetensors").is_file():
        sys.exit("sfgen: there are no trained weights; type `make run` first")
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
