"""The library as arrays: what can be retrieved, how far it is from what was asked, and what its joints sweep."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats
from pipeline.card import cards
from pipeline.errors import ContentError
from pipeline.geometry.kinematics import beyond_body
from pipeline.retrieval.nearest import Asks, AssetArrays, DistanceWeights, Shelves, Tastes, nearest_assets

Row = Mapping[str, Any]
KITCHEN = "kitchen"  # finish of the units of a kitchen
UNKNOWN = (np.nan,) * 3  # finish
TIE = 1e-12  # m3: costs of merging boxes that are nearer than that are alike
SAT_AT = ("desk", "dressing_table", "dining_table")  # categories at which people sit
SEAT = 0.55  # width of a seat, and of who sits on it [m]
KNEES = 0.5  # what opens above this is above the seat [m]
CLOSE = 0.4  # a seat behind what reaches no farther before the front is still at the desk [m]


@dataclass(frozen=True, slots=True)
class Taste:
    """What steers retrieval in a room: the home's `style` ("" for none), `wished` where somebody asked for it, and finishes by group."""

    style: str = ""
    wished: bool = False
    finishes: Mapping[str, Floats] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class RetrievalSettings:
    """How an asset is chosen (section `retrieval` of params.yaml)."""

    latent_weight: float = 0.3  # weight of the standardised latent's rms difference
    size_weight: float = 2.0  # weight of the rms log ratio of the sizes
    prefer_openable: float = 1.5  # assets that do not open are so many times as far, where the category has some that do
    prefer_offset: float = 0.15  # and this much farther, so that a near-perfect static match does not always win
    prefer_style: float = 1.5  # where a style is asked for: assets of another are so much farther
    prefer_taste: float = 0.3  # the same where nobody asked for the style that was drawn for the home
    prefer_finish: float = 0.25  # so much farther is an asset whose finish is 30 (CIELAB) from the room's, at most twice that
    shortlist: int = 8  # nearest assets whose finishes are looked at
    stretch: float = 0.15  # largest change of a static asset's size per axis; articulated ones are never scaled
    sweep_boxes: int = 4  # boxes kept per asset for the articulated-collision guidance


@dataclass(frozen=True, slots=True)
class Match:
    """One retrieved asset: `scale` (3,) on its own size is 1 for articulated ones; `size` (3,) [m] is what it then has."""

    asset_id: str
    distance: float
    scale: NDArray[np.float64]
    size: NDArray[np.float64]
    openable: bool


@dataclass(frozen=True, slots=True)
class AssetIndex:
    """All assets of the library, ordered by asset_id.

    `sizes` (A, 3) [m]; `latents` (A, 32), standardised by `mean` and `spread`; `sweeps` (A, K, 2, 3) [m] object frame,
    NaN where an asset has fewer than K boxes; `stretch` (A, 3) is the largest change of size per axis; `shelves` lists the rows of each category that can be used; `styles` (A,) are "" where there is none, `finishes` (A, 3) CIELAB, NaN likewise.
    """

    asset_ids: tuple[str, ...]
    categories: tuple[str, ...]
    sizes: NDArray[np.float64]
    latents: NDArray[np.float64]
    mean: NDArray[np.float64]
    spread: NDArray[np.float64]
    articulated: NDArray[np.bool_]
    openable: NDArray[np.bool_]
    sweep_boxes: NDArray[np.float32]
    stretch: NDArray[np.float64]
    shelves: Mapping[str, NDArray[np.int64]]
    settings: RetrievalSettings
    styles: NDArray[np.str_]
    finishes: NDArray[np.float64]

    def openers(self) -> AssetIndex:
        """Return the index of the assets that open alone."""
        shelves = {name: shelf[self.openable[shelf]] for name, shelf in self.shelves.items()}
        return replace(self, shelves={name: shelf for name, shelf in shelves.items() if len(shelf)})

    @classmethod
    def from_tables(
        cls,
        assets: Iterable[Row],
        latents: Iterable[Row],
        joints: Iterable[Row] = (),
        settings: RetrievalSettings | None = None,
    ) -> AssetIndex:
        """Build the index from rows of `assets`, `latents` and `asset_joints`.

        Raises ContentError when there is no asset, or one has no latent: the tables are then not of one run.
        """
        settings = settings or RetrievalSettings()
        rows = sorted(assets, key=lambda a: str(a["asset_id"]))
        if not rows:
            raise ContentError(
                "the library holds no furniture", "look at data/tables/rejects.parquet for why, then run `dvc repro preprocess` again"
            )
        known = {r["asset_id"]: (r["latent"], r.get("finish") or UNKNOWN) for r in latents}
        lost = [r["asset_id"] for r in rows if r["asset_id"] not in known]
        if lost:
            raise ContentError(f"{len(lost)} assets have no latent ({lost[0]} ...)", "run `dvc repro encode` again")
        swept: dict[str, list[Any]] = {}
        for joint in joints:
            swept.setdefault(joint["asset_id"], []).append([joint["sweep_min"], joint["sweep_max"]])
        boxes = np.full((len(rows), settings.sweep_boxes, 2, 3), np.nan, np.float32)
        for i, row in enumerate(rows):
            whole = np.array(swept.get(row["asset_id"], []), float).reshape(-1, 2, 3)
            merged = merged_boxes(beyond_body(whole, row["size"]), settings.sweep_boxes)
            boxes[i, : len(merged)] = merged
        shapes, finishes = zip(*(known[r["asset_id"]] for r in rows), strict=True)
        raw = np.array(shapes, np.float64).reshape(len(rows), -1)
        mean = raw.mean(0)
        # A latent channel that the encoder does not use must not be blown up by its tiny spread.
        spread = np.maximum(raw.std(0), 0.05)
        names, sizes = tuple(str(r["category"]) for r in rows), np.array([r["size"] for r in rows], float).reshape(-1, 3)
        shelves = {name: np.flatnonzero(np.array(names) == name) for name in sorted(set(names))}
        for name in set(SAT_AT).intersection(shelves):
            seats = [row for row in shelves[name] if has_knee_room(sizes[row], boxes[row][~np.isnan(boxes[row]).any((1, 2))])]
            shelves[name] = np.array(seats, np.int64) if seats else shelves[name]
        return cls(
            tuple(str(r["asset_id"]) for r in rows),
            names,
            sizes,
            (raw - mean) / spread,
            mean,
            spread,
            np.array([r["articulated"] for r in rows], bool),
            np.array([r["openable"] for r in rows], bool),
            boxes,
            stretch_limits(names, [bool(r["articulated"]) for r in rows], settings.stretch),
            shelves,
            settings,
            np.array([str(r.get("style", "")) for r in rows], np.str_),
            np.array(finishes, float),
        )

    def suited(
        self, tastes: Sequence[Taste], categories: Sequence[str | None], sizes: Floats, latents: Floats
    ) -> tuple[NDArray[np.int64], Floats]:
        """Return the row (P,) of the asset that suits each ask best, -1 where there is none, and its distance (P,).

        `tastes` (P,); `sizes` (P, 3) [m], `latents` (P, 32). An asset of another style than the taste's is farther, by `prefer_style` where
        that was wished for, else by `prefer_taste`; what opens has often none. Of the `shortlist` nearest that is taken which is nearest
        with its finish counted in.
        """
        names = sorted({name for name in categories if name is not None and name in self.shelves})
        place: dict[str | None, int] = {name: k for k, name in enumerate(names)}
        groups = [cards()[name].finish if name in cards() else "" for name in names]
        distinct = {id(taste): taste for taste in tastes}
        which = {key: t for t, key in enumerate(distinct)}
        asks = Asks(
            np.array([place.get(name, -1) for name in categories], np.int64),
            np.array([which[id(taste)] for taste in tastes], np.int64),
            np.asarray(sizes, np.float64),
            (np.asarray(latents, np.float64) - self.mean) / self.spread,
        )
        columns = sorted(set(groups))
        shelves = Shelves.of([self.shelves[name] for name in names], [columns.index(group) for group in groups])
        own, s = self._tastes(list(distinct.values()), columns), self.settings
        return nearest_assets(self._arrays(), shelves, own, asks, self._weights(s.prefer_finish), s.shortlist)

    def _arrays(self) -> AssetArrays:
        return AssetArrays(self.sizes, self.latents, self.openable, self.finishes)

    def _tastes(self, tastes: Sequence[Taste], groups: Sequence[str]) -> Tastes:
        styled = self.styles != ""
        other = [styled & (self.styles != taste.style) if taste.style else np.zeros(len(styled), bool) for taste in tastes]
        costs = [self.settings.prefer_style if taste.wished else self.settings.prefer_taste for taste in tastes]
        finishes = [[taste.finishes.get(group, UNKNOWN) for group in groups] for taste in tastes]
        return Tastes(
            np.array(other).reshape(len(tastes), -1), np.array(costs, float), np.array(finishes, float).reshape(len(tastes), len(groups), 3)
        )

    def _weights(self, finish: float) -> DistanceWeights:
        s = self.settings
        return DistanceWeights(s.latent_weight, s.size_weight, s.prefer_openable, s.prefer_offset, finish)

    def smaller(self, taste: Taste, asset_id: str, max_area: float) -> Match | None:
        """Return the closest asset of the same category whose footprint w * d is below `max_area` [m2] (algorithm 2).

        Closeness is measured from `asset_id` itself; an articulated asset is followed by another that opens, when the
        category has one small enough, so that nothing is gained by replacing cabinets with boxes. Scale is 1.
        """
        row = self.row(asset_id)
        shelf = self.shelves[self.categories[row]]
        areas = self.sizes[shelf, 0] * self.sizes[shelf, 1]
        fits = shelf[(areas < max_area - 1e-9) & (shelf != row)]
        alike = fits[self.openable[fits]] if self.openable[row] else fits
        fits = alike if len(alike) else fits
        if not len(fits):
            return None
        one = np.zeros(1, np.int64)
        asks = Asks(one, one, self.sizes[row][None], self.latents[row][None])
        (closest,), (far,) = nearest_assets(
            self._arrays(), Shelves.of([fits], [0]), self._tastes([taste], [""]), asks, self._weights(0.0), 1
        )
        return self.fit(int(closest), float(far), self.sizes[closest])

    def lookup(
        self,
        tastes: Sequence[Taste | None],
        categories: Sequence[Sequence[str | None]],
        positions: Floats,
        sizes: Floats,
        latents: Floats,
    ) -> tuple[Floats, NDArray[np.float32]]:
        """Return the placed size (B, N, 3) and the sweep boxes (B, N, K, 2, 3) [m] of the asset that each slot of B rooms will retrieve.

        The size is the asset's own, static ones stretched as `fit` would; a slot without an asset keeps what it asked.
        """
        flat = [c for row in categories for c in row]
        each = [taste or Taste() for taste, row in zip(tastes, categories, strict=True) for _ in row]
        meant, shapes = np.array(sizes, float), np.array(latents, float)
        for room, names in enumerate(categories):
            meant[room], shapes[room] = alike_in_sets(names, positions[room], meant[room], shapes[room])
        asked = meant.reshape(-1, 3)
        rows, _ = self.suited(each, flat, asked, shapes.reshape(len(flat), -1))
        safe, has_asset = np.maximum(rows, 0), rows >= 0
        scale = self.scales(safe, asked)
        placed = np.where(has_asset[:, None], self.sizes[safe] * scale, asked)
        boxes = self.sweep_boxes[safe].copy()
        boxes[~has_asset] = np.nan
        shape = (len(categories), -1)
        return placed.reshape(*shape, 3), boxes.reshape(*shape, *boxes.shape[1:])

    def row(self, asset_id: str) -> int:
        """Return the row of an asset."""
        at = bisect_left(self.asset_ids, asset_id)
        if at == len(self.asset_ids) or self.asset_ids[at] != asset_id:
            raise ContentError(f"asset {asset_id!r} is not in the library", "run `dvc repro` so that library and samples agree")
        return at

    def scales(self, rows: NDArray[np.int64], asked: Floats) -> Floats:
        """Return by what the assets of rows (P,) are stretched towards the `asked` sizes (P, 3) [m]."""
        return np.clip(asked / self.sizes[rows], 1 - self.stretch[rows], 1 + self.stretch[rows])

    def fit(self, row: int, distance: float, asked: Floats) -> Match:
        """Return the asset of a row as what was `asked` for (3,) [m] gets it."""
        scale = self.scales(np.array([row]), np.asarray(asked, float)[None])[0]
        return Match(self.asset_ids[row], distance, scale, self.sizes[row] * scale, bool(self.openable[row]))


def stretch_limits(categories: Sequence[str], articulated: Sequence[bool], most: float) -> Floats:
    """Return the largest change of size per axis (A, 3): static assets are stretched a little, kitchen units in width and depth alone: one works at one height."""
    limits = np.where(np.array(articulated), 0.0, most)[:, None] * np.ones(3)
    limits[[name in cards() and cards()[name].finish == KITCHEN for name in categories], 2] = 0.0
    return limits


def sets(categories: Sequence[str | None], positions: Floats) -> list[list[int]]:
    """Return the groups (indices, two or more each) of things at `positions` (P, 2 or 3) [m] that are to be one model."""
    groups: dict[tuple[str, int], list[int]] = {}
    for k, category in enumerate(categories):
        of = cards()[category].set if category and category in cards() else None
        if category is None or of is None:
            continue
        near = [(float(np.linalg.norm(positions[j, :2] - positions[k, :2])), j) for j, other in enumerate(categories) if other in of.at]
        if near and min(near)[0] <= of.within:
            groups.setdefault((category, min(near)[1]), []).append(k)
    return [group for group in groups.values() if len(group) > 1]


def alike_in_sets(categories: Sequence[str | None], positions: Floats, sizes: Floats, latents: Floats) -> tuple[Floats, Floats]:
    """Return the sizes (P, 3) [m] and latents (P, 32) that are asked for: sets ask for one thing, the mean of theirs."""
    asked, shapes = np.array(sizes, float), np.array(latents, float)
    for group in sets(categories, positions):
        asked[group], shapes[group] = asked[group].mean(0), shapes[group].mean(0)
    return asked, shapes


def merged_boxes(boxes: NDArray[np.float64], most: int) -> NDArray[np.float64]:
    """Merge boxes (J, 2, 3) until at most `most` are left; each input lies inside one output.

    Greedy: the pair whose union adds the least volume over its two members goes first (ties: the earlier pair).
    """
    left = boxes[np.isfinite(boxes).all((1, 2)) & (boxes[:, 1] > boxes[:, 0]).all(1)]
    while len(left) > most:
        one, other = np.triu_indices(len(left), 1)
        unions = np.stack([np.minimum(left[one, 0], left[other, 0]), np.maximum(left[one, 1], left[other, 1])], 1)
        volumes = volume(left)
        cost = volume(unions) - volumes[one] - volumes[other]
        pair = int(np.flatnonzero(cost <= cost.min() + TIE)[0])
        left = np.delete(left, other[pair], 0)
        left[one[pair]] = unions[pair]
    return left.reshape(-1, 2, 3)


def volume(boxes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the volumes (N,) of boxes (N, 2, 3) [m3]."""
    return np.asarray(np.prod(boxes[:, 1] - boxes[:, 0], axis=1))


def has_knee_room(size: NDArray[np.float64], sweeps: NDArray[np.float64]) -> bool:
    """Tell whether a table of this size (3,) leaves a place for a seat at its front; `sweeps` (K, 2, 3) are the boxes through which its parts move [m]."""
    half, front = float(size[0]) / 2, -float(size[1]) / 2
    low, high = sweeps[:, 0], sweeps[:, 1]
    blocks = (low[:, 2] < KNEES) & (front - low[:, 1] > CLOSE)
    place = -half
    for box in np.argsort(low[blocks, 0], kind="stable"):
        if low[blocks][box, 0] - place >= SEAT:
            return True
        place = max(place, float(high[blocks][box, 0]))
    return not blocks.any() or half - place >= SEAT
