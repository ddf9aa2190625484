"""The plan's JSON against what its format states line by line, over plans of one to three storeys, and against the exported schema."""

import json
import math
import re

import numpy as np
import pytest
import shapely

from pipeline.errors import RefusedError
from pipeline.floorplan import complete, parse, plan_json, prior, refusal_json, solve
from pipeline.floorplan.document import document_schema
from pipeline.floorplan.program.floor_program import FloorProgram, Footprint, RoomReq, Shell
from stages.plan import main

KINDS = {"door", "open", "portal", "window", "entrance"}
STOREYS = complete(
    FloorProgram(
        storeys=3,
        rooms=(
            RoomReq(id="living", type="living_room", level=0), RoomReq(id="kitchen", type="kitchen", level=0), RoomReq(id="entry", type="entry", level=0),
            RoomReq(id="bed", type="bedroom", count=2, level=1), RoomReq(id="bath", type="bathroom", level=1),
            RoomReq(id="office", type="office", level=2), RoomReq(id="guest", type="bedroom", level=2), RoomReq(id="shower", type="bathroom", level=2),
        ),
    )
)  # fmt: skip
SHELL = Shell(inner_wall=0.15, outer_wall=0.36, ceiling=2.5, stated=True)


def programs():
    for seed in range(44):
        yield prior(np.random.default_rng((seed, 9))), seed
    for seed in range(6):
        yield STOREYS, seed
    cut = {"footprint": Footprint(corners="chamfered"), "shell": SHELL}
    for seed in range(10):
        yield prior(np.random.default_rng((seed, 11))).model_copy(update=cut), seed


@pytest.fixture(scope="module")
def documents():
    return [(program, json.loads(json.dumps(plan_json(solve(program, seed), program)))) for program, seed in programs()]


def millimetres(*values):
    return all(abs(v * 1000 - round(v * 1000)) < 1e-6 for v in values)


def test_there_are_plans_of_every_kind(documents):
    assert len(documents) == 60
    assert {max(v for r in d["rooms"] for v in r["levels"]) for _, d in documents} == {0, 1, 2}
    assert {o["kind"] for _, d in documents for o in d["openings"]} >= KINDS - {"portal"}


def test_top_level(documents):
    for program, d in documents:
        assert set(d) == {
            "version", "rooms", "openings", "entrance", "inner_wall", "outer_wall", "storey_height", "program", "repairs", "assumed", "refused",
        }  # fmt: skip
        assert d["version"] == 1
        assert d["refused"] is None
        assert FloorProgram.model_validate(d["program"]) == program
        (front,) = [o for o in d["openings"] if o["kind"] == "entrance"]
        assert front["rooms"] == [d["entrance"]]
        assert (d["inner_wall"], d["outer_wall"]) == (program.shell.inner_wall, program.shell.outer_wall)
        assert d["storey_height"] >= max(r["height"] for r in d["rooms"])


def test_rooms(documents):
    for program, d in documents:
        assert [r["id"] for r in d["rooms"]] == [r.id for r in sorted(program.rooms, key=lambda r: r.level)]
        top = program.storeys - 1
        for r in d["rooms"]:
            ring = np.array(r["polygon"])
            assert millimetres(*ring.ravel())
            shape = shapely.Polygon(ring)
            assert shape.is_valid
            assert shape.exterior.is_ccw
            assert np.linalg.norm(ring[0] - ring[-1]) > 1e-3, "closed"
            one, two = np.roll(ring, -1, axis=0) - ring, np.roll(ring, -2, axis=0) - np.roll(ring, -1, axis=0)
            assert np.all(np.abs(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]) > 1e-6), "collinear vertex"
            assert r["area"] == pytest.approx(shape.area, abs=1e-4)
            assert r["level"] == min(r["levels"])
            assert r["levels"] == (list(range(top + 1)) if r["type"] == "staircase" else [r["level"]])
            assert r["height"] == program.shell.ceiling
        assert sum(r["type"] == "staircase" for r in d["rooms"]) == int(top > 0)


def test_polygons_are_inner_wall_faces(documents):
    """Rooms of one storey are a wall apart: never nearer, and where an opening joins them exactly that far."""
    for _, d in documents:
        shapes = {r["id"]: shapely.Polygon(r["polygon"]) for r in d["rooms"]}
        for a in d["rooms"]:
            for b in d["rooms"]:
                if a["id"] < b["id"] and set(a["levels"]) & set(b["levels"]):
                    assert shapes[a["id"]].distance(shapes[b["id"]]) > d["inner_wall"] - 2e-3
        for o in d["openings"]:
            if len(o["rooms"]) == 2:
                assert shapes[o["rooms"][0]].distance(shapes[o["rooms"][1]]) == pytest.approx(d["inner_wall"], abs=2e-3)


def test_openings(documents):
    for program, d in documents:
        rooms = {r["id"]: r for r in d["rooms"]}
        assert len({o["id"] for o in d["openings"]}) == len(d["openings"])
        for o in d["openings"]:
            assert o["kind"] in KINDS
            assert set(o["rooms"]) <= set(rooms)
            assert len(o["rooms"]) == (1 if o["kind"] in {"window", "entrance"} else len(set(o["rooms"])))
            p, q = np.array(o["segment"])
            assert millimetres(*p, *q, o["width"], o["height"], o["sill"])
            assert o["width"] == pytest.approx(float(np.linalg.norm(q - p)), abs=1e-6)
            assert all(o["level"] in rooms[i]["levels"] for i in o["rooms"])
            assert o["sill"] >= 0
            assert o["sill"] + o["height"] <= min(rooms[i]["height"] for i in o["rooms"])
            half = (d["inner_wall"] if len(o["rooms"]) == 2 else d["outer_wall"]) / 2
            line = shapely.LineString([p, q])
            for i in o["rooms"]:  # the wall's centre line
                assert shapely.Polygon(rooms[i]["polygon"]).distance(line) == pytest.approx(half, abs=2e-3)
            gate = o["kind"] == "door" and [rooms[i]["type"] for i in o["rooms"]] == ["garage"]
            assert (o["swing"] is not None) == (o["kind"] in {"door", "entrance"} and not gate)
            if o["swing"]:
                assert set(o["swing"]) == {"room", "hinge", "angle"}
                assert o["swing"]["room"] in o["rooms"]
                assert o["swing"]["hinge"] in {0, 1}
                assert 0 < o["swing"]["angle"] <= math.pi
        assert {k.kind for k in program.links} <= KINDS | {"any", "wall"}


def matches(schema, value, root, where="$"):
    """Return where a value breaks a JSON Schema, or "": the keywords that pydantic writes."""
    if "$ref" in schema:
        return matches(root["$defs"][schema["$ref"].rsplit("/", 1)[1]], value, root, where)
    if "anyOf" in schema:
        tried = [matches(s, value, root, where) for s in schema["anyOf"]]
        return "" if "" in tried else tried[0]
    types = {"string": str, "integer": int, "number": (int, float), "boolean": bool, "array": list, "object": dict, "null": type(None)}
    wanted = schema.get("type")
    if wanted and (not isinstance(value, types[wanted]) or (isinstance(value, bool) and wanted != "boolean")):
        return f"{where} is no {wanted}"
    bounds = {"minimum": lambda b: value >= b, "maximum": lambda b: value <= b, "exclusiveMinimum": lambda b: value > b, "exclusiveMaximum": lambda b: value < b,
              "enum": lambda b: value in b, "const": lambda b: value == b, "pattern": lambda b: re.search(b, value), "minItems": lambda b: len(value) >= b,
              "maxItems": lambda b: len(value) <= b, "maxLength": lambda b: len(value) <= b, "required": lambda b: set(b) <= set(value)}  # fmt: skip
    for key, holds in bounds.items():
        if key in schema and not holds(schema[key]):
            return f"{where}: {key}"
    if isinstance(value, dict):
        known = schema.get("properties", {})
        if schema.get("additionalProperties") is False and set(value) - set(known):
            return f"{where} has {set(value) - set(known)}"
        return next((e for k, v in value.items() if k in known and (e := matches(known[k], v, root, f"{where}.{k}"))), "")
    if isinstance(value, list):
        kinds = schema.get("prefixItems") or [schema.get("items", {})] * len(value)
        return next((e for k, (s, v) in enumerate(zip(kinds, value, strict=False)) if (e := matches(s, v, root, f"{where}[{k}]"))), "")
    return ""


def test_the_exported_schema_holds(documents):
    schema = document_schema()
    for _, d in documents:
        assert matches(schema, d, schema) == ""
    with pytest.raises(RefusedError) as caught:
        parse("12 rooms in 20 m2")
    assert matches(schema, refusal_json(caught.value), schema) == ""


@pytest.mark.parametrize(
    "change",
    [
        lambda d: d.update(version=2),
        lambda d: d.update(more=1),
        lambda d: d["rooms"][0].pop("polygon"),
        lambda d: d["rooms"][0].update(level=-1),
        lambda d: d["rooms"][0].update(polygon=[[0, 0], [1, 1]]),
        lambda d: d["openings"][0].update(kind="hatch"),
        lambda d: d["openings"][0].update(rooms=["a", "b", "c"]),
        lambda d: d["openings"][0].update(swing={"room": "a", "hinge": 2, "angle": 1.0}),
    ],
)
def test_the_exported_schema_refuses(documents, change):
    broken = json.loads(json.dumps(documents[0][1]))
    change(broken)
    assert matches(document_schema(), broken, document_schema())


def test_a_refusal_is_written_and_raised(tmp_path):
    with pytest.raises(RefusedError):
        main(tmp_path, prompt="a flat without a bathroom, with an en suite bathroom", json_path=tmp_path / "plan.json")
    d = json.loads((tmp_path / "plan.json").read_text())
    assert d["rooms"] == d["openings"] == []
    assert set(d["refused"]) == {"code", "message", "clashes"}
    assert d["refused"]["clashes"]
    assert all(set(c) == {"text", "start", "end"} and c["end"] - c["start"] == len(c["text"]) for c in d["refused"]["clashes"])
