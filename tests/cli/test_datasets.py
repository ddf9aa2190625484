"""`sfgen shard` and `sfgen generate` with a factory of paper: what they ask for, write, resume and refuse."""

import json
import sys
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "shards"))
import made

import sfgen
from pipeline.entities.plan import Plan, Room
from pipeline.errors import ContentError, RefusedError
from pipeline.homes.life import Empty
from pipeline.shards import scene_id
from sfgen import cli


class Paper:
    """Stands for the factory: homes are made-up rows, and every request is kept."""

    chunk = 4

    def __init__(self, seed, weights="w"):
        self.seed, self.seconds = seed, {}
        self.shard = SimpleNamespace(home_seconds=300.0, shard_seconds=30.0, homes=4, licence="CC0-1.0", preview=768)
        self.digests = {"weights": weights}
        self.asked = []
        self.library = SimpleNamespace(rows={f"asset_{k}": {"style": ""} for k in range(2)})

    @contextmanager
    def time(self, part):
        self.seconds[part] = 1.0
        yield

    @property
    def asset_cache(self):
        return made.AssetSource(Path("cache"))

    def make(self, requests, first=None):
        assert len(requests) <= self.chunk
        self.asked += [(r.index, r.prompt) for r in requests]
        if any("loft" in r.prompt for r in requests):
            raise ZeroDivisionError("a bug")
        return [self.one(r) for r in requests]

    def one(self, request):
        if "mansion" in request.prompt:
            return Empty(request.index, "refused", RefusedError("no palace", "ask for less"))
        return self.home(request)

    def home(self, r):
        rows, files = made.home(r.index, self.seed)
        room = Room("studio", "studio_room", np.array([[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0]]))
        plan = Plan((room,), (), "studio")
        placed = [SimpleNamespace(asset_id="asset_1"), SimpleNamespace(asset_id="asset_0"), SimpleNamespace(asset_id="asset_1")]
        home = SimpleNamespace(scene_id=scene_id(self.seed, r.index), plan=plan, placements=placed, program=r.program or "{}")
        return SimpleNamespace(rows=rows, files=files, home=home)


@pytest.fixture
def factory(monkeypatch, tmp_path):
    """The factory of every command of a test; the commands run in an empty folder, in this process."""
    from stages import generate, shard

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(shard, "cores", lambda: 1)
    paper = Paper(3)

    def opened(_root, seed, _memory=0, preview=None):
        paper.seed = seed
        paper.shard.preview = paper.shard.preview if preview is None else preview
        return paper

    monkeypatch.setattr(shard, "open_factory", opened)
    monkeypatch.setattr(generate, "open_factory", opened)
    return paper


def run(*arguments):
    return cli.run([str(a) for a in arguments])


def test_shard_makes_a_dataset_in_the_working_directory(factory, capsys):
    assert run("shard", "--count", 10, "--seed", 3) == 0
    assert [h.index for h in sfgen.load("datasets/3")] == list(range(10))
    assert factory.asked == [(i, "") for i in range(10)]
    assert "10 homes in datasets/3" in capsys.readouterr().out
    assert sorted(p.name for p in Path("datasets/3/assets").iterdir()) == ["asset_0", "asset_1", "assets.parquet"]
    assert run("verify", "--quick", "datasets/3") == 0


def test_shard_resumes_and_does_nothing_twice(factory):
    assert run("shard", "--count", 8, "--out", "d", "--seed", 3) == 0
    before = made.snapshot("d")
    factory.asked.clear()
    assert run("shard", "--count", 8, "--out", "d", "--seed", 3) == 0
    assert factory.asked == []
    assert made.snapshot("d") == before
    assert run("shard", "--count", 10, "--out", "d", "--seed", 3) == 0
    assert [i for i, _ in factory.asked] == [8, 9]


def test_shard_asks_for_what_the_file_says(factory, tmp_path):
    (tmp_path / "p.txt").write_text("a studio\na two-bedroom apartment\n")
    assert run("shard", "--count", 3, "--out", "d", "--prompts", "p.txt") == 0
    assert factory.asked == [(0, "a studio"), (1, "a two-bedroom apartment"), (2, "a studio")]


@pytest.mark.parametrize(
    ("files", "arguments", "code"),
    [
        ({"d/thesis.tex": "mine"}, ["--out", "d"], 2),
        ({"d": "mine"}, ["--out", "d"], 2),
        ({"p.txt": ""}, ["--prompts", "p.txt"], 2),
        ({"p.txt": "x" * 1_000_000}, ["--prompts", "p.txt"], 2),
        ({"p.yaml": "- {prompt: a studio, weight: -1}"}, ["--prompts", "p.yaml"], 1),
        ({"p.txt": "a studio\nsing me a song\n"}, ["--prompts", "p.txt", "--strict"], 3),
        ({"p.txt": "sing me a song\n"}, ["--prompts", "p.txt"], 3),
        ({}, ["--prompts", "p.txt"], 2),
        ({}, ["--prompts", "."], 2),
        ({}, ["--scheduler", "nowhere.json"], 2),
        ({}, ["--out", "s3://bucket/homes"], 2),
        ({}, ["--out", "s3:/bucket/homes"], 2),
    ],
)
def test_shard_refuses_in_one_line_and_loses_nothing(factory, tmp_path, capsys, files, arguments, code):
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    assert run("shard", "--count", 5, *arguments) == code
    *before, err = capsys.readouterr().err.splitlines()
    assert all(line.startswith("homes: ") for line in before)
    assert err.startswith("sfgen: ")
    assert len(err) < 400
    assert {name: (tmp_path / name).read_text() for name in files} == files
    assert not list(tmp_path.rglob("shard-*"))


HARD = "a studio\na mansion with two bedrooms\na loft with one bedroom\n"


def test_what_cannot_be_made_leaves_its_index_empty_and_the_run_goes_on(factory, tmp_path, capsys):
    (tmp_path / "p.txt").write_text(HARD)
    command = ("shard", "--count", 7, "--out", "d", "--seed", 3, "--prompts", "p.txt")
    assert run(*command) == 1
    said = capsys.readouterr()
    lines = said.err.splitlines()
    assert [line for line in lines if line.startswith("sfgen: ")] == [
        f"sfgen: 2 homes stay empty: internal (s3_00000002: ZeroDivisionError: a bug (test_datasets.py:{broken_line()}, make))",
        "sfgen: 2 homes stay empty: refused (s3_00000001: no palace; ask for less)",
    ]
    (named,) = [line for line in lines if "home 5 " in line]
    assert "shard-00001, seed 3" in named
    assert "sfgen shard --count 7 --seed 3 --prompts p.txt --only 5" in named
    assert "3 homes in d" in said.out
    assert [home.index for home in sfgen.load("d")] == [0, 3, 6]
    assert [row["reason"] for row in sfgen.load("d").table("rejects").to_pylist() if row["what"] == "index"] == ["refused", "internal"] * 2
    assert run("verify", "--quick", "d") == 0
    assert "4 stay empty" in capsys.readouterr().out
    before = made.snapshot("d")
    factory.asked.clear()
    assert run(*command) == 1  # neither repeated nor forgotten
    assert "2 homes stay empty: refused" in capsys.readouterr().err
    assert (factory.asked, made.snapshot("d")) == ([], before)
    assert run(*command, "--strict") == 1


def broken_line():
    return 1 + Path(__file__).read_text().splitlines().index('            raise ZeroDivisionError("a bug")')


def test_strict_stops_at_the_first(factory, tmp_path, capsys):
    (tmp_path / "p.txt").write_text(HARD)
    assert run("shard", "--count", 7, "--out", "d", "--prompts", "p.txt", "--strict") == 3
    assert "no palace" in capsys.readouterr().err
    assert not list(Path("d").glob("commits/shard-*"))


UNREAD = "# mine\na studio\n\ntwo bedrooms and a flumox\na flat with a kitchen island\n"


@pytest.mark.parametrize(("file", "place"), [("p.txt", "line 4 of p.txt"), ("p.yaml", "entry 2 of p.yaml")])
def test_strict_refuses_a_prompt_with_words_that_are_not_understood_before_anything_is_made(factory, tmp_path, capsys, file, place):
    prompts = [line for line in UNREAD.splitlines() if line and line[0] != "#"]
    (tmp_path / file).write_text(UNREAD if file == "p.txt" else json.dumps([{"prompt": p} for p in prompts]))
    command = ("shard", "--count", 7, "--out", "d", "--prompts", file)
    assert run(*command, "--strict") == 3
    assert f"sfgen: {place}: not understood: 'flumox'" in capsys.readouterr().err
    assert factory.asked == []
    assert not Path("d").exists()
    assert run(*command) == 0
    assert len(factory.asked) == 7


def test_generate_refuses_words_that_are_not_understood_before_anything_is_made(factory, tmp_path, capsys):
    plan = {"rooms": [{"type": "bedroom", "polygon": [[0, 0], [5, 0], [5, 4], [0, 4]]}]}
    (tmp_path / "plan.json").write_text(json.dumps(plan))
    for prompt, source in (("two bedrooms and a flumox", []), ("a bedroom with a flumox and two nightstands", ["--plan", "plan.json"])):
        assert run("generate", prompt, *source, "--out", "h", "--strict") == 3
        assert "not understood: 'flumox'" in capsys.readouterr().err
        assert factory.asked == []
        assert not Path("h").exists()


def test_one_home_is_made_again_to_see_what_is_wrong(factory, tmp_path, capsys):
    (tmp_path / "p.txt").write_text(HARD)
    command = ("shard", "--count", 7, "--prompts", "p.txt", "--only")
    assert run(*command, 3) == 0
    assert "home 3 can be made" in capsys.readouterr().out
    assert run(*command, 4) == 3
    assert run(*command, 5) == 1
    assert "ZeroDivisionError" in capsys.readouterr().err
    assert not list(tmp_path.rglob("shard-*"))


def test_machines_get_json_and_the_quiet_nothing(factory, tmp_path, capsys):
    (tmp_path / "p.txt").write_text(HARD)
    assert run("shard", "--count", 6, "--out", "d", "--seed", 3, "--prompts", "p.txt", "--json") == 1
    said = capsys.readouterr()
    assert all(json.loads(line)["event"] for line in said.err.splitlines())
    told = json.loads(said.out)
    assert (told["homes"], told["made"], told["empty"]) == (2, 2, {"refused": 2, "internal": 2})
    assert run("verify", "d", "--quick", "--json") == 0
    assert json.loads(capsys.readouterr().out)["empty"] == 4
    assert run("shard", "--count", 4, "--out", "e", "--quiet") == 0
    assert capsys.readouterr().err == ""
    assert run("generate", "a studio", "--out", "home", "--json") == 0
    said = capsys.readouterr()
    assert json.loads(said.out)["scene_id"] == "s0_00000000"
    assert json.loads(said.err.splitlines()[0])["text"] == "reading the layout model and the library"


def test_a_full_disk_is_one_line_and_nothing_half_written_stays(factory, capsys, monkeypatch):
    """Every write fails from the sixth home on, as on a disk that is full."""
    from pipeline.shards import parts

    real, count = parts.write_bytes, iter(range(100))

    def full(path, data, **how):
        if next(count) >= 5:
            raise OSError(28, "No space left on device", str(path))
        real(path, data, **how)

    monkeypatch.setattr(parts, "write_bytes", full)
    assert run("shard", "--count", 8, "--out", "d", "--seed", 3) == 1
    err = capsys.readouterr().err.splitlines()
    assert err[-1].startswith("sfgen: No space left on device: ")
    assert [line for line in err if line.startswith("sfgen: ")] == err[-1:]
    assert not Path("d/.staging").exists()
    monkeypatch.setattr(parts, "write_bytes", real)
    assert run("shard", "--count", 8, "--out", "d", "--seed", 3) == 0
    assert [i for i, _ in factory.asked] == [0, 1, 2, 3, 4, 5, 6, 7, 5, 6, 7]


def test_another_dataset_stays_as_it_is(factory, capsys):
    assert run("shard", "--count", 4, "--out", "d", "--seed", 3) == 0
    before = made.snapshot("d")
    assert run("shard", "--count", 4, "--out", "d", "--seed", 4) == 2
    assert "seed 3, not 4" in capsys.readouterr().err
    factory.digests = {"weights": "other"}
    assert run("shard", "--count", 4, "--out", "d", "--seed", 3) == 2
    assert run("generate", "a studio", "--out", "d") == 2
    assert made.snapshot("d") == before


def test_generate_makes_a_dataset_of_one_with_what_it_uses(factory, capsys):
    assert run("generate", " a studio ", "--out", "home", "--seed", 7) == 0
    assert factory.asked == [(0, "a studio")]
    assert sorted(p.name for p in Path("home/assets").iterdir()) == ["asset_0", "assets.parquet"]
    assert [h.scene_id for h in sfgen.load("home")] == ["s7_00000000"]
    said = capsys.readouterr()
    assert "home/usd/shard-00000/s7_00000000.usdc" in said.out
    assert "studio_room" not in said.err  # it was asked for
    assert "bath (bathroom)" in said.err  # that was assumed
    assert run("verify", "--quick", "home") == 0
    assert run("generate", "a studio", "--out", "home", "--seed", 7) == 0
    assert run("generate", "a two-bedroom apartment", "--out", "home", "--seed", 7) == 2


@pytest.mark.parametrize(("prompt", "code"), [("", 2), ("  ", 2), ("x" * 1_000_000, 2), ("sing me a song", 3)])
def test_generate_refuses_in_one_line(factory, tmp_path, capsys, prompt, code):
    assert run("generate", prompt) == code
    err = capsys.readouterr().err
    assert err.startswith("sfgen: ")
    assert err.count("\n") == 1
    assert len(err) < 400
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("command", [("shard", "--count", "2"), ("generate", "a studio")])
def test_without_weights_make_run_is_named(monkeypatch, tmp_path, capsys, command):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "params.yaml").write_text("preset: a\npresets: {a: {}}\n")
    monkeypatch.setattr(cli, "ROOT", tmp_path)
    monkeypatch.setattr(cli, "is_checkout", lambda: True)
    assert run(*command) == ContentError.exit_code
    assert "make run" in capsys.readouterr().err


def test_repair_makes_again_what_is_broken_or_gone_byte_for_byte(factory, capsys):
    """One file of every kind, with a bit of its middle flipped, or gone: the header, seal and commits, tables, stages, previews, the library."""
    assert run("shard", "--count", 10, "--out", "d", "--seed", 3) == 0
    whole = made.snapshot("d")
    kinds = {(name.split("/")[0], Path(name).suffix, name.startswith("commits/shard")): name for name in sorted(whole)}
    kinds["seal"], kinds["library"] = "commits/dataset.json", "commits/assets.json"
    for name in sorted(set(kinds.values())):
        for flipped in (True, False):
            data = whole[name]
            Path("d", name).unlink()  # the library's files have another name, in the cache
            if flipped:
                middle = len(data) // 2
                Path("d", name).write_bytes(data[:middle] + bytes([data[middle] ^ 1]) + data[middle + 1 :])
            assert run("verify", "--quick", "d") == 1, name
            assert run("repair", "d") == 0, (name, capsys.readouterr().err)
            assert made.snapshot("d") == whole, name
    assert len(set(kinds.values())) >= 12
    assert run("verify", "--quick", "d") == 0


def test_the_size_of_previews_is_told_by_the_header_and_kept(factory, capsys):
    command = ("shard", "--count", 4, "--out", "d", "--seed", 3)
    assert run(*command, "--preview", 0) == 0
    whole = made.snapshot("d")
    assert json.loads(Path("d/dataset.json").read_text())["preview"] == 0
    factory.shard.preview = 768  # another process
    assert run(*command) == 2
    assert "preview 0, not 768" in capsys.readouterr().err
    for broken in ("objects/shard-00000.parquet", "dataset.json"):
        Path("d", broken).unlink()
        factory.shard.preview = 768
        assert run("repair", "d") == 0
        assert (factory.shard.preview, made.snapshot("d")) == (0, whole)


def test_repair_refuses_what_was_made_otherwise_and_leaves_it_alone(factory, tmp_path, capsys):
    (tmp_path / "p.txt").write_text("a studio\n")
    assert run("shard", "--count", 2, "--out", "d", "--seed", 3, "--prompts", "p.txt") == 0
    Path("d/objects/shard-00000.parquet").unlink()
    before = made.snapshot("d")
    assert run("repair", "d") == 2
    assert "prompts" in capsys.readouterr().err
    factory.digests = {"weights": "others"}
    assert run("repair", "d", "--prompts", "p.txt") == 2
    assert "weights" in capsys.readouterr().err
    assert made.snapshot("d") == before
    factory.digests = {"weights": "w"}
    assert run("repair", "d", "--prompts", "p.txt") == 0
    assert run("verify", "--quick", "d") == 0
