"""Where the colliders of a dataset's homes are: `python benchmarks/colliders.py [DATASET]`.

By building, doors of rooms, and the objects' categories; of objects also by what a link is: a base, what moves by which kind of joint,
furniture that does not open, small things. What is switched off in a home is not counted.
"""

import sys
from collections import Counter
from pathlib import Path

from pxr import Usd, UsdPhysics

ROOT = Path(__file__).resolve().parents[1]


def main() -> None:
    """Count, print two tables and the mean."""
    dataset = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "data" / "shards"
    stages = sorted((dataset / "usd").glob("*/*.usdc"))
    by_source: Counter[str] = Counter()
    by_link: Counter[str] = Counter()
    of_home = []
    for path in stages:
        stage = Usd.Stage.Open(str(path))
        pieces = [prim for prim in stage.Traverse() if prim.HasAPI(UsdPhysics.CollisionAPI)]
        of_home.append(len(pieces))
        for prim in pieces:
            group, name = (p.name for p in prim.GetPath().GetPrefixes()[1:3])
            if group == "Objects":
                root = stage.GetPrimAtPath(f"/World/Objects/{name}")
                by_source[root.GetAttribute("semantics:labels:class").Get()[0]] += 1
                by_link[kind_of(prim, root)] += 1
            else:
                by_source[f"/{group} {prim.GetName().rstrip('0123456789_')}"] += 1
    for title, table in (("by source", by_source), ("of objects, by link", by_link)):
        print(f"{title}, a home:")
        for key, count in table.most_common():
            print(f"  {count / len(stages):7.2f}  {key}")
    print(f"{len(stages)} homes, {sum(of_home) / len(stages):.1f} colliders each ({min(of_home)} to {max(of_home)})")


def kind_of(prim: Usd.Prim, root: Usd.Prim) -> str:
    """Return what a collider of an object is of: the kind of what moves, "base" of what opens, "still" furniture, or "loose"."""
    body = prim
    while body != root and not body.HasAPI(UsdPhysics.RigidBodyAPI):
        body = body.GetParent()
    if body == root:
        return "still"
    part = body.GetAttribute("semantics:labels:part")
    return str(part.Get()[0]) if part else "base" if root.HasAPI(UsdPhysics.ArticulationRootAPI) else "loose"


if __name__ == "__main__":
    main()
