"""Numbers, amounts, typing errors."""

import pytest
import yaml

from pipeline.floorplan.language import tokens
from pipeline.floorplan.language.lexicon import FOLDER, LANGUAGES, lexicon, split
from pipeline.floorplan.language.parser import parse
from pipeline.floorplan.language.spelling import distance, resolve
from pipeline.floorplan.language.text import Verbs, clean, fold, split_words
from pipeline.floorplan.language.tokens import read_words, segment


def amounts(text, language="en"):
    words = read_words(text, language)
    return [m for m in tokens.amounts(segment(words), words) if m.kind == "amount"]


@pytest.mark.parametrize(
    ("text", "language", "value"),
    [
        ("seven", "en", 7), ("twenty five", "en", 25), ("1,900", "en", 1900), ("one hundred and ten", "en", 110), ("2.5", "en", 2.5), ("two hundred", "en", 200),
        ("fünfundsiebzig", "de", 75), ("hundertzwanzig", "de", 120), ("1.250", "de", 1250), ("75,5", "de", 75.5), ("setenta y cinco", "es", 75), ("ciento veinte", "es", 120),
        ("二十五", "zh", 25), ("一百二十", "zh", 120), ("十二", "zh", 12), ("120", "zh", 120),
    ],
)  # fmt: skip
def test_numbers(text, language, value):
    (token,) = segment(read_words(text, language))
    assert (token.kind, token.number) == ("num", value)


@pytest.mark.parametrize(
    ("text", "language", "low", "high", "bound", "unit"),
    [
        ("at least 18 m²", "en", 18, None, "least", "area"),
        ("10 to 12 m²", "en", 10, 12, "", "area"),
        ("between 60 and 70 m2", "en", 60, 70, "", "area"),
        ("10-12 sqm", "en", 10, 12, "", "area"),
        ("7 m² or more", "en", 7, None, "least", "area"),
        ("about 100 sq. ft", "en", 9.2903, None, "about", "area"),
        ("4 x 5 m", "en", 20, None, "", "area"),
        ("1.2 m", "en", 1.2, None, "", "length"),
        ("90 cm", "en", 0.9, None, "", "length"),
        ("70 %", "en", 0.7, None, "", "share"),
        ("eight pieces of furniture", "en", 8, None, "", "pieces"),
        ("mindestens 75,5 qm", "de", 75.5, None, "least", "area"),
        ("60 bis 70 Quadratmeter", "de", 60, 70, "", "area"),
        ("entre 60 y 70 metros", "es", 60, 70, "", "area"),
        ("45 metros cuadrados como máximo", "es", 45, None, "most", "area"),
        ("120平米", "zh", 120, None, "", "area"),
        ("不超过60平方米", "zh", 60, None, "most", "area"),
    ],
)
def test_amounts(text, language, low, high, bound, unit):
    (token,) = amounts(text, language)
    assert token.number == pytest.approx(low)
    assert token.high == (None if high is None else pytest.approx(high))
    assert (token.bound, token.value) == (bound, unit)


@pytest.mark.parametrize(
    ("wrong", "language", "right"),
    [
        ("bedrom", "en", ("bedroom",)), ("kichten", "en", ("kitchen",)), ("batroom", "en", ("bathroom",)), ("livign", "en", ("living",)), ("balconny", "en", ("balcony",)),
        ("twobedroom", "en", ("two", "bedroom")), ("openkitchen", "en", ("open", "kitchen")), ("schlafzimer", "de", ("schlafzimmer",)), ("schlafzimmern", "de", ("schlafzimmer",)),
        ("kuche", "de", ("kuche",)), ("dormitoro", "es", ("dormitorio",)), ("cosina", "es", ("cocina",)),
    ],
)  # fmt: skip
def test_typing_errors_are_repaired(wrong, language, right):
    assert resolve(wrong, language) == right


@pytest.mark.parametrize(
    ("wrong", "language", "right"),
    [
        ("wiht", "en", ("with",)), ("betwen", "en", ("between",)), ("oposite", "en", ("opposite",)), ("conencted", "en", ("connected",)), ("kidds'", "en", ("kids",)),
        ("intothe", "en", ("into", "the")), ("chaors", "en", ("chairs",)), ("zwichen", "de", ("zwischen",)), ("nebem", "de", ("neben",)),
        ("junot", "es", ("junto",)), ("abeirta", "es", ("abierta",)), ("bao", "es", ("bano",)), ("ono", "en", ("onto",)),
    ],
)  # fmt: skip
def test_words_that_build_sentences_are_repaired(wrong, language, right):
    assert resolve(wrong, language, every=True) == right


@pytest.mark.parametrize("language", ["en", "de", "es"])
def test_common_words_stay_as_they_are(language):
    raw = yaml.safe_load((FOLDER / f"{language}.yaml").read_text(encoding="utf-8"))
    words = [fold(w.strip()) for w in raw["common"].split(",")]
    assert len(words) > 200
    assert read_words(" ".join(words), language).texts == [
        lexicon(language).tenses.get(w, w) for w in words
    ]  # verbs in the one tense that is read


@pytest.mark.parametrize("word", ["house", "couch", "both", "tall", "without", "xylophone", "flibbertigibbet"])
def test_other_words_are_left_alone(word):
    assert read_words(word, "en").texts == [word]


@pytest.mark.parametrize(("a", "b", "alike"), [("dsek", "desk", True), ("desck", "desk", True), ("dek", "desk", True), ("dusk", "desk", True), ("disc", "desk", False), ("des", "deskk", False)])  # fmt: skip
def test_one_letter_apart(a, b, alike):
    assert (distance(a, b, 1) == 1) is alike
    assert (distance(b, a, 1) == 1) is alike


def test_distance_is_a_bounded_metric():
    assert distance("kitchen", "kitchen", 2) == 0
    assert distance("ktichen", "kitchen", 2) == 1  # neighbours swapped
    assert distance("abc", "xyz", 2) == 3
    assert distance("hall", "halls", 2) == distance("halls", "hall", 2) == 1


def test_text_is_cleaned_and_keeps_its_places():
    text, places = clean("A\u200bB\u202eＣ\x00廳")
    assert text == "abc 厅"
    assert places == [0, 2, 4, 5, 6]
    assert [(t.text, t.start, t.end) for t in split_words("Küche, 12 m²")] == [("küche", 0, 5), (",", 5, 6), ("12", 7, 9), ("m²", 10, 12)]


@pytest.mark.parametrize("language", LANGUAGES)
def test_lexicons_mean_what_they_say(language):
    found = lexicon(language)
    assert found.trie
    assert {"near", "open", "door", "away", "between", "has"} <= {m.value for m in _meanings(found.trie) if m.kind == "cue"} | {
        f[2] for some in found.frames.values() for f in some
    }


def _meanings(node):
    for key, value in node.items():
        if key:
            yield from _meanings(value)
        else:
            yield value


@pytest.mark.parametrize(
    ("infinitive", "forms"),
    [
        ("abrir", "abra abrirá abrirían abriera"),
        ("tener", "tenga tendrá tuviera tenían"),
        ("cruzar", "cruce cruzará cruzaban"),
        ("llegar", "llegue llegarán llegara"),
        ("conducir", "conduzca conducirá condujera"),
        ("dar", "dará diese den"),
    ],
)
def test_spanish_verbs_are_read_in_every_tense(infinitive, forms):
    verbs = Verbs.model_validate(yaml.safe_load((FOLDER / "es.yaml").read_text(encoding="utf-8"))["verbs_of"])
    known = verbs.canonical()
    shown = {fold(p) for p in verbs.forms(infinitive)[0]}
    assert {known[fold(f)] for f in forms.split()} <= shown


@pytest.mark.parametrize(
    "cue", ["da al", "dan al", "dará al", "diera al", "se abrirá al", "se abriría al", "tendrá puerta al", "comunicará con el"]
)
def test_a_spanish_way_is_said_in_any_tense(cue):
    program = parse(f"El baño {cue} pasillo. Un dormitorio, salón y cocina.")
    assert {("bath", "hall"), ("hall", "bath")} & {(k.a, k.b) for k in program.links if k.stated}


@pytest.mark.parametrize(
    "prompt",
    [
        "Two bathrooms, but only one with a tub.",
        "Zwei Bäder, aber nur eins mit Badewanne.",
        "Dos baños, pero solo uno con bañera.",
        "Deux salles de bain mais une seule avec baignoire.",
        "两个卫生间,但只有一个有浴缸。",
    ],
)
def test_a_thing_of_one_of_two_rooms_is_no_count(prompt):
    baths = [r.furniture.counts for r in parse(prompt).rooms if r.type == "bathroom"]
    assert sorted(len(counts) for counts in baths) == [0, 1]


@pytest.mark.parametrize(
    "prompt",
    [
        "Three bedrooms, one bathroom each.",
        "Three bedrooms and one bathroom per bedroom.",
        "Drei Schlafzimmer, je ein Bad.",
        "Drei Schlafzimmer und ein Bad pro Zimmer.",
        "Tres dormitorios, un baño cada uno.",
        "Trois chambres, une salle de bain chacune.",
        "三间卧室,各一个卫生间。",
    ],
)
def test_a_bathroom_each_is_one_for_each(prompt):
    program = parse(prompt)
    assert sum(r.kind == "ensuite" for r in program.relations) == 3
    assert program.unparsed == ()


@pytest.mark.parametrize(
    "prompt",
    [
        "We parents have a double bed. Our son has a desk.",
        "Die Eltern haben ein Doppelbett, der Sohn hat einen Schreibtisch.",
        "Los padres tenemos una cama doble y nuestro hijo un escritorio.",
        "父母有一张双人床,儿子有书桌。",
    ],
)
def test_what_somebody_has_stands_in_their_bedroom(prompt):
    things = {r.role: [t.category for t in r.furniture.counts] for r in parse(prompt).rooms if r.type == "bedroom"}
    assert things == {"primary": ["double_bed"], "child": ["desk"]}


@pytest.mark.parametrize(
    "prompt",
    [
        "One bedroom. The kitchen is open.",
        "Ein Schlafzimmer. Die Küche ist offen.",
        "Un dormitorio. La cocina tiene que ser abierta.",
        "Une chambre. La cuisine est ouverte.",
        "一间卧室。厨房是开放的。",
    ],
)
def test_a_kitchen_that_is_open_is_an_open_kitchen(prompt):
    program = parse(prompt)
    assert [(k.a, k.b, k.kind) for k in program.links if k.kind == "open"] == [("living", "kitchen", "open")]
    assert program.unparsed == ()


@pytest.mark.parametrize(
    "prompt",
    [
        "A studio with a guest room.",
        "Ein Studio mit Gästezimmer.",
        "Un estudio con habitación de invitados.",
        "Un studio avec chambre d'amis.",
        "一个单间公寓带一间客房",
    ],
)
def test_a_studio_with_a_guest_room_has_no_other_bedroom(prompt):
    program = parse(prompt)
    assert [(r.type, r.role) for r in program.rooms if r.type in {"bedroom", "studio_room"}] == [("bedroom", "guest"), ("studio_room", "")]


@pytest.mark.parametrize(
    "prompt",
    [
        "A flat share for four: everyone has their own room, two bathrooms.",
        "Eine WG für vier: jeder hat sein eigenes Zimmer, dazu zwei Bäder.",
        "Un piso compartido para cuatro, cada uno con su habitación, dos baños.",
        "Une colocation pour quatre, chacun a sa chambre, deux salles de bain.",
        "四人合租,每人一间卧室,两个卫生间。",
    ],
)
def test_who_shares_a_home_has_a_room_each(prompt):
    program = parse(prompt)
    assert sorted(r.type for r in program.rooms if r.stated) == ["bathroom"] * 2 + ["bedroom"] * 4
    assert program.unparsed == ()


def test_what_is_separate_is_no_part_of_what_is_open():
    program = parse("Downstairs an open plan kitchen and dining room, a separate living room. One bedroom.")
    assert [{k.a, k.b} for k in program.links if k.kind == "open"] == [{"kitchen", "dining"}]


def test_a_storey_between_commas_opens_a_new_part():
    program = parse("Maison avec quatre chambres à l'étage et, au rez-de-chaussée, salon, cuisine et buanderie.")
    assert {r.type: r.level for r in program.rooms if r.stated} == {"bedroom": 1, "living_room": 0, "kitchen": 0, "utility": 0}


@pytest.mark.parametrize(
    "prompt",
    [
        "A flat with three bedrooms; the largest one has its own bathroom.",
        "Drei Schlafzimmer. Das größte hat ein eigenes Bad.",
        "Tres dormitorios; el más grande con baño propio.",
        "Trois chambres. La plus grande a sa propre salle de bain.",
    ],
)
def test_the_largest_is_one_of_those_that_were_counted(prompt):
    program = parse(prompt)
    (own,) = (r for r in program.relations if r.kind == "ensuite")
    assert [r.a for r in program.relations if r.kind == "largest"] == [own.b]
    assert sum(r.type == "bedroom" for r in program.rooms) == 3


@pytest.mark.parametrize(
    "prompt",
    [
        "A house for us and our three kids.",
        "Ein Haus für uns, unsere drei Kinder und den Hund.",
        "Una casa para nosotros y nuestros tres hijos.",
        "Une maison pour nous et nos trois enfants.",
    ],
)
def test_who_lives_there_has_a_bedroom_for_two_and_one_for_each_child(prompt):
    program = parse(prompt)
    assert sum(r.type == "bedroom" for r in program.rooms) == 4
    assert program.unparsed == ()


def test_phrases_end_with_their_line():
    assert list(split("two rooms, a bath\na hall,\n[off on] it")) == ["two rooms", "a bath", "a hall", "off it", "on it"]
