"""Frames: what they know, what they read, and that they belong to no language."""

import re
from pathlib import Path

import pytest

from pipeline.floorplan import parse, request
from pipeline.floorplan.language import frames
from pipeline.floorplan.language.lexicon import LANGUAGES, lexicon
from pipeline.floorplan.program.consistency import ImpossibleError
from tests.floorplan.language.faults import faults

KINDS = {
    "wish", "people", "fill", "ignored", "needless", "activity", "adj", "amount", "bound", "but", "clf", "close", "cmp", "colon", "comma", "cue", "dash", "det", "enough", "enter", "every", "factor", "fix", "flag", "home", "hyphen", "join", "level", "look", "neg", "num",
    "open", "ord", "outside", "owner", "post", "pron", "reciprocal", "relative", "room", "size", "slash", "stop", "suite", "times", "to", "unit", "verb", "via", "wing", "word", "zone",
    "single", "two", "many", "some", "zero", "small", "bounded", "plain_area", "large", "vast", "one_room", "lone", "some_of", "halved", "roomy", "^", "$",
}  # fmt: skip


def test_every_atom_is_a_kind_of_token_or_a_sign_of_some_language():
    signs = {sign for language in LANGUAGES for named in lexicon(language).signs.values() for sign in named}
    for frame in frames.frames():
        for atom in frame.atoms:
            unknown = {n for n in atom.names if not atom.slot.isupper() and n.partition("/")[0] not in KINDS | signs}
            assert not unknown, f"{frame.text}: {unknown}"


def test_every_sign_is_used_by_a_frame_or_by_a_reader():
    used = {n for frame in frames.frames() for atom in frame.atoms for n in atom.names}
    for file in Path(frames.__file__).parent.glob("*.py"):
        used |= set(re.findall(r"(?:sign\(|says\(\w+, )f?\"(\w+)", file.read_text(encoding="utf-8")))
    for language in LANGUAGES:
        named = {sign for signs in lexicon(language).signs.values() for sign in signs}
        assert {s for s in named if s.rpartition("_")[0] + "_" not in used} <= used, named - used


@pytest.mark.parametrize(
    ("prompt", "said"),
    [
        ("A door between the kitchen and the study.", {"rooms": {"kitchen": 1, "office": 1}, "links": [["kitchen", "office", "door"]]}),
        ("Three bedrooms; neither may be smaller than 10 m2.", {"rooms": {"bedroom": 3}, "areas": {"bedroom": [10, None]}}),
        (
            "The living room is larger than the kitchen, and neither may be smaller than 12 m2.",
            {"rooms": {"living_room": 1, "kitchen": 1}, "areas": {"living_room": [12, None], "kitchen": [12, None]}},
        ),
        (
            "Deux chambres doivent donner sur le couloir, le couloir doit mener à la cuisine.",
            {
                "rooms": {"bedroom": 2, "hallway": 1, "kitchen": 1},
                "links": [["bedroom", "hallway", "door", 2], ["hallway", "kitchen", "door"]],
            },
        ),
        ("Zwei Schlafzimmer, keines davon darf kleiner als 12 m2 sein.", {"rooms": {"bedroom": 2}, "areas": {"bedroom": [12, None]}}),
        ("两间卧室,都不能小于10平米。", {"rooms": {"bedroom": 2}, "areas": {"bedroom": [10, None]}}),
        (
            "Two bedrooms, neither may be smaller than the kitchen.",
            {"rooms": {"bedroom": 2, "kitchen": 1}, "larger": [["bedroom", "kitchen", 1.0]]},
        ),
        ("A son whose room is next to the bathroom.", {"rooms": {"bedroom": 1, "bathroom": 1}, "links": [["bedroom", "bathroom", "any"]]}),
        ("Connect the kitchen, if you please, to the study.", {"rooms": {"kitchen": 1, "office": 1}}),
        ("3 bedrooms, 85 m2, one bathroom.", {"rooms": {"bedroom": 3, "bathroom": 1}, "total": 85}),
        ("Drei Schlafzimmer, 85 m2, ein Bad.", {"rooms": {"bedroom": 3, "bathroom": 1}, "total": 85}),
        ("3 dormitorios, 85 m2, un baño.", {"rooms": {"bedroom": 3, "bathroom": 1}, "total": 85}),
        ("3个卧室,85平米,1个卫生间。", {"rooms": {"bedroom": 3, "bathroom": 1}, "total": 85}),
        ("Living room, 28 m2, and a kitchen.", {"rooms": {"living_room": 1, "kitchen": 1}, "areas": {"living_room": 28}}),
        ("Two semi-detached houses, each with three bedrooms.", {"refused": True}),
    ],
)
def test_frames_are_read(prompt, said):
    assert faults({"prompt": prompt, **said}) == []


def test_no_frame_and_no_reader_of_frames_knows_a_language():
    code = re.sub(r'""".*?"""|#.*', "", Path(frames.__file__).read_text(encoding="utf-8"), flags=re.DOTALL)
    text = frames.FILE.read_text(encoding="utf-8") + code
    assert not re.search(rf"\b({'|'.join(LANGUAGES)})\b|english|german|spanish|chinese", text, re.IGNORECASE)


def test_strict_refuses_words_that_are_not_understood():
    prompt = "Two bedrooms and a flumox."
    assert [s.text for s in request(prompt).unparsed] == ["flumox"]
    with pytest.raises(ImpossibleError, match="flumox") as caught:
        request(prompt, strict=True)
    assert [(c.field, c.text) for c in caught.value.clashes] == [("unparsed", "flumox")]


def test_strict_refuses_what_is_not_built_under_a_field_of_its_own():
    with pytest.raises(ImpossibleError, match="not understood: 'flumox'; not built here: 'kitchen island'") as caught:
        request("Two bedrooms, a flumox and a kitchen with a kitchen island.", strict=True)
    assert {(c.field, c.text) for c in caught.value.clashes} == {("unparsed", "flumox"), ("unbuilt", "kitchen island")}


@pytest.mark.parametrize(
    ("prompt", "count"),
    [
        ("a house for a family of four", 3),
        ("ein Haus für eine vierköpfige Familie", 3),
        ("una casa para una familia de cuatro", 3),
        ("适合一家四口住的房子", 3),
        ("a flat for a couple", 1),
        ("a flat with two bedrooms for a family of five", 2),
    ],
)
def test_people_have_bedrooms_unless_bedrooms_are_told(prompt, count):
    assert sum(r.type == "bedroom" for r in parse(prompt).rooms) == count


def test_more_than_all_of_a_floor_cannot_be_free():
    with pytest.raises(ImpossibleError):
        parse("A living room, 300% free floor.")
