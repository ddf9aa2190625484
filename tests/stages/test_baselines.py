import json

from pipeline.relations import learning
from pipeline.relations.arrangement import rooms_of
from stages import baselines
from tests.stages.test_train import make_root

SMALL = (
    "seconds: 0.2, width: 16, layers: 1, heads: 2, points: 8, batch: 4, steps: 6, rooms: 3, count_rooms: 2, counts: [3, 5], sample_batch: 2"
)


def write_params(root, *, on):
    switch = "true" if on else "false"
    ours = "model: {width: 16, passes: 2, layers: 1, heads: 2, relation: 4}, inventory: {width: 8, steps: 2}, objects: 16"
    text = f"seed: 0\ntrain: {{{ours}}}\nsample: {{evaluations: 2}}\nbaselines: {{{SMALL}}}\nmetrics: {{baselines: {switch}, split: val}}\npresets: {{quick: {{}}}}\n"
    (root / "params.yaml").write_text(text)


def test_switched_off_it_does_nothing(tmp_path):
    write_params(tmp_path, on=False)
    baselines.main(tmp_path)
    assert json.loads((tmp_path / "metrics/baselines.json").read_text()) == {}
    assert list((tmp_path / "models/baselines").iterdir()) == []


def test_all_are_trained_for_the_same_time_and_furnish_the_same_rooms(tmp_path):
    make_root(tmp_path)
    learning.fit(rooms_of(tmp_path / "data/tables", "train")).save(tmp_path / "data/tables/relations.json")
    write_params(tmp_path, on=True)
    baselines.main(tmp_path)
    found = json.loads((tmp_path / "metrics/baselines.json").read_text())
    assert set(found["models"]) == {"real", "atiss", "diffuscene", "physcene", "scenefoundry", "ours", "ours_guided"}
    assert {row["rooms"] for row in found["models"].values()} == {3}
    assert found["models"]["real"]["objects"]["mean"] == 2
    assert found["models"]["real"]["ckl"]["real_to_generated"] == 0
    assert {name: set(made) for name, made in found["quantity"].items()} == {name: {"3", "5"} for name in ("scenefoundry", "ours")}
    assert [made["rate"] for made in found["quantity"]["ours"].values()] == [1.0, 1.0]
    assert found["models"]["real"]["relations"]["nightstand at the bed"]["n"] == 3
    assert 0 <= found["models"]["atiss"]["sca"]["rate"] <= 1
    assert all(0.2 <= row["cpu_seconds"] < 2 for name, row in found["trained"].items() if name != "ours")
    assert found["trained"]["ours"]["steps"] >= 12
    assert [p.name for p in (tmp_path / "models/baselines").iterdir()] == ["ours.safetensors"]
