"""The furniture library in pictures: path-traced contact sheets.

python benchmarks/pictures/library.py FOLDER [--only sofas,chairs] [--count 30] [--spp 24] [--cell 200] [--seed 0]

One sheet per group of categories goes to FOLDER/images. All models are written as their files, read back as any 3D-FUTURE model or
PartNet-Mobility object is, and rendered; of models that open (the sheets open_*) two pictures stand side by side, closed and open.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from PIL import Image

from pipeline import taxonomy
from pipeline.corpus.furniture.catalogue import Model, catalogue
from pipeline.corpus.future_writer import write_future
from pipeline.corpus.partnet_writer import write_partnet
from pipeline.entities.asset import Asset
from pipeline.preview.sheet import contact_sheet
from pipeline.preview.showroom import portrait
from pipeline.sources.articulated import assets as articulated
from pipeline.sources.articulated.partnet import read_shape
from pipeline.sources.guarded import Folder
from pipeline.sources.settings import ModelLimits
from pipeline.sources.threed_front.future import read_model, read_model_info

SHEETS = {
    "chairs": ("dining_chair", "lounge_chair", "dressing_chair", "chinese_chair", "barstool", "stool"),
    "sofas": ("multi_seat_sofa", "loveseat_sofa", "armchair", "l_shaped_sofa", "lazy_sofa", "chaise_longue_sofa"),
    "cabinets": (
        "bookshelf",
        "shelf",
        "sideboard",
        "tv_stand",
        "wardrobe",
        "nightstand",
        "cabinet",
        "wine_cabinet",
        "children_cabinet",
        "shoe_cabinet",
    ),
}
OPEN_SHEETS = {
    "open_furniture": ("wardrobe", "nightstand", "cabinet", "sideboard", "desk", "tv_stand", "wine_cabinet", "shoe_cabinet"),
    "open_kitchen_bath": (
        *("kitchen_cabinet", "tall_unit", "sink_cabinet", "refrigerator", "oven", "dishwasher", "microwave", "washing_machine"),
        *("toilet", "vanity", "trash_can"),
    ),
}
OPEN = 0.7  # of the range of every joint


def pick_models(models: Sequence[Model], categories: Sequence[str], count: int) -> list[Model]:
    """Take about `count` models of the categories in turn: first one of each form, styles as different as they come."""
    queues = []
    for category in categories:
        mine = [m for m in models if m.category == category]
        seen: set[str] = set()
        first = [m for m in mine if m.form not in seen and not seen.add(m.form)]  # type: ignore[func-returns-value]
        queues.append(first + [m for m in mine if m not in first])
    selection: list[Model] = []
    share = {
        c: max(1, round(count * len([m for m in models if m.category == c]) / len([m for m in models if m.category in categories])))
        for c in categories
    }
    for category, queue in zip(categories, queues, strict=True):
        selection += queue[: share[category]]
    return selection[:count]


def assets(models: Sequence[Model]) -> list[Asset]:
    """Write the models, and read them back."""
    with tempfile.TemporaryDirectory() as name:
        write_future(models, Path(name))
        folder = Folder.at(Path(name))
        infos, _ = read_model_info(folder, "model_info.json")
        return [read_model(folder, infos[m.model_id], taxonomy.load(), ModelLimits(), "CC0-1.0").asset for m in models]


def articulated_assets(models: Sequence[Model]) -> list[Asset]:
    """Write articulated models, and read each back as what it was made as."""
    with tempfile.TemporaryDirectory() as name:
        write_partnet(models, Path(name))
        loaded_assets = []
        for model in models:
            shape = read_shape(Folder.at(Path(name) / model.model_id), model.model_id, ModelLimits().max_texture)
            loaded_assets.append(
                next(articulated.assets(shape, model.model_id, (model.category,), taxonomy.load(), ModelLimits(), "CC0-1.0"))[0]
            )
        return loaded_assets


def pictures(name: str, given: argparse.Namespace) -> list[tuple[str, Image.Image]]:
    """Render the models of one sheet, each with its caption."""
    library = catalogue(given.seed)
    portraits = []
    if name in OPEN_SHEETS:
        models = pick_models(library.partnet, OPEN_SHEETS[name], given.count // 2)
        for model, asset in zip(models, articulated_assets(models), strict=True):
            words = (f"{model.category}: {model.form}".replace("_", " "), model.style)
            portraits += [(text, portrait(asset, given.cell, given.spp, at)) for text, at in zip(words, (0.0, OPEN), strict=True)]
        return portraits
    models = pick_models(library.future, SHEETS[name], given.count)
    for model, asset in zip(models, assets(models), strict=True):
        hangs = taxonomy.load().categories[model.category].mount == "wall"
        portraits.append((caption(model), portrait(asset, given.cell, given.spp, on_wall=hangs)))
    return portraits


def caption(model: Model) -> str:
    """Return what a model is, in words."""
    return f"{model.category} {model.form}, {model.style}".replace("_", " ")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", default=",".join([*SHEETS, *OPEN_SHEETS]))
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--columns", type=int, default=6)
    parser.add_argument("--spp", type=int, default=24)
    parser.add_argument("--cell", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    (given.folder / "images").mkdir(parents=True, exist_ok=True)
    for name in given.only.split(","):
        start = time.process_time()
        portraits = pictures(name, given)
        sheet = contact_sheet(portraits, given.columns, given.cell)
        path = given.folder / "images" / f"library_{name}.png"
        sheet.quantize(256, dither=Image.Dither.NONE).save(path, optimize=True)
        print(f"{path}: {len(portraits)} pictures, {path.stat().st_size / 1e6:.2f} MB, {time.process_time() - start:.0f} CPU s", flush=True)


if __name__ == "__main__":
    main()
