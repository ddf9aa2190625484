"""How fast houses of the embedded corpus are written, how large they are, and how alike.

    python benchmarks/corpus.py [houses] [seed]

Prints CPU seconds and bytes a house, the same for 5,000 houses, how many of the houses are the same as another one, and how much of
the calibration is met. Writes nothing that stays.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from pipeline.corpus.calibration import figures
from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.corpus.house_files import write_houses
from pipeline.corpus.houses import corruption
from pipeline.corpus.settings import CorpusSettings
from pipeline.manifest import digest

HOUSES, WANTED = 500, 5000
MOST_SECONDS, MOST_BYTES = 600.0, 400_000


def key(text: str) -> str:
    """Return a digest of a house's floors and of what stands where, without ids."""
    tree = json.loads(text)
    floors = [mesh["xyz"] for mesh in tree["mesh"] if mesh["type"] == "Floor"]
    jids = {record["uid"]: record["jid"] for record in tree["furniture"] if record.get("valid")}
    placed = [(jids[c["ref"]], c["pos"]) for room in tree["scene"]["room"] for c in room["children"] if c["ref"] in jids]
    return digest([floors, placed])


def main(houses: int, seed: int) -> None:
    """Write, weigh, compare."""
    settings = CorpusSettings(houses, 1.0, corruption=True)
    models = catalogue(seed, settings.models).future
    with tempfile.TemporaryDirectory() as folder:
        start = time.process_time()
        tallies = write_houses(Path(folder), seed, settings, range(houses))
        seconds = (time.process_time() - start) / houses
        files = sorted(Path(folder).glob("*.json"))
        sizes = [file.stat().st_size for file in files]
        seen = Counter(key(file.read_text(encoding="utf-8")) for file in files)
    found = figures.calibration(tallies, models, len(corruption.in_centimetres(seed, models)))
    lines = [entry["ok"] for _, _, entry in figures.table(found)]
    print(f"{houses} houses of seed {seed}: {seconds:.3f} CPU s each; {WANTED} in {seconds * WANTED:.0f} of {MOST_SECONDS:.0f} CPU s")
    print(f"{sum(sizes) / len(sizes) / 1000:.0f} KB each, the largest {max(sizes) / 1000:.0f} of {MOST_BYTES / 1000:.0f} KB")
    print(f"{sum(n - 1 for n in seen.values())} houses the same as another in plan and placement")
    print(f"calibration: {sum(lines)} of {len(lines)} figures as in 3D-FRONT")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else HOUSES, int(sys.argv[2]) if len(sys.argv) > 2 else 0)
