"""A dataset of one real home: four rooms, cabinets that open, chairs, things that lie free; judged, written and committed."""

from dataclasses import replace

import numpy as np

from pipeline.entities.home import Placement
from pipeline.homes.life import files_of
from pipeline.homes.rows import home_rows
from pipeline.shards import Header, add_part, commit_shard, gather, open_or_create
from pipeline.usd.library import write_asset
from pipeline.verify import verify_home
from tests.geometry import furniture
from tests.judging import SETTINGS
from tests.usd.conftest import make_home

HEADER = Header(seed=0, count=1, shard_size=4, licence="CC0-1.0", digests={"params": "p" * 64})


def made():
    """The home and its assets; a book and a thing with a lid lie on a low cabinet."""
    home, assets = make_home()
    things = {name: furniture.LIBRARY[name] if name in furniture.LIBRARY else furniture.flip() for name in ("book", "flip")}

    def put(name, x, y):
        asset = things[name]
        return Placement(f"{name}_0", "living", asset.category, name, np.array([x, y, 0.8]), 0.4, asset.size, support="cabinet_2")

    home = replace(home, placements=(*home.placements, put("book", 1.2, 7.2), put("flip", 0.8, 7.2)))
    return home, assets | things


class Shelf:
    """The assets in a folder of their own."""

    def __init__(self, folder, assets):
        self.folder, self.assets = folder, assets

    def entry(self, asset_id):
        write_asset(self.assets[asset_id], self.folder / asset_id)
        return self.folder / asset_id

    def tables(self, _asset_ids):
        return {}


def fill(folder):
    """Write the dataset."""
    home, assets = made()
    rows = home_rows(home, verify_home(home, assets, SETTINGS), {}, assets, 1, HEADER.licence)
    with open_or_create(folder, HEADER, Shelf(folder.parent / "shelf", assets)) as dataset:
        add_part(dataset, 0, gather(0, {**rows, "rejects": []}, files_of(home, assets, 0)))
        commit_shard(dataset, 0)
