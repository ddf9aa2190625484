"""`sfgen shard`: a dataset of many homes, chunk by chunk, on as many workers as there are; resumes after a kill."""

import shlex
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from pipeline.errors import SfgenError, UsageError
from pipeline.execution import Progress, Voice, cores
from pipeline.homes.factory import open_factory
from pipeline.homes.jit_warmup import warm_up_workers
from pipeline.homes.library import MEMORY
from pipeline.homes.life import Empty
from pipeline.homes.production import FAILURES, Recipe, Tally, fill
from pipeline.homes.prompt_mix import orders, read_order
from pipeline.homes.reproduction import header_of
from pipeline.homes.request import Request
from pipeline.shards import Address, Header, forget_altered, identity, open_or_create, read_header, vouches


def main(
    root: Path,
    *,
    count: int,
    out: str | Path | None = None,
    seed: int = 0,
    workers: int | None = None,
    prompts: Path | None = None,
    scheduler: str | None = None,
    strict: bool = False,
    only: int | None = None,
    memory: int = MEMORY,
    preview: int | None = None,
    voice: Voice = "plain",
) -> int:
    """Fill the folder `out` with `count` homes; returns the exit code: 1 when some could not be made.

    By default, and where `out` is an address (s3://...) to which goes what is committed, the folder is datasets/<seed>. `memory` [MiB] is
    what a worker may take, `preview` [px] the side of the top views, where it is not that of params.yaml; 0: none.
    """
    progress = Progress(count, "homes", voice=voice)
    address = Address(str(out)) if "://" in str(out) else None
    order = read_order(prompts, seed, progress, strict=strict)
    folder = Path("datasets") / str(seed) if address or not out else Path(out)
    progress.say("reading the layout model and the library")
    opened = partial(open_factory, root, seed, memory, preview)
    factory = opened()
    if only is not None:
        return try_one(root, seed, order.wish(only))
    header = header_of(factory, count, order.digest())
    again = shlex.join(["sfgen", "shard", "--count", str(count), "--seed", str(seed), *(["--prompts", str(prompts)] if prompts else [])])
    recipe = Recipe(opened, cache_assets=scheduler is None, digests=factory.digests, versions=header.versions)
    with open_or_create(folder, header, factory.asset_cache, address=address) as dataset:
        where: dict[str, Any] = {"workers": workers or cores(), "scheduler": scheduler}
        if dataset.missing() and not scheduler:
            warm_up_workers(progress, root, opened, where["workers"])
        tally = fill(dataset, recipe, order.wish, **where, strict=strict, progress=progress, again=f"{again} --only {{index}}")
    progress.close()
    return tell(tally, header, str(out if address else folder), progress, voice)


def repair(root: Path, *, folder: Path, prompts: Path | None = None, workers: int | None = None, voice: Voice = "plain") -> int:
    """Make again what is broken or missing of a dataset, its header too, by the checkout that made it; returns the exit code."""
    seed, count = identity(folder)
    factory, progress = open_factory(root, seed), Progress(count, "homes", voice=voice)
    made = [(header_of(factory, count, words), asked) for words, asked in orders(root, seed, prompts)]
    known = [(replace(header, preview=side), asked) for side in (factory.shard.preview, 0) for header, asked in made]
    there = next((header for header, _ in known if vouches(folder, header)), None) or read_header(folder)
    asked = next((asked for header, asked in known if replace(header, preview=there.preview) == there), None)
    if asked is None:
        what = "; ".join(there.differences(known[0][0]))
        raise UsageError(
            f"{folder} was made otherwise than it would be here ({what})", "use its checkout and models, and give its --prompts"
        )
    opened = partial(open_factory, root, seed, MEMORY, there.preview)
    with open_or_create(folder, there, factory.asset_cache) as dataset:
        for name in forget_altered(dataset, FAILURES):
            progress.say(f"{name} is made again")
        recipe = Recipe(opened, digests=factory.digests)
        tally = fill(dataset, recipe, asked, workers=workers or cores(), progress=progress)
    progress.close()
    return tell(tally, there, str(folder), progress, voice)


def try_one(root: Path, seed: int, request: Request) -> int:
    """Make one home of a dataset here and write nothing: shows what goes wrong with it."""
    (outcome,) = open_factory(root, seed).make([request])
    if isinstance(outcome, Empty):
        raise outcome.error
    sys.stdout.write(f"home {request.index} can be made: {len(outcome.home.plan.rooms)} rooms, {len(outcome.home.placements)} things\n")
    return 0


def tell(tally: Tally, header: Header, place: str, progress: Progress, voice: Voice) -> int:
    """Say what the run came to; returns the exit code."""
    lost = sum(map(len, tally.empty.values()))
    if voice == "json":
        figures = {
            "made": tally.homes,
            "resumed": tally.resumed,
            "others": tally.others,
            "retries": tally.retries,
            "cpu_seconds": tally.seconds,
        }
        progress.summary(dataset=place, homes=header.count - lost, **figures, empty={k: len(v) for k, v in tally.empty.items()})
        return 1 if lost else 0
    spent = ", ".join(f"{part} {seconds:.1f}" for part, seconds in sorted(tally.seconds.items(), key=lambda pair: -pair[1]))
    before = f", {tally.resumed} were there before" if tally.resumed else ""
    before += f", {tally.others} made by other commands" if tally.others else ""
    if tally.homes:
        progress.say(f"{tally.homes} made in {progress.seconds:.0f} s{before}, {tally.retries} rooms and homes tried again; CPU s: {spent}")
    for line in tally.lines():
        sys.stderr.write(f"sfgen: {line}\n")
    sys.stdout.write(f"{header.count - lost} homes in {place}\n")
    return SfgenError.exit_code if lost else 0
