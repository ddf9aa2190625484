"""The bars of the floor plans: what was measured beside the paper's and the peers' figures, each with the command that measures it."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from pipeline.report.page import Section, TableView

Json = Mapping[str, Any]
HEADER = ("", "the paper", "best peer", "bar", "ours", "measured by", "commit")
KNOBS = "python -m benchmarks.plan knobs"


def planning_section(planning: Json, failures: Json, knobs: Json, falls: Callable[[Json], bool]) -> Section | None:
    """Return the table of the bars from the records that the checkout carries; None where there is none.

    `planning`, `failures`, `knobs` are planning.json, failures.json and knobs.json of benchmarks/records/, empty where they are missing; `falls` tells
    whether a knob's own term falls as it is turned.
    """
    rows = [*_scores(planning.get("scores")), *_times(planning.get("times"))]
    rows += [*_failures(failures), *_knobs(knobs, falls)]
    if not rows:
        return None
    text = (
        "Measured apart from the run that made this page, for it takes long; each row names its command and the commit that was measured. "
        "Peers: Infinigen's twelve-term solver given the ground-truth graphs with its area weight at 100 (S_constraint), its default and its "
        "fewest-rooms setting, and ProcTHOR's plan stage (CPU seconds), measured on 2 cores; failures as its issue 419 counts them."
    )
    return Section("Floor plans against their bars", [text], [TableView("What is asked, and what was measured", HEADER, rows)])


def _row(what: str, paper: str, peer: str, bar: str, ours: str, run: Json) -> list[str]:
    return [what, paper, peer, bar, ours, run["command"], run["commit"]]


def _scores(run: Json | None) -> list[list[str]]:
    if not run:
        return []
    figures = run["figures"]
    prompt, truth, ceiling = figures["prompt"], figures["truth"], figures["ceiling"]
    seeds = f"{prompt['plans']} plans"
    return [
        _row(f"strict success, {seeds}", "14 of 20", "-", "all", f"{prompt['successes']} of {prompt['plans']}", run),
        _row(
            "S_node, S_edge from the prompt", "0.989, 0.954", "-", "0.995, 0.995", f"{_mean(prompt, 'node')}, {_mean(prompt, 'edge')}", run
        ),
        _row("S_node, S_edge given the truth", "-", "1.0, -", "0.995, 0.995", f"{_mean(truth, 'node')}, {_mean(truth, 'edge')}", run),
        _row("S_constraint given rooms and areas", "0.923", "0.961", "0.975", _mean(truth, "constraint"), run),
        _row(
            "S_constraint from the prompt", "-", "-", f"{ceiling - 0.01:.3f}: 0.01 below exact defaults", _mean(prompt, "constraint"), run
        ),
    ]


def _mean(scores: Json, name: str) -> str:
    mean, low, high = scores[name]
    return f"{mean:.3f}" if low == high else f"{mean:.3f} (seeds {low:.3f}-{high:.3f})"


def _times(run: Json | None) -> list[list[str]]:
    peers = {5: "9.2 s, 0.10 s", 8: "17-59 s, 0.32 s", 12: "17-59 s, -"}
    if not run:
        return []
    return [
        _row(
            f"CPU ms, {r['rooms']} rooms: mean, p99",
            "272 s (wall)",
            peers.get(r["rooms"], "-"),
            f"{r['bar_ms']}, 5 means",
            f"{r['mean_ms']:.0f}, {r['p99_ms']:.0f}; {r['runs']} runs, {r['proposals']} proposals a room at least",
            run,
        )
        for r in run["figures"]
    ]


def _failures(runs: Json) -> list[list[str]]:
    names = {"prior": "programs of the prior", "trees": "programs of an independent generator"}
    rows = []
    for source, run in runs.items():
        figures = run["figures"]
        ours = f"{len(figures['failures'])} of {figures['count']:,}; {1e3 * figures['cpu_s'] / max(figures['count'], 1):.0f} CPU ms each"
        rows.append(_row(f"failures, {names.get(source, source)}", "-", "about 80 % of single rooms crash", "0 of 10,000", ours, run))
    return rows


def _knobs(knobs: Json, falls: Callable[[Json], bool]) -> list[list[str]]:
    terms: Mapping[str, Json] = knobs.get("terms", {})
    if not terms:
        return []
    good = [name for name, term in terms.items() if falls(term)]
    left: Sequence[str] = [name for name in terms if name not in good]
    ours = f"{len(good)} of {len(terms)}" + (f"; not {', '.join(left)}" if left else "")
    run = {"command": f"{KNOBS} --count {knobs['seeds']}", "commit": knobs.get("commit", "-")}
    return [_row("knobs that move their term monotonically", "Fig. 3, one", "one", "12 of 12", ours, run)]
