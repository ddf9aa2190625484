"""Warming up compiles every kernel of planning, each for one set of types."""

import subprocess
import sys

SCRIPT = """
from pipeline.floorplan import FloorProgram, complete, solve, warm
from pipeline.floorplan.search import anneal
from pipeline.floorplan.search import energy
from pipeline.floorplan.search import grid
from pipeline.floorplan.search import slicing
from pipeline.floorplan.program.floor_program import RoomReq

def signatures():
    every = [f for m in (energy, grid, slicing, anneal) for f in vars(m).values() if hasattr(f, "py_func")]
    return {f"{f.py_func.__module__}.{f.py_func.__name__}": len(f.signatures) for f in every}

warm()
before = signatures()
types = ("entry", "living_room", "kitchen", "wc", "bedroom", "bathroom")
rooms = tuple(RoomReq(id=f"r{i}", type=k, level=int(i > 3)) for i, k in enumerate(types))
solve(complete(FloorProgram(rooms=rooms, storeys=2)), 1)
print([f for f, n in signatures().items() if n > 1 or n != before[f]], before["pipeline.floorplan.search.anneal.anneal"])
"""


def test_warm_compiles_all_that_a_house_needs():
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[] 1"
