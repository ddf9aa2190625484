from pipeline import seeds
from pipeline.experiments.baselines import figures, success
from pipeline.metrics.intervals import rate
from pipeline.report.baselines import NAMES, baselines_section
from pipeline.report.page import render


def test_what_was_not_run_has_no_chapter():
    assert baselines_section({}) is None


def test_the_chapter_shows_every_model_and_its_price():
    row = figures(seeds.generator(0, "t"), [], [], [], {"bed": False}, [5, 12])
    row |= {"relations": {"chair at its table": rate(3, 4), "never asked": rate(0, 0)}, "sca": rate(7, 10)}
    made = {
        "models": dict.fromkeys(sorted(NAMES), row),  # JSON's order
        "quantity": {name: {n: success([[None] * 5, []], 5) for n in ("12", "5")} for name in ("scenefoundry", "ours")},
        "trained": {name: {"parameters": 1234567, "steps": 900, "cpu_seconds": 120.4} for name in ("atiss", "diffuscene", "scenefoundry")},
        "train_rooms": 31000,
    }
    page = render("t", "", [baselines_section(made)])
    assert all(name in page for name in NAMES.values())
    assert "1,234,567" in page
    assert page.index("real rooms") < page.index("ATISS-type")
    assert page.index("SR(5)") < page.index("SR(12)")
    assert "0.500" in page
    assert "31,000" in page
    assert "0.750" in page
    assert "0.700" in page
    assert "never asked" not in page
