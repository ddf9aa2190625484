"""Categories: each is one card, and a card is all that a new one needs."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from pipeline import card
from pipeline.errors import ContentError

HOPE_CHEST = """
super: cabinet
names:
  future: [hope chest, dower chest]
  titles: [bottom drawer]
  kinds: [storage unit]
  partnet: [HopeChest]
  files: [dowry]
  peers: {bedroom: cabinet}
words:
  en: [hope chest]
  de: [aussteuertruhe]
  es: [baúl de novia]
  fr: [coffre de mariage]
  zh: [嫁妆箱]
groups: [any_cabinet]
size: {mean: [1.1, 0.5, 0.55], std: [0.1, 0.05, 0.05], p05: [0.94, 0.42, 0.47], p95: [1.26, 0.58, 0.63]}
mass: [15.0, 60.0]
density: 555.0
signs: {doors: 0.05, drawers: 0.1, covered: [0.1, 0.1]}
usual: [bedroom]
never: [wc, kitchen]
holds: {candle: 0.4}
finish: timber
set: {at: [double_bed], within: 2.0}
corpus:
  builder: storage.cabinet
  name: Hope Chest
  forms:
    drawers: {styles: [classic, Nordic]}
    doors: {}
  static: 3
  moving: 3
"""
VASE_STAND = """
super: other
layout: false
names: {future: [incense burner]}
size: {mean: [0.1, 0.1, 0.12], std: [0.01, 0.01, 0.01], p05: [0.08, 0.08, 0.1], p95: [0.12, 0.12, 0.14]}
mass: [0.2, 1.5]
lies: [centred]
lies_on: {hope_chest: 0.5, sideboard: 0.1}
corpus: {builder: tableware.vase, name: Incense Burner, forms: {belly: {round: true}}}
"""
WAY = """
import sys
from pathlib import Path
from pipeline import card
card.FOLDER = Path(sys.argv[1])
import numpy as np
from pipeline import taxonomy
from pipeline.corpus.furniture.assembly import shape_of
from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.floorplan import parse
from pipeline.floorplan.program.furniture import impossible, members, natural
from pipeline.sources.articulated.plain_urdf import candidates
from pipeline.sources.atiss.labels import KINDS
from pipeline.sources.rows import mass_factor
from pipeline.sources.sizes import sizes
from pipeline.sources.densities import density

words = taxonomy.load()
assert "hope_chest" in words.names and "incense_burner" in words.small and words.names[0] == "double_bed"
assert words.from_future("Dower Chest") == words.from_title("cabinet/ bottom drawer") == "hope_chest"
assert words.from_partnet("HopeChest") == ("hope_chest",) and words.of_kind("Storage Unit")[-1] == "hope_chest"
assert candidates("models/dowry_3.urdf", words) == candidates("a/hope_chest.urdf", words) == ("hope_chest",)
assert KINDS["bedroom"].label("hope_chest") == "cabinet" and "hope_chest" in KINDS["bedroom"].categories("cabinet")
assert sizes()["hope_chest"].mean[0] == 1.1 and mass_factor("hope_chest", 120.0) == 0.5 and density("cabinet", "Metal", "hope_chest") == 555.0
for prompt in ("a flat with a bedroom with two hope chests", "Wohnung mit einem Schlafzimmer mit zwei Aussteuertruhen"):
    rooms = parse(prompt).rooms
    assert [(c.category, c.min) for r in rooms for c in r.furniture.counts] == [("hope_chest", 2)], prompt
assert natural("hope_chest") == ("bedroom",) and impossible("wc", "hope_chest") and not impossible("bedroom", "hope_chest")
assert "hope_chest" in members("any_cabinet")
assert card.cards()["hope_chest"].holds == {"candle": 0.4, "incense_burner": 0.5} and card.cards()["sideboard"].holds["incense_burner"] == 0.1
made = catalogue(0)
new = [m for m in (*made.future, *made.partnet) if m.category == "hope_chest"]
assert len(new) == 6 and {m.future_name for m in new} == {"Hope Chest"} and {m.partnet_category for m in new} == {"", "HopeChest"}
for model in new:
    low, high = shape_of(model).bounds()
    assert np.allclose(high - low, model.size, atol=2e-3)
print("all the way")
"""


@pytest.fixture
def folder(tmp_path):
    """The cards and two new ones."""
    shutil.copytree(card.FOLDER, tmp_path / "categories")
    (tmp_path / "categories" / "hope_chest.yaml").write_text(HOPE_CHEST, encoding="utf-8")
    (tmp_path / "categories" / "incense_burner.yaml").write_text(VASE_STAND, encoding="utf-8")
    return tmp_path / "categories"


def test_a_new_category_is_one_card(folder):
    """In a process of its own: what is read once stays read."""
    root = Path(__file__).parents[1]
    found = subprocess.run([sys.executable, "-c", WAY, str(folder)], cwd=root, capture_output=True, text=True, check=False)
    assert found.stdout.strip() == "all the way", found.stderr


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("mass: [15.0, 60.0]", "mas: [15.0, 60.0]", "hope_chest.mas"),
        ("mass: [15.0, 60.0]", "", "hope_chest.mass is missing"),
        ("mass: [15.0, 60.0]", "mass: heavy", "hope_chest.mass = 'heavy'"),
        ("static: 3", "static: many", "hope_chest.corpus.static = 'many'"),
        ("finish: timber", "finish: gold", "hope_chest.finish = 'gold'"),
        ("candle: 0.4", "kandle: 0.4", "holds.kandle"),
        ("at: [double_bed]", "at: [bed]", "set.at.bed"),
        ("super: cabinet", "super: [", "cannot read"),
    ],
)
def test_what_is_wrong_on_a_card_is_named(folder, monkeypatch, old, new, told):
    assert old in HOPE_CHEST
    (folder / "hope_chest.yaml").write_text(HOPE_CHEST.replace(old, new), encoding="utf-8")
    monkeypatch.setattr(card, "FOLDER", folder)
    with pytest.raises(ContentError, match=r"manifests/categories/hope_chest.yaml") as error:
        card.cards.__wrapped__()
    assert told in str(error.value)


def test_cards_without_an_order_come_last(folder, monkeypatch):
    before = list(card.cards())
    monkeypatch.setattr(card, "FOLDER", folder)
    names = list(card.cards.__wrapped__())
    assert names[:-2] == before
    assert names[-2:] == ["hope_chest", "incense_burner"]
