"""One attempt at each of a batch of rooms: guided diffusion, then retrieval from both libraries."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import shapely

from pipeline import seeds, taxonomy
from pipeline.diffusion.context import CategoryBounds, Proposal, RoomContext
from pipeline.entities.home import Placement
from pipeline.execution import give_memory_back
from pipeline.geometry.beside import sideways
from pipeline.homes.parts import split_room
from pipeline.homes.request import RoomJob
from pipeline.homes.resources import Resources
from pipeline.retrieval.index import AssetIndex, Match, Taste
from pipeline.retrieval.taste import draw_finishes, draw_style, tasteful
from pipeline.retrieval.wall_alignment import keep_at_walls, part, put_before_walls, straightened
from pipeline.taxonomy import Taxonomy

PART = 1000  # between the numbers of a room's parts: more than homes have rooms
SEATS = ("chair", "stool")  # super-categories
HELD = 1e-9  # [m] by which a wall has moved what it holds
FREE_CHOICE = 2  # tries of a room in which any category of an essential group will do


@dataclass(frozen=True, slots=True)
class Draft:
    """One attempt at a room, as retrieved, before anything is moved; `lost` names categories the library lacks."""

    job: RoomJob
    placements: tuple[Placement, ...]
    lost: tuple[str, ...] = ()
    taste: Taste = field(default_factory=Taste)


def draft_rooms(resources: Resources, jobs: Sequence[RoomJob]) -> list[Draft]:
    """Return what the layout model places in each room, as assets of the library, timed as "sample"; nothing is moved yet.

    Draws are keyed by (seed, home, room, attempt) alone, so a room does not depend on which rooms share its batch.
    """
    sampler, known = resources.sampler, taxonomy.load()
    with resources.time("sample"):
        wholes = [context_of(job, sampler.seed, resources.index) for job in jobs]
        draws = [seeds.generator(sampler.seed, "usual", job.index, job.number) for job in jobs]
        rooms = [_parts(job, whole, known, draw) for job, whole, draw in zip(jobs, wholes, draws, strict=True)]
        contexts = [part for parts in rooms for part in parts]
        keys = [(job.index, job.number + PART * k, job.draw) for job, parts in zip(jobs, rooms, strict=True) for k in range(len(parts))]
        proposals = iter(sampler.sample_rooms(contexts, keys))
        drafts = [
            retrieve(job, whole, [p for _ in parts for p in next(proposals)], resources.index, known)
            for job, whole, parts in zip(jobs, wholes, rooms, strict=True)
        ]
        give_memory_back()  # some 30 MiB of the sampler's, before previews take as much
    return drafts


def _parts(job: RoomJob, whole: RoomContext, words: Taxonomy, rng: np.random.Generator) -> list[RoomContext]:
    """Return a room, or the parts of one that serves as several, each as the layout model is asked for it."""
    parts = split_room(whole, [(kind, words.layouts[kind].part) for kind in job.kinds]) if len(job.kinds) > 1 else [whole]
    counts = _split_count(job.count, [shapely.Polygon(part.polygon).area for part in parts])
    kinds = [part.layout_type for part in parts]
    asked = [(*category_bounds(job, kind, kinds, words), *usual_bounds(job, kind, words, rng)) for kind in kinds]
    company = tuple((c.of, c.also, c.least) for c in words.company)
    return [replace(part, n_target=n, category_bounds=b, company=company) for part, n, b in zip(parts, counts, asked, strict=True)]


def _split_count(count: int | None, areas: Sequence[float]) -> list[int | None]:
    """Share a told number of objects among parts by their areas [m2]; None to each where none is told."""
    if count is None:
        return [None] * len(areas)
    passed = np.round(count * np.cumsum(areas) / sum(areas)).astype(int)
    return [int(n) for n in np.diff(passed, prepend=0)]


def context_of(job: RoomJob, seed: int, index: AssetIndex) -> RoomContext:
    """Return a job's room with its taste, nothing asked of it."""
    return replace(RoomContext.of(job.plan, job.room_id, job.layout_type), taste=taste_of(job, seed, index))


def taste_of(job: RoomJob, seed: int, index: AssetIndex) -> Taste:
    """Draw the taste of a room: the style is its home's, or the one that is wished for; the finishes are its own. Tries share it."""
    wish = job.furniture.style or ""
    style = wish or draw_style(seeds.generator(seed, "style", job.index), index)
    finishes = draw_finishes(seeds.generator(seed, "finish", job.index, job.number), index, style)
    return Taste(style, bool(wish), finishes)


def category_bounds(job: RoomJob, kind: str, kinds: Sequence[str], words: Taxonomy) -> tuple[CategoryBounds, ...]:
    """Return what a room, or the part of layout type `kind` of one whose parts are of `kinds`, is to hold: what is wished for, and of each group of the type's essentials one thing.

    What is wished for of a group, none of it too, stands. What rooms of the plan's type do not want stays out, unless it is wished for.
    """
    wished = {c for bounds in job.category_bounds for c in bounds.categories}
    unwanted = tuple(c for c in job.exclusions(words) if c not in wished)
    needed = Counter(tuple(c for c in group if c not in unwanted) for group in job.essentials_of(kind, words))
    groups = [b for group, least in needed.items() if not wished.intersection(group) for b in _essential(group, least, job.attempt)]
    own = [
        bounds if _host(bounds, kinds, words) == kind else replace(bounds, least=0, most=bounds.most and 0)
        for bounds in job.category_bounds
    ]
    return (*own, *groups, *([CategoryBounds(unwanted, 0, 0)] if unwanted else []))


def _host(bounds: CategoryBounds, kinds: Sequence[str], words: Taxonomy) -> str:
    """Return the part, by its layout type, in which what is wished for usually stands; the first of them where it stands nowhere."""
    usual = [room for c in bounds.categories for room in words.categories[c].usual]
    places = [kind for room in usual for kind in kinds if room == kind or words.types[room].furnished_as == kind or room in kind]
    return places[0] if places else kinds[0]


def usual_bounds(job: RoomJob, kind: str, words: Taxonomy, rng: np.random.Generator) -> tuple[CategoryBounds, ...]:
    """Return what a room, or its part of layout type `kind`, is asked to hold because most do, on its first tries; nothing where a number of objects, or some of these, is wished for."""
    own = words.types[job.room.type].usual if job.room.type in words.types else ()
    asked = [usual for usual in own if _host(CategoryBounds(usual.of), job.kinds, words) == kind]
    asked += words.layouts[kind].usual if kind in words.layouts else ()
    marks = [(usual, rng.random()) for usual in asked]
    if job.count is not None or job.attempt >= FREE_CHOICE:
        return ()
    settled, out = {c for bounds in job.category_bounds for c in bounds.categories}, set(job.exclusions(words))
    drawn = [usual.of for usual, mark in marks if mark < usual.share and job.room.area >= usual.floor and settled.isdisjoint(usual.of)]
    return tuple(CategoryBounds(of, 1) for group in dict.fromkeys(drawn) if (of := tuple(c for c in group if c not in out)))


def _essential(group: tuple[str, ...], least: int, attempt: int) -> list[CategoryBounds]:
    """Ask for so many things of a group; later tries insist on one category after the other: where no double bed finds a place a single one may."""
    if attempt < FREE_CHOICE or len(group) == 1:
        return [CategoryBounds(group, least)]
    chosen = group[(attempt - FREE_CHOICE + 1) % len(group)]
    return [CategoryBounds((chosen,), least), CategoryBounds(tuple(c for c in group if c != chosen), 0, 0)]


def retrieve(
    job: RoomJob,
    context: RoomContext,
    proposals: Sequence[Proposal],
    index: AssetIndex,
    words: Taxonomy,
) -> Draft:
    """Replace each proposal by the nearest asset that suits the taste of the room `context`, standing on the floor, hanging from the ceiling, or at its wall.

    Object ids carry the room's id and the slot, so they are unique in the home.
    """
    taste = context.taste or Taste()
    if not proposals:
        return Draft(job, (), taste=taste)
    yaws = straightened(np.array([p.yaw for p in proposals]), context.polygon)
    proposals = [replace(p, yaw=float(yaw)) for p, yaw in zip(proposals, yaws, strict=True)]
    matches = _matches(job, index, taste, proposals)
    placements: list[Placement] = []
    lost: list[str] = []
    places, yaws, before = (np.array([getattr(p, name) for p in proposals], float) for name in ("position", "yaw", "size"))
    after = np.array([p.size if m is None else m.size for p, m in zip(proposals, matches, strict=True)], float)
    aside = sideways(places, yaws, before, after)
    for number, (proposal, match) in enumerate(zip(proposals, matches, strict=True)):
        if match is None:
            lost.append(proposal.category)
            continue
        position = keep_at_walls(proposal.position, proposal.yaw, proposal.size, match.size, context.polygon)
        if abs(np.dot(position[:2] - proposal.position[:2], (math.cos(proposal.yaw), math.sin(proposal.yaw)))) < HELD:
            position[:2] += aside[number]  # no wall holds it on either side
        position[2] = _height(words.categories[proposal.category].mount, proposal, float(match.size[2]), context)
        placement = Placement(
            f"{job.room_id}_{proposal.category}_{number}",
            job.room_id,
            proposal.category,
            match.asset_id,
            position,
            proposal.yaw,
            match.size,
            match.scale,
            np.round(proposal.latent, 5).astype(np.float32),
            match.distance,
        )
        placements.append(placement)
    return Draft(job, tuple(map(round_placement, _apart(placements, context, words))), tuple(lost), taste)


def _apart(placements: Sequence[Placement], context: RoomContext, words: Taxonomy) -> list[Placement]:
    """Return the placements, what stands on the floor or hangs on walls moved out of walls and of its neighbours; seats are not: they belong under tables."""
    apart = list(placements)
    own = [k for k, p in enumerate(placements) if (c := words.categories[p.category]).mount in ("floor", "wall") and c.super not in SEATS]
    if own:
        yaws, sizes = np.array([placements[k].yaw for k in own]), np.array([placements[k].size for k in own])
        before = [put_before_walls(placements[k].position, placements[k].yaw, placements[k].size, context.polygon) for k in own]
        for k, position in zip(own, part(np.array(before), yaws, sizes, context.polygon), strict=True):
            apart[k] = replace(placements[k], position=position)
    return apart


def _matches(job: RoomJob, index: AssetIndex, taste: Taste, proposals: Sequence[Proposal]) -> list[Match | None]:
    """Return the assets; where more shall open, the objects that lose least by it get assets that do."""
    categories = [p.category for p in proposals]
    sizes, latents, positions = (np.array([getattr(p, name) for p in proposals]) for name in ("size", "latent", "position"))
    matches = tasteful(index, taste, categories, sizes, latents, positions)
    lacking = (job.furniture.openable or 0) - sum(m.openable for m in matches if m)
    if lacking > 0:
        opening = tasteful(index.openers(), taste, categories, sizes, latents, positions)
        pairs = enumerate(zip(matches, opening, strict=True))
        farther = sorted((o.distance - m.distance, k) for k, (m, o) in pairs if m and o and not m.openable)
        for _, k in farther[:lacking]:
            matches[k] = opening[k]
    return matches


def _height(mount: str, proposal: Proposal, height: float, context: RoomContext) -> float:
    """Return the z of the asset's bottom: its mount decides, and nothing sticks through floor or ceiling."""
    if mount == "floor":
        return context.elevation
    highest = context.elevation + max(0.0, context.height - height)
    if mount == "ceiling":
        return highest
    return float(np.clip(proposal.position[2], context.elevation, highest))


def round_placement(placement: Placement) -> Placement:
    """Round a pose, so that the last bits of a sum never reach a dataset: position and size to 0.1 mm, yaw to 1e-5 rad in (-pi, pi], scale to 1e-6."""
    yaw = round(math.remainder(placement.yaw, 2 * math.pi), 5)
    if yaw <= -3.14159:
        yaw = 3.14159
    # Adding 0.0 turns -0.0 into 0.0: equal numbers must be equal bytes.
    return replace(
        placement,
        position=np.round(placement.position, 4) + 0.0,
        yaw=yaw + 0.0,
        size=np.round(placement.size, 4),
        scale=np.round(placement.scale, 6),
        retrieval_distance=round(placement.retrieval_distance, 6),
    )
