"""A factory whose layout model is a few rules: it shows everything around the net without training one."""

import sys
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest

from pipeline import params, seeds
from pipeline.arrange import LearntRelations, PostoptSettings
from pipeline.diffusion.context import Proposal
from pipeline.diffusion.settings import SampleSettings
from pipeline.entities.files import save_asset
from pipeline.floorplan.program.priors import PriorSettings
from pipeline.homes.factory import Factory
from pipeline.homes.library import Library
from pipeline.homes.resources import ShardSettings
from pipeline.relations.model import relations
from pipeline.retrieval.index import AssetIndex
from tests.judging import SETTINGS

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests" / "geometry"))
import furniture  # noqa: E402

MENU = {
    "bedroom": ["double_bed", "nightstand", "wardrobe"],
    "kids_room": ["single_bed", "wardrobe"],
    "living_room": ["multi_seat_sofa", "cabinet"],
    "living_dining_room": ["multi_seat_sofa", "cabinet", "dining_table", "dining_chair"],
    "dining_room": ["dining_table", "dining_chair"],
    "kitchen": ["kitchen_cabinet", "kitchen_cabinet"],
    "bathroom": ["toilet"],
    "study": ["desk"],
}
BLOCKS = {
    "double_bed": (1.6, 2.0, 0.6),
    "single_bed": (0.9, 2.0, 0.5),
    "nightstand": (0.4, 0.4, 0.5),
    "multi_seat_sofa": (2.0, 0.9, 0.8),
    "toilet": (0.4, 0.6, 0.8),
    "desk": (1.2, 0.6, 0.75),
}


@dataclass(frozen=True)
class Rules:
    """Stands in for the sampler: things of the room's menu, anywhere in its box, keyed like the real one."""

    seed: int = 0
    settings: SampleSettings = field(default_factory=SampleSettings)
    slots: int = 24

    def baseline(self):
        return replace(self, settings=replace(self.settings, quantity=False, articulation="none"))

    def sample_rooms(self, rooms, keys):
        return [self._room(room, key) for room, key in zip(rooms, keys, strict=True)]

    def _room(self, room, key):
        rng = seeds.generator(self.seed, "rules", *key)
        menu = MENU.get(room.layout_type, [])
        if room.n_target is not None:
            menu = ["nightstand" if room.n_target < 10 else "double_bed"] * room.n_target
        low, high = room.polygon.min(0), room.polygon.max(0)
        sizes = {**BLOCKS, "wardrobe": (0.6, 0.5, 1.8), "cabinet": (0.8, 0.5, 0.9), "kitchen_cabinet": (0.8, 0.5, 0.9)}
        sizes |= {"dining_table": (1.4, 0.8, 0.75), "dining_chair": (0.45, 0.5, 0.9)}
        return [
            Proposal(
                name,
                np.array([*rng.uniform(low, high), room.elevation]),
                float(rng.choice([0.0, np.pi / 2, np.pi, -np.pi / 2]) + rng.normal(0, 0.05)),
                np.array(sizes[name]),
                rng.standard_normal(32).astype(np.float32),
            )
            for name in menu
        ]


def assets():
    made = [furniture.block(f"block_{name}", name, size) for name, size in BLOCKS.items()]
    made += [furniture.block(f"small_{name}", name, tuple(0.8 * s for s in size)) for name, size in BLOCKS.items()]
    made += [furniture.cupboard("cupboard"), furniture.chest("chest"), furniture.chest("base", "kitchen_cabinet")]
    return [*made, furniture.table(), furniture.chair()]


def library_of(folder, made):
    rows = []
    for asset in made:
        digest = save_asset(folder / f"{asset.asset_id}.safetensors", asset)
        rows.append(
            {
                "asset_id": asset.asset_id,
                "source": "test",
                "source_id": asset.asset_id,
                "category": asset.category,
                "super_category": "",
                "style": "",
                "material": "",
                "split": "train",
                "size": asset.size.tolist(),
                "unit_scale": 1.0,
                "scale_from": "file",
                "scale_rms": None,
                "articulated": asset.articulated,
                "openable": asset.openable,
                "joints": len(asset.joints),
                "triangles": 12,
                "mass": 10.0,
                "density": 600.0,
                "licence": "CC0-1.0",
                "file": f"{asset.asset_id}.safetensors",
                "sha256": digest,
            }
        )
    return Library(folder, rows, [])


def factory_of(library):
    latents = [{"asset_id": a, "latent": np.full(32, i, np.float32)} for i, a in enumerate(sorted(library))]
    index = AssetIndex.from_tables(library.rows.values(), latents)
    shard = replace(params.section(ShardSettings, params.read(ROOT / "params.yaml"), "shard"), homes=4, chunk=2, preview=0)
    return Factory(3, Rules(3), index, library, shard, PostoptSettings(), SETTINGS, PriorSettings(), {}, LearntRelations(relations([], [])))


@pytest.fixture(scope="session")
def library(tmp_path_factory):
    return library_of(tmp_path_factory.mktemp("library"), assets())


@pytest.fixture(scope="session")
def factory(library):
    return factory_of(library)


@pytest.fixture
def factory_with(tmp_path):
    return lambda kept: factory_of(library_of(tmp_path, list(filter(kept, assets()))))
