"""One attempt at each of a batch of rooms: guided diffusion, then retrieval from both libraries."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.diffusion.context import Demand, Proposal, RoomContext
from pipeline.diffusion.sampling import Sampler
from pipeline.entities.home import Placement
from pipeline.homes.request import RoomJob
from pipeline.homes.rounding import rounded
from pipeline.retrieval.anchor import anchored
from pipeline.retrieval.index import AssetIndex, Match
from pipeline.taxonomy import Taxonomy


@dataclass(frozen=True, slots=True)
class Draft:
    """One attempt at a room, as retrieved, before anything is moved; `lost` names categories the library lacks."""

    job: RoomJob
    placements: tuple[Placement, ...]
    lost: tuple[str, ...] = ()


def furnish(jobs: Sequence[RoomJob], sampler: Sampler, index: AssetIndex, taxonomy: Taxonomy) -> list[Draft]:
    """Return what the layout model places in each room.

    Draws are keyed by (seed, home, room, attempt) alone, so a room does not depend on which rooms share its batch.
    """
    contexts = [RoomContext.of(job.plan, job.room_id, job.layout_type, job.count, demands(job, taxonomy)) for job in jobs]
    keys = [(job.index, job.number, job.attempt) for job in jobs]
    proposals = sampler.sample_rooms(contexts, keys)
    return [retrieve(job, context, found, index, taxonomy) for job, context, found in zip(jobs, contexts, proposals, strict=True)]


def demands(job: RoomJob, taxonomy: Taxonomy) -> tuple[Demand, ...]:
    """Return what a room is to hold: what is wished for, and of each group of its type's essentials one thing.

    What is wished for of a group, none of it too, stands.
    """
    wished = {c for demand in job.demands for c in demand.categories}
    return (*job.demands, *(Demand(group, 1) for group in job.essentials(taxonomy) if not wished.intersection(group)))


def retrieve(job: RoomJob, context: RoomContext, proposals: Sequence[Proposal], index: AssetIndex, taxonomy: Taxonomy) -> Draft:
    """Replace each proposal by the nearest asset, standing on the floor, hanging from the ceiling, or at its wall.

    Object ids carry the room's id and the slot, so they are unique in the home.
    """
    if not proposals:
        return Draft(job, ())
    categories = [p.category for p in proposals]
    sizes = np.array([p.size for p in proposals])
    matches = _matches(job, index.favouring(job.furniture.style), categories, sizes, np.array([p.latent for p in proposals]))
    placements: list[Placement] = []
    lost: list[str] = []
    for number, (proposal, match) in enumerate(zip(proposals, matches, strict=True)):
        if match is None:
            lost.append(proposal.category)
            continue
        position = anchored(proposal.position, proposal.yaw, proposal.size, match.size, context.polygon)
        position[2] = _height(taxonomy.categories[proposal.category].mount, proposal, float(match.size[2]), context)
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
        placements.append(rounded(placement))
    return Draft(job, tuple(placements), tuple(lost))


def _matches(
    job: RoomJob, index: AssetIndex, categories: Sequence[str], sizes: NDArray[np.float64], latents: NDArray[np.float32]
) -> list[Match | None]:
    """Return the nearest assets; where more shall open, the objects that lose least by it get assets that do."""
    matches = index.match(categories, sizes, latents)
    lacking = (job.furniture.openable or 0) - sum(m.openable for m in matches if m)
    if lacking > 0:
        opening = index.openers().match(categories, sizes, latents)
        still = [k for k, (m, o) in enumerate(zip(matches, opening, strict=True)) if m and o and not m.openable]
        for k in sorted(still, key=lambda k: (_distance(opening[k]) - _distance(matches[k]), k))[:lacking]:
            matches[k] = opening[k]
    return matches


def _distance(match: Match | None) -> float:
    return match.distance if match else np.inf


def _height(mount: str, proposal: Proposal, height: float, context: RoomContext) -> float:
    """Return the z of the asset's bottom: its mount decides, and nothing sticks through floor or ceiling."""
    if mount == "floor":
        return context.elevation
    highest = context.elevation + max(0.0, context.height - height)
    if mount == "ceiling":
        return highest
    return float(np.clip(proposal.position[2], context.elevation, highest))
