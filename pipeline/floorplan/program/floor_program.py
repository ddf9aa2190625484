"""FloorProgram: the typed, versioned request that language is turned into and floor plans are solved from."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from pipeline import style, taxonomy

MOST_ASPECT = 5.0  # of an outline
MAX_ROOMS = 40
MAX_PIECES = 200

if TYPE_CHECKING:
    RoomType = str
    FurnitureStyle = str
else:  # of manifests/rooms.yaml and manifests/styles.yaml
    RoomType = Literal[tuple(taxonomy.load().types)]
    FurnitureStyle = Literal[tuple(name for name in style.load().styles if name != "Others")]
Role = Literal["", "primary", "guest", "child", "elder", "staff", "carer", "shared"]
OTHERS = frozenset({"child", "guest", "elder", "carer", "staff"})  # who sleeps in a home beside those whose home it is
LinkKind = Literal["door", "open", "portal", "any", "wall"]
Slug = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]{0,39}$")]
Selector = Annotated[
    str, Field(pattern=r"^[a-z][a-z0-9_]{0,39}$", description="a room's id, a room type (every room of it) or a zone's name")
]
Metres2 = Annotated[float, Field(gt=0.0, le=5000.0)]
Metres = Annotated[float, Field(gt=0.0, le=100.0)]
Knob = Annotated[int, Field(ge=-3, le=3)]


class Model(BaseModel):
    """Strict base: unknown fields are errors, instances do not change."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class Range(Model):
    """A wish for a number. `stated` says whether a person asked for it or a default filled it in."""

    min: Metres2 | None = None
    max: Metres2 | None = None
    target: Metres2 | None = None
    stated: bool = False


Pieces = Annotated[int, Field(ge=0, le=MAX_PIECES)]


class Things(Model):
    """How many of one category, or of a group such as `any_chair`: at least `min`, at most `max`; both alike: exactly; 0: none."""

    category: Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]{0,39}$", description="a category of manifests/categories, or a group")]
    min: Pieces = 0
    max: Pieces | None = None


class Furniture(Model):
    """Wishes for what stands in a room (or in every room, where the whole home has them).

    `least` and `most` bound the number of pieces, both alike: exactly. `style` is one of 3D-FUTURE's. At least `openable` pieces have
    something that opens; `walkable` is the share of the floor that a robot gets to.
    """

    least: Pieces | None = None
    most: Pieces | None = None
    counts: tuple[Things, ...] = ()
    style: FurnitureStyle | None = None
    openable: Pieces | None = None
    walkable: Annotated[float, Field(ge=0.0, le=1.0)] | None = None


class RoomReq(Model):
    """One room (or `count` like ones). `area` in m2 between inner wall faces, `min_width` in m.

    `furniture` are the wishes for what stands in it.
    `inferred` rooms were not named; the plan needs them.
    """

    id: Slug
    type: RoomType
    count: Annotated[int, Field(ge=1, le=MAX_ROOMS)] = 1
    role: Role = ""
    functions: tuple[Literal["living", "sleeping", "cooking", "dining", "working"], ...] = ()
    area: Range = Range()
    min_width: Metres | None = None
    level: Annotated[int, Field(ge=0, le=2)] | None = None
    exterior: Literal["none", "wall", "corner", "door"] | None = None
    exterior_length: Metres | None = None
    window: Literal["required", "forbidden", "auto"] = "auto"
    furniture: Furniture = Furniture()
    stated: bool = True
    inferred: bool = False


class Link(Model):
    """Two rooms that are joined: by a door, an open front, a portal, or only a common wall; "any" are rooms that lie next to each other."""

    a: Selector
    b: Selector
    kind: LinkKind = "door"
    quant: Literal["each", "some"] = "each"
    stated: bool = False

    @property
    def opens(self) -> bool:
        """Whether one gets through: what is only said to lie next to each other has a wall in common, and doors elsewhere."""
        return self.kind not in {"wall", "any"}

    @property
    def ends(self) -> frozenset[Selector]:
        """The two that are joined, in no order."""
        return frozenset((self.a, self.b))

    @property
    def fields(self) -> tuple[str, str]:
        """What evidence calls the link: a request may have named its ends in either order."""
        return f"links.{self.a}-{self.b}", f"links.{self.b}-{self.a}"

    def beyond(self, room: Selector) -> Selector | None:
        """Return the other end, seen from `room`; None where the link does not join it."""
        return self.b if self.a == room else self.a if self.b == room else None


class Forbid(Model):
    """Something that must not be: a room type, a common wall, an opening, an open front, or a way that leads through `avoid`."""

    what: Literal["room_type", "adjacent", "connected", "open", "through"]
    a: Selector
    b: Selector | None = None
    avoid: Selector | None = None
    stated: bool = True


class Relation(Model):
    """A relation between rooms.

    area_order: every room of `a` is at least `value` times as large as every room of `b`. area_equal: the rooms of `a` (and
    `b`) differ by at most the share `value`. largest: `a` is the largest of `b`. separation: centroids of `a` and `b` are at least `value`
    of the outline's diagonal apart. hops: at least `value` openings lie on the way from `a` to `b`. degree: `a` has exactly
    `value` openings. area_share: `a` takes at least `value` of the total area. between: `a` lies between `b` and `c` and is joined
    to both. ensuite: the bathroom `a` belongs to the bedroom `b` alone. hub: the rooms hang on `a`. Links, degrees and
    prohibitions that follow from the last three stand in the program as well.
    """

    kind: Literal["area_order", "area_equal", "largest", "separation", "hops", "degree", "area_share", "between", "ensuite", "hub"]
    a: Selector
    b: Selector | None = None
    c: Selector | None = None
    value: Annotated[float, Field(ge=0.0, le=100.0)] = 1.0
    stated: bool = True


class Zone(Model):
    """Rooms that belong together, as the parents' wing. Its name serves as a selector."""

    name: Slug
    members: tuple[Selector, ...]


class Footprint(Model):
    """The outline: its shape, and the ratio of its longer to its shorter side.

    `corners`: chamfered ones are cut at 45 degrees wherever no opening stands in the way.
    """

    shape: Literal["rectangle", "L", "T", "any"] = "rectangle"
    corners: Literal["plain", "chamfered"] = "plain"
    min_aspect: Annotated[float, Field(ge=1.0, le=MOST_ASPECT)] = 1.0
    max_aspect: Annotated[float, Field(ge=1.0, le=MOST_ASPECT)] = 1.6
    stated: bool = False


class Shell(Model):
    """Thickness of walls between rooms and of outside walls, and the height of rooms from floor to ceiling [m]."""

    inner_wall: Annotated[float, Field(ge=0.05, le=0.6)] = 0.12
    outer_wall: Annotated[float, Field(ge=0.05, le=0.6)] = 0.24
    ceiling: Annotated[float, Field(ge=1.8, le=8.0)] = 2.7
    stated: bool = False


class Accessibility(Model):
    """Clear width of doors and corridors [m]."""

    step_free: bool = False
    min_door: Annotated[float, Field(ge=0.7, le=1.2)] = 0.8
    min_corridor: Annotated[float, Field(ge=0.8, le=3.0)] = 1.0


class Style(Model):
    """Twelve knobs, one per energy term: the term's weight is multiplied by 2**knob."""

    circulation: Knob = 0
    area: Knob = 0
    squareness: Knob = 0
    convexity: Knob = 0
    simplicity: Knob = 0
    exterior: Knob = 0
    corner_light: Knob = 0
    alignment: Knob = 0
    useful_area: Knob = 0
    min_width: Knob = 0
    stair_fit: Knob = 0
    stair_snug: Knob = 0


class Entrance(Model):
    """The room that one enters, and rooms with an outside door of their own."""

    into: Selector | None = None
    separate: tuple[Selector, ...] = ()
    stated: bool = False


class Span(Model):
    """Words of the prompt of which nothing was made."""

    start: Annotated[int, Field(ge=0)]
    end: Annotated[int, Field(ge=0)]
    text: str


class Evidence(Span):
    """Words `text` = prompt[start:end] that `field` was read from."""

    field: str
    source: Literal["rule", "llm"] = "rule"


class FloorProgram(Model):
    """A request for a home. Every field is optional; `total_area` [m2] counts neither balconies nor garages.

    `furniture` are wishes for every room that is furnished. `only` closes the list of rooms: nothing is added that was not named. `nonrect` is the least number of rooms that are not
    rectangles; one or more give an outline that nobody stated cut-out and chamfered corners. `unparsed` are words that were not understood, `unbuilt` words for what nobody builds here (a pool, a view).
    """

    version: Literal[1] = 1
    storeys: Annotated[int, Field(ge=1, le=3)] = 1
    total_area: Range = Range()
    footprint: Footprint = Footprint()
    shell: Shell = Shell()
    rooms: tuple[RoomReq, ...] = ()
    links: tuple[Link, ...] = ()
    forbids: tuple[Forbid, ...] = ()
    relations: tuple[Relation, ...] = ()
    zones: tuple[Zone, ...] = ()
    entrance: Entrance = Entrance()
    accessibility: Accessibility = Accessibility()
    style: Style = Style()
    furniture: Furniture = Furniture()
    nonrect: Annotated[int, Field(ge=0, le=10)] = 0
    scale: Annotated[float, Field(ge=0.5, le=2.0)] = 1.0
    only: bool = False
    language: str | None = None
    evidence: tuple[Evidence, ...] = ()
    unparsed: tuple[Span, ...] = ()
    unbuilt: tuple[Span, ...] = ()

    def select(self, selector: str) -> tuple[RoomReq, ...]:
        """Return the rooms that a selector names: the room of that id, else every room of that type, else the members of that zone."""
        exact = tuple(r for r in self.rooms if r.id == selector)
        same = exact or tuple(r for r in self.rooms if r.type == selector)
        members = () if same else next((z.members for z in self.zones if z.name == selector), ())
        return same or tuple(r for r in self.rooms if r.id in members or r.type in members)


def json_schema() -> dict[str, Any]:
    """Return the JSON Schema of FloorProgram: what `docs/floorplan.md` describes and language models are asked to fill."""
    return FloorProgram.model_json_schema()
