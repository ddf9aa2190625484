"""Docs that can fail: commands, targets, columns and files that they name exist, and what exists is named."""

import re
import sys
from pathlib import Path

import pytest
import typer.main

from pipeline.manifest import sha256_file
from sfgen import cli

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / ".ci"))
import reference  # noqa: E402

PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
COMMANDS = {c.callback.__name__: c for c in cli.app.registered_commands}
TARGETS = set(re.findall(r"(?m)^([a-z]+):.*## ", (ROOT / "Makefile").read_text()))


def options(command):
    return {opt for p in typer.main.get_command(cli.app).commands[command].params for opt in p.opts if opt.startswith("--")}


def code(page):
    """The lines of a page's code blocks, and its spans of code."""
    text = page.read_text(encoding="utf-8")
    blocks = re.findall(r"(?s)```\w*\n(.*?)```", text)
    return [line for block in blocks for line in block.splitlines()] + re.findall(r"`([^`\n]+)`", re.sub(r"(?s)```.*?```", "", text))


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_commands_on_the_page_exist(page):
    for line in code(page):
        if found := re.match(r"(?:\S+/)?sfgen ([a-z]+)(.*)", line.strip()):
            command, rest = found.groups()
            assert command in COMMANDS, line
            given = set(re.findall(r"(?<=\s)(--[a-z]+)", re.sub(r'"[^"]*"|#.*', "", rest)))
            assert given <= options(command) | {"--help"}, line
        for target in re.findall(r"(?:^|\s|`)make ([a-z]+)", line):
            assert target in TARGETS, line


def test_every_command_and_option_is_documented():
    text = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    for command in COMMANDS:
        assert f"## sfgen {command}" in text
        for option in options(command) - {"--help"}:
            assert option in text, f"{command} {option}"
    assert all(f"`{target}`" in text for target in TARGETS - {"help"})


def test_readme_names_every_command_and_the_main_targets():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert all(f"sfgen {command}" in text for command in COMMANDS)
    assert all(f"make {target}" in text for target in ("run", "test", "check"))


def test_the_weights_are_those_of_their_card():
    text = (ROOT / "weights" / "README.md").read_text(encoding="utf-8")
    told = {
        name: (int(size.replace(",", "")), sha)
        for name, size, sha in re.findall(r"(?m)^\| `(\S+)` \|.*\| ([\d,]+) \| `(\w{64})` \|$", text)
    }
    files = [path for path in (ROOT / "weights").iterdir() if path != ROOT / "weights" / "README.md"]
    assert told == {path.name: (path.stat().st_size, sha256_file(path)) for path in files}


def test_columns_are_those_of_the_schemas():
    text = reference.PAGE.read_text(encoding="utf-8")
    assert reference.page(text) == text, "run `python .ci/reference.py`"


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\((?!https?:)([^)#]+)", page.read_text(encoding="utf-8")):
        assert (page.parent / target).exists(), target


def test_files_that_contributors_are_sent_to_exist():
    named = [span for span in code(ROOT / "CONTRIBUTING.md") if re.fullmatch(r"[\w./]+/[\w.]+\.(py|yaml|md)", span)]
    places = (ROOT, ROOT / "pipeline" / "sources")
    assert len(named) > 10
    assert [span for span in named if not any((place / span).exists() for place in places)] == []


def test_changelog_has_the_version():
    from sfgen import __version__

    assert f'version = "{__version__}"' in (ROOT / "pyproject.toml").read_text()
    assert "## [Unreleased]" in (ROOT / "CHANGELOG.md").read_text()


def test_make_help_lists_every_target():
    import subprocess

    said = subprocess.run(["make", "help"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    assert all(f"make {target}" in said for target in TARGETS)
    assert all(name in said for name in ("PRESET=", "TORCH_INDEX=", "PYTHON="))
