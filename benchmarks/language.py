"""How exactly prompts are read: the share of prompts whose program states what they say, per file, language and half.

`python -m benchmarks.language [--file sentences] [--half held|tuned] [--language en] [--faults]`. Ground truth:
`languages.yaml`, `sentences.yaml`, `speech.yaml`, `requests.yaml` and `everyday.yaml` in `manifests/prompts`. With `--engine llm [--replies FILE]`: read by the language model that SFGEN_LLM_* name; FILE (YAML, a list of
{prompt, reply}, the reply as text or as what its JSON holds) holds what it has answered before, is read instead of asking, and gets what is new;
without SFGEN_LLM_* the prompts that it holds are scored, and no server is asked.
"""

import argparse
import json
import sys
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import yaml

from pipeline.floorplan import FloorProgram, complete
from pipeline.floorplan.language import llm
from pipeline.floorplan.program.consistency import check
from tests.floorplan.language.faults import FILES, Engine, faults, load


def replay_engine(replies: dict[str, Any], server: llm.Server | None) -> Engine:
    """Return an engine that reads what a model has replied; what it has not been asked yet is asked, and its program kept as a reply."""

    def read(prompt: str) -> FloorProgram:
        if prompt not in replies:
            if server is None:
                raise llm.UnansweredError("no reply is recorded, and no server is configured")
            replies[prompt] = json.loads(llm.ask(prompt, server).model_dump_json(exclude_defaults=True))
        reply = replies[prompt] if isinstance(replies[prompt], str) else json.dumps(replies[prompt], ensure_ascii=False)
        try:
            program = complete(llm.validate_reply(reply, prompt))
        except llm.INVALID as error:
            raise llm.UnansweredError(f"the reply is no program: {str(error)[:100]}") from error
        check(program)
        return program

    return read


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the share of exact prompts and of exact facts."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--file", choices=FILES)
    parser.add_argument("--half", choices=("held", "tuned"))
    parser.add_argument("--language")
    parser.add_argument("--faults", action="store_true")
    parser.add_argument("--engine", choices=("rules", "llm"), default="rules")
    parser.add_argument("--replies", type=Path)
    asked = parser.parse_args(arguments)
    known = yaml.safe_load(asked.replies.read_text(encoding="utf-8")) if asked.replies and asked.replies.exists() else []
    replies = {row["prompt"]: row["reply"] for row in known}
    server = llm.server_from_env() if asked.engine == "llm" else None
    engine = replay_engine(replies, server) if asked.engine == "llm" else None
    offline = engine is not None and server is None
    if offline and not replies:
        parser.error("no reply is recorded: give --replies FILE, or set SFGEN_LLM_BASE_URL and SFGEN_LLM_MODEL")
    exact: Counter[tuple[str, str, str]] = Counter()
    count: Counter[tuple[str, str, str]] = Counter()
    spent = 0.0
    for name, case in ((f, c) for f in FILES if asked.file in (None, f) for c in load(f)):
        key = (name, case["id"][:2], case["half"])
        other = (asked.half and asked.half != key[2]) or (asked.language and asked.language != key[1])
        if other or (offline and case["prompt"] not in replies):
            continue
        start = time.process_time()
        wrong = faults(case, engine)
        spent += time.process_time() - start
        count[key] += 1
        exact[key] += not wrong
        if wrong and asked.faults:
            print(f"{case['id']}: {case['prompt']}\n    " + "\n    ".join(wrong))
    for key in sorted(count):
        print(f"{' '.join(key)}: {exact[key]} of {count[key]} exact")
    if offline:
        print(f"{sum(exact.values())} of {sum(count.values())} recorded replies exact")
    if asked.replies and len(replies) > len(known):
        rows = [{"prompt": prompt, "reply": reply} for prompt, reply in replies.items()]
        asked.replies.write_text(yaml.safe_dump(rows, allow_unicode=True, sort_keys=False), encoding="utf-8")
    print(f"{1000 * spent / max(sum(count.values()), 1):.1f} ms a prompt (CPU, completion and checks with it)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
