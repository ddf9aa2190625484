"""The plan as JSON and back, its drawings, and what `sfgen plan` does."""

import json
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from pipeline.errors import ContentError, RefusedError, UsageError
from pipeline.floorplan import parse, plan_from_json, plan_json, prior, refusal_json, solve
from pipeline.floorplan.document import PlanDocument
from pipeline.floorplan.draw.characters import terminal
from pipeline.floorplan.draw.drawing import image, svg
from pipeline.floorplan.program.floor_program import FloorProgram
from stages.plan import main


@pytest.fixture(scope="module")
def made():
    program = parse("a two-bedroom flat with a balcony")
    return program, solve(program, 0)


def test_round_trip(made):
    program, plan = made
    text = json.dumps(plan_json(plan, program))
    again = plan_from_json(json.loads(text))
    assert json.dumps(plan_json(again, program)) == text
    for a, b in zip(plan.rooms, again.rooms, strict=True):
        np.testing.assert_array_equal(a.polygon, b.polygon)
    assert FloorProgram.model_validate(json.loads(text)["program"]) == program


def test_what_the_document_says(made):
    document = plan_json(made[1], made[0])
    assert document["refused"] is None
    for row in document["rooms"]:
        points = np.array(row["polygon"])
        x, y = points.T
        assert row["area"] == pytest.approx(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y), abs=1e-3)
        np.testing.assert_allclose(points, np.round(points, 3))
    for row in document["openings"]:
        p, q = np.array(row["segment"])
        assert row["width"] == pytest.approx(np.linalg.norm(q - p), abs=1e-3)
        assert (row["swing"] is not None) or row["kind"] != "entrance"


@pytest.mark.parametrize(
    "change",
    [
        lambda d: d.pop("rooms"),
        lambda d: d.update(version=99),
        lambda d: d.update(entrance="nowhere"),
        lambda d: d["rooms"][0].update(polygon=[[0, 0], [1, float("nan")], [1, 1]]),
        lambda d: d["rooms"][0].update(polygon="square"),
        lambda d: d["openings"][0].update(rooms=["ghost"]),
        lambda d: d["openings"][0].update(kind="trapdoor"),
    ],
)
def test_wrong_documents_are_content_errors(made, change):
    document = plan_json(made[1])
    change(document)
    with pytest.raises(ContentError):
        plan_from_json(document)


def test_refusals_have_a_document():
    with pytest.raises(RefusedError) as caught:
        parse("12 rooms in 20 m2")
    document = refusal_json(caught.value)
    assert document["refused"]["message"]
    assert {c["text"] for c in document["refused"]["clashes"]} == {"12 rooms", "20 m2"}


def test_drawings(made):
    plan = made[1]
    root = ET.fromstring(svg(plan))
    words = [e.text for e in root.iter() if e.tag.endswith("text")]
    assert all(r.room_id.replace("_", " ") in words and f"{r.area:.1f} m²" in words for r in plan.rooms)
    x, y = np.vstack([r.polygon for r in plan.rooms]).T
    assert {f"{np.ptp(v) + 2 * plan.outer_wall:.2f} m" for v in (x, y)} <= set(words)
    picture = np.asarray(image(plan, 30.0))
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 5
    text = terminal(plan)
    assert all(r.room_id in text for r in plan.rooms)
    assert "▒" in text
    assert all(len(line) < 90 for line in text.splitlines())


def test_the_command_writes_what_is_asked(tmp_path, capsys):
    prompt = "a studio with a balcony"
    main(tmp_path, prompt=prompt, seed=1, json_path=tmp_path / "a.json", svg_path=tmp_path / "a.svg", png_path=tmp_path / "a.png")
    assert capsys.readouterr().out == ""
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    first = (tmp_path / "a.json").read_bytes()
    main(tmp_path, prompt=prompt, seed=1, json_path=tmp_path / "a.json")
    assert (tmp_path / "a.json").read_bytes() == first
    main(tmp_path, prompt=prompt)
    assert "studio" in capsys.readouterr().out


def test_the_command_refuses(tmp_path):
    with pytest.raises(RefusedError):
        main(tmp_path, prompt="12 rooms in 20 m2", json_path=tmp_path / "a.json")
    assert json.loads((tmp_path / "a.json").read_text())["refused"]["clashes"]
    with pytest.raises(UsageError):
        main(tmp_path, prompt="a studio", svg_path=tmp_path)
    with pytest.raises(UsageError):
        main(tmp_path, prompt="a studio", png_path=tmp_path / "no" / "a.png")
    with pytest.raises(UsageError):
        main(tmp_path, prompt="")


def test_two_storeys_are_drawn():
    plan = solve(parse("two-storey house with two bedrooms and a bathroom upstairs, living room and kitchen downstairs"), 0)
    assert "level 1" in terminal(plan)
    stairs = next(r for r in plan_json(plan)["rooms"] if r["type"] == "staircase")
    assert stairs["levels"] == [0, 1]
    assert plan_json(solve(prior(np.random.default_rng(0)), 0))["rooms"][0]["levels"] == [0]


def test_a_file_may_be_the_terminal(tmp_path, capsysbinary, monkeypatch):
    monkeypatch.chdir(tmp_path)
    main(tmp_path, prompt="a studio", svg_path=Path("-"))
    ET.fromstring(capsysbinary.readouterr().out)
    main(tmp_path, prompt="a studio", png_path=Path("-"))
    assert capsysbinary.readouterr().out.startswith(b"\x89PNG")
    main(tmp_path, prompt="a studio", json_path=Path("-"), svg_path=Path("a.svg"))
    assert json.loads(capsysbinary.readouterr().out)["refused"] is None
    with pytest.raises(UsageError, match="two things"):
        main(tmp_path, prompt="a studio", json_path=Path("-"), svg_path=Path("-"))
    assert [p.name for p in tmp_path.iterdir()] == ["a.svg"]


@pytest.mark.parametrize(("prompt", "code"), [("12 rooms in 20 m2", "impossible"), ("Квартира с двумя спальнями", "refused")])
def test_refusals_have_codes(tmp_path, capsys, prompt, code):
    with pytest.raises(RefusedError):
        main(tmp_path, prompt=prompt, json_path=Path("-"))
    assert PlanDocument.model_validate_json(capsys.readouterr().out).refused.code == code
