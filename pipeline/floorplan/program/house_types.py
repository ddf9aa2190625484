"""Plan types of houses on two storeys, with stairs from a hall below to a landing above."""

from pipeline.floorplan.program.floor_program import FloorProgram
from pipeline.floorplan.program.program_sketch import Sketch


def terrace(s: Sketch, beds: int) -> FloorProgram:
    """Draw a Victorian terrace: a narrow house, hall and stairs along two parlours, the kitchen behind; bedrooms and bath above."""
    s.room("hall", "hallway", level=0)
    s.off("hall", "front", "living_room", 17.0, level=0)
    s.off("hall", "dining", "dining_room", 15.5, level=0)
    if s.odds(0.5):
        s.link("front", "dining", "open", "portal")
    s.room("kitchen", "kitchen", 8.5, level=0)
    s.link("dining", "kitchen", "door", "open")
    if s.odds(0.5):
        s.off("kitchen", "scullery", "utility", 4.5, level=0)
    if s.odds(0.5):
        s.off("hall", "wc", "wc", 1.9, 0.1, level=0)
    _stairs(s, "hall")
    s.bedrooms("landing", beds, 16.0, 11.8, level=1)
    s.off("landing", "bath", "bathroom", 6.0, 0.14, level=1)
    s.balance()
    return s.program(into="hall", corner=0.0, aspects=(1.3, 1.6, 1.8), span=0.6, storeys=2)


def detached_house(s: Sketch, beds: int) -> FloorProgram:
    """Draw a detached house of today: an entrance hall with the stairs, kitchen open to the dining room; a suite above."""
    s.room("entry", "entry", 8.0, level=0)
    s.off("entry", "living", "living_room", 17.0 + 1.2 * beds, level=0)
    s.room("kitchen", "kitchen", 9.5, level=0)
    s.room("dining", "dining_room", 17.0, level=0)
    s.link("kitchen", "dining", "open")
    s.link("living", "dining", "open", "portal", "door")
    s.off("entry", "wc", "wc", 2.2, 0.1, level=0)
    if s.odds(0.6):
        s.off("kitchen", "laundry", "utility", 5.5, level=0)
    if s.odds(0.35):
        s.off("laundry" if s.has("laundry") else "entry", "garage", "garage", 19.0, 0.1, level=0)
    if s.odds(0.4):
        s.off("entry", "office", "office", 10.0, level=0)
    _stairs(s, "entry")
    s.bedrooms("landing", beds, 17.0, 12.0, level=1)
    s.off("landing", "bath", "bathroom", 6.5, 0.14, level=1)
    s.off("bed_1", "ensuite", "bathroom", 5.0, 0.14, level=1)
    if s.odds(0.4):
        s.off("bed_1", "closet", "closet", 4.5, level=1)
    s.balance()
    return s.program(into="entry", corner=0.0, storeys=2)


def _stairs(s: Sketch, below: str) -> None:
    s.room("stairs", "staircase", 6.0, 0.06, level=0)
    s.link(below, "stairs", "open")
    s.room("landing", "hallway", level=1)
    s.link("landing", "stairs", "open")
