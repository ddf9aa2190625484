"""The catalogue: which models there are. Cheap: ids, categories and sizes need no mesh."""

import functools
import uuid
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pipeline import seeds, taxonomy
from pipeline.corpus.furniture import sizes
from pipeline.corpus.furniture.finishes import MANNERS
from pipeline.corpus.furniture.lines import OTHER_SUPER_CATEGORY, SUPER_CATEGORIES, Form, Line, lines


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


@functools.lru_cache(maxsize=8)
def catalogue(seed: int, size: float = 1.0) -> Catalogue:
    """Return the models of a seed. `size` scales their number: 1 gives some 900 static and 350 articulated ones."""
    future: list[Model] = []
    partnet: list[Model] = []
    for category, line in lines().items():
        future += _models(seed, category, line, max(1, round(line.static * size)), articulated=False)
        if line.moving:
            partnet += _models(seed, category, line, max(1, round(line.moving * size)), articulated=True)
    return Catalogue(tuple(future), tuple(_assign_ids(seed, partnet)))


def _models(seed: int, category: str, line: Line, count: int, *, articulated: bool) -> list[Model]:
    """Draw `count` models of one category: forms in turn, styles at random, sizes in strata."""
    library = "partnet" if articulated else "future"
    rng = seeds.generator(seed, "corpus.furniture", library, category)
    entry = taxonomy.load().categories[category]
    forms = _turns(rng, [f for f in line.forms if not (articulated and f.still)], count)
    styles = [_style(rng, form) for form in forms]
    boxes = sizes.draw(rng, sizes.load()[category], count, [form.round for form in forms])
    _raise(forms, boxes)
    models = []
    for form, style, box in zip(forms, styles, boxes, strict=True):
        w, d, h = (round(float(x), 3) for x in box)
        kind = form if h >= form.least_height else line.forms[0]
        if kind.round:
            d = w
        if kind.upright:
            h = w
        models.append(
            Model(
                model_id=str(uuid.UUID(bytes=rng.bytes(16), version=4)),
                category=category,
                size=(w, d, h),
                style=str(style),
                form=kind.name,
                future_name=kind.future,
                super_category=SUPER_CATEGORIES.get(entry.super, OTHER_SUPER_CATEGORY),
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
    shares = np.array([MANNERS[name].share for name in form.styles])
    return str(rng.choice(form.styles, p=shares / shares.sum()))


def _turns(rng: np.random.Generator, forms: Sequence[Form], count: int) -> list[Form]:
    """Deal the forms round robin from a random start, so that each comes equally often."""
    start = int(rng.integers(len(forms)))
    return [forms[(start + i) % len(forms)] for i in range(count)]


def _assign_ids(seed: int, models: list[Model]) -> list[Model]:
    """Give the articulated models PartNet-Mobility's kind of id: distinct numbers of five digits, in no order."""
    rng = seeds.generator(seed, "corpus.furniture", "partnet_ids")
    numbers = rng.choice(np.arange(10_000, 100_000), size=len(models), replace=False)
    return [replace(model, model_id=str(number)) for model, number in zip(models, numbers, strict=True)]
