"""A folder of exported homes: the library's things once, homes that refer to them; whatever has its name there is whole."""

import json
import os
import shutil
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

from pipeline.errors import UsageError
from pipeline.export.files import write_meshes
from pipeline.export.glb import scene_glb
from pipeline.export.mjcf import model_xml, scene_xml
from pipeline.export.model import Model, Scene
from pipeline.export.stage import read_asset, read_home
from pipeline.export.urdf import building_urdf, model_srdf, model_urdf, placements
from pipeline.manifest import digest, write_bytes, write_json
from pipeline.shards import TABLES, Header, shard_name
from pipeline.shards.layout import commit_path, table_path
from pipeline.tables import read

FORMATS = ("mjcf", "urdf", "glb")
HEADER = "export.json"
TEMPORARY = ".tmp-"  # how names begin of what is being written, here and in pipeline/manifest.py
REMEMBERED = 512  # models of the library that are kept in memory


def home_stages(dataset: Path, header: Header) -> dict[str, Path]:
    """Return the USD stage of each home in the committed shards of a dataset, by the home's id."""
    return {
        row["scene_id"]: dataset / row["usd"]
        for number in range(header.shards)
        if (dataset / commit_path(shard_name(number))).is_file()
        for row in read(dataset / table_path("scenes", number), TABLES["scenes"])
        if row["usd"]
    }


class ExportFolder:
    """Where homes of one dataset in one format go; a run that was killed goes on."""

    def __init__(self, path: Path, form: str, dataset: str, licence: str) -> None:
        self.path, self.form, self.licence = path, form, licence
        about = {"format": f"sfgen-{form}-1", "dataset": dataset, "licence": licence}
        if path.exists() and (not path.is_dir() or any(path.iterdir())) and _header(path) != about:
            raise UsageError(f"--out {path} holds something else than an export of this dataset to {form}", "name a new folder")
        write_json(path / HEADER, about)
        for left in path.glob(f"*/{TEMPORARY}*"):  # by a run that was killed
            shutil.rmtree(left) if left.is_dir() else left.unlink()
        self._asset = lru_cache(REMEMBERED)(read_asset)

    @classmethod
    def of_dataset(cls, path: Path, form: str, header: Header) -> "ExportFolder":
        """Return the folder `path` for homes of the dataset with this header. Raises UsageError where it holds something else."""
        return cls(path, form, digest(header.to_json()), header.licence)

    def home_file(self, scene_id: str) -> Path:
        """Return the file that a simulator or viewer opens."""
        return self.path / {"mjcf": f"homes/{scene_id}/{scene_id}.xml", "urdf": f"homes/{scene_id}/home.json"}.get(
            self.form, f"homes/{scene_id}.glb"
        )

    def read(self, stage: Path, scene_id: str) -> Scene:
        """Read a home's stage."""
        return read_home(stage, scene_id, lambda file: self._asset(file.resolve()))


def export_home(folder: ExportFolder, stage: Path, scene_id: str) -> Path:
    """Write one home, and what of the library it needs and is not there yet; returns the file to open."""
    target = folder.home_file(scene_id)
    if target.exists():
        return target
    scene = folder.read(stage, scene_id)
    if folder.form == "glb":
        write_bytes(target, scene_glb(scene, folder.licence), flush=False)
        return target
    for model in scene.models.values():
        if model.shared:
            _whole(folder.path / "assets" / model.name, lambda place, model=model: _write_asset(model, place, folder.form))  # type: ignore[misc]
    _whole(target.parent, lambda place: _write_home(scene, place, folder.form))
    return target


def _write_asset(model: Model, place: Path, form: str) -> None:
    write_meshes(model, place)
    if form == "mjcf":
        (place / f"{model.name}.xml").write_bytes(model_xml(model))
    else:
        _write_urdf(model, place / f"{model.name}.urdf", ".")


def _write_urdf(model: Model, path: Path, folder: str) -> None:
    path.write_bytes(model_urdf(model, folder))
    if model.passes:
        path.with_suffix(".srdf").write_bytes(model_srdf(model))


def _write_home(scene: Scene, place: Path, form: str) -> None:
    place.mkdir(parents=True)
    own = [model for model in scene.models.values() if not model.shared]
    for model in own:
        write_meshes(model, place / "meshes" / model.name)
    folders = {m.name: f"../../assets/{m.name}" if m.shared else f"meshes/{m.name}" for m in scene.models.values()}
    if form == "mjcf":
        (place / f"{scene.scene_id}.xml").write_bytes(scene_xml(scene, folders))
        return
    files = {}
    for placed in scene.placed:
        model = scene.models[placed.model]
        as_it_lies = model.shared and not placed.off
        files[placed.name] = f"{folders[model.name]}/{model.name}.urdf" if as_it_lies else f"{placed.name}.urdf"
        if not as_it_lies and not model.still:
            _write_urdf(model.without(placed.off), place / files[placed.name], folders[model.name])
    (place / "building.urdf").write_bytes(building_urdf(scene, folders))
    write_json(place / "home.json", placements(scene, files))


def _whole(target: Path, fill: Callable[[Path], object]) -> None:
    """Let `fill` make a folder under a name of its own, then rename it: under its name it is whole or not there."""
    if target.exists():
        return
    temporary = target.with_name(f"{TEMPORARY}{os.getpid()}-{target.name}")
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        fill(temporary)
        temporary.rename(target)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def _header(path: Path) -> object:
    with suppress(OSError, ValueError):
        return json.loads((path / HEADER).read_text(encoding="utf-8"))
    return None
