"""Prompts of a file: what is read, and what is measured."""

import json
from pathlib import Path

import numpy as np
import pytest
import yaml

from pipeline.errors import ContentError, UsageError
from pipeline.experiments.prompts import CHECKED, SCORES, evaluate_prompts, read_prompts, report
from pipeline.floorplan import parse, solve
from pipeline.metrics.plan_checks import CHECKS, MEASURES
from pipeline.metrics.plan_scores import score

CASE = {
    "id": "flat",
    "prompt": "a flat with a living room, a kitchen next to it, a bedroom and a bathroom",
    "graph": {
        "rooms": [
            {"id": "l", "type": "living_room", "area": 22},
            {"id": "k", "type": "kitchen", "area": 11},
            {"id": "b", "type": "bedroom", "area": 12},
            {"id": "w", "type": "bathroom", "area": 5.5},
        ],
        "edges": [{"a": "l", "b": "k"}, {"a": "l", "b": "b"}, {"a": "l", "b": "w", "optional": True}],
    },
    "checks": {"presence": {"living_room": 1, "kitchen": 1}, "adjacency": [{"a": "kitchen", "b": "living_room"}]},
}


def write(tmp_path, value, name="cases.yaml"):
    path = tmp_path / name
    path.write_text(value if isinstance(value, str) else yaml.safe_dump(value))
    return path


def test_scores_means_and_spread(tmp_path):
    cases = read_prompts(write(tmp_path, [CASE, "a studio with a bathroom", {"prompt": "12 rooms in 20 m2", "graph": CASE["graph"]}]))
    found = evaluate_prompts(cases, 2)
    flat, studio, refused = found["prompts"]
    assert flat["mean"]["node"] == flat["mean"]["presence"] == 1.0
    assert not studio["scored"]
    assert refused["mean"]["node"] == 0.0
    assert refused["runs"][0]["refused"]
    for name in SCORES:
        runs = [[row["runs"][s][name] for row in (flat, refused)] for s in range(2)]
        assert found["mean"][name] == pytest.approx(np.mean(runs), abs=1e-4)
        assert found["spread"][name] == pytest.approx(np.std(np.mean(runs, axis=1)), abs=1e-4)
    assert (found["failures"], found["plans"]) == (2, 6)
    text = report(found)
    assert "strict success" in text
    assert "refused: entry 3" in text


@pytest.mark.parametrize(
    "value",
    [
        "a: {",
        {"prompt": "x"},
        [{"id": "x"}],
        [{"prompt": 3}],
        [{"prompt": "a studio", "graph": {"rooms": []}}],
        [{"prompt": "a studio", "graph": {"rooms": [{"id": "a", "type": "bedroom", "area": -1}]}}],
        [{"prompt": "a studio", "graph": {"rooms": [{"id": "a", "type": "bedroom", "area": 9}], "edges": [{"a": "a", "b": "z"}]}}],
        [{"prompt": "a studio", "checks": {"constraints": [{"type": "beauty"}]}}],
    ],
)
def test_wrong_files_are_named(tmp_path, value):
    with pytest.raises(ContentError, match=r"cases\.yaml"):
        read_prompts(write(tmp_path, value))


def test_files_without_a_prompt(tmp_path):
    with pytest.raises(UsageError):
        read_prompts(write(tmp_path, "# nothing\n", "p.txt"))
    with pytest.raises(UsageError):
        read_prompts(tmp_path)
    with pytest.raises(UsageError, match="empty"):
        read_prompts(write(tmp_path, [{"prompt": "  "}]))


def test_forms_of_a_file_mean_the_same(tmp_path):
    cases = [CASE, "ein Studio mit Balkon", {"prompt": "两室一厅", "id": 7}, {"prompt": "un estudio con terraza"}]
    listed = read_prompts(write(tmp_path, cases))
    assert [c["id"] for c in listed] == ["flat", "entry 2", "7", "entry 4"]
    assert read_prompts(write(tmp_path, json.dumps(cases), "a.json")) == listed
    lines = "\n\n".join(json.dumps(c) for c in cases)
    assert [c["prompt"] for c in read_prompts(write(tmp_path, lines, "a.jsonl"))] == [c["prompt"] for c in listed]
    plain = "\ufeff# four\n" + "\n".join(c["prompt"] for c in listed)
    assert [c["prompt"] for c in read_prompts(write(tmp_path, plain, "a.txt"))] == [c["prompt"] for c in listed]
    found = evaluate_prompts(listed, 1)
    assert found["failures"] == 0
    assert found["prompts"][0]["mean"]["node"] == 1.0


def test_a_case_without_a_graph_is_scored_on_its_checks(tmp_path):
    checks = {"presence": {"bedroom": 2}, "absent": ["balcony"], "constraints": [{"type": "room_area", "room": "bedroom", "min": 90}]}
    (case,) = read_prompts(write(tmp_path, [{"prompt": "a two-bedroom flat without a balcony", "checks": checks}]))
    mean = evaluate_prompts([case], 1)["prompts"][0]["mean"]
    assert set(CHECKED) <= set(mean)
    assert (mean["presence"], mean["constraints"], mean["strict"]) == (1.0, 0.0, 0.0)
    assert "node" not in mean


def test_names_of_rooms_mean_nothing(tmp_path):
    """Ids that are numbers, or words of another language, give the scores that the usual ones give."""
    names = {"l": 1, "k": 2, "b": "卧室", "w": "kitchen bath #3"}
    graph = {
        "rooms": [{**r, "id": names[r["id"]]} for r in CASE["graph"]["rooms"]],
        "edges": [{**e, "a": names[e["a"]], "b": names[e["b"]]} for e in CASE["graph"]["edges"]],
    }
    checks = {
        "adjacency": [{"a": 2, "b": 1}],
        "constraints": [{"type": "degree", "room": "卧室", "equals": 1}, {"type": "level", "room": 1, "equals": 0}],
    }
    found = evaluate_prompts(read_prompts(write(tmp_path, [{**CASE, "graph": graph, "checks": checks}])), 2)
    for name in ("node", "edge", "adjacency", "constraints", "strict"):
        assert found["mean"][name] == 1.0


def test_an_id_that_is_the_name_of_a_type_is_that_room():
    plan = solve(parse("a flat with a living room, a kitchen and two bedrooms, each off the living room, and a bathroom"), 0)
    rooms = [
        {"id": r.type if r.room_id != "bed_2" else "second", "type": r.type, "area": r.area} for r in plan.rooms if r.type != "hallway"
    ]
    case = {"graph": {"rooms": rooms, "edges": []}, "checks": {"adjacency": [{"a": "bedroom", "b": "living_room", "quant": "each"}]}}
    assert score(plan, case).adjacency == 1.0


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("a.json", "{}"),
        ("a.json", "[1]"),
        ("a.jsonl", '{"prompt": "a studio"}\n{"prompt": '),
        ("a.json", "[" * 100_000),
        ("a.yaml", [{**CASE, "graph": {**CASE["graph"], "rooms": [*CASE["graph"]["rooms"], CASE["graph"]["rooms"][0]]}}]),
        ("a.yaml", [{"prompt": "a studio", "graph": {"rooms": [{"id": "a", "type": "studio_room"}]}}]),
        ("a.yaml", [{"prompt": "a studio", "checks": {"constraints": [{"type": "room_area", "min": 3}]}}]),
        ("a.yaml", [{"prompt": "a studio", "checks": {"constraints": [{"type": "total_area", "min": "big"}]}}]),
        ("a.yaml", [{"prompt": "a studio", "checks": {"constraints": [{"type": "zone_split", "zones": ["a"]}]}}]),
        ("a.yaml", [{"prompt": "a studio", "checks": {"presence": {"bedroom": "two"}}}]),
        ("a.yaml", "- prompt: a studio\n  graph: 2001-99-99"),
    ],
)
def test_what_is_wrong_is_named(tmp_path, name, value):
    with pytest.raises(ContentError, match=r"a\.(json|yaml)"):
        read_prompts(write(tmp_path, value, name))


@pytest.mark.parametrize("name", ["a.txt", "a.yaml", "a.json", "a.jsonl"])
def test_an_empty_file_holds_no_prompt(tmp_path, name):
    with pytest.raises(UsageError, match="no prompt"):
        read_prompts(write(tmp_path, "\n", name))


@pytest.mark.parametrize("kind", sorted(CHECKS))
def test_no_check_crashes_on_rooms_that_are_not_there(kind):
    plan = solve(parse("a studio"), 0)
    values = dict.fromkeys(MEASURES, 1.0) | {"zones": {"a": ["x"], "b": ["y"]}, "rooms": ["x"], "avoid": ["x"], "tol": 0}
    names = dict.fromkeys(("room", "larger", "smaller", "among", "a", "b", "bath", "bedroom", "target", "mid"), "x")
    case = {
        "graph": {"rooms": [{"id": "s", "type": "studio_room", "area": 20.0}], "edges": []},
        "checks": {"constraints": [{"type": kind, **values, **names}]},
    }
    assert 0.0 <= score(plan, case).constraints <= 1.0


def test_the_plans_of_the_benchmark_meet_every_check():
    found = evaluate_prompts(read_prompts(Path(__file__).parents[2] / "manifests" / "prompts" / "benchmark.yaml"), 1)
    assert {row["id"]: row["mean"]["strict"] for row in found["prompts"] if row["mean"]["strict"] < 1.0} == {}
    assert found["mean"]["constraint"] >= 0.945
