"""`sfgen generate`: one home from words, or in a plan of the user's own, as a dataset of one with the assets that it uses."""

import json
import sys
from dataclasses import asdict
from pathlib import Path

from pipeline.entities.home import Home
from pipeline.execution import Progress, Voice, single_thread
from pipeline.execution.progress import listen
from pipeline.floorplan import FloorProgram, describe, plan_json, request
from pipeline.floorplan.draw.drawing import svg
from pipeline.floorplan.imports import describe_repairs, program_of, read_own
from pipeline.floorplan.program.description import assumptions, notes
from pipeline.floorplan.prompt import require_understood
from pipeline.floorplan.wishes import with_wishes
from pipeline.homes.empty_plan import require_sound
from pipeline.homes.factory import open_factory
from pipeline.homes.furniture_report import deliveries, report
from pipeline.homes.jit_warmup import warm_up
from pipeline.homes.life import Empty
from pipeline.homes.reproduction import header_of
from pipeline.homes.request import Request
from pipeline.manifest import digest
from pipeline.shards import add_part, commit_shard, gather, open_or_create, require_prompt


def main(
    root: Path,
    *,
    out: Path,
    prompt: str = "",
    seed: int = 0,
    source: Path | None = None,
    house: str | None = None,
    strict: bool = False,
    voice: Voice = "plain",
) -> None:
    """Make the home that `prompt` asks for, or the one of the plan in `source`, in the folder `out`.

    A language model reads the prompt where one is configured.
    """
    program, wish, repairs = (
        asked_in_words(prompt, strict=strict) if source is None else asked_by_plan(root, source, house, prompt, strict=strict)
    )
    single_thread()
    progress = Progress(1, "home", voice=voice)
    progress.phase("reading the layout model and the library")
    factory = open_factory(root, seed)
    header = header_of(factory, 1, digest([wish.prompt, wish.program, wish.plan]))
    warm_up(progress, root)
    listen(lambda note: progress.phase(note[0]))
    (outcome,) = factory.make([wish])  # before the folder is touched: a request may yet be refused
    listen(None)
    if isinstance(outcome, Empty):
        raise outcome.error
    with open_or_create(out, header, factory.asset_cache) as dataset:
        if dataset.missing():
            progress.phase("writing the assets")
            assumed = assumptions(program) if source is None else []
            files = {**outcome.files, **drawings(outcome.home, program, repairs, assumed)}
            add_part(dataset, 0, gather(0, outcome.rows, files))
            commit_shard(dataset, 0)
    progress.close()
    styles = {p.asset_id: str(factory.library.rows[p.asset_id]["style"]) for p in outcome.home.placements}
    delivered = deliveries(FloorProgram.model_validate_json(outcome.home.program), outcome.rows, styles)
    written = [str(p) for p in sorted(out.glob("*/shard-00000/*")) if p.is_file()]
    if voice == "json":
        progress.summary(scene_id=outcome.home.scene_id, files=written, deliveries=[asdict(d) for d in delivered], repairs=repairs)
        return
    sys.stdout.write(report(delivered))
    sys.stderr.write(notes(program, assumptions(program) if source is None else []))
    sys.stdout.write(describe_repairs(repairs))
    for file in written:
        sys.stdout.write(f"{file}\n")


def asked_in_words(prompt: str, *, strict: bool = False) -> tuple[FloorProgram, Request, list[dict[str, str]]]:
    """Return the program and the request of a prompt."""
    asked = require_prompt(prompt)
    program = request(asked, strict=strict)
    return program, Request(0, asked, program.model_dump_json(exclude_defaults=True)), []


def asked_by_plan(
    root: Path, source: Path, house: str | None, prompt: str, *, strict: bool = False
) -> tuple[FloorProgram, Request, list[dict[str, str]]]:
    """Return the program and the request of a plan of the user's own, and what was repaired in it; `prompt` wishes for furniture."""
    own = require_sound(root, read_own(source, house))
    program = program_of(own.plan)
    if prompt:
        program = require_understood(with_wishes(program, require_prompt(prompt)), strict=strict)
    document = json.dumps(plan_json(own.plan))
    return program, Request(0, prompt or describe(program), program.model_dump_json(exclude_defaults=True), document), own.repairs_json()


def drawings(home: Home, program: FloorProgram, repairs: list[dict[str, str]], assumed: list[dict[str, str]]) -> dict[str, bytes]:
    """Return the home's floor plan as JSON and as a drawing."""
    return {
        f"plans/{home.scene_id}.json": (json.dumps(plan_json(home.plan, program, repairs, assumed), indent=1) + "\n").encode(),
        f"plans/{home.scene_id}.svg": svg(home.plan).encode(),
    }
