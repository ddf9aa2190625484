"""Fills a dataset, alone or beside other commands: chunks of homes on workers, put aside as they come, joined to shards; what cannot be made is accounted for."""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
import time
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

from pipeline import tables
from pipeline.errors import ContentError, SfgenError
from pipeline.execution import Lost, Progress, map_divisible
from pipeline.homes.factory import Factory, forget_factory
from pipeline.homes.life import Empty, Outcome
from pipeline.homes.planning import PlannedHome
from pipeline.homes.reproduction import made_with
from pipeline.homes.request import Request
from pipeline.homes.rows import BEST
from pipeline.shards import (
    EMPTY,
    TABLES,
    Dataset,
    HomeContent,
    add_part,
    commit_shard,
    gather,
    shard_name,
)
from pipeline.shards.commits import read_commit
from pipeline.shards.layout import table_path
from pipeline.shards.parts import Part, part_place, parts_there

LEAST = 4  # homes of a chunk: fewer fill the sampler's batches badly
WAIT = 0.5  # seconds between two looks at what other commands have done
# Reasons that are the factory's or the machine's, not the home's: worth another try.
FAILURES = frozenset({"internal", "shard_deadline", "worker_lost"})
SPARE = 16 << 20  # bytes of disk below which an unknown error is taken for a full disk


@dataclass(frozen=True, slots=True)
class Chunk:
    """The unit of work: some consecutive homes of a shard. They stay empty where it is `overdue`: the shard has had its time."""

    shard: int
    requests: tuple[Request, ...]
    overdue: bool = False

    def pieces(self) -> list[Chunk]:
        """Return a chunk for each home."""
        return [replace(self, requests=(request,)) for request in self.requests]

    def __str__(self) -> str:
        return f"homes {self.requests[0].index} to {self.requests[-1].index} of {shard_name(self.shard)}"


@dataclass(frozen=True, slots=True)
class Batch:
    """A chunk that is made: each home, those that could not be made, CPU seconds by part, and rooms and homes that were tried again."""

    homes: tuple[HomeContent, ...]
    empties: tuple[Empty, ...]
    seconds: Mapping[str, float]
    retries: int


@dataclass(frozen=True, slots=True)
class Recipe:
    """What a worker needs to make chunks: how to open the factory, and the first drafts, where a stage has made them.

    With `cache_assets` it also puts the assets into its machine's cache, from which the dataset takes them. `digests` are what the dataset
    says that homes are made of: a worker that has loaded something else loads again, or refuses. `versions` are those of what computes: a worker
    with others refuses.
    """

    opened: Callable[[], Factory]
    drafts: Callable[[Factory, Sequence[Request]], list[PlannedHome]] | None = None
    cache_assets: bool = True
    digests: Mapping[str, str] = field(default_factory=dict)
    versions: Mapping[str, str] = field(default_factory=dict)

    def factory(self) -> Factory:
        """Open the factory that the dataset is to be made with. Raises ContentError where there is another."""
        factory, here = self.opened(), made_with() if self.versions else {}
        if other := [f"{name} {here.get(name)}, not {value}" for name, value in self.versions.items() if here.get(name) != value]:
            raise ContentError(
                f"a worker has other versions than the command ({'; '.join(other)})", "give it the same; workers of Dask need a nanny"
            )
        if stale := self._others(factory):
            forget_factory()
            factory = self.opened()
            if "code" in stale or (stale := self._others(factory)):  # code that is loaded stays
                raise ContentError(
                    f"a worker has other {', '.join(stale)} than the command",
                    "give it the same checkout, models and data, and start it again",
                )
        return factory

    def _others(self, factory: Factory) -> list[str]:
        return sorted(name for name, value in self.digests.items() if factory.digests.get(name) != value)


@dataclass
class Tally:
    """What a run came to: homes made and found impossible, those that were there before or that other commands made. `empty` lists, by reason, every home of the dataset that stays empty, whichever run found that: (scene id, detail)."""

    homes: int = 0
    unmade: int = 0
    resumed: int = 0
    others: int = 0
    retries: int = 0
    seconds: dict[str, float] = field(default_factory=dict)
    empty: dict[str, list[tuple[str, str]]] = field(default_factory=dict)

    def lines(self) -> list[str]:
        """Return one line for each reason why homes stay empty."""
        reasons = []
        for reason, cases in sorted(self.empty.items()):
            count = "1 home stays" if len(cases) == 1 else f"{len(cases)} homes stay"
            reasons.append(f"{count} empty: {reason} ({'; '.join(f'{scene}: {detail}'[:200] for scene, detail in cases[:1])})")
        return reasons


def fill(
    dataset: Dataset,
    recipe: Recipe,
    asked: Callable[[int], Request],
    *,
    workers: int = 1,
    scheduler: str | None = None,
    strict: bool = False,
    progress: Progress,
    again: str = "",
) -> Tally:
    """Make what is missing of a dataset; `asked` tells what each home shall be, `again` is the command that makes one home again.

    A home that cannot be made leaves its index empty and the run goes on; with `strict` its error is raised.
    """
    factory, tally = recipe.opened(), Tally()
    missing = dataset.missing()
    todo = sum(len(dataset.todo(number)) for number in missing)
    tally.resumed = dataset.header.count - todo
    if strict:
        for reason, cases in empties_of(dataset).items():
            raise ContentError(f"{cases[0][0]} stays empty ({reason}: {cases[0][1]})", "leave --strict out")
    watch = _Watch(tally, progress)
    spent = dict.fromkeys(missing, 0.0)  # CPU seconds by shard, and seconds of waiting for workers that kept silent
    while missing:
        allowed = {number: factory.shard.shard_seconds * len(dataset.header.indices(number)) for number in missing}
        done = map_divisible(
            partial(make_chunk, recipe),
            (replace(c, overdue=spent[c.shard] > allowed[c.shard]) for c in chunks(dataset, missing, asked, factory.chunk, workers)),
            Chunk.pieces,
            workers=min(workers, -(-todo // LEAST)),
            scheduler=scheduler,
            note=watch.heard,
            silence=factory.shard.home_seconds,
        )
        before = tally.homes + tally.unmade
        with closing(done):  # an error stops the workers at once
            for chunk, answer in done:
                batch = lost_batch(chunk, answer, factory.seed) if isinstance(answer, Lost) else answer
                silent = answer.times * factory.shard.home_seconds if isinstance(answer, Lost) and answer.how == "hung" else 0.0
                spent[chunk.shard] += sum(batch.seconds.values()) + silent
                for empty in batch.empties:
                    if strict:
                        raise empty.error
                    if empty.reason in FAILURES:
                        place = f"home {empty.index} ({shard_name(chunk.shard)}, seed {factory.seed})"
                        progress.say(f"{place} stays empty: {empty.error}{f'; again: {again.format(index=empty.index)}' if again else ''}")
                for home in batch.homes:
                    add_part(dataset, chunk.shard, home)
                watch.counted(chunk, batch)
                commit_shard(dataset, chunk.shard)
        for number in dataset.missing():  # whose last home is another command's, or whose maker was killed before the commit
            commit_shard(dataset, number)
        if (missing := dataset.missing()) and tally.homes + tally.unmade == before:
            progress.state("waiting for other commands")
            time.sleep(WAIT)
    tally.others = todo - tally.homes - tally.unmade
    progress.add(tally.others)
    tally.empty = empties_of(dataset)
    return tally


def chunks(dataset: Dataset, missing: Sequence[int], asked: Callable[[int], Request], most: int, workers: int) -> Iterator[Chunk]:
    """Claim what is still to be made, in order, and yield it in runs of at most `most` consecutive homes; of fewer when few are left."""
    left = sum(len(dataset.todo(number)) for number in missing)
    for number in missing:
        hands = max(1, workers) * (1 + len(dataset.claims.others()))
        run: list[Request] = []
        todo = dataset.todo(number)
        for index in todo:
            taken = dataset.take(number, index)
            if run and (not taken or len(run) >= max(LEAST, min(most, -(-left // hands))) or index != run[-1].index + 1):
                left -= len(run)
                yield Chunk(number, tuple(run))
                run = []
            if taken:
                run.append(asked(index))
        if run:
            left -= len(run)
            yield Chunk(number, tuple(run))


def make_chunk(recipe: Recipe, chunk: Chunk) -> Batch:
    """Make one chunk: the step that workers run."""
    factory = recipe.factory()
    factory.seconds.clear()
    outcomes: Sequence[Outcome | Empty]
    if chunk.overdue:
        late = ContentError(f"{shard_name(chunk.shard)} took too long before it was begun", "`sfgen repair` goes on with it")
        outcomes = [Empty(request.index, "shard_deadline", late) for request in chunk.requests]
    else:
        first = recipe.drafts(factory, chunk.requests) if recipe.drafts else None
        outcomes = attempt(factory, chunk.requests, first)
    brought = [(o.rows(factory.seed), {}) if isinstance(o, Empty) else (o.rows, o.files) for o in outcomes]
    homes = tuple(gather(chunk.shard, rows, files) for rows, files in brought)
    if recipe.cache_assets:
        with factory.time("library"):
            factory.asset_cache.stock(row["asset_id"] for home in homes for row in home.rows["objects"])
    retries = sum(row["what"] in {"room", "home"} and row["reason"] != BEST for home in homes for row in home.rows["rejects"])
    return Batch(homes, tuple(o for o in outcomes if isinstance(o, Empty)), dict(factory.seconds), retries)


def attempt(factory: Factory, requests: Sequence[Request], first: Sequence[PlannedHome] | None) -> list[Outcome | Empty]:
    """Make homes; an error that the factory does not know costs the one home that raises it, alone, again."""
    try:
        return factory.make(requests, first)
    except (SfgenError, OSError, MemoryError):  # the checkout, the disk, the machine: no home is at fault
        raise
    except Exception as error:
        if shutil.disk_usage(tempfile.gettempdir()).free < SPARE:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), tempfile.gettempdir()) from error
        if len(requests) > 1:
            mine = {d.request.index: [d] for d in first or ()}
            return [o for r in requests for o in attempt(factory, [r], None if first is None else mine.get(r.index, []))]
        frame = traceback.extract_tb(error.__traceback__)[-1]
        message = f"{type(error).__name__}: {error} ({Path(frame.filename).name}:{frame.lineno}, {frame.name})"
        return [Empty(requests[0].index, "internal", ContentError(message))]


def lost_batch(chunk: Chunk, answer: Lost, seed: int) -> Batch:
    """Return what a chunk of one home comes to that its workers did not survive."""
    (request,) = chunk.requests
    how = "died at it" if answer.how == "died" else "kept silent"
    empty = Empty(request.index, "worker_lost", ContentError(f"{answer.times} workers {how}", "give them more memory (fewer --workers)"))
    return Batch((gather(chunk.shard, empty.rows(seed), {}),), (empty,), {}, 0)


def empties_of(dataset: Dataset) -> dict[str, list[tuple[str, str]]]:
    """Return the homes that stay empty, by reason: (scene id, detail)."""
    by_reason: dict[str, list[tuple[str, str]]] = {}
    for number in range(dataset.header.shards):
        commit = read_commit(dataset.folder, shard_name(number))
        if commit and commit.rows["scenes"] == len(dataset.header.indices(number)):
            continue
        if commit:
            rows = tables.read(dataset.folder / table_path("rejects", number), TABLES["rejects"])
        else:
            parts = [Part(part_place(dataset.folder, number, i)) for i in sorted(parts_there(dataset.folder, number))]
            rows = [row for part in parts if part.whole() for row in part.rows()["rejects"].to_pylist()]
        for row in rows:
            if row["what"] == EMPTY:
                by_reason.setdefault(row["reason"], []).append((row["where"], row["detail"]))
    return by_reason


class _Watch:
    """Counts homes: as they are told of while their chunk is at work, or else when it is done."""

    def __init__(self, tally: Tally, progress: Progress) -> None:
        self.tally, self.progress = tally, progress
        self._told: set[int] = set()

    def heard(self, note: tuple[Any, ...]) -> None:
        what, index = note
        if what == "made" and index not in self._told:
            self._told.add(index)
            self.progress.add()
        else:
            self.progress.state(f"{what} home {index}")

    def counted(self, chunk: Chunk, batch: Batch) -> None:
        indices = {request.index for request in chunk.requests}
        self.progress.count(retries=batch.retries, empty=len(batch.empties))
        self.progress.add(len(indices - self._told))
        self._told -= indices
        self.tally.homes += len(indices) - len(batch.empties)
        self.tally.unmade += len(batch.empties)
        self.tally.retries += batch.retries
        for part, spent in batch.seconds.items():
            self.tally.seconds[part] = self.tally.seconds.get(part, 0.0) + spent
