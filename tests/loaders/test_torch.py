"""sfgen.torch: homes as tensors, one by one and in batches."""

from dataclasses import replace

import pytest
import torch
from torch.utils.data import DataLoader

from sfgen.torch import HomeDataset, HomeStream, collate


def test_items_hold_what_the_homes_hold(dataset_folder):
    data = HomeDataset(dataset_folder)
    assert len(data) == 10
    item = data[4]
    home = data.homes[4]
    assert item["position"].shape == (2, 3)
    assert item["latent"].shape == (2, 32)
    assert [data.categories[i] for i in item["category"]] == [o.category for o in home.objects]
    assert [data.room_types[i] for i in item["room_type"]] == [r.type for r in home.rooms]
    assert item["room"].tolist() == [0, 1]
    torch.testing.assert_close(item["yaw"], torch.tensor([o.yaw for o in home.objects]))
    assert item["polygon"][0].shape == (4, 2)


def test_vocabulary_does_not_depend_on_the_split(dataset_folder):
    assert HomeDataset(dataset_folder, "val").categories == HomeDataset(dataset_folder).categories
    assert [i["scene_id"] for i in HomeDataset(dataset_folder, "val")] == ["s5_00000001", "s5_00000004", "s5_00000007"]


@pytest.mark.parametrize("workers", [0, 1])
def test_batches_are_padded_and_masked(dataset_folder, workers):
    loader = DataLoader(HomeDataset(dataset_folder), batch_size=4, collate_fn=collate, num_workers=workers)
    batches = list(loader)
    assert [len(b["scene_id"]) for b in batches] == [4, 4, 2]
    first = batches[0]
    assert first["position"].shape == (4, 3, 3)
    assert first["objects"].sum(1).tolist() == [1, 2, 3, 1]
    assert first["rooms"].all()
    assert (first["position"][~first["objects"]] == 0).all()


def names(stream):
    return [item["scene_id"] for item in stream]


@pytest.fixture(scope="module")
def long(tmp_path_factory):
    """42 homes in 11 shards."""
    import made

    folder = tmp_path_factory.mktemp("long") / "set"
    made.fill(folder, replace(made.HEADER, count=42))
    return folder


def test_a_stream_brings_every_home_once_and_another_order_each_epoch(long):
    stream = HomeStream(long, window=3)
    first = names(stream)
    assert names(stream) == first
    stream.set_epoch(1)
    second = names(stream)
    assert first != second
    assert sorted(first) == sorted(second) == [h.scene_id for h in stream.data.homes]
    assert names(HomeStream(long, seed=1)) != first
    assert names(HomeStream(long, shuffle=False)) == sorted(first)


def test_a_stream_reads_each_shard_once(long, monkeypatch):
    stream, read = HomeStream(long, window=3), []
    real = stream.data.homes._read
    monkeypatch.setattr(stream.data.homes, "_read", lambda table, n, *columns: read.append((table, n)) or real(table, n, *columns))
    names(stream)
    assert len(read) == len(set(read)) == 55


@pytest.mark.parametrize(("world", "workers"), [(1, 2), (2, 0), (3, 2), (5, 1)])
def test_ranks_and_workers_share_an_epoch_without_doubles(long, world, workers):
    seen = []
    for rank in range(world):
        stream = HomeStream(long, rank=rank, world=world)
        mine = [name for batch in DataLoader(stream, batch_size=4, collate_fn=collate, num_workers=workers) for name in batch["scene_id"]]
        assert len(mine) == len(stream) == 42 // world
        seen += mine
    assert len(set(seen)) == len(seen) == world * (42 // world)


def test_a_stream_goes_on_where_it_was(long):
    whole = names(HomeStream(long, seed=4))
    stream = HomeStream(long, seed=4)
    reader = iter(stream)
    begun = [next(reader)["scene_id"] for _ in range(17)]
    again = HomeStream(long, seed=4)
    again.load_state_dict(stream.state_dict())
    assert begun + names(again) == whole
    assert names(again) == whole  # the next pass begins at the beginning


def test_class_numbers_do_not_hang_on_what_occurs(tmp_path, dataset_folder):
    import made

    made.fill(tmp_path / "small", replace(made.HEADER, count=1))  # one bed
    small, large = HomeDataset(tmp_path / "small"), HomeDataset(dataset_folder)
    assert small[0]["category"].tolist() == large[0]["category"].tolist()
    assert small.categories == large.categories


def test_a_window_that_does_not_fit_into_memory_is_refused(long):
    with pytest.raises(ValueError, match="1 to"):
        HomeStream(long, window=1000)
