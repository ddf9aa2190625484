"""Prompts of a file: what is read, and what is measured."""

import numpy as np
import pytest
import yaml

from pipeline.errors import ContentError, UsageError
from pipeline.experiments.prompts import SCORES, measured, read_prompts, report

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
    found = measured(cases, 2)
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
