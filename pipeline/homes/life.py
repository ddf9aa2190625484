"""The life of a home as a state machine, and the loop that takes a batch of homes through it.

    planned ──draft, finish──► finished ──judge──► shipped
       ▲                         │  │
       └── a room once more, or ─┘  └──► refused, when a budget is spent or a wish cannot be met
           the home on another plan

The budgets are those of ShardSettings: tries of a room, plans of a home, CPU seconds of a home.
"""

import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from enum import Enum

from pipeline import seeds
from pipeline.entities.asset import Asset
from pipeline.entities.home import Home, Placement
from pipeline.entities.plan import Plan
from pipeline.errors import ContentError, RefusedError, SfgenError
from pipeline.execution import tell
from pipeline.homes.clutter import small_things, unlaid
from pipeline.homes.empty_plan import closed_rooms
from pipeline.homes.furnish import Draft, draft_rooms
from pipeline.homes.planning import PlannedHome, plan_home
from pipeline.homes.request import Request, RoomJob
from pipeline.homes.resources import Resources
from pipeline.homes.room_finishing import RoomResult, finish
from pipeline.homes.rows import BEST, REASONS, Row, home_rows, reject_row
from pipeline.homes.violations import Violation, violations
from pipeline.preview.top import top_view
from pipeline.rendering.png import png
from pipeline.shards import EMPTY, scene_id
from pipeline.usd.home import home_layer
from pipeline.usd.layer import crate
from pipeline.usd.mujoco import home_overlay
from pipeline.verify import Certificate, verify_home

LIBRARY = "../../assets"  # as seen from usd/shard-00000/
WISHES = frozenset({"count_missed", "category_missed", "openable_missed", "walkable_missed"})  # reasons that a request cannot be met


@dataclass(frozen=True, slots=True)
class Outcome:
    """A home that ships. `rows` by table, `files` by `<family>/<name>`."""

    home: Home
    certificate: Certificate
    rows: dict[str, list[Row]]
    files: dict[str, bytes]


@dataclass(frozen=True, slots=True)
class Empty:
    """A home that could not be made: the reason code, what a user is told, and the rows of what was tried."""

    index: int
    reason: str
    error: SfgenError
    rejects: list[Row] = field(default_factory=list)

    def rows(self, seed: int) -> dict[str, list[Row]]:
        """Return the rows of rejects. Raises KeyError for a code that REASONS lacks."""
        REASONS[self.reason]  # a typo must not reach the table
        detail = " ".join(str(self.error).split())[:400]
        return {"rejects": [*self.rejects, {"what": EMPTY, "where": scene_id(seed, self.index), "reason": self.reason, "detail": detail}]}


class State(Enum):
    """Where a home stands."""

    PLANNED = "rooms wait for a draft"
    FINISHED = "every room is as good as its tries made it"
    SHIPPED = "the judge has certified it"
    REFUSED = "it stays empty"


@dataclass(slots=True)
class RoomTries:
    """The tries of one room under one plan: the job of the latest, and the best result so far."""

    job: RoomJob
    best: RoomResult | None = None

    def keep(self, result: RoomResult) -> RoomResult:
        """Take a result where it is better than those before it; return the best."""
        if self.best is None or result.rank() > self.best.rank():
            self.best = result
        return self.best

    def again(self, most: int) -> RoomJob | None:
        """Return the job of the next try, None when all `most` of them are spent."""
        if self.job.attempt + 1 >= most:
            return None
        self.job = replace(self.job, attempt=self.job.attempt + 1)
        return self.job


class HomeLife:
    """One home from its plan until it is shipped or refused; `first` is a draft of it that a stage has made already."""

    def __init__(self, resources: Resources, request: Request, first: PlannedHome | None = None) -> None:
        self.resources, self.request = resources, request
        self.rejects: list[Row] = []
        self.tries = 0  # of rooms, under all plans
        self.plan_attempt = 0
        self.planned = PlannedHome(request, request.prompt, "", Plan((), (), ""), ())
        self.rooms: dict[str, RoomTries] = {}
        self.waiting: dict[str, RoomJob] = {}  # by room id: what is to be drafted
        self.drafted: dict[RoomJob, Draft] = {}  # by a stage, or ahead of their time
        self.things: tuple[Placement, ...] = ()
        self.closed: frozenset[str] = frozenset()  # rooms that a plan of the user's own closes to the robot
        self.certificate: Certificate | None = None
        self.refusal: Empty | None = None
        self._seconds = 0.0
        if first:
            self._move_in(first)
        else:
            tell("planning", request.index)
            self._draw_plan()

    @property
    def state(self) -> State:
        """Where the home stands."""
        if self.refusal:
            return State.REFUSED
        if self.certificate:
            return State.SHIPPED
        return State.PLANNED if self.waiting else State.FINISHED

    @property
    def name(self) -> str:
        """The scene id."""
        return scene_id(self.resources.seed, self.request.index)

    @property
    def home(self) -> Home:
        """The home as it stands now, small things included."""
        own = self.planned
        rooms = [self.rooms.get(room.room_id) for room in own.plan.rooms]
        placed = tuple(p for room in rooms if room and room.best for p in room.best.placements)
        return Home(self.name, self.resources.seed, self.request.index, own.prompt, own.program, own.plan, placed + self.things)

    # -- planned -----------------------------------------------------------------------------------------------------

    def _draw_plan(self) -> None:
        try:
            with self._charge():
                self._move_in(plan_home(self.resources, self.request, self.plan_attempt))
        except RefusedError as error:
            self._refuse("refused", error)

    def _move_in(self, planned: PlannedHome) -> None:
        self.planned = planned
        self.rooms = {job.room_id: RoomTries(job) for job in planned.jobs}
        self.waiting = {job.room_id: job for job in planned.jobs}
        self.drafted = {draft.job: draft for draft in planned.drafts}
        if self.request.plan:
            self.closed = closed_rooms(planned.plan, self.resources.verify)

    def finish(self, draft: Draft) -> None:
        """Arrange the draft of a room that waits for it; keep the better of it and what was there."""
        job = draft.job
        if self.waiting.get(job.room_id) is not job:  # another room of the same round has led to a new plan
            return
        tell("furnishing", self.request.index)
        del self.waiting[job.room_id]
        self.drafted.pop(job, None)
        self.tries += 1
        r = self.resources
        with self._charge(), r.time("postopt"):
            result = finish(draft, r)
        self.rejects.extend(self._reject(job, reject) for reject in result.rejects)
        self._check(result, self.rooms[job.room_id].keep(result))

    def _check(self, result: RoomResult, best: RoomResult) -> None:
        """Where a result is not good enough the room is tried again; a wish that even the best leaves unmet needs another plan."""
        if not result.failure or self.refusal:
            return
        job, budget = result.draft.job, self.resources.shard
        self.rejects.append(self._reject(job, ("room", result.failure, result.detail)))
        if self._seconds > budget.home_seconds:
            message = f"took more than {budget.home_seconds:.0f} s, last by {result.failure} ({result.detail})"
            self._refuse("deadline", ContentError(message))
        elif again := self.rooms[job.room_id].again(budget.room_attempts):
            self.waiting[job.room_id] = again
        elif best.binding:
            self._replan(result.failure, f"{job.room_id}: {result.detail}")

    def _replan(self, failure: str, detail: str) -> None:
        """Start again with another plan; refuse the home when it has had all its plans."""
        most = self.resources.shard.home_attempts
        if self.plan_attempt + 1 >= most:
            kind = RefusedError if failure in WISHES else ContentError
            message = f"home {self.request.index} (seed {self.resources.seed}) failed {most} times, last by {failure} ({detail})"
            self._refuse("attempts_spent", kind(message, "ask for fewer or smaller things, or larger rooms"))
            return
        self.rejects.append(reject_row(self.name, "", self.plan_attempt, ("home", failure, detail)))
        self.plan_attempt += 1
        self._draw_plan()

    def _refuse(self, reason: str, error: SfgenError) -> None:
        self.refusal = Empty(self.request.index, reason, error, self.rejects)
        self.waiting = {}

    # -- finished ----------------------------------------------------------------------------------------------------

    def judge(self) -> None:
        """Lay small things and verify the whole home; what is at fault goes, and a room that is then not good enough is tried again."""
        r, bare = self.resources, self.home
        wishes = {job.room_id: job.furniture for job in self.planned.jobs if r.postopt.things.rate > 0}
        with r.time("things"):
            draw = seeds.generator(r.seed, "things", self.request.index, self.plan_attempt)
            things = small_things(bare, r.library, r.postopt.things, draw, r.postopt.separate.touch, wishes)
        things, certificate, violating = self._verdict(bare, things)
        if violating:
            self._expel(violating)  # things are laid anew on what is left
        elif faults := certificate.faults(r.verify.policy, self.closed):
            self._replan(*faults[0])
        elif lacking := unlaid(things, wishes):
            self._replan("category_missed", lacking)
        else:
            self.things, self.certificate = things, certificate

    def _verdict(self, bare: Home, things: tuple[Placement, ...]) -> tuple[tuple[Placement, ...], Certificate, dict[str, Violation]]:
        """Judge a home with its small things, leaving out those at fault; return the others, the certificate, the furniture that violates."""
        while True:
            home = replace(bare, placements=bare.placements + things)
            with self.resources.time("verify"):
                certificate = verify_home(home, self.resources.library, self.resources.verify)
            violating = violations(home, certificate, self.closed)
            small = {p.object_id for p in things}
            furniture = {k: violation for k, violation in violating.items() if k not in small}
            if furniture or not violating:
                return things, certificate, furniture
            for object_id, violation in sorted(violating.items()):
                best = self.rooms[violation.room_id].best
                assert best is not None
                self._leave_out(best.draft.job, object_id, violation)
            things = tuple(p for p in things if p.object_id not in violating)

    def _expel(self, violating: Mapping[str, Violation]) -> None:
        """Take the violating objects out of their rooms, each with its reason."""
        plan = self.plan_attempt
        for room_id in sorted({violation.room_id for violation in violating.values()}):
            if self.plan_attempt != plan or self.refusal:  # a room before it has led to a new plan
                break
            tries = self.rooms[room_id]
            assert tries.best is not None
            mine = {k: violation for k, violation in sorted(violating.items()) if violation.room_id == room_id}
            left = tries.best = tries.best.without(mine)
            for object_id, violation in mine.items():
                self._leave_out(left.draft.job, object_id, violation)
            self._check(left, left)

    def _leave_out(self, job: RoomJob, object_id: str, violation: Violation) -> None:
        """Write down that an object is not in its room, and why."""
        self.rejects.append(self._reject(job, ("object", violation.reason, f"{object_id}: {violation.detail}")))

    def _reject(self, job: RoomJob, reject: tuple[str, str, str]) -> Row:
        return reject_row(self.name, job.room_id, job.draw, reject)

    @contextmanager
    def _charge(self) -> Iterator[None]:
        """Add the CPU seconds of the block to what the home has taken."""
        start = time.process_time()
        yield
        self._seconds += time.process_time() - start

    # -- shipped or refused ------------------------------------------------------------------------------------------

    def outcome(self, *, files: bool) -> Outcome | Empty:
        """Return the home with its rows and files, or why there is none."""
        if self.refusal:
            return self.refusal
        assert self.certificate is not None
        tell("exporting", self.request.index)
        r, home = self.resources, self.home
        exported: dict[str, bytes] = {}
        if files:
            with r.time("export"):
                exported = files_of(home, r.library, r.shard.preview)
        results = {k: room.best for k, room in self.rooms.items() if room.best}
        drafts = {k: best.draft for k, best in results.items()}
        rows = home_rows(home, self.certificate, drafts, r.library, self.tries, r.shard.licence)
        failed = [(best.draft.job, ("room", BEST, f"{best.failure}: {best.detail}")) for best in results.values() if best.failure]
        rows["rejects"] = self.rejects + [self._reject(job, reject) for job, reject in failed]
        tell("made", home.index)
        return Outcome(home, self.certificate, rows, exported)


def files_of(home: Home, assets: Mapping[str, Asset], preview: int) -> dict[str, bytes]:
    """Return the USD stage, its MuJoCo overlay and the preview of a home by `<family>/<name>`; `preview` is the side of the top view [px], 0 for none."""
    stage, name = home_layer(home, assets, LIBRARY), f"usd/{home.scene_id}"
    overlay = home_overlay(stage, f"{home.scene_id}.usdc")
    files = {f"{name}.usdc": crate(stage), f"{name}.mujoco.usda": overlay.ExportToString().encode()}
    if preview:
        files[f"previews/{home.scene_id}.png"] = png(top_view(home, assets, preview))
    return files


def make_homes(
    resources: Resources, requests: Sequence[Request], first: Mapping[int, PlannedHome], *, files: bool
) -> list[Outcome | Empty]:
    """Take a batch of homes through their lives; rooms are drafted together. `first` are first drafts that a stage has made, by index."""
    homes = [HomeLife(resources, request, first.get(request.index)) for request in requests]
    while any(home.state in {State.PLANNED, State.FINISHED} for home in homes):
        jobs = [(home, job) for home in homes for job in home.waiting.values() if job not in home.drafted]
        for (home, job), draft in zip(jobs, draft_rooms(resources, [job for _, job in jobs]), strict=True):
            home.drafted[job] = draft
        for home in homes:
            for draft in [home.drafted[job] for job in home.waiting.values()]:
                home.finish(draft)
            while home.state is State.FINISHED:
                home.judge()
    return [home.outcome(files=files) for home in homes]
