"""From tables to the peers' rooms and back through both stages: the same rooms, the same split, the same numbers."""

import numpy as np
import pytest

from pipeline import tables
from pipeline.errors import UsageError
from pipeline.sources import inventory
from pipeline.sources.atiss.files import BOXES
from pipeline.sources.atiss.source import Atiss
from pipeline.sources.settings import PreprocessSettings
from schemas import OBJECTS, REJECTS, ROOMS, SCENES
from stages import peers, preprocess
from tests.stages.test_preprocess import checkout, write_params


def read(root, table):
    return tables.read(root / "data/tables" / f"{table.name}.parquet", table)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    root = checkout(tmp_path_factory.mktemp("checkout"), houses=12)
    preprocess.main(root)
    peers.main(root, out=root / "peers", filtered=False)
    inventory.write(root / inventory.FOLDER / "peers.csv", inventory.scan(Atiss().list(root / "peers", PreprocessSettings())))
    return root


def boxes(folder):
    found = {}
    for path in sorted(folder.rglob(BOXES)):
        with np.load(path, allow_pickle=False) as file:
            found[path.parent.relative_to(folder).as_posix()] = {k: file[k] for k in file.files}
    return found


def test_split_is_ours(made):
    """Of every scene; and only bedrooms hold something here."""
    splits = {r["scene_id"].removeprefix("h_").replace("_", "-"): r["split"] for r in read(made, SCENES)}
    lines = [line.split(",") for line in (made / "peers" / "bedroom_threed_front_splits.csv").read_text().split()]
    names = sorted(p.parent.name for p in (made / "peers" / "bedroom").glob(f"*/{BOXES}"))
    assert {tuple(line) for line in lines} == {(n.split("_")[1], splits[n.split("_")[0]]) for n in names}
    assert len(names) == 12
    assert not list((made / "peers" / "livingroom").glob(f"*/{BOXES}"))


def test_round_trip_through_the_tables(made, capsys):
    before = {(o["source_id"].split("/")[0], o["category"]): o for o in read(made, OBJECTS)}
    write_params(made, peers="peers", front="data/raw/3d-front")
    preprocess.main(made)
    assert "12 houses, 12 rooms" in capsys.readouterr().out
    after = {(o["source_id"].split("/")[0], o["category"]): o for o in read(made, OBJECTS)}
    assert before.keys() == after.keys()
    for key, o in after.items():
        for name in ("position", "size", "yaw", "scale"):
            assert np.allclose(o[name], before[key][name], atol=2e-6), (key, name)
        assert o["asset_id"] == before[key]["asset_id"]
    assert {r["type"] for r in read(made, ROOMS)} == {"masterbedroom"}
    assert {r["reason"] for r in read(made, REJECTS)} <= {"hull_collider"}
    peers.main(made, out=made / "again", filtered=False)
    first, second = boxes(made / "peers"), boxes(made / "again")
    # a room id that recurs keeps the mark that it got the first time
    assert first.keys() == second.keys()
    for name, arrays in first.items():
        for key, array in arrays.items():
            assert np.array_equal(array, second[name][key]), (name, key)


def test_without_models_boxes_stand_alone(made):
    write_params(made, peers="peers", front="data/raw", partnet=None)
    preprocess.main(made)
    assert {o["asset_id"] for o in read(made, OBJECTS)} == {""}
    assert {r["reason"] for r in read(made, REJECTS)} == {"size_from_bbox"}


def test_a_folder_with_something_in_it_is_left_alone(made):
    with pytest.raises(UsageError, match="not an empty folder"):
        peers.main(made, out=made / "peers", filtered=True)
