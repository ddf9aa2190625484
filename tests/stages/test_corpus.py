"""The corpus stage: whole or not at all, the same bytes for any number of workers, in the folders of the real sets."""

import json
from pathlib import Path

import pytest

from pipeline.corpus.furniture.catalogue import Catalogue, catalogue
from pipeline.corpus.house_files import CorpusSettings
from pipeline.errors import ContentError
from stages import corpus

SMALL = CorpusSettings(houses=12, models=0.1, corruption=True)


def contents(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


@pytest.fixture
def light(monkeypatch):
    """Models are a line each: what furniture looks like is tested elsewhere."""

    def write_model(model, folder, unit=1.0):
        folder.mkdir(parents=True)
        (folder / "raw_model.obj").write_text(model.model_id)

    def write_partnet(models, folder):
        for model in models:
            (folder / model.model_id).mkdir()
            (folder / model.model_id / "mobility.urdf").write_text(model.category)

    monkeypatch.setattr(corpus, "write_model", write_model)
    monkeypatch.setattr(corpus, "write_partnet", write_partnet)


def test_folders_hold_what_the_real_sets_hold(tmp_path, light):
    corpus.make(tmp_path / "raw", 3, SMALL, workers=1)
    front, models = tmp_path / "raw" / "3d-front", catalogue(3, SMALL.models)
    files = sorted((front / "3D-FRONT").glob("*.json"))
    assert len(files) == SMALL.houses
    trees = [json.loads(f.read_text()) for f in files]
    assert all(tree["uid"] == f.stem for tree, f in zip(trees, files, strict=True))
    assert {tree["code_version"] for tree in trees} == {"0.4", "0.11"}
    assert all(f.stat().st_size < 400_000 for f in files)
    info = json.loads((front / "3D-FUTURE-model" / "model_info.json").read_text())
    assert {r["model_id"] for r in info} == {m.model_id for m in models.future}
    assert {p.name for p in (front / "3D-FUTURE-model").iterdir() if p.is_dir()} == {m.model_id for m in models.future}
    assert {p.name for p in (tmp_path / "raw" / "partnet").iterdir()} == {m.model_id for m in models.partnet}
    used = {f["jid"] for tree in trees for f in tree["furniture"] if f.get("valid")}
    assert used <= {m.model_id for m in models.future}
    rooms = [r["instanceid"] for tree in trees for r in tree["scene"]["room"] if r["instanceid"] != "OtherRoom"]
    assert len(rooms) == len(set(rooms))


def test_workers_do_not_change_a_byte_and_seeds_do(tmp_path, light):
    corpus.make(tmp_path / "one", 3, SMALL, workers=1)
    corpus.make(tmp_path / "two", 3, SMALL, workers=2)
    corpus.make(tmp_path / "other", 4, SMALL, workers=2)
    assert contents(tmp_path / "one") == contents(tmp_path / "two")
    houses = {n: {p for p in contents(tmp_path / n) if "3D-FRONT/" in p} for n in ("one", "other")}
    assert not houses["one"] & houses["other"]


def test_a_run_that_fails_leaves_the_old_corpus_as_it_was(tmp_path, light, monkeypatch):
    target = tmp_path / "raw"
    corpus.make(target, 3, CorpusSettings(1, 0.1, corruption=False), workers=1)
    before = contents(target)

    def fails(*_):
        raise ContentError("no house", "another seed")

    monkeypatch.setattr(corpus, "write_houses", fails)
    with pytest.raises(ContentError):
        corpus.make(target, 4, SMALL, workers=1)
    assert contents(target) == before


def test_leftovers_of_a_killed_run_are_cleared(tmp_path, light):
    (tmp_path / ".raw.making" / "3d-front").mkdir(parents=True)
    (tmp_path / ".raw.making" / "junk").write_text("x")
    corpus.make(tmp_path / "raw", 3, CorpusSettings(1, 0.1, corruption=False), workers=1)
    assert {p.name for p in tmp_path.iterdir()} == {"raw"}
    assert {p.name for p in (tmp_path / "raw").iterdir()} == {"3d-front", "partnet"}


def test_real_models_are_written(tmp_path, monkeypatch):
    full = catalogue(0, 0.1)
    few = Catalogue(full.future[:2], full.partnet[:1])
    monkeypatch.setattr(corpus, "catalogue", lambda *_: few)
    corpus.make(tmp_path / "raw", 0, CorpusSettings(1, 0.1, corruption=True), workers=1)
    names = {Path(p).name for p in contents(tmp_path / "raw")}
    assert {"raw_model.obj", "model.mtl", "texture.png", "mobility.urdf", "link_annotation_gapartnet.json"} <= names


@pytest.mark.parametrize("bad", [{"houses": 0}, {"houses": -5}, {"models": 0.0}, {"models": 1e9}])
def test_settings_out_of_range_are_refused(bad):
    with pytest.raises(ContentError, match=f"corpus.{next(iter(bad))}"):
        CorpusSettings(**({"houses": 1, "models": 1.0, "corruption": True} | bad))


def test_main_reads_params(tmp_path, light):
    text = "seed: 1\npreset: quick\ncorpus: {houses: 2, models: 0.1, corruption: false}\npresets: {quick: {corpus: {houses: 1}}}\n"
    (tmp_path / "params.yaml").write_text(text)
    corpus.main(tmp_path)
    assert len(list((tmp_path / "data" / "raw" / "3d-front" / "3D-FRONT").glob("*.json"))) == 1
