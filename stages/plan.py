"""`sfgen plan`: words, or a plan of the user's own → floor plan; drawn in the terminal, or written as JSON, SVG or PNG."""

import json
import sys
from pathlib import Path

from pipeline.entry import announce_compiling
from pipeline.errors import RefusedError, UsageError
from pipeline.experiments.prompts import evaluate_prompts, read_prompts, report
from pipeline.floorplan import plan_json, refusal_json, request, solve, warm
from pipeline.floorplan.document import document_schema
from pipeline.floorplan.draw.characters import terminal
from pipeline.floorplan.draw.drawing import png, svg
from pipeline.floorplan.imports import describe_repairs, program_of, read_own
from pipeline.floorplan.program.description import assumptions, notes
from pipeline.homes.empty_plan import require_sound
from pipeline.manifest import write_bytes, write_json

STDOUT = "-"


def main(
    root: Path,
    *,
    prompt: str = "",
    seed: int = 0,
    source: Path | None = None,
    house: str | None = None,
    json_path: Path | None = None,
    svg_path: Path | None = None,
    png_path: Path | None = None,
    strict: bool = False,
) -> None:
    """Plan the prompt, or read the plan in `source`, and show it. A refusal is written to the JSON file too, then raised."""
    targets = (json_path, svg_path, png_path)
    for path in targets:
        _check_target(path)
    if [str(path) for path in targets].count(STDOUT) > 1:
        raise UsageError("two things are to be written to the terminal", f"give {STDOUT} once, and names of files for the rest")
    repairs: list[dict[str, str]] = []
    assumed: list[dict[str, str]] = []
    try:
        if source is None:
            program = request(prompt, strict=strict)
            announce_compiling()
            plan, assumed = solve(program, seed), assumptions(program)
        else:
            own = require_sound(root, read_own(source, house))
            program, plan, repairs = program_of(own.plan), own.plan, own.repairs_json()
    except RefusedError as error:
        _write_json(json_path, refusal_json(error))
        raise
    _write_json(json_path, plan_json(plan, program, repairs, assumed))
    if svg_path is not None:
        _write(svg_path, svg(plan).encode())
    if png_path is not None:
        _write(png_path, png(plan))
    if json_path is None and svg_path is None and png_path is None:
        sys.stdout.write(terminal(plan) + notes(program, assumed))
    else:
        sys.stderr.write(notes(program, assumed))
    if STDOUT not in {str(path) for path in targets}:
        sys.stdout.write(describe_repairs(repairs))


def schema(_root: Path) -> None:
    """Write the JSON Schema of the plan document, which holds that of the program."""
    sys.stdout.write(json.dumps(document_schema(), indent=2) + "\n")


def score(_root: Path, *, prompts: Path, seeds: int = 5, json_path: Path | None = None) -> None:
    """Plan every prompt of a file with several seeds; print scores where there is ground truth, failures and seconds everywhere."""
    _check_target(json_path)
    cases = read_prompts(prompts)
    announce_compiling()
    warm()  # no prompt pays for what is compiled once
    figures = evaluate_prompts(cases, seeds)
    _write_json(json_path, figures)
    if str(json_path) != STDOUT:
        sys.stdout.write(report(figures))


def _check_target(path: Path | None) -> None:
    if path is None or str(path) == STDOUT:
        return
    if path.is_dir():
        raise UsageError(f"{path} is a folder", "name a file")
    if not path.absolute().parent.is_dir():
        raise UsageError(f"the folder {path.parent} does not exist", "make it first")


def _write(path: Path, data: bytes) -> None:
    if str(path) == STDOUT:
        sys.stdout.flush()
        sys.stdout.buffer.write(data)
    else:
        write_bytes(path, data)


def _write_json(path: Path | None, document: object) -> None:
    if path is None:
        return
    if str(path) == STDOUT:
        sys.stdout.write(json.dumps(document, indent=2, ensure_ascii=False) + "\n")
    else:
        write_json(path, document)
