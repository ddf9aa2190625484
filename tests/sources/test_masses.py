"""What models weigh: within the range of their category, whatever their mesh; the library's own without being held to it, most of them."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline import taxonomy
from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.corpus.future_writer import write_future
from pipeline.corpus.partnet_writer import write_partnet
from pipeline.sources.articulated import assets as articulated
from pipeline.sources.articulated.partnet import read_shape
from pipeline.sources.guarded import Folder
from pipeline.sources.rows import clamp_mass, mass, mass_factor
from pipeline.sources.settings import ModelLimits
from pipeline.sources.threed_front.future import read_model, read_model_info


@pytest.fixture(scope="module")
def read(tmp_path_factory):
    """The second model of each category of both libraries, through the files and back."""
    library, words, root = catalogue(3), taxonomy.load(), tmp_path_factory.mktemp("library")
    still, moving = ({m.category: m for m in models[1::2]}.values() for models in (library.future, library.partnet))
    write_future(list(still), root / "future")
    write_partnet(list(moving), root / "partnet")
    infos, _ = read_model_info(Folder.at(root / "future"), "model_info.json")
    made = [read_model(Folder.at(root / "future"), infos[m.model_id], ModelLimits(), "CC0-1.0").asset for m in still]
    for model in moving:
        shape = read_shape(Folder.at(root / "partnet" / model.model_id), model.model_id, 64)
        made.append(next(articulated.assets(shape, model.model_id, (model.category,), words, ModelLimits(), "CC0-1.0"))[0])
    return made


def test_every_range_is_one():
    assert all(0 < c.mass[0] < c.mass[1] for c in taxonomy.load().categories.values())


def test_what_is_held_weighs_what_such_things_weigh(read):
    for asset in read:
        low, high = taxonomy.load().categories[asset.category].mass
        made, by = clamp_mass(asset)
        assert low * 0.999 <= mass(made) <= high * 1.001, (asset.category, mass(made))
        assert by == pytest.approx(mass_factor(asset.category, mass(asset)))
        if by != 1.0:
            assert np.allclose(made.links[0].inertia, asset.links[0].inertia * by)


def test_few_have_to_be_held(read):
    outside = [(a.category, round(mass(a), 2)) for a in read if mass_factor(a.category, mass(a)) != 1.0]
    assert len(outside) < 0.1 * len(read), outside


def test_ten_times_too_heavy_and_too_light(read):
    for by in (0.01, 100.0):
        wrong = replace(read[0], links=tuple(replace(k, mass=k.mass * by, inertia=k.inertia * by) for k in read[0].links))
        low, high = taxonomy.load().categories[wrong.category].mass
        assert mass(clamp_mass(wrong)[0]) == pytest.approx(low if by < 1 else high, rel=1e-4)
