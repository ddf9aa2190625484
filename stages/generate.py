"""`sfgen generate`: one home from words, as a dataset of one with the assets that it uses."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from pipeline.entities.home import Home
from pipeline.execution import single_thread
from pipeline.floorplan import FloorProgram, plan_json, request
from pipeline.floorplan.draw import svg
from pipeline.homes.factory import open_factory
from pipeline.homes.request import Request
from pipeline.manifest import digest
from pipeline.shards import Header, commit_library, commit_shard, gather, open_or_create, require_prompt


def main(root: Path, *, prompt: str, out: Path, seed: int = 0) -> None:
    """Make the home that `prompt` asks for in the folder `out`; a language model reads it where one is configured."""
    asked = require_prompt(prompt)
    program = request(asked)
    single_thread()
    wish = Request(0, asked, program.model_dump_json(exclude_defaults=True))
    factory = open_factory(root, seed)
    header = Header(seed, 1, factory.shard_size, factory.licence, {**factory.digests, "prompts": digest([asked, wish.program])})
    (outcome,) = factory.make([wish])  # before the folder is touched: a request may yet be refused
    used = sorted({p.asset_id for p in outcome.home.placements})
    with open_or_create(out, header) as dataset:
        if dataset.missing():
            commit_library(dataset, lambda folder: factory.write_library(folder, used))
            commit_shard(dataset, 0, gather(0, [(outcome.rows, {**outcome.files, **drawings(outcome.home, program)})]))
    for file in sorted(p for p in out.glob("*/shard-00000/*") if p.is_file()):
        sys.stdout.write(f"{file}\n")


def drawings(home: Home, program: FloorProgram) -> dict[str, bytes]:
    """Return the home's floor plan as JSON and as a drawing."""
    return {
        f"plans/{home.scene_id}.json": (json.dumps(plan_json(home.plan, program), indent=1) + "\n").encode(),
        f"plans/{home.scene_id}.svg": svg(home.plan).encode(),
    }
