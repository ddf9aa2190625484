"""What articulated objects cost to read: CPU seconds of each, over made ones of several categories and of up to 300,000 triangles; and the memory of the process.

    python benchmarks/articulated.py [objects]

Real PartNet-Mobility objects cannot be put here: these are made in the same way (tests/sources/mobility.py). A run on another
checkout, as `PYTHONPATH=<it> python benchmarks/articulated.py`, compares.
"""

from __future__ import annotations

import resource
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from pipeline.sources.articulated.objects import Found
from pipeline.sources.articulated.source import ObjectTask, read_object
from pipeline.sources.settings import ModelLimits
from tests.sources import mobility

OBJECTS = 60
TRIANGLES = (5_000, 20_000, 60_000, 150_000, 300_000)  # of an object, by turns
TWICE = 1.6  # by what drawing faces from both sides makes them more
LICENCE = "CC0-1.0"


def triangles(folder: Path) -> int:
    """Return how many triangles the meshes of an object have."""
    return sum(path.read_text(encoding="utf-8").count("\nf ") for path in (folder / "textured_objs").glob("*.obj"))


def main(count: int) -> None:
    """Make objects, read each, and print what it cost."""
    spent, lost = [], 0
    with tempfile.TemporaryDirectory() as place:
        source = Path(place) / "partnet"
        names = sorted(mobility.MAKERS)
        for k in range(count):
            category = names[k % len(names)]
            make = mobility.MAKERS[category]
            rng = np.random.default_rng(k)
            four = sum(len(faces) for link in make(rng, n=4) for _, faces in link.meshes) * TWICE
            fine = max(1, round(4 * np.sqrt(TRIANGLES[k // len(names) % len(TRIANGLES)] / four)))
            folder = mobility.write(source, f"{k:05d}", category, make(rng, n=fine), k)
            found = Found(folder.name, folder.name)
            children = resource.getrusage(resource.RUSAGE_CHILDREN)
            start = time.process_time()
            made = read_object(ObjectTask(source, Path(place) / "assets", ModelLimits(), LICENCE), found)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            spent.append(time.process_time() - start + after.ru_utime + after.ru_stime - children.ru_utime - children.ru_stime)
            lost += not made.assets
            said = ", ".join(sorted({row["reason"] for row in made.rejects}))
            print(f"{category:18} {triangles(folder):7} triangles {spent[-1]:7.2f} CPU s  {len(made.assets)} assets  {said}", flush=True)
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        print(f"{count} objects: {np.mean(spent):.2f} CPU s in the mean, {max(spent):.2f} at most; {lost} refused; peak {peak:.0f} MiB")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else OBJECTS)
