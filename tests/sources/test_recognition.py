import json

import pytest

from pipeline.errors import ContentError, UsageError
from pipeline.sources.articulated.source import Articulated
from pipeline.sources.registry import recognise_sources
from pipeline.sources.settings import PreprocessSettings

HOUSE = "3D-FRONT/0a1b2c3d-0000-4000-8000-0123456789ab.json"
INFO = "3D-FUTURE-model/model_info.json"


def make(root, *files):
    for name in files:
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(json.dumps({}))
    return root


def front(root):
    return make(root, HOUSE, INFO, "3D-FUTURE-model/m1/raw_model.obj")


def partnet(root):
    return make(root, "100/mobility.urdf", "100/meta.json", "200/mobility.urdf", "200/mobility_annotation_gapartnet.urdf")


def test_front_is_found_where_archives_leave_it(tmp_path):
    root = front(tmp_path / "downloads" / "unpacked")
    (tmp_path / "downloads" / "other").mkdir()
    for path in (root, root / "3D-FRONT", root / "3D-FUTURE-model", tmp_path / "downloads"):
        (found,) = recognise_sources(path)
        assert (found.key, found.root) == ("front", root)
        assert dict(found.counts) == {"houses": 1, "models": 1}
        assert "3D-FRONT-texture" in found.lacks[0]


def test_objects_are_found_and_counted(tmp_path):
    root = partnet(tmp_path / "a" / "dataset")
    for path in (root, tmp_path / "a", root / "100"):
        (found,) = recognise_sources(path)
        assert (found.key, found.root, found.parts) == ("partnet", root, ("100", "200"))
        assert dict(found.counts) == {"objects": 2, "of them with GAPartNet's parts": 1}


def test_both_may_lie_in_one_folder(tmp_path):
    front(tmp_path)
    partnet(tmp_path / "gapartnet")
    assert {s.key: s.root for s in recognise_sources(tmp_path)} == {"front": tmp_path, "partnet": tmp_path / "gapartnet"}


@pytest.mark.parametrize(("files", "path"), [
    ((HOUSE,), "."),
    ((HOUSE,), "3D-FRONT"),
    ((INFO,), "3D-FUTURE-model"),
    (("x/" + HOUSE, "y/" + INFO), "."),
    ((HOUSE.replace("3D-FRONT", "my houses"), INFO), "."),
    (("notes/readme.json",), "."),
    (("notes/readme.json",), "notes"),
])  # fmt: skip
def test_half_a_source_or_none_is_said_with_what_should_be_there(tmp_path, files, path):
    make(tmp_path, *files)
    with pytest.raises(ContentError, match="known here") as error:
        recognise_sources(tmp_path / path)
    assert "3D-FRONT/*.json beside 3D-FUTURE-model/model_info.json" in error.value.remedy


def test_a_neighbour_is_not_taken_for_the_folder_that_was_named(tmp_path):
    front(tmp_path)
    (tmp_path / "empty").mkdir()
    with pytest.raises(ContentError, match="known here"):
        recognise_sources(tmp_path / "empty")


def test_a_path_that_is_no_folder_is_a_usage_error(tmp_path):
    make(tmp_path, "file.zip")
    for path in (tmp_path / "file.zip", tmp_path / "nowhere"):
        with pytest.raises(UsageError):
            recognise_sources(path)


def test_urdfs_by_themselves_count_with_their_folders(tmp_path):
    for file in ("a/fridge.urdf", "a/b/desk.urdf", "c/x.urdf"):
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).write_text("<robot/>")
    (tmp_path / "away").mkdir()
    (tmp_path / "c" / "linked").symlink_to(tmp_path.parent)
    found = Articulated().list(tmp_path, PreprocessSettings())
    assert found.parts == ("a", "c")
    assert found.counts[0] == ("objects", 4)  # the link is one, to be refused
