"""The factory: requests in, homes with certificates, rows and files out; the same for every command that asks.

A home is a function of (program, seed, index, weights). Rooms are drafted in batches, finished one by one, and tried
again where they fail; the whole home is then judged, and what the judge faults sends its room back once more.
"""

from __future__ import annotations

import functools
import gc
import json
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from pipeline import floorplan, params, seeds, tables, taxonomy
from pipeline.arrange import LearntRelations, PostoptSettings
from pipeline.diffusion.sampling import Sampler
from pipeline.diffusion.settings import SampleSettings
from pipeline.entities.home import Home, Placement
from pipeline.entities.plan import Plan
from pipeline.errors import ContentError, RefusedError, SfgenError
from pipeline.execution import tell
from pipeline.floorplan.language import parse
from pipeline.floorplan.program.floor_program import Furniture
from pipeline.floorplan.program.furniture import meant, needed, plain
from pipeline.floorplan.program.priors import PriorSettings
from pipeline.homes.asset_cache import AssetCache
from pipeline.homes.clutter import small_things
from pipeline.homes.exports import files_of
from pipeline.homes.furnish import Draft, furnish
from pipeline.homes.home_state import HomeDraft, Work
from pipeline.homes.library import MEMORY, Library, kept_within
from pipeline.homes.outcomes import Empty, Outcome
from pipeline.homes.request import Request, RoomJob, layout_type
from pipeline.homes.room_finishing import finish
from pipeline.homes.rows import home_rows, reject_row
from pipeline.homes.settings import ShardSettings
from pipeline.homes.soundness import closed_rooms
from pipeline.homes.violations import Violation, violations
from pipeline.manifest import digest, sha256_file
from pipeline.relations import files as relation_files
from pipeline.retrieval.index import AssetIndex
from pipeline.retrieval.settings import RetrievalSettings
from pipeline.shards import code_digest, scene_id
from pipeline.verify import Certificate, VerifySettings, verify_home
from schemas.assets import LATENTS

WISHES = frozenset({"count_missed", "category_missed", "openable_missed", "walkable_missed"})  # reasons that a request cannot be met
PLANS = 8  # plans of one attempt that the judge may find unsound


@dataclass(frozen=True)
class Factory:
    """Everything that making homes needs, loaded once per process. `learnt` is what the training tables know of relations; `seconds` sums CPU seconds by part."""

    seed: int
    sampler: Sampler
    index: AssetIndex
    library: Library
    shard: ShardSettings
    postopt: PostoptSettings
    verify: VerifySettings
    prior: PriorSettings
    digests: Mapping[str, str]
    learnt: LearntRelations
    seconds: dict[str, float] = field(default_factory=dict)

    @property
    def shard_size(self) -> int:
        """Homes per shard."""
        return self.shard.homes

    @property
    def chunk(self) -> int:
        """Homes that are sampled together."""
        return self.shard.chunk

    @property
    def licence(self) -> str:
        """The licence that binds what is made."""
        return self.shard.licence

    @contextmanager
    def timed(self, part: str) -> Iterator[None]:
        """Add the CPU seconds (user + system) of the block to `seconds[part]`."""
        start = time.process_time()
        try:
            yield
        finally:
            self.seconds[part] = self.seconds.get(part, 0.0) + time.process_time() - start

    # -- drafting ----------------------------------------------------------------------------------------------------

    def plan(self, request: Request, attempt: int) -> tuple[str, str, Plan, list[RoomJob]]:
        """Return (prompt, program as JSON, plan, one job per room that is furnished) of one attempt at a home."""
        with self.timed("plan"):
            if request.program:
                program, prompt = floorplan.FloorProgram.model_validate_json(request.program), request.prompt
            elif request.prompt:
                program, prompt = parse(request.prompt), request.prompt
            else:
                program = floorplan.prior(seeds.generator(self.seed, "program", request.index), self.prior)
                prompt = floorplan.describe(program)
            if request.plan:  # the user's own, which `check_sound` has seen
                solved = floorplan.plan_from_json(json.loads(request.plan))
            else:
                program = floorplan.complete(program)
                solved = self._sound_plan(program, (request.index, attempt))
        wishes = {room.id: room.furniture for room in program.rooms}
        return prompt, program.model_dump_json(exclude_defaults=True), solved, self.jobs(solved, request.index, attempt, wishes)

    def _sound_plan(self, program: floorplan.FloorProgram, keys: tuple[int, int]) -> Plan:
        """Solve a program until the judge finds nothing wrong with the empty home: doors swing, every room is entered."""
        solved = floorplan.solve(program, self.seed, keys)
        for retry in range(1, PLANS):
            empty = Home("empty", self.seed, keys[0], "", "", solved, ())
            if verify_home(empty, {}, self.verify).ok(self.verify.policy):
                break
            solved = floorplan.solve(program, self.seed, (*keys, retry))
        return solved

    def jobs(self, plan: Plan, index: int, attempt: int, wishes: Mapping[str, Furniture]) -> list[RoomJob]:
        """Return one job per room that the layout model furnishes; `wishes` by room id.

        The first plan's rooms count their attempts from 0, those of plan k from 100 k, so that no draw is made twice.
        """
        found = []
        for number, room in enumerate(plan.rooms):
            kind = layout_type(room, plan, taxonomy.load())
            if kind is None:
                continue
            wish = wishes.get(room.room_id, Furniture())
            self._possible(room.room_id, room.type, wish)
            draw = seeds.generator(self.seed, "pieces", index, number, attempt)
            found.append(RoomJob(plan, room.room_id, kind, index, number, 100 * attempt, told_count(wish, draw), wish.walkable, wish))
        return found

    def _possible(self, room_id: str, kind: str, wish: Furniture) -> None:
        """Raise RefusedError for wishes that the layout model or the library cannot meet."""
        most = max(wish.least or 0, needed(wish))
        if most > self.sampler.slots:
            raise RefusedError(
                f"{most} objects are asked for in {room_id}, and a room takes at most {self.sampler.slots}",
                "ask for fewer, or train with more train.slots",
            )
        for things in wish.counts:
            if things.min and not any(self.index.shelves.get(name) is not None for name in meant(things, kind)):
                raise RefusedError(f"the library has no {plain(things.category)} for {room_id}", "ask for something else")

    def draft(self, jobs: Sequence[RoomJob]) -> list[Draft]:
        """Furnish a batch of rooms: diffusion and retrieval, nothing moved yet."""
        with self.timed("sample"):
            return furnish(jobs, self.sampler, self.index, taxonomy.load(), self.library.finish)

    def first_drafts(self, requests: Sequence[Request]) -> list[HomeDraft]:
        """Return the first attempt at each home that can be: what the stage `sample` writes."""
        planned = []
        for request in requests:
            tell("planning", request.index)
            with suppress(RefusedError):  # said where the home would be made
                planned.append((request, self.plan(request, 0)))
        drafts = iter(self.draft([job for _, (*_, jobs) in planned for job in jobs]))
        return [
            HomeDraft(request, prompt, program, plan, tuple(next(drafts) for _ in jobs))
            for request, (prompt, program, plan, jobs) in planned
        ]

    # -- making ------------------------------------------------------------------------------------------------------

    def make(self, requests: Sequence[Request], first: Sequence[HomeDraft] | None = None, *, files: bool = True) -> list[Outcome | Empty]:
        """Make a batch of homes, each an Outcome or, where it cannot be made, an Empty. `first` are first drafts that a stage has made already."""
        drafts = {d.request.index: d for d in first} if first is not None else {}
        works = [self._begun(request, drafts.get(request.index)) for request in requests]
        for work in works:
            self._judge(work)  # homes without a room to furnish are done here
        while pending := [(work, job) for work in works for job in work.pending]:
            ready = [work.first.pop(job.room_id, None) for work, job in pending]
            made = iter(self.draft([job for (_, job), draft in zip(pending, ready, strict=True) if draft is None]))
            for (work, job), draft in zip(pending, ready, strict=True):
                self._try(work, job, draft or next(made))
            for work in works:
                self._judge(work)
        return [work.empty or self._outcome(work, files=files) for work in works]

    def _begun(self, request: Request, draft: HomeDraft | None) -> Work:
        tell("planning", request.index)
        try:
            return self._started(request, draft)
        except RefusedError as error:
            empty = Empty(request.index, "refused", error)
            return Work(request, 0, request.prompt, "", Plan((), (), ""), [], {}, empty=empty)

    def _started(self, request: Request, draft: HomeDraft | None, attempt: int = 0) -> Work:
        if draft is None:
            prompt, program, plan, jobs = self.plan(request, attempt)
            closed = closed_rooms(plan, self.verify) if request.plan else frozenset[str]()
            return Work(request, attempt, prompt, program, plan, jobs, {job.room_id: job.attempt for job in jobs}, closed=closed)
        jobs = [d.job for d in draft.drafts]
        last = {job.room_id: 0 for job in jobs}
        return Work(request, 0, draft.prompt, draft.program, draft.plan, jobs, last, first={d.job.room_id: d for d in draft.drafts})

    def _try(self, work: Work, job: RoomJob, draft: Draft) -> None:
        """Finish one draft of a room; keep the better of it and what was there; queue another try if it is needed."""
        if job not in work.pending:  # another room of the same round has led to a new plan
            return
        tell("furnishing", work.request.index)
        work.pending.remove(job)
        work.tries += 1
        with self._charged(work), self.timed("postopt"):
            result = finish(draft, self.library, self.index, self.learnt, self.postopt, self.verify, taxonomy.load())
        before = work.results.get(job.room_id)
        work.rejects.extend(reject_row(scene_id(self.seed, job.index), job.room_id, job.attempt, r) for r in result.rejects)
        if before is None or result.rank() > before.rank():
            work.results[job.room_id] = result
        self._retry(work, job, result.failure, result.detail)

    def _retry(self, work: Work, job: RoomJob, failure: str, detail: str) -> None:
        """Note why a try of a room failed, and queue the next one; a wish that stays unmet needs another plan."""
        if not failure or work.empty:
            return
        work.rejects.append(reject_row(scene_id(self.seed, job.index), job.room_id, job.attempt, ("room", failure, detail)))
        if work.seconds > self.shard.home_seconds:
            self._give_up(work, "deadline", ContentError(f"took more than {self.shard.home_seconds:.0f} s, last by {failure} ({detail})"))
        elif work.last[job.room_id] % 100 + 1 < self.shard.room_attempts:
            work.last[job.room_id] += 1
            work.pending.append(replace(job, attempt=work.last[job.room_id]))
        elif work.results[job.room_id].binding:
            self._replan(work, failure, f"{job.room_id}: {detail}")

    def _replan(self, work: Work, failure: str, detail: str) -> None:
        """Start a home again with another plan; give it up when it has had all its attempts."""
        index = work.request.index
        if work.attempt + 1 >= self.shard.home_attempts:
            kind = RefusedError if failure in WISHES else ContentError
            told = f"home {index} (seed {self.seed}) failed {self.shard.home_attempts} times, last by {failure} ({detail})"
            self._give_up(work, "attempts_spent", kind(told, "ask for fewer or smaller things, or larger rooms"))
            return
        work.rejects.append(reject_row(scene_id(self.seed, index), "", work.attempt, ("home", failure, detail)))
        try:
            with self._charged(work):
                fresh = self._started(work.request, None, work.attempt + 1)
        except RefusedError as error:
            self._give_up(work, "refused", error)
            return
        work.attempt, work.program, work.plan = fresh.attempt, fresh.program, fresh.plan
        work.pending, work.last, work.results, work.first = fresh.pending, fresh.last, {}, {}

    def _give_up(self, work: Work, reason: str, error: SfgenError) -> None:
        work.empty = Empty(work.request.index, reason, error, work.rejects)
        work.pending = []

    @contextmanager
    def _charged(self, work: Work) -> Iterator[None]:
        """Add the CPU seconds of the block to what the home has taken."""
        start = time.process_time()
        yield
        work.seconds += time.process_time() - start

    def _judge(self, work: Work) -> None:
        """Lay small things and verify the whole home; what is at fault goes, and a room that is then not good enough is tried again."""
        while work.certificate is None and work.empty is None and not work.pending:
            bare = self._home(work)
            with self.timed("things"):
                draw = seeds.generator(self.seed, "things", work.request.index, work.attempt)
                laid = small_things(bare, self.library, self.postopt.things, draw, self.postopt.separate.touch)
            laid, certificate, violating = self._verdict(work, bare, laid)
            if violating:
                self._expel(work, violating)  # things are laid anew on what is left
            elif faults := certificate.faults(self.verify.policy, work.closed):
                self._replan(work, *faults[0])
            else:
                work.things, work.certificate = laid, certificate

    def _verdict(
        self, work: Work, bare: Home, laid: tuple[Placement, ...]
    ) -> tuple[tuple[Placement, ...], Certificate, dict[str, Violation]]:
        """Judge a home with its small things, leaving out those at fault; return the others, the certificate, the furniture that violates."""
        while True:
            home = replace(bare, placements=bare.placements + laid)
            with self.timed("verify"):
                certificate = verify_home(home, self.library, self.verify)
            violating = violations(home, certificate, work.closed)
            small = {p.object_id for p in laid}
            furniture = {k: violation for k, violation in violating.items() if k not in small}
            if furniture or not violating:
                return laid, certificate, furniture
            for object_id, violation in sorted(violating.items()):
                reject = ("object", violation.reason, f"{object_id}: {violation.detail}")
                work.rejects.append(reject_row(home.scene_id, violation.room_id, work.results[violation.room_id].draft.job.attempt, reject))
            laid = tuple(p for p in laid if p.object_id not in violating)

    def _expel(self, work: Work, violating: Mapping[str, Violation]) -> None:
        """Take the violating objects out of their rooms, each with its reason."""
        where = scene_id(self.seed, work.request.index)
        for room_id in sorted({violation.room_id for violation in violating.values()}):
            if room_id not in work.results:  # a room before it has led to a new plan
                break
            mine = {k: violation for k, violation in sorted(violating.items()) if violation.room_id == room_id}
            result = work.results[room_id] = work.results[room_id].without(mine, taxonomy.load())
            job = result.draft.job
            work.rejects.extend(
                reject_row(where, room_id, job.attempt, ("object", violation.reason, f"{object_id}: {violation.detail}"))
                for object_id, violation in mine.items()
            )
            self._retry(work, job, result.failure, result.detail)

    def _home(self, work: Work) -> Home:
        placed = tuple(p for room in work.plan.rooms if room.room_id in work.results for p in work.results[room.room_id].placements)
        index = work.request.index
        return Home(scene_id(self.seed, index), self.seed, index, work.prompt, work.program, work.plan, placed + work.things)

    def _outcome(self, work: Work, *, files: bool) -> Outcome:
        assert work.certificate is not None
        tell("exporting", work.request.index)
        home = self._home(work)
        exported: dict[str, bytes] = {}
        if files:
            with self.timed("export"):
                exported = files_of(home, self.library, self.shard.preview)
        rows = home_rows(home, work.certificate, work.results, self.library, taxonomy.load(), work.tries, self.licence)
        rows["rejects"] = work.rejects
        tell("made", home.index)
        return Outcome(home, work.certificate, rows, exported)

    @functools.cached_property
    def asset_cache(self) -> AssetCache:
        """Return the asset cache of this machine from which datasets take their assets."""
        return AssetCache(self.library, self.digests["code"])


def told_count(wish: Furniture, rng: np.random.Generator) -> int | None:
    """Return the number of objects that the sampler is told: any number within the bounds; None where nobody asked."""
    least, most = wish.least, wish.most
    if least is None and most is None:
        return None
    low = max(least or 0, needed(wish))
    high = most if most is not None else max(low + 2, 4)
    low = low if least is not None else max(low, high // 2)
    return int(rng.integers(low, max(high, low) + 1))


def load_factory(root: Path, tree: Mapping[str, Any], seed: int) -> Factory:
    """Load models, tables and settings of the checkout at `root`. Raises ContentError for what is missing or broken."""
    data, weights = root / "data", root / "models" / "denoiser.safetensors"
    relations = data / "tables" / "relations.json"
    if not weights.is_file():
        raise ContentError(f"there are no trained weights ({weights} is missing)", f"type `make run` in {root}")
    library = Library.read(data / "tables", data / "assets")
    latents = tables.read(data / "latents" / "latents.parquet", LATENTS)
    index = AssetIndex.from_tables(library.rows.values(), latents, library.joints, params.section(RetrievalSettings, tree, "retrieval"))
    names = ("sample", "retrieval", "postopt", "verify", "prior", "shard")
    return Factory(
        seed,
        Sampler.load(weights, params.section(SampleSettings, tree, "sample"), seed, index),
        index,
        library,
        params.section(ShardSettings, tree, "shard"),
        params.section(PostoptSettings, tree, "postopt"),
        params.section(VerifySettings, tree, "verify"),
        params.section(PriorSettings, tree, "prior"),
        {
            "code": code_digest(root),
            "library": library.digest(),
            "params": digest({name: tree[name] for name in names}),
            "relations": sha256_file(relations),
            "weights": sha256_file(weights),
        },
        LearntRelations(relation_files.load(relations)),
    )


def open_factory(root: Path, seed: int, memory: int = MEMORY) -> Factory:
    """Return this process's factory for the checkout at `root`, loaded once; as much of the library stays read as fits into `memory` [MiB]."""
    factory = _loaded_factory(root, seed)
    factory.library.kept = kept_within(memory)
    return factory


def forget_factory() -> None:
    """Let this process load its factory again when it is next opened: files have changed."""
    _loaded_factory.cache_clear()


@functools.lru_cache(maxsize=1)
def _loaded_factory(root: Path, seed: int) -> Factory:
    factory = load_factory(root, params.read(root / "params.yaml"), seed)
    gc.freeze()  # modules, models and library stay: looking through them for garbage again and again costs a tenth of all time
    return factory
