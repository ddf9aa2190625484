import sys
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "homes"))
from conftest import Rules, factory, library  # noqa: F401 - the factory of rules

from pipeline.errors import ContentError
from pipeline.experiments import paper_tables
from pipeline.experiments.settings import MetricsSettings, spread
from pipeline.experiments.trials import Condition, Drafts, Trial, trial
from pipeline.experiments.trials import test_rooms as rooms_of
from pipeline.homes.rows import opening_row, room_row, scene_row

SETTINGS = MetricsSettings(rooms=2, counts=(3,), taus=(0.5, 0.7))


@pytest.fixture(scope="module")
def jobs():
    import furniture

    home = furniture.home([], furniture.two_rooms())
    kinds = {"living": "living_room", "bed": "bedroom"}
    rows = {
        "scenes": [{**scene_row(home), "split": "test"}],
        "rooms": [room_row(home.scene_id, room, kinds[room.room_id]) for room in home.plan.rooms],
        "openings": [opening_row(home.scene_id, opening) for opening in home.plan.openings],
    }
    return rooms_of(rows, "test", ("bedroom", "living_room"))


@pytest.fixture(scope="module")
def trials(factory, jobs):  # noqa: F811
    made = {}
    for family in paper_tables.families(SETTINGS):
        drafts = Drafts(factory, family[0].articulation)
        made |= {c.name: trial(factory, jobs, c, drafts) for c in family}
    return made


def test_rooms_come_alone_with_their_own_openings(jobs):
    assert [job.layout_type for job in jobs] == ["living_room", "bedroom"]
    assert [len(job.plan.openings) for job in jobs] == [2, 1]
    with pytest.raises(ContentError, match="no furnished room"):
        rooms_of({"scenes": [], "rooms": [], "openings": []}, "test", ("bedroom",))


def test_spread_takes_the_ends_and_never_more_than_there_are():
    assert spread(list(range(10)), 5) == [0, 2, 4, 6, 8]
    assert spread([1, 2], 5) == [1, 2]


def test_what_ships_is_clean_and_counts_are_kept(trials):
    for made in trials.values():
        assert all(j["clear"] for j in made.shipped["joints"])
        for room in made.shipped["rooms"]:
            assert room["asked_objects"] in {None, room["objects"]}


def test_tables_have_every_row_and_rates_lie_in_their_intervals(factory, trials):  # noqa: F811
    quantity = paper_tables.quantity_table(trials, SETTINGS.counts, 2)
    assert quantity["3"]["drafted"]["rate"] == 1.0
    walkable = paper_tables.walkable_table(trials, SETTINGS.taus, 2)
    assert set(walkable) == {"0.50", "0.70"}
    rng = np.random.default_rng(1)
    made = paper_tables.articulation_table(rng, trials, {}, factory.library)
    assert list(made) == ["plain_drafted", "heuristic_drafted", "guided_drafted", "plain_shipped", "guided_shipped"]
    assert made["guided_shipped"]["collision"]["prism"]["col_obj"]["rate"] == 0.0
    ablation = paper_tables.ablation_table(rng, trials, SETTINGS.taus)
    assert set(ablation) == {"neither", "articulation", "walkable", "both"}
    for row in ablation.values():
        for rate in (row["col_obj"], row["r_reach"], row["r_walkable"]["free"]):
            assert rate["low"] <= rate.get("rate", rate.get("mean")) <= rate["high"]
    curves = paper_tables.curves({"quantity": quantity, "walkable": walkable})
    assert curves["quantity"].splitlines()[0] == "n,guidance,rate,low,high"
    assert len(curves["walkable"].splitlines()) == 1 + 3 * 2


def test_shipped_rooms_reach_their_share_of_free_floor(trials):
    for tau in SETTINGS.taus:
        assert all(r["walkable_free"] >= tau - 0.03 for r in trials[f"walkable_{tau:.2f}"].shipped["rooms"])


def test_things_that_the_layout_model_does_not_learn_are_not_compared():
    def rows(*names):
        return {"objects": [{"category": name} for name in names]}

    drafted = {name: Trial(rows("double_bed"), {}, {}) for name in (paper_tables.ALL_PLAIN, paper_tables.ALL_GUIDED)}
    held_out = [{"category": name} for name in ("double_bed", "cup", "rug")]
    table = paper_tables.category_table(drafted, [{"category": "double_bed"}], held_out, ("double_bed", "nightstand"))
    assert table["guided"] == {"real_to_generated": 0.0, "generated_to_real": 0.0, "real_objects": 1, "generated_objects": 1}


def test_conditions_of_a_family_draw_alike_and_share_their_draws(factory, jobs):  # noqa: F811
    for family in paper_tables.families(SETTINGS):
        assert len({(c.articulation, c.count) for c in family}) == 1
    drawn = []
    drafts = Drafts(replace(factory, sampler=Counting(**vars(factory.sampler), drawn=drawn)), "joints")
    condition = Condition("walkable_0.70", walkable=0.7)
    first = trial(factory, jobs, condition, drafts)
    made = len(drawn)
    assert trial(factory, jobs, condition, drafts) == first  # and nothing drawn again
    assert len(drawn) == made >= len(jobs)
    assert trial(factory, jobs, condition, Drafts(factory, "joints")) == first


@dataclass(frozen=True)
class Counting(Rules):
    """Notes what it draws."""

    drawn: list = field(default_factory=list)

    def sample_rooms(self, rooms, keys):
        self.drawn.extend(keys)
        return super().sample_rooms(rooms, keys)
