"""Houses as scene files, with the defects of real ones or without, each counted as it is written."""

import json
from pathlib import Path

from pipeline.corpus import front_statistics
from pipeline.corpus.calibration.tally import HouseTally, tally
from pipeline.corpus.front_writer import DIALECTS, scene_json
from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.corpus.furniture.level_tops import surfaces_of
from pipeline.corpus.houses import corruption
from pipeline.corpus.houses.house import make_house
from pipeline.corpus.houses.stock import Stock
from pipeline.corpus.settings import CorpusSettings
from pipeline.seeds import generator


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
