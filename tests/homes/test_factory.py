import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline import params, taxonomy
from pipeline.diffusion.checkpoint import Header, build_inventory, build_net, save_weights
from pipeline.diffusion.codec import CHANNELS, Normalisation
from pipeline.diffusion.settings import ModelSettings
from pipeline.errors import ContentError, RefusedError
from pipeline.homes import factory as factories
from pipeline.homes.drafts import draft_rows, drafts_of
from pipeline.homes.request import Request
from pipeline.verify import verify_home

ROOT = Path(__file__).parents[2]
STUDIO = "a one-bedroom flat of 50 m2 with a living room, a kitchen and a bathroom"


@pytest.fixture(scope="module")
def outcomes(factory):
    return factory.make([Request(0, STUDIO), Request(1)], files=False)


def test_homes_that_ship_satisfy_the_judge(factory, outcomes):
    for outcome in outcomes:
        assert not verify_home(outcome.home, factory.library, factory.verify).faults(factory.verify.policy)
        assert outcome.home.placements
        scene = outcome.rows["scenes"][0]
        assert scene["collisions"] == 0
        assert scene["joints"] == scene["joints_clear"] == len(outcome.rows["joints"])
        assert scene["objects"] == len(outcome.rows["objects"]) == sum(r["objects"] for r in outcome.rows["rooms"])


def test_a_home_does_not_depend_on_who_is_made_beside_it(factory, outcomes):
    alone = factory.make([Request(1)], files=False)[0]
    assert alone.rows == outcomes[1].rows


def test_drafts_survive_their_tables(factory, outcomes):
    requests = [Request(0, STUDIO), Request(1)]
    rows = draft_rows(factory.first_drafts(requests), factory.seed, factory.library)
    again = factory.make(requests, drafts_of(rows, requests, factory), files=False)
    assert [o.rows for o in again] == [o.rows for o in outcomes]


def test_what_is_left_out_has_a_reason(factory, outcomes):
    for outcome in outcomes:
        sampled = sum(r["openable_sampled"] or 0 for r in outcome.rows["rooms"])
        lost = sampled - sum(r["openable"] for r in outcome.rows["rooms"])
        assert lost <= len(outcome.rows["rejects"])
        assert all(r["reason"] and r["where"].startswith(outcome.home.scene_id) for r in outcome.rows["rejects"])


def test_seeds_give_different_homes(factory, outcomes):
    other = replace(factory, seed=4, sampler=replace(factory.sampler, seed=4)).make([Request(1)], files=False)[0]
    mine, theirs = ([r["polygon"] for r in o.rows["rooms"]] for o in (outcomes[1], other))
    assert mine != theirs


def test_a_stated_number_of_things_is_met_exactly(factory):
    home = factory.make([Request(0, "a bedroom with four pieces of furniture and a bathroom, 40 m2")], files=False)[0]
    asked = [(r["asked_objects"], r["objects"]) for r in home.rows["rooms"] if r["asked_objects"] is not None]
    assert asked == [(4, 4)]


def test_what_can_never_fit_stays_empty_naming_the_home_and_all_that_was_tried(factory):
    tight = replace(factory, shard=replace(factory.shard, room_attempts=1, home_attempts=2))
    hard = "a bedroom of 9 m2 with 24 pieces of furniture and a bathroom"
    (empty,) = tight.make([Request(5, hard)], files=False)
    assert isinstance(empty.error, RefusedError)
    assert re.search(r"home 5 .*count_missed", str(empty.error))
    *tries, last = empty.rows(factory.seed)["rejects"]
    assert (last["what"], last["where"], last["reason"]) == ("index", "s3_00000005", "attempts_spent")
    assert {row["what"] for row in tries} >= {"room", "home"}
    impatient = replace(tight, shard=replace(tight.shard, home_seconds=0.0))
    assert [e.reason for e in impatient.make([Request(5, hard)], files=False)] == ["deadline"]


@pytest.mark.parametrize(
    ("prompt", "word"),
    [
        ("a bedroom of 40 m2 with thirty pieces of furniture and a bathroom", "at most 24"),
        ("an apartment with no bathroom and an en suite bathroom", "bathroom"),
    ],
)
def test_what_cannot_be_is_refused_and_costs_the_homes_beside_it_nothing(factory, outcomes, prompt, word):
    empty, home = factory.make([Request(0, prompt), Request(1)], files=False)
    assert (empty.reason, type(empty.error).exit_code) == ("refused", 3)
    assert word in str(empty.error)
    assert home.rows == outcomes[1].rows
    assert [d.request.index for d in factory.first_drafts([Request(0, prompt), Request(1)])] == [1]


def test_poses_are_rounded(outcomes):
    for outcome in outcomes:
        for p in outcome.home.placements:
            assert np.array_equal(p.position, np.round(p.position, 4))
            assert p.yaw == round(p.yaw, 5)
            assert -np.pi < p.yaw <= np.pi


def test_cpu_seconds_are_counted_by_part(factory, outcomes):
    assert outcomes
    assert {"plan", "sample", "postopt", "verify"} <= factory.seconds.keys()


def test_weights_of_another_vocabulary_make_no_homes(tmp_path):
    """A category of the taxonomy that they do not know would never be in a home, and nobody would be told."""
    words, net = taxonomy.load(), ModelSettings(8, 1, 1, 2, 4)
    for classes, layouts, odd in (
        (("king_size_bed", *words.names[1:]), words.layout_types, "king_size_bed"),
        (words.names, words.layout_types[:-1], words.layout_types[-1]),
    ):
        ones = ((1.0,) * CHANNELS,) * len(classes)
        norm = Normalisation(ones, ones, classes)
        header = Header(norm, layouts, 24, net, 8)
        save_weights(
            tmp_path / "models/denoiser.safetensors", header, {"denoiser": build_net(header), "inventory": build_inventory(header)}
        )
        with pytest.raises(ContentError, match=odd) as refused:
            factories.load_factory(tmp_path, params.read(ROOT / "params.yaml"), 0)
        assert "dvc repro train" in refused.value.remedy


def test_a_worker_without_the_commands_folder_takes_the_checkout_of_its_own_code(tmp_path, monkeypatch):
    def loaded(root, *_):
        roots.append(root)
        return SimpleNamespace(library=SimpleNamespace())

    roots = []
    monkeypatch.setattr(factories, "_loaded_factory", loaded)
    (tmp_path / "params.yaml").touch()
    factories.open_factory(tmp_path, 0)
    factories.open_factory(tmp_path / "of-another-machine", 0)
    assert roots == [tmp_path, Path(factories.__file__).parents[2]]
