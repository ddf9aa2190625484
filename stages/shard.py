"""`sfgen shard`: a dataset of many homes, shard by shard, on as many workers as there are; resumes after a kill."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path

from pipeline.execution import map_shards, track
from pipeline.floorplan import request
from pipeline.homes.factory import open_factory
from pipeline.homes.request import Request
from pipeline.manifest import digest
from pipeline.shards import Header, Mix, ShardContent, commit_library, commit_shard, gather, open_or_create, read_mix

Job = tuple[int, tuple[Request, ...]]  # the shard's number, and what each of its homes is asked to be


def main(
    root: Path,
    *,
    count: int,
    out: Path | None = None,
    seed: int = 0,
    workers: int = 1,
    prompts: Path | None = None,
    scheduler: str | None = None,
) -> None:
    """Fill the folder `out` (by default datasets/<seed>) with `count` homes."""
    mix = read_mix(prompts) if prompts else Mix()
    programs = {asked: request(asked).model_dump_json(exclude_defaults=True) for asked in mix.prompts}  # refused now, not after hours
    factory = open_factory(root, seed)
    header = Header(seed, count, factory.shard_size, factory.licence, {**factory.digests, "prompts": digest([mix.digest(), programs])})
    with open_or_create(out or Path("datasets") / str(seed), header) as dataset:
        commit_library(dataset, factory.write_library)
        missing = dataset.missing()
        jobs = ((n, (n, requests(mix, programs, seed, header.indices(n)))) for n in missing)
        done = map_shards(
            partial(make_shard, root, seed), jobs, digest=digest(header.to_json()), workers=min(workers, len(missing)), scheduler=scheduler
        )
        total = sum(len(header.indices(n)) for n in missing)
        for number, content in track(done, total, "homes", size=lambda pair: len(header.indices(pair[0]))):
            commit_shard(dataset, number, content)
        sys.stdout.write(f"{count} homes in {dataset.folder}\n")


def requests(mix: Mix, programs: Mapping[str, str], seed: int, indices: range) -> tuple[Request, ...]:
    """Return what each home is asked to be: its words, and the program that was read from them (none: one of the prior)."""
    words = ((index, mix.prompt(seed, index)) for index in indices)
    return tuple(Request(index, asked, programs.get(asked, "")) for index, asked in words)


def make_shard(root: Path, seed: int, job: Job) -> ShardContent:
    """Make one shard: the step that workers run, in batches of a chunk."""
    number, asked = job
    factory = open_factory(root, seed)
    return gather(number, ((o.rows, o.files) for chunk in chunks(asked, factory.chunk) for o in factory.make(chunk)))


def chunks(asked: tuple[Request, ...], size: int) -> Iterator[tuple[Request, ...]]:
    """Cut a shard's requests into the batches that are sampled together."""
    return (asked[i : i + size] for i in range(0, len(asked), size))
