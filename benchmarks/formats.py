"""How far MJCF, URDF and GLB stand off the USD stages that they were exported from, what they cost, and whether MuJoCo can step them.

    python benchmarks/formats.py [homes]

Exports homes of data/shards/ to a temporary folder and reads every file again as the tests do (tests/export/readings.py).
"""

import sys
import tempfile
import time
from collections import defaultdict
from pathlib import Path

import sfgen
from pipeline.export import ExportFolder, export_home
from tests.export.readings import READERS, deviations, from_usd, steps

ROOT = Path(__file__).resolve().parents[1]
HOMES = 8
SECONDS = 1.0  # that each home is stepped


def main(count: int) -> None:
    """Export, read again, compare, step; print figures."""
    homes = sfgen.load(ROOT / "data" / "shards")[:count]
    with tempfile.TemporaryDirectory() as place:
        for form, reader in READERS.items():
            folder = ExportFolder(Path(place) / form, form, "benchmark", homes.header["licence"])
            worst: dict[str, float] = defaultdict(float)
            spent, bodies, joints = 0.0, 0, 0
            for home in homes:
                before, usd = time.process_time(), Path(str(home.usd))
                path = export_home(folder, usd, home.scene_id)
                spent += time.process_time() - before
                stage = from_usd(usd)
                bodies, joints = bodies + len(stage.bodies), joints + len(stage.joints)
                for key, value in deviations(stage, reader(path)).items():
                    worst[key] = max(worst[key], value)
            size = sum(p.stat().st_size for p in folder.path.rglob("*") if p.is_file()) / 1e6
            print(
                f"{form}: {len(homes)} homes, {bodies} bodies, {joints} joints; {spent / len(homes):.1f} CPU s and {size / len(homes):.1f} MB a home"
            )
            print("  largest difference from USD: " + ", ".join(f"{key} {value:.1e}" for key, value in worst.items()))
        for home in homes:
            cost, turned, moved = steps(Path(place) / f"mjcf/homes/{home.scene_id}/{home.scene_id}.xml", SECONDS)
            print(
                f"{home.scene_id}: {cost:.2f} CPU ms a step; after {SECONDS:g} s no joint has moved more than {turned:.4f}, nothing more than {moved:.3f} m"
            )


if __name__ == "__main__":
    if not (ROOT / "data" / "shards").is_dir():
        sys.exit("sfgen: there is no data/shards; type `make run` first")
    main(int(sys.argv[1]) if len(sys.argv) > 1 else HOMES)
