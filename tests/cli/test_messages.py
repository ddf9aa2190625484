"""The command line: fast, and whatever goes wrong is one line that names the thing and the remedy, with its exit code."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from pipeline.errors import ContentError, RefusedError, UsageError
from sfgen import cli

ROOT = Path(__file__).parents[2]
COMMANDS = ("generate", "shard", "plan", "peers", "export", "repair", "verify", "doctor")


@pytest.fixture
def sfgen(capsys, monkeypatch, tmp_path):
    """Run one command line in an empty folder; returns (exit code, stdout, stderr)."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("SFGEN_DEBUG", raising=False)

    def run(*arguments):
        code = cli.run([str(a) for a in arguments])
        said = capsys.readouterr()
        return code, said.out, said.err

    return run


def one_line(err):
    return err.startswith("sfgen: ") and err.count("\n") == 1 and ";" in err and "Traceback" not in err and len(err) < 500


def test_help_imports_nothing_heavy():
    program = "import sys\nfrom sfgen.cli import run\nassert run(['--help']) == 0\nassert not {'numpy', 'pyarrow', 'torch', 'rich', 'dask', 'pipeline'} & sys.modules.keys()"
    subprocess.run([sys.executable, "-c", program], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_with_an_example(sfgen, command):
    code, out, err = sfgen(command, "--help")
    assert (code, err) == (0, "")
    example = re.search(rf"Example:\n +(sfgen {command}.*)", out)
    assert example


def test_commands_are_those_that_are_tested():
    assert {c.callback.__name__ for c in cli.app.registered_commands} == set(COMMANDS)


def test_version(sfgen):
    assert sfgen("--version")[:2] == (0, "0.1.0\n")


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["shar"], "shar"),
        (["shard"], "--count"),
        (["shard", "--count", "0"], "--count"),
        (["shard", "--count", "-5"], "--count"),
        (["shard", "--count", "many"], "--count"),
        (["shard", "--count", "5", "--workers", "0"], "--workers"),
        (["shard", "--count", "5", "--seed", "-1"], "--seed"),
        (["shard", "--count", "5", "--colour", "red"], "--colour"),
        (["shard", "5"], "--count"),
        (["generate"], "prompt"),
        (["export", "d", "--to", "obj", "--out", "x"], "obj"),
        (["export", "d", "--to", "glb"], "--out"),
        (["verify"], "DATASET"),
        (["verify", "nowhere"], "nowhere is missing"),
        (["verify", __file__], "not a folder"),
        (["plan"], "prompt"),
    ],
)
def test_a_wrong_command_line_is_2(sfgen, arguments, word):
    code, out, err = sfgen(*arguments)
    assert (code, out) == (2, "")
    assert one_line(err), err
    assert word in err


def test_no_command_shows_the_commands(sfgen):
    code, _out, err = sfgen()
    assert code == 2
    assert all(command in err for command in COMMANDS)


def test_wrong_content_is_1(sfgen, dataset_folder, tmp_path):
    folder = shutil.copytree(dataset_folder, tmp_path / "copy")
    (folder / "rooms" / "shard-00001.parquet").write_bytes(b"PAR1")
    code, _, err = sfgen("verify", folder)
    assert code == 1
    assert one_line(err)
    assert "rooms/shard-00001.parquet" in err
    (folder / "dataset.json").write_text("{")
    assert sfgen("verify", folder)[0] == 1


def test_export_names_what_is_not_there(sfgen, furnished, tmp_path):
    code, _, err = sfgen("export", "nowhere", "--to", "glb", "--out", "x")
    assert code == 1
    assert one_line(err)
    assert "nowhere holds no dataset" in err
    code, _, err = sfgen("export", furnished, "--to", "glb", "--out", "x", "--home", "s0_00000009")
    assert code == 2
    assert one_line(err)
    assert "s0_00000009" in err
    assert "s0_00000000" in err
    (tmp_path / "x").mkdir()
    (tmp_path / "x" / "mine.txt").write_text("")
    code, _, err = sfgen("export", furnished, "--to", "glb", "--out", "x")
    assert code == 2
    assert one_line(err)
    assert list((tmp_path / "x").iterdir()) == [tmp_path / "x" / "mine.txt"]


def test_export_writes_what_was_asked_for(sfgen, furnished, tmp_path):
    code, out, err = sfgen("export", furnished, "--to", "glb", "--out", "x", "--home", "s0_00000000")
    assert (code, err) == (0, "")
    assert "x/homes/s0_00000000.glb" in out
    assert {p.name for p in (tmp_path / "x").rglob("*") if p.is_file()} == {"export.json", "s0_00000000.glb"}


def test_verify_counts(sfgen, dataset_folder):
    code, out, err = sfgen("verify", "--quick", dataset_folder)
    assert (code, err) == (0, "")
    assert "10 homes in 3 shards" in out


def test_verify_opens_the_stages(sfgen, dataset_folder):
    """The made-up stages are no USD: without --quick, the first is named."""
    code, _, err = sfgen("verify", dataset_folder)
    assert code == 1
    assert "s5_00000000.usdc" in err


@pytest.mark.parametrize(
    ("error", "code", "text"),
    [
        (ContentError("a.json is cut", "copy it again"), 1, "a.json is cut; copy it again"),
        (UsageError("no such path"), 2, "no such path"),
        (RefusedError("two lines\nof text", "ask for less"), 3, "two lines of text; ask for less"),
        (KeyboardInterrupt(), 130, ""),
        (ModuleNotFoundError("No module named 'trimesh'", name="trimesh"), 1, "the package trimesh is not installed; type `make run`"),
        (OSError(28, "No space left on device", "/data/x"), 1, "No space left on device: /data/x"),
        (MemoryError(), 1, "out of memory"),
        (ZeroDivisionError("division by zero"), 1, "unexpected ZeroDivisionError: division by zero; SFGEN_DEBUG=1"),
    ],
)
def test_every_failure_is_one_line_with_its_code(sfgen, monkeypatch, error, code, text):
    class Failing:
        @staticmethod
        def main(*_args, **_options):
            raise error

    monkeypatch.setattr(cli, "stage", lambda _name: Failing)
    got, out, err = sfgen("doctor")
    assert (got, out) == (code, "")
    assert err.startswith(f"sfgen: {text}") if text else err == ""
    assert err.count("\n") <= 1


def test_a_traceback_is_there_for_who_asks(sfgen, monkeypatch):
    monkeypatch.setattr(cli, "stage", lambda _name: None)
    monkeypatch.setenv("SFGEN_DEBUG", "1")
    with pytest.raises(AttributeError):
        sfgen("doctor")


def test_doctor_says_what_is_there(sfgen):
    code, out, err = sfgen("doctor")
    assert (code, err) == (0, "")
    assert re.search(r"\+ Python 3\.\d+", out)
    assert re.search(r"\+ torch \d", out)
    assert "layout model" in out


def test_stages_explain_their_errors_too(tmp_path):
    program = "from pipeline.entry import run\nfrom pipeline.errors import RefusedError\ndef main(root):\n    raise RefusedError('a\\nb', 'c')\nrun(main)"
    answer = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False)
    assert (answer.returncode, answer.stdout, answer.stderr) == (3, "", "sfgen: a b; c\n")


def test_without_the_factory_loaders_work_and_commands_say_how_to_get_it(tmp_path, dataset_folder):
    shutil.copytree(ROOT / "sfgen", tmp_path / "site" / "sfgen", ignore=shutil.ignore_patterns("__pycache__"))
    program = "import sys, sfgen.cli, sfgen\nassert len(sfgen.load(sys.argv[1])) == 10\nsys.exit(sfgen.cli.run(['doctor']))"
    answer = subprocess.run(
        [sys.executable, "-P", "-c", program, str(dataset_folder)],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path / "site")},
        capture_output=True,
        text=True,
        check=False,
    )
    assert answer.returncode == 1, answer.stderr
    assert one_line(answer.stderr)
    assert "make run" in answer.stderr


def test_a_reader_that_leaves_is_no_error(dataset_folder):
    command = f"{sys.executable} -m sfgen.cli doctor | true"
    answer = subprocess.run(["bash", "-c", f"{command}; exit ${{PIPESTATUS[0]}}"], cwd=ROOT, capture_output=True, text=True, check=False)
    assert answer.stderr == ""


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["plan", "a flat", "--from", "x.json"], "PROMPT and --from are given"),
        (["plan", "--prompts", "x.txt"], "--score"),
        (["plan", "--score"], "no prompt"),
        (["plan", "--from", "nowhere.json"], "nowhere.json is missing"),
        (["plan", "--prompts", "nowhere.txt", "--score"], "nowhere.txt is missing"),
        (["plan", "--from", __file__, "--house", "3"], "--house"),
    ],
)
def test_ways_to_plan_exclude_each_other(sfgen, arguments, word):
    code, out, err = sfgen(*arguments)
    assert (code, out) == (2, "")
    assert one_line(err), err
    assert word in err


def test_a_plan_of_ones_own(sfgen, tmp_path):
    room = {"type": "studio_room", "polygon": [[0, 0], [5, 0], [5, 6], [0, 6]]}
    (tmp_path / "plan.json").write_text(json.dumps({"rooms": [room]}))
    code, out, err = sfgen("plan", "--from", "plan.json", "--json", "-")
    assert (code, err) == (0, "")
    assert [r["code"] for r in json.loads(out)["repairs"]] == ["entrance"]
    code, out, err = sfgen("plan", "--from", "plan.json")
    assert "repaired: studio_room: no door leads outside" in out
    room["polygon"] = [[0, 0], [5, 6], [5, 0], [0, 6]]
    (tmp_path / "plan.json").write_text(json.dumps({"rooms": [room]}))
    code, out, err = sfgen("plan", "--from", "plan.json", "--json", "-")
    assert code == 3
    assert one_line(err)
    assert json.loads(out)["refused"]["code"] == "own_plan"
    (tmp_path / "plan.json").write_text('{"rooms": [')
    code, _, err = sfgen("plan", "--from", "plan.json")
    assert code == 1
    assert one_line(err)


def test_prompts_are_scored(sfgen, tmp_path):
    (tmp_path / "p.txt").write_text("# two\na studio with a bathroom\n12 rooms in 20 m2\n")
    code, out, err = sfgen("plan", "--prompts", "p.txt", "--score", "--seeds", "2", "--json", "-")
    assert code == 0
    assert [
        line for line in err.splitlines() if not line.startswith("sfgen: compiling")
    ] == []  # which it says where it is the first to plan
    found = json.loads(out)
    assert (found["plans"], found["failures"]) == (4, 2)
    assert "node" not in found["mean"]
    assert found["prompts"][0]["mean"]["seconds"] > 0
    code, out, _ = sfgen("plan", "--prompts", "p.txt", "--score", "--seeds", "1")
    assert code == 0
    assert "seconds" in out


def test_what_was_assumed_and_what_was_not_understood_is_told_beside_a_file_too(sfgen):
    code, out, err = sfgen("plan", "one bedroom, sauna", "--json", "-")
    assert code == 0
    document = json.loads(out)
    assert [each["text"] for each in document["assumed"]]
    assert "living_room" in err
    assert "not built here: sauna" in err


def test_the_schema_is_printed(sfgen):
    code, out, _ = sfgen("plan", "--schema")
    assert code == 0
    assert "FloorProgram" in json.loads(out)["$defs"]
