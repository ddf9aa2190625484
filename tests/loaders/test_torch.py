"""sfgen.torch: homes as tensors, one by one and in batches."""

import pytest
import torch
from torch.utils.data import DataLoader

from sfgen.torch import HomeDataset, collate


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
