"""The table of the bars shows every figure that was kept, with its command, and nothing where nothing was kept."""

from pipeline.report.planning import HEADER, planning_section

TOLD = {"command": "python -m benchmarks.plan x", "commit": "abc"}
SCORES = {
    "plans": 100, "successes": 99, "node": [1.0, 1.0, 1.0], "edge": [0.997, 0.99, 1.0], "constraint": [0.943, 0.94, 0.95],
}  # fmt: skip
PLANNING = {
    "scores": {**TOLD, "figures": {"prompt": SCORES, "truth": {**SCORES, "constraint": [0.991, 0.991, 0.991]}, "ceiling": 0.946}},
    "times": {**TOLD, "figures": [{"rooms": 5, "bar_ms": 40, "mean_ms": 24.8, "p99_ms": 41.2, "proposals": 169, "runs": 2}]},
}
FAILURES = {
    "prior": {
        **TOLD,
        "figures": {"start": 0, "count": 10000, "cpu_s": 900.0, "slowest_s": 4.0, "failures": [{"seed": 3, "why": ["refused: x"]}]},
    }
}
KNOBS = {"seeds": 40, "terms": {"area": {"ends": [-1, 0.1]}, "alignment": {"ends": [1, 0.1]}}}


def test_every_figure_has_its_row_and_command():
    made = planning_section(PLANNING, FAILURES, KNOBS, lambda found: found["ends"][0] < 0)
    rows = {row[0]: row for row in made.tables[0].rows}
    assert all(len(row) == len(HEADER) and "benchmarks.plan" in row[5] for row in rows.values())
    assert rows["strict success, 100 plans"][4] == "99 of 100"
    assert rows["S_constraint given rooms and areas"][4] == "0.991"
    assert rows["S_constraint from the prompt"][3:5] == ["0.936: 0.01 below exact defaults", "0.943 (seeds 0.940-0.950)"]
    assert rows["CPU ms, 5 rooms: mean, p99"][4].startswith("25, 41; 2 runs, 169 proposals")
    assert rows["failures, programs of the prior"][4:] == ["1 of 10,000; 90 CPU ms each", TOLD["command"], "abc"]
    assert rows["knobs that move their term monotonically"][4] == "1 of 2; not alignment"


def test_what_was_not_measured_is_not_shown():
    assert planning_section({}, {}, {}, bool) is None
    made = planning_section({"times": PLANNING["times"]}, {}, {}, bool)
    assert [row[0] for row in made.tables[0].rows] == ["CPU ms, 5 rooms: mean, p99"]
