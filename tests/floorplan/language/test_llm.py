"""A language model that answers well, badly, too long, too late, or with malice; spoken to over HTTP on this machine."""

import gzip
import json
import logging
import threading
import time
from dataclasses import replace
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
import yaml

from benchmarks.language import main as score
from benchmarks.language import replay_engine
from pipeline.errors import RefusedError, UsageError
from pipeline.floorplan import complete
from pipeline.floorplan.language import llm
from pipeline.floorplan.language.llm import Server, UnansweredError, ask, server_from_env
from pipeline.floorplan.program.consistency import check
from pipeline.floorplan.prompt import request
from tests.floorplan.language.faults import faults, load

GOOD = json.dumps(
    {
        "rooms": [
            {"id": "salon", "type": "living_room"},
            {"id": "cuisine", "type": "kitchen"},
            {"id": "chambre", "type": "bedroom", "area": {"target": 14, "stated": True}},
            {"id": "bain", "type": "bathroom"},
        ],
        "links": [{"a": "salon", "b": "cuisine", "kind": "open", "stated": True}],
    }
)
PROMPT = "a one-bedroom flat with living room, kitchen and bathroom"


class Answers(BaseHTTPRequestHandler):
    def do_POST(self):
        asked = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        self.server.seen.append((self.path, dict(self.headers), asked))
        answer = self.server.answers[min(len(self.server.seen), len(self.server.answers)) - 1]
        answer(self)

    def log_message(self, *_):
        pass


def says(content):
    return raw(json.dumps({"choices": [{"message": {"content": content}}]}).encode())


def raw(body, status=200, headers=()):
    def answer(handler):
        handler.send_response(status)
        handler.send_header("Content-Length", str(len(body)))
        for name, value in headers:
            handler.send_header(name, value)
        handler.end_headers()
        handler.wfile.write(body)

    return answer


def truncated(handler):
    handler.send_response(200)
    handler.send_header("Content-Length", "5000")
    handler.end_headers()
    handler.wfile.write(b'{"choices": [{"mess')


def dripping(handler):
    handler.send_response(200)
    handler.send_header("Content-Length", "500000")
    handler.end_headers()
    for _ in range(4000):
        try:
            handler.wfile.write(b" ")
            handler.wfile.flush()
        except OSError:
            return
        time.sleep(0.05)


def dripping_headers(handler):
    handler.wfile.write(b"HTTP/1.1 200 OK\r\n")
    for k in range(4000):
        try:
            handler.wfile.write(f"X-{k}: 1\r\n".encode())
            handler.wfile.flush()
        except OSError:
            return
        time.sleep(0.05)


@pytest.fixture
def serve(monkeypatch):
    monkeypatch.setattr(llm, "PAUSES", (0.01, 0.02))
    servers = []

    def start(*answers, **limits):
        http = ThreadingHTTPServer(("127.0.0.1", 0), Answers)
        http.answers, http.seen = answers, []
        threading.Thread(target=http.serve_forever, args=(0.01,), daemon=True).start()
        servers.append(http)
        return http, Server(f"http://127.0.0.1:{http.server_port}/v1", "some-model", "secret", **{"seconds": 5.0, **limits})

    yield start
    for http in servers:
        http.shutdown()
        http.server_close()


def test_a_good_answer_is_taken(serve):
    http, server = serve(says(GOOD))
    program = request(PROMPT, server)
    assert [r.id for r in program.rooms] == ["salon", "cuisine", "chambre", "bain"]
    assert {(k.a, k.b, k.kind) for k in program.links if k.stated} == {("salon", "cuisine", "open")}
    path, headers, asked = http.seen[0]
    assert path == "/v1/chat/completions"
    assert headers["Authorization"] == "Bearer secret"
    assert asked["model"] == "some-model"
    assert asked["response_format"]["json_schema"]["schema"]["title"] == "FloorProgram"
    assert asked["messages"][-1]["content"] == PROMPT


def test_fenced_json_is_taken(serve):
    _, server = serve(says(f"```json\n{GOOD}\n```"))
    assert len(request(PROMPT, server).rooms) == 4


def test_a_bad_answer_is_repaired_with_its_faults_named(serve):
    http, server = serve(says('{"rooms": [{"id": "x", "type": "dungeon"}]}'), says("no"), says(GOOD))
    assert len(request(PROMPT, server).rooms) == 4
    assert len(http.seen) == 3
    assert "rooms.0.type" in http.seen[1][2]["messages"][-1]["content"]


@pytest.mark.parametrize(
    ("answer", "limits"),
    [
        (says("I cannot do that"), {}),
        (says("[1, 2]"), {}),
        (says('{"rooms": []}'), {}),
        (says("[" * 100_000), {}),
        (raw(b"<html>"), {}),
        (raw(b"{}"), {}),
        (raw(b"", 500), {}),
        (raw(b"", 302, [("Location", "http://127.0.0.1:9/")]), {}),
        (truncated, {}),
        (raw(b" " * 300_000), {"most_bytes": 100_000}),
        (dripping, {"seconds": 0.4}),
        (lambda _: time.sleep(1.0), {"seconds": 0.3}),
        (dripping_headers, {"seconds": 0.4}),
        (raw(gzip.compress(b" " * 3_000_000), 200, [("Content-Encoding", "gzip")]), {}),
        (raw(b"<html><body>sign in</body></html>", 200, [("Content-Type", "text/html")]), {}),
        (raw(b"", 401), {}),
        (says(json.dumps({"rooms": [{"id": "x", "type": "bedroom", "count": 1e9}]})), {}),
        (says(json.dumps({"rooms": [{"id": f"x{k}", "type": "bedroom", "count": 40} for k in range(40)]})), {}),
        (says('{"rooms": ' + '{"a":' * 10_000 + "1" + "}" * 10_000 + "}"), {}),
        (says('{"rooms": [{"id": "a", "type": "bedroom", "area": {"target": 1e999}}]}'), {}),
        (says(json.dumps({"rooms": [{"id": "a", "type": "bedroom", "furniture": {"counts": [{"category": "unicorn", "min": 2}]}}]})), {}),
    ],
    ids=[
        "prose",
        "list",
        "no-rooms",
        "deep",
        "html",
        "no-choices",
        "500",
        "redirect",
        "truncated",
        "huge",
        "dripping",
        "silent",
        "header-drip",
        "gzip-bomb",
        "sign-in",
        "401",
        "1e9",
        "1600-rooms",
        "nested",
        "infinite",
        "unicorn",
    ],
)
def test_useless_answers_fall_back_to_the_built_in_parser(serve, caplog, answer, limits):
    http, server = serve(answer, **limits)
    began = time.monotonic()
    with caplog.at_level(logging.WARNING):
        program = request(PROMPT, server)
    assert time.monotonic() - began < 30.0  # what drips would take three minutes
    assert {r.id for r in program.rooms} == {"bed", "living", "kitchen", "bath"}
    assert "built-in parser" in caplog.text
    assert "secret" not in caplog.text
    assert len(http.seen) <= 3


def test_answers_are_data(serve):
    nasty = json.dumps({"rooms": [{"id": "../../etc/passwd", "type": "bedroom"}], "__import__": "os"})
    _, server = serve(says(nasty))
    with pytest.raises(UnansweredError, match="repairs"):
        ask(PROMPT, server)


def test_a_contradiction_of_the_models_own_making_is_not_believed(serve, caplog):
    program = json.loads(GOOD) | {"forbids": [{"what": "adjacent", "a": "salon", "b": "cuisine"}]}
    _, server = serve(says(json.dumps(program)))
    assert {r.id for r in request(PROMPT, server).rooms} == {"bed", "living", "kitchen", "bath"}
    assert "contradicts" in caplog.text


def test_configuration_comes_from_the_environment():
    assert server_from_env({}) is None
    both = {"SFGEN_LLM_BASE_URL": "http://localhost:1/v1/", "SFGEN_LLM_MODEL": "m"}
    found = server_from_env(both)
    assert (found.base_url, found.model, found.key, found.cache.name) == ("http://localhost:1/v1", "m", "", "llm")
    assert server_from_env({**both, "SFGEN_CACHE": "/x"}).cache == Path("/x/llm")
    with pytest.raises(UsageError) as caught:
        server_from_env({**both, "SFGEN_LLM_API_KEY": "secret\nX-Evil: 1"})
    assert "secret" not in str(caught.value)
    with pytest.raises(UsageError, match="SFGEN_LLM_MODEL"):
        server_from_env({"SFGEN_LLM_BASE_URL": "http://localhost:1"})
    with pytest.raises(UsageError, match="http"):
        server_from_env({"SFGEN_LLM_BASE_URL": "file:///etc/passwd", "SFGEN_LLM_MODEL": "m"})


def test_no_server_is_asked_about_an_empty_prompt(serve):
    http, server = serve(says(GOOD))
    with pytest.raises(UsageError):
        request("  ", server)
    assert http.seen == []


# llama-cpp-python's server calls a format that it does not know a fault of its own: 500
@pytest.mark.parametrize("status", [400, 500])
def test_a_server_without_json_schema_is_asked_in_another_way_then_for_plain_json(serve, status):
    refusal = raw(b'{"error": "response_format is not supported"}', status)
    http, server = serve(refusal, refusal, says(GOOD))
    assert len(request(PROMPT, server).rooms) == 4
    asked = [asked["response_format"] for _, _, asked in http.seen]
    assert [(each["type"], "schema" in each) for each in asked] == [("json_schema", False), ("json_object", True), ("json_object", False)]


@pytest.mark.parametrize("status", [429, 500, 503])
def test_a_busy_server_is_asked_again(serve, status):
    http, server = serve(raw(b"", status), raw(b"", status), says(GOOD))
    assert len(ask(PROMPT, server).rooms) == 4
    assert len(http.seen) == 3


def test_answers_are_kept_by_content(serve, tmp_path):
    http, server = serve(says(GOOD), cache=tmp_path / "llm")
    first = ask(PROMPT, server)
    assert ask(PROMPT, server) == first
    assert len(http.seen) == 1
    (entry,) = (tmp_path / "llm").iterdir()
    ask(PROMPT + "!", server)
    ask(PROMPT, replace(server, model="another"))
    assert len(http.seen) == 3
    for damage in (b"", b"{", b"[" * 100_000, b'{"rooms": [{"id": "../../etc/passwd", "type": "bedroom"}]}', b"\xff\xfe", b'{"rooms": []}'):
        entry.write_bytes(damage)
        assert ask(PROMPT, server) == first
        assert json.loads(entry.read_bytes())["rooms"]


def test_a_cache_that_cannot_be_written_is_no_fault(serve, tmp_path):
    (tmp_path / "file").write_text("")
    _, server = serve(says(GOOD), cache=tmp_path / "file")
    assert len(ask(PROMPT, server).rooms) == 4


def test_a_bad_answer_is_not_kept(serve, tmp_path):
    _, server = serve(says("no"), cache=tmp_path)
    with pytest.raises(UnansweredError):
        ask(PROMPT, server)
    assert not list(tmp_path.iterdir())


def test_furniture_is_part_of_the_answer(serve):
    wish = {"least": 8, "most": 8, "style": "Nordic", "counts": [{"category": "nightstand", "min": 2, "max": 2}]}
    program = json.loads(GOOD)
    program["rooms"][2]["furniture"] = wish
    http, server = serve(says(json.dumps(program)))
    bed = request(PROMPT, server).rooms[2]
    assert (bed.furniture.least, bed.furniture.style, bed.furniture.counts[0].category) == (8, "Nordic", "nightstand")
    assert "nightstand" in http.seen[0][2]["messages"][0]["content"]


def test_quotes_are_looked_up_in_the_prompt(serve):
    program = {
        "rooms": [{"id": "bed", "type": "bedroom"}, {"id": "bath", "type": "bathroom"}, {"id": "gym", "type": "gym"}],
        "total_area": {"target": 61.0},
        "evidence": [{"field": "rooms.bed", "text": "One  BEDROOM", "start": 900, "end": 3}, {"field": "rooms.x", "text": "not there"}, 7],
    }
    prompt = "One bedroom and a bath of 5 m2 please"
    _, server = serve(says(json.dumps(program)))
    made = ask(prompt, server)
    assert all(prompt[e.start : e.end] == e.text for e in made.evidence)
    assert {(e.field, e.source) for e in made.evidence} == {("rooms.bed", "llm"), ("rooms.bath", "rule")}
    assert {r.id: r.stated for r in made.rooms} == {"bed": True, "bath": True, "gym": False}  # nobody spoke of a gym
    assert not made.total_area.stated


def test_the_schema_asks_for_nothing_that_the_words_decide():
    shown = json.dumps(llm.schema())
    assert all(f'"{name}"' not in shown for name in ("stated", "inferred", "start", "end", "source", "unparsed"))
    assert shown in llm.instructions()


def test_the_worked_examples_are_valid_and_quote_their_requests():
    examples = yaml.safe_load(llm.EXAMPLES.read_text(encoding="utf-8"))
    assert len(examples) == 6
    for example in examples:
        program = llm.validate_reply(json.dumps(example["reply"], ensure_ascii=False), example["prompt"])
        check(complete(program))
        assert len(program.evidence) == len(example["reply"]["evidence"])
        assert all(r.stated for r in program.rooms)


RENAMED = "Unsupported parameter: 'max_tokens' is not supported with this model. Use 'max_completion_tokens' instead."
PICKY = [
    ({"max_tokens": RENAMED}, {"temperature", "seed", "response_format", "max_completion_tokens"}, 2),
    ({"max_tokens": "use max_completion_tokens"}, {"temperature", "seed", "response_format", "max_completion_tokens"}, 2),
    ({"max_tokens": RENAMED, "temperature": "'temperature' does not support 0"}, {"seed", "response_format", "max_completion_tokens"}, 3),
    ({"temperature": "'temperature' does not support 0"}, {"max_tokens", "seed", "response_format"}, 2),
    ({"max_tokens": RENAMED, "max_completion_tokens": "max_completion_tokens: unknown"}, {"temperature", "seed", "response_format"}, 3),
    ({"seed": "seed?", "response_format": "no response_format here"}, set(), 5),
    ({"temperature": "no", "max_tokens": "no"}, set(), 4),
]


@pytest.mark.parametrize(("refuses", "kept", "asked"), PICKY)
def test_a_server_that_refuses_a_parameter_is_asked_without_it_or_by_its_newer_name(serve, refuses, kept, asked):
    def answer(handler):
        sent = handler.server.seen[-1][2]
        complaint = next((why for name, why in refuses.items() if name in sent), "")
        (raw(json.dumps({"error": {"message": complaint}}).encode(), 400) if complaint else says(GOOD))(handler)

    http, server = serve(answer)
    assert [r.id for r in ask(PROMPT, server).rooms] == ["salon", "cuisine", "chambre", "bain"]
    first, last = http.seen[0][2], http.seen[-1][2]
    assert first["max_tokens"] == llm.MOST_TOKENS
    assert set(last) == {"model", "messages", *kept}
    assert last.get("max_completion_tokens", llm.MOST_TOKENS) == llm.MOST_TOKENS
    assert len(http.seen) == asked


@pytest.mark.parametrize("complaint", ["not so", ""])
def test_a_server_that_does_not_say_what_it_refuses_is_asked_with_nothing_besides(serve, complaint):
    http, server = serve(*[raw(json.dumps({"error": complaint}).encode(), 400)] * 3, says(GOOD))
    assert len(request(PROMPT, server).rooms) == 4
    first, *_, last = (asked for _, _, asked in http.seen)
    assert "max_tokens" in first
    assert set(last) == {"model", "messages"}


def test_a_server_that_knows_no_format_is_asked_without(serve):
    http, server = serve(raw(b"", 400), raw(b"", 422), raw(b"", 400), says(GOOD))
    assert len(request(PROMPT, server).rooms) == 4
    assert "response_format" not in http.seen[3][2]


def test_a_contradiction_that_the_model_has_settled_is_refused(serve):
    _, server = serve(says(json.dumps({"rooms": [{"id": "bed", "type": "bedroom", "count": 2}]})))
    with pytest.raises(RefusedError):
        request("A two-bedroom flat. The third bedroom is for guests.", server)


def test_recorded_replies_are_scored_without_a_server():
    prompt = "Two bedrooms and a bath"
    engine = replay_engine({prompt: {"rooms": [{"id": "bed", "type": "bedroom", "count": 2}, {"id": "bath", "type": "bathroom"}]}}, None)
    case = {"prompt": prompt, "rooms": ["bedroom", "bedroom", "bathroom"]}
    assert faults(case, engine) == []
    assert faults({**case, "prompt": "A kitchen"}, engine) != []


def test_a_file_of_recorded_replies_is_scored_by_one_command_without_a_server(tmp_path, monkeypatch, capsys):
    for name in ("SFGEN_LLM_BASE_URL", "SFGEN_LLM_MODEL"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(llm, "_post", lambda *_: pytest.fail("a server was asked"))
    right, wrong, broken, refused = (c["prompt"] for c in load("languages")[:4])
    rooms = [{"id": kind, "type": kind, "count": n} for kind, n in load("languages")[0]["rooms"].items()]
    reply = {"rooms": rooms, "links": [{"a": "living_room", "b": "kitchen", "kind": "open"}], "total_area": {"target": 42}}
    rows = [
        {"prompt": right, "reply": f"```json\n{json.dumps(reply)}\n```"},  # as a model wrote it
        {"prompt": wrong, "reply": {"rooms": [{"id": "gym", "type": "gym"}]}},
        {"prompt": broken, "reply": "I cannot do that"},
        {"prompt": refused, "reply": {"rooms": [{"id": "x", "type": "dungeon"}]}},
    ]
    recorded = tmp_path / "replies.yaml"
    recorded.write_text(yaml.safe_dump(rows, allow_unicode=True), encoding="utf-8")
    before = recorded.read_bytes()
    assert score(["--engine", "llm", "--replies", str(recorded), "--faults"]) == 0
    said = capsys.readouterr().out
    assert "1 of 4 recorded replies exact" in said
    assert said.count("no program: the reply is no program") == 2
    assert recorded.read_bytes() == before
    assert score(["--engine", "llm", "--replies", str(recorded), "--file", "everyday"]) == 0
    assert "0 of 0 recorded" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        score(["--engine", "llm"])
