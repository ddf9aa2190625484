"""The factory's vocabulary: the cards of its categories, types of rooms, and the names that other people give them."""

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from pipeline import params, style, yaml_text
from pipeline.card import Category, cards

PATH = Path(__file__).resolve().parent.parent / "manifests" / "rooms.yaml"


@dataclass(frozen=True, slots=True)
class Usual:
    """One thing of these categories is asked for in a `share` of the rooms that would do without and have this much `floor` [m2]."""

    of: tuple[str, ...]
    share: float
    floor: float = 0.0


@dataclass(frozen=True, slots=True)
class RoomType:
    """What a room of a plan is like unless the request says otherwise.

    `area` [m2] between inner wall faces, `width` [m] the least clear width, `exterior` whether it needs an outside wall, `window` whether it
    gets windows where it has one, `habitable` whether daylight matters (energy terms 6 and 7), `useful` whether its area counts as useful
    (term 9), `through` whether one may walk through it to another room, `square` whether a square shape is wanted (term 3).
    `furnished_as` is the layout type, "": it stays empty; `roles` the layout types by whose room it is, where that is another; `functions` what it serves as where that may be several things; `unwanted` what it has not, though others furnished so have,
    and `usual` what it has oftener than they.
    `entered_from` are the types that it is entered from where nobody says, the usual one first, () for any hub; what `belongs` is entered from what it lies next to.
    `floor` and `wall` are names of manifests/materials.yaml. `called`: what people and other datasets call it besides.
    """

    area: float
    width: float
    exterior: bool = False
    window: bool = False
    habitable: bool = False
    useful: bool = True
    through: bool = False
    square: bool = True
    furnished_as: str = ""
    roles: Mapping[str, str] = field(default_factory=dict)
    functions: tuple[str, ...] = ()
    unwanted: tuple[str, ...] = ()
    usual: tuple[Usual, ...] = ()
    entered_from: tuple[str, ...] = ()
    belongs: bool = False
    floor: str = "oak"
    wall: str = "plaster"
    called: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Rug:
    """A rug of `category` lies in a `share` of rooms: under, across the foot of, or before one of these; or in the middle."""

    category: str
    share: float
    under: tuple[str, ...] = ()
    across: tuple[str, ...] = ()
    before: tuple[str, ...] = ()
    middle: bool = False


@dataclass(frozen=True, slots=True)
class Company:
    """A room that holds something `of` these categories `also` holds `least` things of those."""

    of: tuple[str, ...]
    also: tuple[str, ...]
    least: int = 1


@dataclass(frozen=True, slots=True)
class Layout:
    """A room as the layout model furnishes it: 3D-FRONT's types that are so, of which categories it `needs` one of each group, or `usual`ly has one.

    `part` [m2] is the floor that it usually takes of a room that serves as others too. What made ones hold besides: a rug, shares of rooms with things at all windows, expected numbers on the walls.
    """

    front: tuple[str, ...]
    needs: tuple[tuple[str, ...], ...] = ()
    usual: tuple[Usual, ...] = ()
    part: float = 5.0
    rug: Rug | None = None
    windows: Mapping[str, float] = field(default_factory=dict)
    walls: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Taxonomy:
    """manifests/rooms.yaml, and the cards. `functions` are the layout types of what rooms may serve as; `company` says what is not in a room without something else; `empty` are 3D-FRONT's types that are read, but not furnished; `densities` [kg/m3] those of 3D-FUTURE's materials."""

    types: Mapping[str, RoomType]
    layouts: Mapping[str, Layout]
    functions: Mapping[str, str]
    company: tuple[Company, ...]
    empty: tuple[str, ...]
    densities: Mapping[str, float | None]

    @functools.cached_property
    def categories(self) -> Mapping[str, Category]:
        """Categories by name."""
        return cards()

    @functools.cached_property
    def front_rooms(self) -> Mapping[str, str | None]:
        """The layout type of each of 3D-FRONT's types of rooms, None for one that stays empty."""
        return {name: kind for kind, layout in self.layouts.items() for name in layout.front} | dict.fromkeys(self.empty)

    @functools.cached_property
    def styles(self) -> Mapping[str, str]:
        """Names of styles by their lower case."""
        return {name.lower(): name for name in style.load().styles}

    @functools.cached_property
    def materials(self) -> Mapping[str, str]:
        """Names of materials by their lower case."""
        return {name.lower(): name for name in self.densities}

    @property
    def layout_types(self) -> tuple[str, ...]:
        """Names of the layout model's types of rooms, in order."""
        return tuple(self.layouts)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the layout model's categories, in class order."""
        return tuple(c.name for c in self.categories.values() if c.layout)

    @property
    def small(self) -> frozenset[str]:
        """Names of the categories that the layout model does not learn."""
        return frozenset(c.name for c in self.categories.values() if not c.layout)

    def from_future(self, name: str) -> str | None:
        """Return the category for a 3D-FUTURE name of any spelling, or None."""
        wanted = normalise(name)
        return next((c.name for c in self.categories.values() if wanted in c.names.future), None)

    def from_title(self, title: str) -> str | None:
        """Return the category for a title "group/kind" of a 3D-FRONT record, such as "sofa/ multi seat sofa", or None."""
        kind = normalise(title).rsplit("/", 1)[-1]
        named = next((c.name for c in self.categories.values() if kind in c.names.titles), None)
        return named or self.from_future(kind) or self.from_future(title)

    def of_kind(self, *names: str) -> tuple[str, ...]:
        """Return the categories that the first known of these super-categories or title groups may be, () for none."""
        for name in map(normalise, names):
            if categories := tuple(c.name for c in self.categories.values() if name in c.names.kinds):
                return categories
        return ()

    def from_partnet(self, model_cat: str) -> tuple[str, ...]:
        """Return the categories that a PartNet-Mobility object of that model_cat may serve as."""
        return tuple(c.name for c in self.categories.values() if model_cat in c.names.partnet)


def normalise(name: str) -> str:
    """Lower-case and strip the blanks around slashes, as in "Corner / Side Table"."""
    return "/".join(part.strip() for part in name.lower().split("/"))


@functools.cache
def load() -> Taxonomy:
    """Read the cards and manifests/rooms.yaml."""
    return params.build(Taxonomy, yaml_text.parse(PATH.read_text(encoding="utf-8")), "rooms", "manifests/rooms.yaml")
