"""Which joints wait for others, from geometry alone."""

from pipeline import taxonomy
from pipeline.corpus.furniture.assembly import shape_of
from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.corpus.partnet_writer import write_partnet
from pipeline.geometry.prerequisites import find_prerequisites, with_prerequisites
from pipeline.sources.articulated.assets import assets
from pipeline.sources.articulated.partnet import read_shape
from pipeline.sources.guarded import Folder
from pipeline.sources.settings import ModelLimits
from tests.geometry.furniture import inner_drawer


def test_a_drawer_waits_for_the_door_before_it():
    assert find_prerequisites(inner_drawer()) == [(), (0,)]
    assert find_prerequisites(inner_drawer(outer=True)) == [(), ()]
    assert [j.after for j in with_prerequisites(inner_drawer()).joints] == [(), ("door",)]


def test_what_an_open_door_does_not_help_waits_for_nothing():
    assert find_prerequisites(inner_drawer(angle=0.3)) == [(), ()]  # the door is still in the way when it is open


def test_the_catalogue_says_the_same(tmp_path):
    """What the builders declare is found again in their files; a key under a flap can travel, it only cannot be reached."""
    by_form = {(m.category, m.form): m for m in catalogue(0).partnet}
    write_partnet(tuple(by_form.values()), tmp_path)
    declared = 0
    for model in by_form.values():
        movers = shape_of(model).movers
        names = {mover.name: f"joint_{k}" for k, mover in enumerate(movers)}
        read = read_shape(Folder.at(tmp_path / model.model_id), model.model_id, 64)
        asset = next(assets(read, model.model_id, (model.category,), taxonomy.load(), ModelLimits(), ""))[0]
        joints = {joint.name: joint for joint in asset.joints}
        for mover in movers:
            if mover.part_class != "slider_button":
                after = joints[names[mover.name]].after
                assert set(after) == {names[name] for name in mover.after}, (model.model_id, mover.name)
                declared += bool(after)
    assert declared >= 3
