"""Cards: `manifests/categories/<name>.yaml` holds all that is known of one category of things, each fact once; the fields here are its schema."""

import functools
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

import yaml

from pipeline import params, yaml_text
from pipeline.errors import ContentError

FOLDER = Path(__file__).resolve().parent.parent / "manifests" / "categories"
LAST = 1_000_000
Triple = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Names:
    """What other people call it.

    `future`: names in 3D-FUTURE's model_info.json, old ones too; `titles`: kinds in the titles ("group/kind") of 3D-FRONT's furniture
    records that are no 3D-FUTURE name; `kinds`: 3D-FUTURE's super-categories and groups of those titles under which it is found;
    `partnet`: model_cat of PartNet-Mobility / GAPartNet objects that may serve as it; `files`: words in the names of URDF files;
    `peers`: its class in the peers' `bedroom` and `living` data sets, where that is not its name.
    """

    future: tuple[str, ...] = ()
    titles: tuple[str, ...] = ()
    kinds: tuple[str, ...] = ()
    partnet: tuple[str, ...] = ()
    files: tuple[str, ...] = ()
    peers: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Size:
    """Full extents (w, d, h) [m] of its models: mean, standard deviation, 5th and 95th percentile over `n` distinct models.

    `source`: `own` our estimate from usual products (n 0, percentiles at 1.64 deviations); `future_ids` 3D-FRONT-ToolBox's
    config/model_info.json (9,990 models of the 2020 pool) by category id, names matched with scene titles; `future_ids_shape` the same for
    an id without a known name, matched by the shape of its box; `future_bedroom` the same boxes by the labels of ATISS's bedroom classes
    (2,330 models); `scenes_12` counted on 12 scene files, indicative only.
    """

    mean: Triple
    std: Triple
    p05: Triple
    p95: Triple
    n: int = 0
    source: Literal["own", "future_ids", "future_ids_shape", "future_bedroom", "scenes_12"] = "own"


@dataclass(frozen=True, slots=True)
class Signs:
    """What tells it from others where sizes do not: our estimates from usual products, wide on purpose.

    `doors`, `drawers`: share of the products that have any; `glass`: of those with doors, share with a glazed one. `covered`: mean and
    deviation of the share of the front that doors and drawers cover; `grip`: of a handle's height on a hinged door, from -0.5 at its lower
    to 0.5 at its upper edge.
    """

    doors: float = 0.5
    drawers: float = 0.5
    glass: float = 0.15
    covered: tuple[float, float] = (0.60, 0.30)
    grip: tuple[float, float] = (0.10, 0.30)


@dataclass(frozen=True, slots=True)
class Hangs:
    """How it hangs on a wall: height of its middle [m], chance of one more in a row, over or beside which furniture rather than anywhere."""

    middle: float
    row: float
    over: tuple[str, ...] = ()
    beside: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class SetOf:
    """All of it that are drafted nearest to one of `at`, within so far of it [m], are one model."""

    at: tuple[str, ...]
    within: float


@dataclass(frozen=True, slots=True)
class Form:
    """One form in the embedded corpus, under the name that its builder knows. `name` is the category name to write where it is not the corpus's own.

    `builder`: what builds it where that is not the corpus's own.
    A `round` form has one diameter: its depth is set to its width; of an `upright` one its height is. A `still` form has nothing that
    moves. Models lower than `least_height` [m] take the first form instead. `styles`: those that it comes in, all where none is named;
    `classic` and `oriental` stand for several.
    """

    name: str = ""
    builder: str = ""
    round: bool = False
    upright: bool = False
    still: bool = False
    least_height: float = 0.0
    styles: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Corpus:
    """Its part in the embedded corpus: none where it has no forms.

    `builder`: module and function of pipeline/corpus/furniture that builds it; `name`: the category name that model_info.json gets; at
    size 1 `static` models as 3D-FUTURE folders and `moving` ones as PartNet-Mobility folders. `material`: 3D-FUTURE's word for the main
    one where it does not follow from wood or lacquer, `soft`: that of the cover. `title`: of its records in house files. `front`: free
    depth before it [m]. `series`: its models come in the styles `series` of styles.yaml, and those of one style have one front, worktop and
    handle, as kitchens are sold. `facing`: it looks where its support looks. `holds`: expected numbers of things on or in it. `order`: place among
    the lines, where that is not the category's.
    """

    builder: str = ""
    name: str = ""
    forms: Mapping[str, Form] = field(default_factory=dict)
    static: int = 1
    moving: int = 0
    material: str = ""
    title: str = ""
    front: float | None = None
    facing: bool = False
    holds: Mapping[str, float] = field(default_factory=dict)
    order: int | None = None
    series: bool = False


@dataclass(frozen=True, slots=True)
class Category:
    """One category.

    `order` fixes the order of the layout model's classes; a card without one comes last. `super`: what it is a kind of. The layout model
    learns what has `layout`; the rest are things that lie on, in or beside furniture. What is `fixed` belongs to the floor. `words`: what it
    is called, by language: lower case, plurals and endings follow the language's rules; a form with `@` before it means furniture only
    where a room that has such things is named before it ("bed" can be a room). `groups`: of manifests/lexicon/furniture.yaml, to which it
    belongs. `mass`: from light to heavy products [kg], as makers and shipping lists state them; `density` [kg/m3]: of things unlike their
    kind. `felt`: what of it a robot feels, which its colliders keep to: nothing of what is `seen`, the outside of what is `closed` (no hand
    goes in), more truly where it is `handled`, its hull where it is a `block`, less the higher up of what is `yielding`, a lump of what is `soft`. `tuck`: a seat may stand under a table. `usual`: types of a plan's rooms where it stands, the likeliest first; `never`: where not.
    `lies`: in the middle of its support, at its back, looking where the support looks. `holds`: expected numbers of things on or in it in a
    made home; `lies_on` says the same from the thing's side. `finish`: with which others its finish goes in a room.
    """

    name: str
    super: str
    names: Names
    size: Size
    mass: tuple[float, float]
    order: int = LAST
    mount: Literal["floor", "wall", "ceiling"] = "floor"
    layout: bool = True
    fixed: bool = False
    words: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    groups: tuple[str, ...] = ()
    density: float | None = None
    signs: Signs = field(default_factory=Signs)
    felt: Literal["", "seen", "closed", "handled", "block", "yielding", "soft"] = ""
    tuck: Literal["", "seat", "table"] = ""
    usual: tuple[str, ...] = ()
    never: tuple[str, ...] = ()
    lies: tuple[Literal["centred", "backed", "facing"], ...] = ()
    hangs: Hangs | None = None
    holds: Mapping[str, float] = field(default_factory=dict)
    lies_on: Mapping[str, float] = field(default_factory=dict)
    finish: Literal["", "timber", "kitchen", "soft"] = ""
    set: SetOf | None = None
    corpus: Corpus = field(default_factory=Corpus)

    @property
    def loose(self) -> bool:
        """Whether it lies where it was put and can be taken away: a body of its own in simulators. Not so a rug, under furniture."""
        return not self.layout and self.mount == "floor" and not self.fixed

    @property
    def tuck_role(self) -> int:
        """1 for a seat, 2 for a table, 0 for the rest: of two things whose roles add up to 3 one may stand under the other."""
        return {"": 0, "seat": 1, "table": 2}[self.tuck]


@functools.cache
def cards() -> Mapping[str, Category]:
    """Return the categories by name, in order. Raises ContentError naming the card that is not valid."""
    categories = [_card(path) for path in sorted(FOLDER.glob("*.yaml"))]
    by_name = {c.name: c for c in sorted(categories, key=lambda c: (c.order, c.name))}
    for card in categories:
        for key, name in _references(card):
            if name not in by_name:
                raise params.unknown(f"{key}.{name}", name, by_name, f"manifests/categories/{card.name}.yaml")
    for card in categories:  # what lies on furniture is added to what that holds
        for support, expected in card.lies_on.items():
            other = by_name[support]
            by_name[support] = replace(other, holds={**other.holds, card.name: expected})
    return by_name


def _card(path: Path) -> Category:
    file = f"manifests/categories/{path.name}"
    try:
        raw: Any = yaml_text.parse(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise ContentError(f"cannot read {file}: {str(error).splitlines()[0]}", "compare it with the files beside it") from error
    if not isinstance(raw, Mapping):
        raise ContentError(f"{file} is not a mapping", "compare it with the files beside it")
    return params.build(Category, {"name": path.stem, **raw}, path.stem, file)


def _references(card: Category) -> Iterator[tuple[str, str]]:
    """Yield (key, category) for each category that a card names."""
    hangs, of = card.hangs, card.set
    named: dict[str, Iterable[str]] = {"holds": card.holds, "lies_on": card.lies_on, "corpus.holds": card.corpus.holds}
    named |= {"hangs.over": hangs.over if hangs else (), "hangs.beside": hangs.beside if hangs else (), "set.at": of.at if of else ()}
    yield from ((key, name) for key, names in named.items() for name in names)
