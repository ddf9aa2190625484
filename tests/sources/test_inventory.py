import os

import pytest

from pipeline.errors import ContentError
from pipeline.sources import inventory
from pipeline.sources.source import Listing


@pytest.fixture
def source(tmp_path):
    for name in ("a/1.json", "a/deep/x.obj", "b/2.json", "unlisted/3.json", "a/parts_render/0.png", 'a/über, "x".mtl'):
        path = tmp_path / "data" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(name)
    return Listing("front", tmp_path / "data", ("b", "a"), ())


def test_it_lists_what_is_read_and_nothing_else(source):
    assert [path for path, *_ in inventory.scan(source)] == ["a/1.json", "a/deep/x.obj", 'a/über, "x".mtl', "b/2.json"]


def test_what_is_written_is_read_back(source, tmp_path):
    listed = list(inventory.scan(source))
    assert inventory.write(tmp_path / "i.csv", listed) == 4
    assert inventory.read(tmp_path / "i.csv") == listed
    inventory.require_match(tmp_path / "i.csv", source)


def change_size(root):
    (root / "a/1.json").write_text("longer than it was")


def change_time(root):
    os.utime(root / "a/1.json", (1, 1))


def take(root):
    (root / "a/1.json").unlink()


def add(root):
    (root / "a/0.json").write_text("")


@pytest.mark.parametrize(("change", "said"), [(change_size, "a/1.json"), (change_time, "a/1.json"), (take, "a/1.json"), (add, "a/0.json")])
def test_every_change_stops_and_is_named(source, tmp_path, change, said):
    inventory.write(tmp_path / "i.csv", inventory.scan(source))
    change(source.root)
    with pytest.raises(ContentError, match=said) as error:
        inventory.require_match(tmp_path / "i.csv", source)
    assert "sfgen doctor --use" in error.value.remedy


@pytest.mark.parametrize("text", [None, "", "path,size\n", "path,size,mtime_ns\na,b,c\n", "path,size,mtime_ns\na,1\n"])
def test_what_is_no_inventory_is_refused(tmp_path, text):
    if text is not None:
        (tmp_path / "i.csv").write_text(text)
    with pytest.raises(ContentError, match="inventory"):
        inventory.read(tmp_path / "i.csv")
