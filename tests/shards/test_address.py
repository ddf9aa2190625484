"""Datasets at addresses: sent shard by shard, whole or not at all, resumed from another machine, refused where another one lies."""

import json
from dataclasses import replace

import made
import pytest

from pipeline.errors import ContentError, UsageError
from pipeline.shards import Address, read_header
from pipeline.shards.commits import parse_commit
from pipeline.shards.layout import commit_path, shard_name
from sfgen.check import check

fsspec = pytest.importorskip("fsspec")
PLACE = "memory://bucket/homes"


@pytest.fixture(autouse=True)
def store():
    system = fsspec.filesystem("memory")
    system.store.clear()
    system.pseudo_dirs[:] = [""]
    yield system
    system.store.clear()


def there(store):
    """Every object of the store: its bytes by its name within the dataset."""
    return {path.removeprefix("/bucket/homes/"): store.cat_file(path) for path in store.find("/bucket/homes")}


def cut(store, monkeypatch, after):
    """Let the store fail from the `after`-th object on, as a machine does that loses its network."""
    left = [after]

    def counted(write):
        def wrapped(*args, **kwargs):
            if left[0] == 0:
                raise ConnectionError("the network is gone")
            left[0] -= 1
            return write(*args, **kwargs)

        return wrapped

    for name in ("put_file", "pipe_file"):
        monkeypatch.setattr(type(store), name, counted(getattr(type(store), name)))


def test_what_lies_at_the_address_is_what_lies_in_the_folder(tmp_path, store):
    made.fill(tmp_path / "set", address=Address(PLACE))
    assert there(store) == made.snapshot(tmp_path / "set")
    assert check(PLACE) == check(str(tmp_path / "set"))


def test_another_machine_goes_on_with_what_is_committed_there(tmp_path, store):
    made.fill(tmp_path / "first", numbers={0, 2}, address=Address(PLACE))
    assert made.fill(tmp_path / "second", address=Address(PLACE)) == [1]
    assert made.snapshot(tmp_path / "second") == there(store)
    made.fill(tmp_path / "alone")
    assert made.snapshot(tmp_path / "alone") == there(store)


def test_a_torn_shard_is_made_and_sent_again(tmp_path, store):
    made.fill(tmp_path / "first", numbers={0, 2}, address=Address(PLACE))
    store.pipe_file("/bucket/homes/usd/shard-00002/s5_00000008.usdc", b"torn")
    assert made.fill(tmp_path / "second", address=Address(PLACE)) == [1, 2]
    assert made.snapshot(tmp_path / "second") == there(store)


@pytest.mark.parametrize("after", [0, 1, 2, 9, 17, 23, 30, 41])
def test_a_commit_that_is_there_names_only_what_is_there(tmp_path, store, monkeypatch, after):
    with monkeypatch.context() as patch:
        cut(store, patch, after)
        with pytest.raises(ContentError, match="network is gone"):
            made.fill(tmp_path / "set", address=Address(PLACE))
    objects = there(store)
    for path in (p for p in objects if p.startswith("commits/shard-")):
        for file, entry in parse_commit(objects[path], path).files.items():
            assert len(objects[file]) == entry.bytes
    made.fill(tmp_path / "set", address=Address(PLACE))
    assert there(store) == made.snapshot(tmp_path / "set")


def test_a_dataset_that_grows_loses_its_seal_until_it_is_whole(tmp_path, store):
    small, large = replace(made.HEADER, count=8), replace(made.HEADER, count=12)
    made.fill(tmp_path / "set", small, address=Address(PLACE))
    made.fill(tmp_path / "set", large, numbers=set(), address=Address(PLACE))
    assert "commits/dataset.json" not in there(store)
    assert json.loads(there(store)["dataset.json"])["count"] == 12
    assert made.fill(tmp_path / "other", large, address=Address(PLACE)) == [2]
    assert there(store) == made.snapshot(tmp_path / "other")


def test_another_dataset_and_other_files_are_left_alone(tmp_path, store):
    made.fill(tmp_path / "set", address=Address(PLACE))
    before = there(store)
    with pytest.raises(UsageError, match="seed 5, not 6"):
        made.fill(tmp_path / "other", replace(made.HEADER, seed=6), address=Address(PLACE))
    assert there(store) == before
    assert not (tmp_path / "other").exists()
    store.pipe_file("/bucket/mine/notes.txt", b"mine")
    with pytest.raises(UsageError, match="holds other files"):
        made.fill(tmp_path / "other", address=Address("memory://bucket/mine"))


def test_a_mounted_folder_is_an_address_too(tmp_path):
    made.fill(tmp_path / "set", address=Address(f"file://{tmp_path}/mounted/set"))
    assert made.snapshot(tmp_path / "mounted" / "set") == made.snapshot(tmp_path / "set")


def test_only_what_changed_is_sent(tmp_path, store, monkeypatch):
    made.fill(tmp_path / "set", address=Address(PLACE))
    cut(store, monkeypatch, 0)
    made.fill(tmp_path / "set", address=Address(PLACE))


def test_an_address_of_an_unknown_kind_is_refused():
    with pytest.raises(UsageError, match="cannot be reached"):
        Address("nowhere://bucket/homes")


def test_a_header_at_an_address_is_read_as_one_in_a_folder(tmp_path):
    made.fill(tmp_path / "set", address=Address(PLACE))
    assert Address(PLACE).header() == read_header(tmp_path / "set")


def test_a_real_object_store_takes_it(tmp_path, monkeypatch):
    """S3's protocol, by moto's server: needs moto and s3fs."""
    pytest.importorskip("s3fs")
    server = pytest.importorskip("moto.server").ThreadedMotoServer(port=0)
    for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY"):
        monkeypatch.setenv(name, "testing")
    server.start()
    try:
        host, port = server.get_host_and_port()
        monkeypatch.setitem(fsspec.config.conf, "s3", {"endpoint_url": f"http://{host}:{port}"})
        fsspec.filesystem("s3").mkdir("homes")
        made.fill(tmp_path / "first", numbers={1}, address=Address("s3://homes/set"))
        assert made.fill(tmp_path / "second", address=Address("s3://homes/set")) == [0, 2]
        assert commit_path(shard_name(2)) in made.snapshot(tmp_path / "second")
        assert check("s3://homes/set") == check(str(tmp_path / "second"))
    finally:
        server.stop()
