"""The catalogue: which models there are, by the cards, in sizes drawn in strata. Cheap: ids, categories and sizes need no mesh."""

import functools
import uuid
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import ndtri

from pipeline import seeds, style, taxonomy
from pipeline.card import Corpus, Form, Size, cards
from pipeline.corpus.furniture.finishes import STYLES, SUPER_CATEGORIES

TAIL = float(ndtri(0.95))
MOST_SKEWED = 1.2  # largest shape parameter of the log-normal; beyond it a handful of draws cannot show the spread
LEAST, MOST = 0.75, 1.3  # no draw is smaller than this share of the 5th percentile, or larger than this multiple of the 95th
ROUNDS = 6
SERIES = "series"  # group of styles.yaml


def draw_sizes(rng: np.random.Generator, size: Size, count: int, rounds: Sequence[bool] = ()) -> NDArray[np.float64]:
    """Draw `count` sizes (count, 3) [m]: per axis one draw from each of `count` equal quantile strata, in random order.

    From three draws on their mean and standard deviation are those of the category, as far as the bounds let them. Where
    `rounds` (count,) is true, width and depth are equal.
    """
    drawn = np.stack([_axis(rng, size, axis, count) for axis in range(3)], axis=1)
    for axis in range(3):
        drawn[:, axis] = rng.permutation(drawn[:, axis])
    mask = np.array(rounds, bool) if len(rounds) else np.zeros(count, bool)
    if mask.any():
        drawn[mask, :2] = _round(rng, size, int(mask.sum()))[:, None]
    for _ in range(ROUNDS):  # what is clipped at a bound shifts the others
        for axis in range(3):
            free = ~mask if axis < 2 and (~mask).sum() >= 2 else np.ones(count, bool)
            _standardise(drawn[:, axis], free, size, axis)
    if mask.any():
        drawn[mask, 1] = drawn[mask, 0]
    return drawn


def _axis(rng: np.random.Generator, size: Size, axis: int, count: int) -> NDArray[np.float64]:
    """Draw one axis: a shifted log-normal with the category's mean and deviation, leaning as its percentiles do."""
    mean, std = size.mean[axis], size.std[axis]
    z = ndtri((np.arange(count) + rng.uniform(0.1, 0.9, count)) / max(count, 1))
    above, below = size.p95[axis] - mean, mean - size.p05[axis]
    if min(above, below) <= 0:
        return np.asarray(mean + std * z)
    shape, sign = skew(above / below)
    if shape < 1e-3:
        return np.asarray(mean + std * z)
    scale = std / np.sqrt(np.expm1(shape**2))
    return np.asarray(mean + sign * scale * (np.exp(sign * shape * z - shape**2 / 2) - 1))


@functools.lru_cache(maxsize=512)
def skew(ratio: float) -> tuple[float, float]:
    """Return (shape, sign) of the log-normal whose (p95 - mean) / (mean - p05) is `ratio`; sign -1: it leans the other way."""
    sign, wanted = (1.0, ratio) if ratio >= 1 else (-1.0, 1 / ratio)

    def lean(shape: float) -> float:
        middle = np.exp(shape**2 / 2)
        return float((np.exp(TAIL * shape) - middle) / (middle - np.exp(-TAIL * shape)))

    # The ratio grows with the shape up to a point; the mean passes the 95th percentile far beyond MOST_SKEWED.
    peak = max(np.linspace(0.01, MOST_SKEWED, 60), key=lean)
    if wanted <= lean(0.01):
        return 0.0, sign
    return (float(peak) if wanted >= lean(float(peak)) else float(brentq(lambda s: lean(s) - wanted, 0.01, peak))), sign


def _round(rng: np.random.Generator, size: Size, count: int) -> NDArray[np.float64]:
    """Draw diameters (count,): where the distributions of width and depth meet, each weighed by its precision."""
    precision = 1 / np.maximum(size.std[:2], 1e-3) ** 2
    middle = float((np.array(size.mean[:2]) * precision).sum() / precision.sum())
    z = ndtri((rng.permutation(count) + rng.uniform(0.1, 0.9, count)) / count)
    return np.asarray(np.maximum(middle + 0.8 * min(size.std[:2]) * z, LEAST * max(size.p05[:2])))


def _standardise(values: NDArray[np.float64], free: NDArray[np.bool_], size: Size, axis: int) -> None:
    """Shift and stretch the `free` values so that all together have the category's mean and deviation; keep the bounds."""
    count = len(values)
    if count < 3:
        return
    mean, std = size.mean[axis], size.std[axis]
    fixed = values[~free]
    n = int(free.sum())
    middle = (count * mean - fixed.sum()) / n
    variance = (count * std**2 - float(((fixed - mean) ** 2).sum())) / n - (middle - mean) ** 2
    now = float(values[free].std())
    stretch = np.sqrt(max(variance, 0.04 * std**2)) / now if now > 1e-9 else 1.0
    values[free] = middle + (values[free] - values[free].mean()) * stretch
    np.clip(values, LEAST * size.p05[axis], MOST * size.p95[axis], out=values)


@functools.cache
def corpus_cards() -> Mapping[str, Corpus]:
    """Return what the cards say of the corpus, by category, in the corpus's order."""
    listed = [c for c in cards().values() if c.corpus.forms]
    return {c.name: c.corpus for c in sorted(listed, key=lambda c: (c.order if c.corpus.order is None else c.corpus.order, c.name))}


def styles_of(form: Form) -> tuple[str, ...]:
    """Return the styles that a form comes in; words for several are spelt out."""
    return tuple(s for word in form.styles for s in style.load().groups.get(word, (word,))) or tuple(STYLES)


@dataclass(frozen=True, slots=True)
class Model:
    """One model. `size` (w, d, h) [m] is the box at rest in the object frame; what `assembly.shape_of` gives it.

    `model_id` is a uuid4 for 3D-FUTURE, digits for PartNet-Mobility; `future_name` and `super_category` are what
    model_info.json calls it, `partnet_category` what meta.json does ("" for static models); `form` and `seed` decide its look.
    """

    model_id: str
    category: str
    size: tuple[float, float, float]
    style: str
    form: str
    future_name: str
    super_category: str
    partnet_category: str
    seed: int

    @property
    def articulated(self) -> bool:
        """Whether the model is of the articulated library."""
        return bool(self.partnet_category)


@dataclass(frozen=True, slots=True)
class Catalogue:
    """All models: `future` static ones, written as 3D-FUTURE folders; `partnet` articulated ones, as PartNet-Mobility folders."""

    future: tuple[Model, ...]
    partnet: tuple[Model, ...]


def series_rng(style_name: str) -> np.random.Generator:
    """Return the generator of what all units of a series share: one kitchen looks the same in every catalogue."""
    return seeds.generator(0, "corpus.furniture.series", style_name)


@functools.lru_cache(maxsize=8)
def catalogue(seed: int, size: float = 1.0) -> Catalogue:
    """Return the models of a seed. `size` scales their number: 1 gives some 900 static and 350 articulated ones."""
    future: list[Model] = []
    partnet: list[Model] = []
    for category, card in corpus_cards().items():
        future += _models(seed, category, card, max(1, round(card.static * size)), articulated=False)
        if card.moving:
            partnet += _models(seed, category, card, max(1, round(card.moving * size)), articulated=True)
    return Catalogue(tuple(future), tuple(_assign_ids(seed, partnet)))


def _models(seed: int, category: str, card: Corpus, count: int, *, articulated: bool) -> list[Model]:
    """Draw `count` models of one category: forms in turn, styles at random, sizes in strata."""
    rng = seeds.generator(seed, "corpus.furniture", "partnet" if articulated else "future", category)
    entry = taxonomy.load().categories[category]
    usable = [name for name, form in card.forms.items() if not (articulated and form.still)]
    start = int(rng.integers(len(usable)))  # dealt round robin from there, so that each comes equally often
    names = [usable[(start + i) % len(usable)] for i in range(count)]
    forms = [card.forms[name] for name in names]
    styles = _series(rng, count) if card.series else [_style(rng, form) for form in forms]
    boxes = draw_sizes(rng, cards()[category].size, count, [form.round for form in forms])
    _raise(forms, boxes)
    models = []
    for wanted, style_name, box in zip(names, styles, boxes, strict=True):
        w, d, h = (round(float(x), 3) for x in box)
        name = wanted if h >= card.forms[wanted].least_height else next(iter(card.forms))
        form = card.forms[name]
        models.append(
            Model(
                model_id=str(uuid.UUID(bytes=rng.bytes(16), version=4)),
                category=category,
                size=(w, w if form.round else d, w if form.upright else h),
                style=style_name,
                form=name,
                future_name=form.name or card.name,
                super_category=SUPER_CATEGORIES.get(entry.super, "Others"),
                partnet_category=entry.names.partnet[0] if articulated else "",
                seed=int(rng.integers(2**31)),
            )
        )
    return models


def _raise(forms: Sequence[Form], boxes: NDArray[np.float64]) -> None:
    """Swap heights of `boxes` (count, 3) in place, so that forms that need a height have it where there is one to be had."""
    for k, form in enumerate(forms):
        if boxes[k, 2] < form.least_height:
            able = [j for j, other in enumerate(forms) if boxes[j, 2] >= form.least_height and boxes[k, 2] >= other.least_height]
            if able:
                j = min(able, key=lambda j: float(boxes[j, 2]))
                boxes[[k, j], 2] = boxes[[j, k], 2]


def _style(rng: np.random.Generator, form: Form) -> str:
    """Draw a style by its share, among those that suit the form."""
    names = styles_of(form)
    shares = np.array([STYLES[name].share for name in names])
    return str(rng.choice(names, p=shares / shares.sum()))


def _series(rng: np.random.Generator, count: int) -> list[str]:
    """Deal the styles in which kitchens are sold, so that each series has units of every category."""
    names = style.load().groups[SERIES]
    start = int(rng.integers(len(names)))
    return [names[(start + k) % len(names)] for k in range(count)]


def _assign_ids(seed: int, models: list[Model]) -> list[Model]:
    """Give the articulated models PartNet-Mobility's kind of id: distinct numbers of five digits, in no order."""
    rng = seeds.generator(seed, "corpus.furniture", "partnet_ids")
    numbers = rng.choice(np.arange(10_000, 100_000), size=len(models), replace=False)
    return [replace(model, model_id=str(number)) for model, number in zip(models, numbers, strict=True)]
