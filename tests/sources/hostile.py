"""Files changed by chance, each read within 2 s of processor time and 256 MiB: what became of them, and what they cost.

    python -m tests.sources.hostile [files]

Good files of fifteen kinds are damaged by the generator of the tests (`mutation.py`): bits turned, numbers made absurd, pieces
cut, moved or repeated up to 4 MiB, nested brackets, the end cut off. Nothing is random: file k is the same on every machine.
"""

import sys
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np

from pipeline.execution import cores
from tests.sources import mutation

FILES = 1000
ROUND = 100  # files on disk at a time


def main(count: int) -> None:
    """Make, read, print."""
    outcomes = []
    for start in range(0, count, ROUND):
        with tempfile.TemporaryDirectory() as place:
            outcomes += list(mutation.outcomes(Path(place), range(start, min(start + ROUND, count)), cores()))
    reasons = Counter(reason for _, _, codes, *_ in outcomes for reason in codes)
    changed = [entry for entry in outcomes if entry[1]]
    spent, memory = (np.array([entry[k] for entry in outcomes]) for k in (4, 5))
    print(f"{len(changed)} changed files, {len(outcomes) - len(changed)} good ones among them")
    print(f"good ones read: {sum(not kind and many > 0 for _, kind, _, many, _, _ in outcomes)}")
    print(f"changed ones of which something was read: {sum(many > 0 for _, kind, _, many, _, _ in changed)}")
    print("refused or repaired: " + ", ".join(f"{reason} {times}" for reason, times in reasons.most_common()))
    print(
        f"CPU seconds: {spent.mean():.3f} in the mean, {spent.max():.2f} at most; memory: {memory.mean():.0f} MiB, {memory.max():.0f} at most"
    )
    for folder, kind, codes, _, seconds, mib in outcomes:
        if seconds > 1 or mib > 128 or {"internal", "out_of_time", "out_of_memory", "reader_died"} & set(codes):
            print(f"  {folder.name} {kind}: {', '.join(codes)}, {seconds:.2f} s, {mib:.0f} MiB")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else FILES)
