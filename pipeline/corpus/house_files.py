"""Houses as scene files, with the defects of real ones or without, each counted as it is written; and what params.yaml says about them."""

import json
from dataclasses import dataclass
from pathlib import Path

from pipeline.corpus import front_statistics
from pipeline.corpus.calibration import HouseTally, tally
from pipeline.corpus.front_writer import DIALECTS, scene_json
from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.corpus.houses import corruption
from pipeline.corpus.houses.house import make_house
from pipeline.corpus.houses.stock import Stock, surfaces_of
from pipeline.errors import ContentError
from pipeline.seeds import generator

MOST_HOUSES = 1_000_000


@dataclass(frozen=True, slots=True)
class CorpusSettings:
    """`houses` in number; `models` as a factor on the catalogue (1 is some hundreds); `corruption`: with the defects of real files."""

    houses: int
    models: float
    corruption: bool

    def __post_init__(self) -> None:
        if not 1 <= self.houses <= MOST_HOUSES:
            raise ContentError(f"params.yaml: corpus.houses = {self.houses} is not valid", f"give a number from 1 to {MOST_HOUSES}")
        if not 0 < self.models <= 100:
            raise ContentError(f"params.yaml: corpus.models = {self.models} is not valid", "give a factor above 0, at most 100")


def write_houses(folder: Path, seed: int, settings: CorpusSettings, indices: range) -> list[HouseTally]:
    """Write the houses of these indices to `folder`, one scene file each, the two dialects in their observed shares; return their counts."""
    stock = Stock(catalogue(seed, settings.models).future, surfaces_of)
    tallies = []
    for index in indices:
        house = make_house(seed, index, stock)
        rng = generator(seed, "front", index)
        dialect = DIALECTS[int(rng.random() >= 5 / 12)]
        litter = corruption.Litter()
        if settings.corruption:
            house = corruption.disturb(rng, house, stock)
            litter = corruption.litter(rng, house)
        scene = scene_json(house, dialect, rng, litter)
        (folder / f"{house.uid}.json").write_text(json.dumps(scene, separators=(",", ":")), encoding="utf-8")
        tallies.append(tally(house, scene, front_statistics.load()))
    return tallies
