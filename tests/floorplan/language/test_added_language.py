"""French is a file of data, `manifests/lexicon/fr.yaml`: plurals, adjectives behind their noun and all ways to say a thing, without a line of code of its own."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from pipeline.floorplan import parse
from pipeline.floorplan.language.lexicon import LANGUAGES, lexicon
from tests.floorplan.language.faults import faults

SAID = [
    ("Un appartement de 70 m² avec deux chambres, une salle de bain et une cuisine ouverte sur le salon.",
     {"rooms": {"bedroom": 2, "bathroom": 1, "kitchen": 1, "living_room": 1}, "links": [["kitchen", "living_room", "open"]], "total": 70}),
    ("Trois chambres, 85 m2, une salle de bain.", {"rooms": {"bedroom": 3, "bathroom": 1}, "total": 85}),
    ("Une maison à deux étages : en bas la cuisine, le salon et les toilettes, en haut trois chambres et une salle de bain.",
     {"rooms": {"kitchen": 1, "living_room": 1, "wc": 1, "bedroom": 3, "bathroom": 1}, "storeys": 2, "levels": [["kitchen", 0, 1], ["bedroom", 1, 3], ["bathroom", 1, 1]]}),
    ("La cuisine est à côté de la salle à manger. Pas de garage.", {"rooms": {"kitchen": 1, "dining_room": 1}, "absent": ["garage"]}),
    ("Chambre parentale avec sa propre salle de bain, deux chambres d'enfants.",
     {"rooms": {"bedroom": 3, "bathroom": 1}, "roles": {"primary": 1, "child": 2}, "links": [["bathroom", "bedroom", "door"]]}),
    ("Une porte entre la cuisine et le bureau.", {"rooms": {"kitchen": 1, "office": 1}, "links": [["kitchen", "office", "door"]]}),
    ("Le couloir dessert la cuisine, la salle de bain et le salon.",
     {"rooms": {"hallway": 1, "kitchen": 1, "bathroom": 1, "living_room": 1},
      "links": [["hallway", "kitchen", "*"], ["bathroom", "hallway", "*"], ["hallway", "living_room", "*"]]}),
    ("La cuisine doit faire au moins 12 m². Une chambre, un salon de 25 m².",
     {"rooms": {"kitchen": 1, "bedroom": 1, "living_room": 1}, "areas": {"kitchen": [12, None], "living_room": 25}}),
    ("Le bureau ne doit pas être à côté de la cuisine.", {"rooms": {"office": 1, "kitchen": 1}, "apart": [["office", "kitchen"]]}),
    ("Studio de 30 m² avec salle d'eau et balcon.", {"rooms": {"studio_room": 1, "bathroom": 1, "balcony": 1}, "total": 30}),
]  # fmt: skip


@pytest.mark.parametrize(("prompt", "said"), SAID, ids=[p[:40] for p, _ in SAID])
def test_french_is_read(prompt, said):
    assert faults({"prompt": prompt, **said}) == []
    assert parse(prompt).language == "fr"


FURNISHED = [
    ("Une chambre avec un lit double et deux tables de chevet, une cuisine avec lave-vaisselle.",
     {"bed": {"double_bed": (1, None), "nightstand": (2, 2)}, "kitchen": {"dishwasher": (1, None)}}),
    ("Salon avec canapé d'angle, deux fauteuils et une table basse, chambre avec armoire et commode.",
     {"living": {"l_shaped_sofa": (1, None), "armchair": (2, 2), "coffee_table": (1, None)}, "bed": {"wardrobe": (1, None), "cabinet": (1, None)}}),
    ("Chambre avec un lit et un tabouret, au moins quatre chaises dans la salle à manger.",
     {"bed": {"any_bed": (1, None), "stool": (1, None)}, "dining": {"any_chair": (4, None)}}),
]  # fmt: skip


@pytest.mark.parametrize(("prompt", "said"), FURNISHED, ids=[p[:40] for p, _ in FURNISHED])
def test_french_furniture_is_on_the_cards(prompt, said):
    made = parse(prompt)
    assert {r.id: {c.category: (c.min, c.max) for c in r.furniture.counts} for r in made.rooms if r.furniture.counts} == said
    assert not made.unparsed


def test_a_french_family_has_bedrooms():
    assert sum(r.type == "bedroom" for r in parse("Une maison pour une famille de quatre personnes.").rooms) == 3


CODE = Path(__file__).parents[3] / "pipeline" / "floorplan" / "language"
TAKES_TEXT = {"startswith", "endswith", "removesuffix", "removeprefix"}
ELIDED = re.compile(r"'(\(\?:)?[a-z]", re.IGNORECASE)  # "n't", "'s", and a pattern of such
NAMES = {"auto", "chat"}  # of a wish for windows and of a server's address; words in German and French besides


def strings(tree: ast.AST) -> Iterator[ast.Constant]:
    """Yield the strings of a module that are no docstrings and no messages: those without a blank, be they parts of a pattern."""
    texts = {id(n.value) for n in ast.walk(tree) if isinstance(n, ast.Expr) and isinstance(n.value, ast.Constant)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in texts and " " not in node.value:
            yield node


def words_of_languages(code: str) -> list[str]:
    """Return what in a module's code is a piece of some language: letters that English lacks, words of the other lexicons, what is elided, and ends of words."""
    tree, found = ast.parse(code), []
    english = lexicon("en").vocabulary
    others = set().union(*(lexicon(language).vocabulary for language in LANGUAGES)) - english
    for node in strings(tree):
        letters = [c for c in node.value if c.isalpha() and not c.isascii()]
        foreign = [w for w in re.findall(r"[a-z]+", node.value) if len(w) > 1 and w in others - NAMES]
        if letters or foreign or ELIDED.search(node.value):
            found.append(f"{node.lineno}: {node.value!r}")
    for node in ast.walk(tree):
        called = isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in TAKES_TEXT
        compared = isinstance(node, ast.Compare) and re.search(r"\btexts?\b", ast.unparse(node))
        texts = [n for n in ast.walk(node) if isinstance(n, ast.Constant) and isinstance(n.value, str)] if called or compared else []
        found += [f"{n.lineno}: {n.value!r}" for n in texts if re.fullmatch(r"'?[a-z]{1,3}'?", n.value)]
    return found


def test_no_code_holds_words_of_a_language():
    found = [f"{file.name}:{what}" for file in sorted(CODE.glob("*.py")) for what in words_of_languages(file.read_text(encoding="utf-8"))]
    assert not found


@pytest.mark.parametrize(
    "code",
    [
        'ENDINGS = ("en", "es", "as", "os", "em", "e", "n", "s", "a", "o")',
        r"""WORD = re.compile(rf"[^\W\d_{HAN}]+(?:'(?:s|t|ve|d|ll|re|m)\b)?'?")""",
        'ALIKE = str.maketrans("廳", "厅")',
        'word = word.replace("ä", "ae")',
        """bared = word.removesuffix("'").removesuffix("'s")""",
        """plain = words(phrase.replace("n't", "nt"))""",
        'least = 2 if last.endswith("s") else 1',
        'if self.text(k) != "a": pass',
        'crossed = mark.text in {"x", "mal"}',
        'if "zimmer" in signs: pass',
    ],
)
def test_words_of_a_language_in_code_are_found(code):
    assert words_of_languages(code)


def test_no_code_asks_for_a_language_by_name():
    names = {lexicon(language).name.lower() for language in LANGUAGES} | {"mandarin"}
    for file in sorted(CODE.glob("*.py")):
        assert not names & set(file.stem.split("_")), file.name
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Compare) and "language" in ast.unparse(node):
                asked = {c.value for c in ast.walk(node) if isinstance(c, ast.Constant)} & set(LANGUAGES)
                assert not asked, f"{file.name}:{node.lineno} asks for {asked}"
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                assert not names & set(node.name.lower().split("_")), f"{file.name}:{node.lineno} {node.name}"
