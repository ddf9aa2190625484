"""The inventory: which classes a room holds, and how many of each, drawn before anything is placed.

p(counts | room) = product over classes of p(n_c | room, counts of the classes before, N where it is told): a small network
over counts, exact where a diffusion over slots drifts (it loses the chairs of large rooms) and made to be conditioned:
a told number N is met exactly, and so is what is asked of categories.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from pipeline.arrays import Bools, Floats, Ints
from pipeline.diffusion.context import KINDS, CategoryBounds, Floor
from pipeline.diffusion.poses import PoseModel, fit_poses
from pipeline.diffusion.settings import InventorySettings
from pipeline.geometry.compiled import compiled
from pipeline.tensors import Checkpoint, advance, cosine, generator, initial

MOST = 12  # of one class in one room; more are counted as this
DEPTH = 0.6  # of what stands at a wall [m]
WAY = 0.5  # free floor before an opening without a leaf [m]
ON_WALL = 0.05  # how far off a wall's face an opening's ends may lie [m]
STRETCHES = 4  # of wall that furniture may stand at, the longest, which a room's features tell
ROOM_FEATURES = 6 + 2 * (len(KINDS) - 1) + 2 * STRETCHES
DRAWS = 9  # inventories that are drawn for a room, of which the first that meets what is asked is taken
UNTOLD = -1
SEVERAL, LIKELY = 2, 0.003  # so many of a class, or more, are drawn only where that is at least this likely


class Inventory(nn.Module):
    """Logits of each class's count, given the room and the counts of the classes before it; beside it the model of how they stand, `poses`."""

    def __init__(self, classes: int, layouts: int, width: int) -> None:
        super().__init__()
        self.classes = classes
        self.layout = nn.Embedding(layouts, width)
        self.room = nn.Sequential(nn.Linear(ROOM_FEATURES, width), nn.SiLU(), nn.Linear(width, width))
        self.held = nn.Parameter(torch.zeros(classes, MOST + 1, width))  # what n of class c says to the classes after it
        self.asked = nn.Embedding(classes, width)
        self.left = nn.Linear(3, width)  # of a told number: how many are still to come
        self.think = nn.Sequential(nn.Linear(width, 2 * width), nn.SiLU(), nn.Linear(2 * width, width), nn.SiLU())
        self.out = nn.Linear(width, MOST + 1)
        self.poses = PoseModel(classes, layouts, ROOM_FEATURES, width)
        self.own = nn.Parameter(torch.zeros(classes, layouts, MOST + 1))  # how often rooms of a type hold so many, all else unknown
        nn.init.normal_(self.held, std=0.1)
        nn.init.zeros_(self.out.weight)
        nn.init.zeros_(self.out.bias)

    def about(self, features: Tensor, layout: Tensor) -> Tensor:
        """Return what is known of rooms (B, d) from their features (B, F) and types (B,)."""
        known: Tensor = self.room(features) + self.layout(layout)
        return known

    def logits(self, about: Tensor, before: Tensor, left: Tensor, layout: Tensor, which: slice) -> Tensor:
        """Return logits (B, K, MOST + 1) of the classes `which`; `before` (B, K, d) sums what earlier counts say, `left` (B, K) is what a told number leaves."""
        known = (left >= 0).float()
        rest = left.clamp(0, 2 * MOST).float()
        still = self.left(torch.stack([known, known * rest / 8, known * (rest == 0)], -1))
        hidden = nn.functional.layer_norm(about[:, None] + before + self.asked.weight[which] + still, about.shape[-1:])
        answer: Tensor = self.out(self.think(hidden)) + self.own[which, layout].transpose(0, 1)
        return answer

    def forward(self, features: Tensor, layout: Tensor, counts: Tensor, known: Tensor) -> Tensor:
        """Return the log-likelihood (B,) of counts (B, C); `known` (B,) says whose total is told."""
        clipped = counts.clamp_max(MOST)
        says = self.held[torch.arange(self.classes), clipped]
        before = says.cumsum(1) - says
        passed = counts.cumsum(1) - counts
        left = torch.where(known[:, None], counts.sum(1, keepdim=True) - passed, torch.full_like(passed, UNTOLD))
        scores = self.logits(self.about(features, layout), before, left, layout, slice(None)).log_softmax(-1)
        return scores.gather(-1, clipped[..., None])[..., 0].sum(1)


@dataclass(frozen=True, slots=True)
class Ask:
    """What is asked of one room: the exact number of objects or None, bounds on groups of classes (classes, least, most or None), most objects.

    `company`: pairs of groups of classes; a room that holds something of the first holds so many of the second, as far as the rest lets it.
    """

    total: int | None
    bounds: tuple[tuple[tuple[int, ...], int, int | None], ...] = ()
    most: int = 24
    company: tuple[tuple[tuple[int, ...], tuple[int, ...], int], ...] = ()

    @classmethod
    def of(
        cls,
        total: int | None,
        category_bounds: Sequence[CategoryBounds],
        classes: Sequence[str],
        most: int = 24,
        company: Sequence[tuple[Sequence[str], Sequence[str], int]] = (),
    ) -> Ask:
        """Read what a room context asks for, in class indices. A least number that a total cannot hold is cut by nobody: both are asked."""
        order = {name: k for k, name in enumerate(classes)}
        groups = ((tuple(sorted({order[c] for c in d.categories if c in order})), d.least, d.most) for d in category_bounds)
        pairs = ((tuple(order[c] for c in of if c in order), tuple(order[c] for c in also if c in order), n) for of, also, n in company)
        return cls(total, tuple(group for group in groups if group[0]), most, tuple(pair for pair in pairs if pair[0] and pair[1]))

    def completed(self, counts: NDArray[np.int64]) -> Ask:
        """Return the same with company asked for, where an inventory (C,) holds something without it, or something is asked for that goes with it: a desk gets its chair, it does not go.

        What is said of the company itself stands.
        """
        if self.total is not None:
            return self
        said = {c for members, least, most in self.bounds if least or most is not None for c in members}
        barred = {c for members, _, most in self.bounds if most == 0 for c in members}
        both: list[tuple[tuple[int, ...], int, int | None]] = []
        for of, also, n in self.company:
            asked = any(least and set(members) <= set(of) for members, least, _ in self.bounds)
            alone = bool(counts[list(of)].any()) and counts[list(also)].sum() < n and not set(of) <= barred
            if (asked or alone) and said.isdisjoint(also):
                both += [(also, n, None)] if asked else [(of, 1, None), (also, n, None)]
        return replace(self, bounds=(*self.bounds, *both))

    def sized(self, usual: int) -> Ask:
        """Return the same with the number `usual` told, where nobody told one and no more than single things, or none, are asked for."""
        if self.total is not None or any(least > 1 or most not in {None, 0} for _, least, most in self.bounds):
            return self
        return replace(self, total=min(max(usual, 1, sum(least for _, least, _ in self.bounds)), self.most))

    def met_by(self, counts: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Tell which inventories (K, C) meet it."""
        good: NDArray[np.bool_] = counts.sum(1) <= self.most if self.total is None else counts.sum(1) == self.total
        for members, least, most in self.bounds:
            have = counts[:, list(members)].sum(1)
            good &= (have >= least) & (have <= (np.inf if most is None else most))
        for of, also, n in self.company:
            good &= ~counts[:, list(of)].any(1) | (counts[:, list(also)].sum(1) >= n)
        return good


def room_features(floor: Floor, height: float) -> NDArray[np.float32]:
    """Return features (F,) of a room, the same however it is turned: area, extents, perimeter, openings by kind, free wall."""
    walls = floor.ends[(floor.kind == 0) & floor.mask].astype(float)
    a, b = walls[:, 0], walls[:, 1]
    area = 0.5 * float(np.abs((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()))
    extent = np.sort(a.max(0) - a.min(0)) if len(a) else np.zeros(2)
    around = float(np.linalg.norm(b - a, axis=1).sum())
    openings: list[float] = []
    for kind in range(1, len(KINDS)):
        of_kind = (floor.kind == kind) & floor.mask
        ends = floor.ends[of_kind]
        openings += [float(of_kind.sum()) / 2, float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=-1).sum()) / 3]
    shape = [np.log(max(area, 0.5)) - 2, extent[0] / 3 - 1, extent[1] / 4 - 1, around / 12 - 1, len(walls) / 8 - 1, height - 2.7]
    return np.array([*shape, *openings, *(free_stretches(floor).ravel() / 2 - 1)], np.float32)


def free_stretches(floor: Floor) -> NDArray[np.float64]:
    """Return the lengths (2, STRETCHES) of the longest stretches of wall that furniture may stand at, falling [m]: with no opening in DEPTH before them, and with no door.

    A door takes the square that its leaf turns in, where it turns into the room.
    """
    free = np.zeros((2, STRETCHES))
    there, window = floor.mask, floor.kind == KINDS.index("window")
    _find_stretches(
        floor.ends.astype(float),
        floor.normal.astype(float),
        there & (floor.kind == 0),
        there & (floor.kind != 0),
        window,
        floor.hinge,
        free,
    )
    return free


@compiled
def _find_stretches(ends: Floats, normal: Floats, wall: Bools, opening: Bools, window: Bools, hinge: Ints, free: Floats) -> None:
    """Fill in the longest free stretches of walls (M,): between what openings take of them, and between what doors do."""
    taken = np.empty((len(ends), 2))
    for low in range(2):
        for w in np.flatnonzero(wall):
            across, along = ends[w, 1, 0] - ends[w, 0, 0], ends[w, 1, 1] - ends[w, 0, 1]
            length = np.sqrt(across * across + along * along)
            ux, uy, count = across / max(length, 1e-9), along / max(length, 1e-9), 0
            for o in np.flatnonzero(opening):
                if low and window[o]:
                    continue
                wide = np.hypot(ends[o, 1, 0] - ends[o, 0, 0], ends[o, 1, 1] - ends[o, 0, 1])
                depth = 0.0 if window[o] else wide if hinge[o] >= 0 else WAY
                first, last, near, far = np.inf, -np.inf, np.inf, -np.inf
                for end in range(2):
                    for ahead in (0.0, depth):
                        x, y = (
                            ends[o, end, 0] + ahead * normal[o, 0] - ends[w, 0, 0],
                            ends[o, end, 1] + ahead * normal[o, 1] - ends[w, 0, 1],
                        )
                        place, off = x * ux + y * uy, x * normal[w, 0] + y * normal[w, 1]
                        first, last, near, far = min(first, place), max(last, place), min(near, off), max(far, off)
                if near < DEPTH and far > -ON_WALL:
                    k = count
                    while k and taken[k - 1, 0] > first:
                        taken[k] = taken[k - 1]
                        k -= 1
                    taken[k, 0], taken[k, 1] = first, last
                    count += 1
            at = 0.0
            for k in range(count):
                _keep_longest(min(taken[k, 0], length) - at, free[low])
                at = max(at, taken[k, 1])
            _keep_longest(length - at, free[low])


@compiled
def _keep_longest(length: float, longest: Floats) -> None:
    """Put a length into a falling list where it belongs."""
    for k in range(len(longest)):
        if length > longest[k]:
            longest[k], length = length, longest[k]


class Holdings(NamedTuple):
    """What n rooms hold: features (n, F), types (n,), counts (n, C); classes, rising, and pose classes (n, N) of their objects, C and UNTOLD for padding."""

    features: NDArray[np.float32]
    layouts: NDArray[np.int64]
    counts: NDArray[np.int64]
    classes: NDArray[np.int64]
    poses: NDArray[np.int64]


def initial_inventory(contents: Holdings, types: int, width: int, seed: int) -> Inventory:
    """Return an inventory model that knows how often each room type holds how many of a class, and nothing else yet."""
    net = initial(lambda: Inventory(contents.counts.shape[1], types, width), seed, "inventory-init")
    counts, layouts = torch.from_numpy(contents.counts), torch.from_numpy(contents.layouts)
    with torch.no_grad():
        for k in range(types):
            rooms = counts[layouts == k].clamp_max(MOST)
            share = torch.stack([(rooms == n).float().sum(0) for n in range(MOST + 1)], -1) + 0.02
            net.own[:, k] = (share / share.sum(-1, keepdim=True)).log()
    net.poses.learn_shares(layouts, torch.from_numpy(contents.classes), torch.from_numpy(contents.poses))
    return net


def fit(
    net: Inventory, contents: Holdings, settings: InventorySettings, seed: int, checkpoint: Checkpoint | None = None, every: int = 250
) -> Inventory:
    """Train an inventory model in place on what rooms hold: AdamW, a cosine to zero. Every draw is keyed by `seed`.

    With a `checkpoint` it goes on from there, and is kept there `every` so many steps.
    """
    rng = generator(seed, "inventory")
    features, layouts, counts, classes, poses = (torch.from_numpy(part) for part in contents)
    optimiser = torch.optim.AdamW(net.parameters(), weight_decay=1e-3)
    done = checkpoint.resume(net, optimiser, rng) if checkpoint else 0
    for step in range(done, settings.steps):
        rows = torch.randint(len(features), (min(settings.batch, len(features)),), generator=rng)
        known = torch.rand(len(rows), generator=rng) < settings.count_known
        (-net(features[rows], layouts[rows], counts[rows], known).mean()).backward()
        advance(optimiser, settings.learning_rate * min(1.0, (step + 1) / 50) * cosine(step / settings.steps), 1.0)
        if checkpoint and (step + 1) % every == 0:
            checkpoint.keep(step + 1, net, optimiser, rng)
    fit_poses(net.poses, (features, layouts, classes, poses), settings.steps // 4, settings.batch, settings.learning_rate, seed)
    return net.eval()


@torch.inference_mode()
def draw_inventories(
    net: Inventory, features: Tensor, layout: Tensor, asks: Sequence[Ask], uniform: NDArray[np.float64]
) -> list[NDArray[np.int64]]:
    """Draw one inventory (C,) for each of B rooms; `uniform` (B, DRAWS, C) in [0, 1) is all the randomness.

    The first draw is free. Where it lacks one thing of a kind, the room is drawn again with the number of the first draw told:
    rooms then hold what they need and no more than rooms of their type do. `repair_counts` mends what no draw meets.
    """
    about = net.about(features, layout)
    free = [Ask(None, most=ask.most) for ask in asks]
    inventories = list(_draw_counts(net, about, layout, free, uniform[:, :1], np.zeros((len(asks), net.classes)))[:, 0])
    met = [bool(ask.met_by(mine[None])[0]) for ask, mine in zip(asks, inventories, strict=True)]
    lacking = [i for i, mine in enumerate(inventories) if not (met[i] and mine.any())]
    if not lacking:
        return inventories
    asks = [asks[i] if met[i] else asks[i].completed(inventories[i]).sized(int(inventories[i].sum())) for i in lacking]
    usual = np.array([net.own[:, layout[i]].softmax(-1).double().numpy() @ np.arange(MOST + 1.0) for i in lacking])
    drawn = _draw_counts(net, about[lacking], layout[lacking], asks, uniform[lacking, 1:], usual)
    for i, ask, mine, own in zip(lacking, asks, drawn, usual, strict=True):
        good, apart = (np.flatnonzero(a.met_by(mine) & (mine.sum(1) > 0)) for a in (ask, replace(ask, company=())))
        good = good if len(good) else apart
        inventories[i] = mine[good[0]] if len(good) else repair_counts(mine[-1], ask, own)
    return inventories


def _draw_counts(
    net: Inventory, about: Tensor, layout: Tensor, asks: Sequence[Ask], uniform: NDArray[np.float64], usual: NDArray[np.float64]
) -> NDArray[np.int64]:
    """Draw inventories (B, D, C) from `uniform` (B, D, C); `usual` (B, C) is how many of each class rooms of these types hold.

    The later half of a room's draws are held to what is asked while they are made: a bounded group is cut at its most and
    filled with what is most usual of it, a told number is never passed. Those before are samples of what the net knows, without its tail.
    """
    rooms, draws, classes = uniform.shape
    about = about.repeat_interleave(draws, 0)
    kinds = layout.repeat_interleave(draws)
    total = np.repeat([UNTOLD if a.total is None else a.total for a in asks], draws)
    full = np.repeat([a.most for a in asks], draws)
    held_to = np.tile(np.arange(draws) >= (draws + 1) // 2, rooms)
    counts = np.zeros((rooms * draws, classes), np.int64)
    before = torch.zeros(rooms * draws, 1, about.shape[-1])
    for c in range(classes):
        left = np.where(total >= 0, np.maximum(total - counts.sum(1), 0), UNTOLD)
        logits = net.logits(about, before, torch.from_numpy(left)[:, None], kinds, slice(c, c + 1))[:, 0]
        chance = logits.softmax(-1).double().numpy()
        chance[:, SEVERAL:][chance[:, SEVERAL:] < LIKELY] = 0.0  # the net's tail: eight loveseats once in a thousand rooms
        least, most = _limits(asks, counts, c, usual)
        most = np.minimum(most, np.where(total >= 0, left, (full - counts.sum(1)).clip(0)))
        n = np.arange(MOST + 1)
        allowed = (n >= np.minimum(least, most)[:, None]) & (n <= most[:, None])
        chance = np.where(allowed | ~held_to[:, None], chance, 0.0)
        lost = chance.sum(1) <= 1e-300
        chance[lost, allowed[lost].argmax(1)] = 1.0  # of what the net never does, the least that is asked for
        ladder = np.cumsum(chance, 1)
        picked = (ladder <= (uniform[:, :, c].reshape(-1) * ladder[:, -1])[:, None]).sum(1).clip(0, MOST)
        counts[:, c] = picked
        before = before + net.held[c, torch.from_numpy(picked)][:, None]
    return counts.reshape(rooms, draws, classes)


def _limits(
    asks: Sequence[Ask], counts: NDArray[np.int64], c: int, usual: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the least and the most (B * DRAWS,) of class c that bounds on its groups leave, given the counts so far."""
    draws = len(counts) // len(asks)
    least, most = np.zeros(len(counts), np.int64), np.full(len(counts), MOST)
    for i, ask in enumerate(asks):
        part = slice(i * draws, (i + 1) * draws)
        for members, low, high in ask.bounds:
            if c not in members:
                continue
            have = counts[part][:, list(members)].sum(1)
            if c == max(members, key=lambda k: usual[i, k]):
                least[part] = np.maximum(least[part], (low - have).clip(0))
            if high is not None:
                most[part] = np.minimum(most[part], (high - have).clip(0))
    return least, most


def repair_counts(counts: NDArray[np.int64], ask: Ask, usual: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return counts (C,) changed one object at a time until they meet what is asked; `usual` (C,) is how many of each a room of the type holds.

    What is added is what rooms of the type hold most of beyond what is there; what goes is what there is most of beyond that.
    """
    counts = counts.copy()
    bound = np.zeros(len(counts), bool)
    for members, least, most in sorted(ask.bounds, key=lambda b: len(b[0])):
        mine = list(members)
        while counts[mine].sum() < least:
            counts[mine[int(np.argmax((usual - counts)[mine]))]] += 1
        while most is not None and counts[mine].sum() > most:
            counts[mine[int(np.argmax(np.where(counts[mine] > 0, (counts - usual)[mine], -np.inf)))]] -= 1
        bound[mine] = True
    if ask.total is None and not counts.sum() and not bound.all():
        counts[int(np.argmax(np.where(bound, -np.inf, usual)))] += 1
    wanted = min(int(counts.sum()), ask.most) if ask.total is None else ask.total
    barred = np.array([any(c in members and most == 0 for members, _, most in ask.bounds) for c in range(len(counts))])
    if barred.all():
        return np.zeros_like(counts)
    while counts.sum() != wanted:
        free = ~bound if (~bound).any() else ~barred
        if counts.sum() < wanted:
            counts[int(np.argmax(np.where(free, usual / (counts + 1.0), -np.inf)))] += 1
        else:
            spare = free & (counts > 0) if (free & (counts > 0)).any() else counts > 0
            counts[int(np.argmax(np.where(spare, (counts + 1.0) / (usual + 0.1), -np.inf)))] -= 1
    return counts
