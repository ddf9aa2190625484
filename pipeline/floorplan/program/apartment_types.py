"""Plan types of homes on one storey. Each draws a program with that many bedrooms; docs/floorplan.md tells them apart.

Mean areas [m2] are those usual for the type; the links are what makes it: what one passes on the way to a bedroom, whether the kitchen is
a room, where the bathroom hangs.
"""

from pipeline.floorplan.program.floor_program import FloorProgram, Forbid
from pipeline.floorplan.program.program_sketch import Sketch


def _lounge(beds: int) -> float:
    """Mean area of a living room beside a dining room: such rooms of the training houses have 18 m2."""
    return 14.0 + 1.2 * beds


def _great_room(beds: int) -> float:
    """Mean area of a living room in which one dines as well: such rooms of the training houses have 34 m2, most in homes of three bedrooms."""
    return 25.0 + 3.0 * beds


def studio(s: Sketch, _beds: int) -> FloorProgram:
    """One room to live and sleep in, a bathroom, mostly a kitchen of its own."""
    entered = s.odds(0.35)
    apart = s.odds(0.7)
    s.room(
        "studio", "studio_room", 22.0 if apart else 26.0, functions=("living", "sleeping") if apart else ("living", "sleeping", "cooking")
    )
    if entered:
        s.off("studio", "entry", "entry", 3.6)
    s.off("entry" if entered else "studio", "bath", "bathroom", 4.2)
    if apart:
        s.room("kitchen", "kitchen", 5.5)
        s.link("studio", "kitchen", "open", "open", "door")
    if s.odds(0.25):
        s.off("studio", "balcony", "balcony", 3.5)
    return s.program(corner=0.0)


def flat(s: Sketch, beds: int) -> FloorProgram:
    """Draw a contemporary flat: bedrooms off a hallway, an entry or the living room; the kitchen open, apart or behind the dining room."""
    draw = s.rng.random()
    apart = beds >= 2 and draw < 0.2
    s.room("living", "living_room", _lounge(beds) if apart else _great_room(beds))
    hub = _hub(s, beds)
    s.room("kitchen", "kitchen", 5.6 + 0.4 * beds)
    if apart:
        s.room("dining", "dining_room", 16.5)
        s.link("living", "dining", "door", "open", "portal")
        s.link("dining", "kitchen", "door", "open")
    elif draw < 0.65:
        s.link("living", "kitchen", "open")
    else:
        s.link("living" if hub == "living" or s.odds(0.6) else hub, "kitchen")
    s.bedrooms(hub, beds)
    s.off(hub, "bath", "bathroom", 5.5, 0.14)
    if beds >= 2 and s.odds(0.25 + 0.15 * beds):
        s.off("bed_1", "ensuite", "bathroom", 5.0, 0.14)
    if beds >= 4:
        s.off(hub, "bath_2", "bathroom", 5.0, 0.14)
    if beds >= 2 and s.odds(0.25):
        s.off("entry" if s.has("entry") else hub, "wc", "wc", 2.1, 0.1)
    _extras(s, beds, hub)
    if beds >= 2 and s.odds(0.15):
        s.forbids.append(Forbid(what="adjacent", a="bed_1", b="kitchen", stated=False))
    return s.program()


def _hub(s: Sketch, beds: int) -> str:
    """Add what bedrooms open off: a hallway, an entry, or the living room itself."""
    draw = s.rng.random()
    if (beds == 1 and draw < 0.35) or (beds == 2 and draw > 0.93):
        return "living"
    if beds <= 2 and draw < 0.55:
        s.room("entry", "entry", 5.0 + 1.2 * beds)
        s.link("entry", "living", "door", "door", "door", "portal")
        return "entry"
    s.room("hall", "hallway")
    s.link("living", "hall", "door", "door", "door", "portal")
    if s.odds(0.3):
        s.room("entry", "entry", 5.0)
        s.link("entry", "living" if s.odds(0.5) else "hall")
    return "hall"


def _extras(s: Sketch, beds: int, hub: str) -> None:
    if s.odds(0.35):
        s.off("living", "balcony", "balcony", 3.5)
    if s.odds(0.12 + 0.04 * beds):
        s.off(hub, "office", "office", 9.5)
    if beds >= 2 and s.odds(0.2):
        s.off("bed_1", "closet", "closet", 4.2)
    if s.odds(0.1 + 0.05 * beds):
        s.off("kitchen", "utility", "utility", 4.8)
    if s.odds(0.15):
        s.off(hub, "storage", "storage", 3.2)
    if beds >= 3 and s.odds(0.2):
        s.off("utility" if s.has("utility") else hub, "garage", "garage", 19.0)


def corridor(s: Sketch, beds: int) -> FloorProgram:
    """Draw a flat of the European block: one corridor from the front door, every room closed off it, a WC apart from the bath."""
    s.room("hall", "hallway")
    s.off("hall", "living", "living_room", _great_room(beds))
    if s.odds(0.6):
        s.off("hall", "kitchen", "kitchen", 5.6 + 0.4 * beds)
    else:
        s.off("living", "kitchen", "kitchen", 5.6 + 0.4 * beds)
    if s.odds(0.25):
        s.link("living", "kitchen") if s.links[-1].a == "hall" else s.link("hall", "kitchen")
    s.bedrooms("hall", beds, 15.0, 12.3)
    s.off("hall", "bath", "bathroom", 5.2, 0.14)
    if s.odds(0.45):
        s.off("hall", "wc", "wc", 1.9, 0.1)
    if s.odds(0.4):
        s.off("hall", "storage", "storage", 2.6, 0.12)
    if s.odds(0.55):
        s.off("living", "balcony", "balcony", 3.7)
    return s.program(into="hall", aspects=(1.0, 1.2, 1.4))


def open_plan(s: Sketch, beds: int) -> FloorProgram:
    """Draw a North American home: living, dining and kitchen in one; a primary suite with walk-in closet; the garage behind the laundry."""
    apart = s.odds(0.55)
    s.room("living", "living_room", _lounge(beds) if apart else _great_room(beds))
    s.room("kitchen", "kitchen", 6.6 + 0.4 * beds)
    s.link("living", "kitchen", "open")
    if apart:
        s.room("dining", "dining_room", 16.5)
        s.link("living" if s.odds(0.5) else "kitchen", "dining", "open")
    s.room("hall", "hallway")
    s.link("living", "hall", "portal", "door")
    s.bedrooms("hall", beds, 18.0, 12.5)
    s.off("bed_1", "closet", "closet", 5.0)
    s.off("closet" if s.odds(0.35) else "bed_1", "ensuite", "bathroom", 7.0, 0.14)
    s.off("hall", "bath", "bathroom", 5.5, 0.14)
    if beds >= 5:
        s.off("bed_2", "ensuite_2", "bathroom", 5.0, 0.14)
    if s.odds(0.75):
        s.off("kitchen", "laundry", "utility", 5.5)
        if s.odds(0.6):
            s.off("laundry", "garage", "garage", 30.0, 0.12)
    if s.odds(0.35):
        s.off("living", "entry", "entry", 5.0)
    if s.odds(0.25):
        s.off("hall", "office", "office", 10.5)
    return s.program(corner=0.3)


def ldk(s: Sketch, beds: int) -> FloorProgram:
    """Draw a Japanese nLDK flat: genkan and corridor, one living-dining-kitchen, WC apart, the bath behind a washroom."""
    s.room("genkan", "entry", 3.4, 0.12)
    s.room("hall", "hallway")
    s.link("genkan", "hall", "portal", "door")
    s.room("ldk", "living_room", 20.0 + 2.5 * beds, functions=("living", "dining", "cooking"))
    s.link("hall", "ldk")
    s.off("hall", "wc", "wc", 1.7, 0.08)
    s.off("hall", "washroom", "utility", 3.6, 0.1)
    s.off("washroom", "bath", "bathroom", 3.6, 0.1)
    for k in range(beds):
        beside = beds > 1 and k == beds - 1 and s.odds(0.5)  # a room of mats that opens to the living room
        s.off("ldk" if beside else "hall", f"bed_{k + 1}", "bedroom", 12.0 if k == 0 else 10.5, 0.1)
    if s.odds(0.8):
        s.off("ldk", "balcony", "balcony", 3.7)
    if s.odds(0.35):
        s.off("bed_1", "closet", "closet", 2.8)
    return s.program(into="genkan", aspects=(1.0, 1.3, 1.6), corner=0.05)


def two_halls(s: Sketch, beds: int) -> FloorProgram:
    """Draw a Chinese flat of n bedrooms and two halls: living and dining in one run, kitchen off the dining hall, balcony south of the living."""
    s.room("living", "living_room", _lounge(beds))
    s.room("dining", "dining_room", 16.0)
    s.link("living", "dining", "open")
    s.off("dining", "kitchen", "kitchen", 6.6)
    s.room("hall", "hallway")
    s.link("living", "hall", "portal", "door")
    s.bedrooms("hall", beds, 15.0, 11.5)
    s.off("hall", "bath", "bathroom", 4.5, 0.12)
    if beds >= 3 and s.odds(0.7):
        s.off("bed_1", "ensuite", "bathroom", 4.2, 0.12)
    s.off("living", "balcony", "balcony", 3.5)
    if s.odds(0.3):
        s.off("kitchen", "balcony_2", "balcony", 2.8, 0.1)
    if s.odds(0.3):
        s.off("dining", "genkan", "entry", 3.6, 0.12)
    return s.program(into="genkan" if s.has("genkan") else "living")


def hall_less(s: Sketch, beds: int) -> FloorProgram:
    """Draw a tropical house without corridors: everything opens off one large living room; a veranda; the kitchen behind."""
    apart = s.odds(0.4)
    s.room("living", "living_room", (_lounge(beds) + 3.0) if apart else _great_room(beds))
    s.bedrooms("living", beds, 14.5, 12.3)
    if apart:
        s.room("dining", "dining_room", 16.0)
        s.link("living", "dining", "open", "portal")
        s.off("dining", "kitchen", "kitchen", 7.0)
    else:
        s.room("kitchen", "kitchen", 7.2)
        s.link("living", "kitchen", "door", "open")
    s.off("kitchen" if s.odds(0.3) else "living", "bath", "bathroom", 4.2, 0.14)
    if beds >= 3 and s.odds(0.5):
        s.off("bed_1", "ensuite", "bathroom", 4.0, 0.14)
    if s.odds(0.75):
        s.off("living", "veranda", "balcony", 5.5)
    if s.odds(0.3):
        s.off("kitchen", "utility", "utility", 4.5)
    return s.program(corner=0.2)


def shared_flat(s: Sketch, beds: int) -> FloorProgram:
    """Draw a flat that several people share: like bedrooms off a hallway, a large kitchen to eat in, often no living room."""
    s.room("hall", "hallway")
    for k in range(beds):
        s.off("hall", f"bed_{k + 1}", "bedroom", 14.0, 0.1)
    s.off("hall", "kitchen", "kitchen", 15.0, functions=("cooking", "dining"))
    s.off("hall", "bath", "bathroom", 5.5, 0.12)
    s.off("hall", "wc", "wc", 2.0, 0.1)
    if beds >= 4:
        s.off("hall", "bath_2", "bathroom", 4.5, 0.12)
    if s.odds(0.5):
        s.off("hall", "living", "living_room", 18.0)
    if s.odds(0.4):
        s.off("kitchen", "balcony", "balcony", 3.7)
    return s.program(into="hall", aspects=(1.0, 1.3, 1.5))
