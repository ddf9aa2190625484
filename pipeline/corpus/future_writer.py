"""Static models as 3D-FUTURE's folders: model_info.json and, per model, OBJ files, a material library and a texture.

Frame of the OBJ files ("3D-FRONT format", canonical model frame): metres, y up, front +z, bottom centre at the origin.
"""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from pipeline import seeds
from pipeline.corpus.furniture import texture, wavefront
from pipeline.corpus.furniture.assembly import main_material, shape_of
from pipeline.corpus.furniture.catalogue import Model

# 3D-FUTURE's themes that fit parametric furniture; half of the real records have none.
THEMES = ("Smooth Net", "Lines", None, None)


def write_future(models: Sequence[Model], folder: Path) -> None:
    """Write `folder` (3D-FUTURE-model): model_info.json and one folder per model."""
    folder.mkdir(parents=True, exist_ok=True)
    for model in models:
        write_model(model, folder / model.model_id)
    records = [info(model) for model in models]
    (folder / "model_info.json").write_bytes((json.dumps(records, indent=1) + "\n").encode())


def info(model: Model) -> dict[str, str | None]:
    """Return the record of a model in model_info.json."""
    return {
        "model_id": model.model_id,
        "super-category": model.super_category,
        "category": model.future_name,
        "style": model.style,
        "theme": THEMES[model.seed % len(THEMES)],
        "material": main_material(model),
    }


def write_model(model: Model, folder: Path, unit: float = 1.0) -> None:
    """Write one model's folder: raw_model.obj, normalized_model.obj (centred, longest side 1), model.mtl, texture.png.

    `unit`: 1 writes metres; 100 makes one of those models that are in centimetres.
    """
    folder.mkdir(parents=True, exist_ok=True)
    shape = shape_of(model)
    sheet = texture.atlas(shape.pieces())
    groups = wavefront.group_by_finish(shape.pieces(), "solid_{:03d}")
    text = wavefront.text(groups, "model.mtl", sheet)
    w, d, h = model.size
    (folder / "raw_model.obj").write_bytes(text.obj(unit))
    (folder / "normalized_model.obj").write_bytes(text.obj(1 / max(w, d, h), np.array([0.0, -h / 2, 0.0])))
    (folder / "model.mtl").write_bytes(wavefront.mtl(groups, "./texture.png"))
    (folder / "texture.png").write_bytes(texture.paint(seeds.generator(model.seed, "corpus.furniture.texture"), sheet))
