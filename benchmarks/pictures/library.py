"""The furniture library in pictures and figures: path-traced contact sheets, and the counts of docs/library.md.

python benchmarks/pictures/library.py FOLDER [--only beds,chairs,counts] [--count 30] [--spp 24] [--cell 200] [--seed 0]

One sheet per group of categories goes to FOLDER/images; the tables between the two marks of FOLDER/library.md are made anew.
All models are written as their files, read back as any 3D-FUTURE model or PartNet-Mobility object is, and rendered; of models
that open (the sheets open_*) two pictures stand side by side, closed and open.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from PIL import Image

from pipeline import taxonomy
from pipeline.corpus.furniture.assembly import shape_of
from pipeline.corpus.furniture.catalogue import Catalogue, Model, catalogue
from pipeline.corpus.furniture.shape import colliders
from pipeline.corpus.future_writer import write_future
from pipeline.corpus.partnet_writer import write_partnet
from pipeline.entities.asset import PART_CLASSES, Asset
from pipeline.preview.sheet import contact_sheet
from pipeline.preview.showroom import portrait
from pipeline.sources.articulated import assets as articulated
from pipeline.sources.articulated.partnet import read_shape
from pipeline.sources.guarded import Folder
from pipeline.sources.settings import ModelLimits
from pipeline.sources.threed_front.future import read_model, read_model_info

MARKS = ("<!-- counts: made by benchmarks/pictures/library.py -->\n", "<!-- end of counts -->\n")
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


def chosen(models: Sequence[Model], categories: Sequence[str], count: int) -> list[Model]:
    """Take about `count` models of the categories in turn: first one of each form, styles as different as they come."""
    queues = []
    for category in categories:
        mine = [m for m in models if m.category == category]
        seen: set[str] = set()
        first = [m for m in mine if m.form not in seen and not seen.add(m.form)]  # type: ignore[func-returns-value]
        queues.append(first + [m for m in mine if m not in first])
    made: list[Model] = []
    share = {
        c: max(1, round(count * len([m for m in models if m.category == c]) / len([m for m in models if m.category in categories])))
        for c in categories
    }
    for category, queue in zip(categories, queues, strict=True):
        made += queue[: share[category]]
    return made[:count]


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
        made = []
        for model in models:
            shape = read_shape(Folder.at(Path(name) / model.model_id), model.model_id, ModelLimits().max_texture)
            made.append(next(articulated.assets(shape, model.model_id, (model.category,), taxonomy.load(), ModelLimits(), "CC0-1.0"))[0])
        return made


def pictures(name: str, given: argparse.Namespace) -> list[tuple[str, Image.Image]]:
    """Render the models of one sheet, each with its caption."""
    library = catalogue(given.seed)
    made = []
    if name in OPEN_SHEETS:
        models = chosen(library.partnet, OPEN_SHEETS[name], given.count // 2)
        for model, asset in zip(models, articulated_assets(models), strict=True):
            words = (f"{model.category}: {model.form}".replace("_", " "), model.style)
            made += [(text, portrait(asset, given.cell, given.spp, at)) for text, at in zip(words, (0.0, OPEN), strict=True)]
        return made
    models = chosen(library.future, SHEETS[name], given.count)
    for model, asset in zip(models, assets(models), strict=True):
        hangs = taxonomy.load().categories[model.category].mount == "wall"
        made.append((caption(model), portrait(asset, given.cell, given.spp, on_wall=hangs)))
    return made


def caption(model: Model) -> str:
    """Return what a model is, in words."""
    return f"{model.category} {model.form}, {model.style}".replace("_", " ")


def counts(library: Catalogue) -> str:
    """Return the library's counts as Markdown."""
    everything = (*library.future, *library.partnet)
    supers = {c: entry.super for c, entry in taxonomy.load().categories.items()}
    of = {kind: Counter(m.category for m in models) for kind, models in (("static", library.future), ("moving", library.partnet))}
    forms = {(m.category, m.form) for m in everything}
    text = [
        (
            f"{len(everything):,} models: {len(library.future)} static ones, {len(library.partnet)} that open; {len(forms)} pairs of category and "
            f"form under {len({m.category for m in everything})} category names, {len({m.style for m in everything})} styles.\n"
        ),
        table(("super-category of 3D-FUTURE", "static models"), Counter(m.super_category for m in library.future).most_common()),
    ]
    rows = [
        (c, supers[c], of["static"][c], of["moving"][c], len({m.form for m in everything if m.category == c}))
        for c in supers
        if of["static"][c]
    ]
    text.append(table(("category", "kind", "static", "that open", "forms"), rows))
    names = Counter(m.partnet_category for m in library.partnet)
    text.append(table(("model_cat: GAPartNet's names, BathroomVanity, KitchenSink", "models"), names.most_common()))
    shapes = [shape_of(m) for m in library.partnet]
    found = Counter(mover.part_class for shape in shapes for mover in shape.movers)
    for shape in shapes:
        found.update(part for mover in shape.movers for part in {p.name: p.part for p in mover.pieces if p.part}.values())
    text.append(table(("part class", "parts"), [(name, found[name]) for name in PART_CLASSES[:9]]))
    text.append(table(("", "static", "that open"), figures(library)))
    return "\n".join(text)


def figures(library: Catalogue) -> list[tuple[str, str, str]]:
    """Return triangles and convex pieces of all models, and what it costs to build and write every sixth."""
    columns = []
    for models, write in ((library.future, write_future), (library.partnet, write_partnet)):
        shapes = [shape_of(m) for m in models]
        triangles = [sum(len(p.solid.triangles()) for p in s.pieces()) for s in shapes]
        hulls = [len(colliders(s.base)) + sum(len(colliders(m.pieces)) for m in s.movers) for s in shapes]
        some = models[::6]
        shape_of.cache_clear()
        with tempfile.TemporaryDirectory() as name:
            start = time.process_time()
            write(some, Path(name))
            seconds = time.process_time() - start
            sizes = [(p.suffix == ".png", p.stat().st_size) for p in Path(name).rglob("*") if p.is_file()]
        columns.append(
            (
                *(f"{np.median(v):,.0f}; {max(v):,}" for v in (triangles, hulls)),
                *(f"{sum(n for image, n in sizes if image >= least) / len(some) / 1e3:.0f}" for least in (False, True)),
                f"{100 * seconds / len(some):.1f}",
            )
        )
    names = (
        "triangles: median; most",
        "convex pieces: median; most",
        "KB of files a model",
        "KB of texture in them",
        "CPU seconds for 100 models",
    )
    return list(zip(names, *columns, strict=True))


def table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(str(cell).replace("_", " ") for cell in line) + " |\n" for line in lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", default=",".join([*SHEETS, *OPEN_SHEETS, "counts"]))
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--columns", type=int, default=6)
    parser.add_argument("--spp", type=int, default=24)
    parser.add_argument("--cell", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    (given.folder / "images").mkdir(parents=True, exist_ok=True)
    for name in given.only.split(","):
        if name == "counts":
            page = given.folder / "library.md"
            before, _, rest = page.read_text(encoding="utf-8").partition(MARKS[0])
            page.write_text(before + MARKS[0] + counts(catalogue(given.seed)) + MARKS[1] + rest.partition(MARKS[1])[2], encoding="utf-8")
            continue
        start = time.process_time()
        made = pictures(name, given)
        sheet = contact_sheet(made, given.columns, given.cell)
        path = given.folder / "images" / f"library_{name}.png"
        sheet.quantize(256, dither=Image.Dither.NONE).save(path, optimize=True)
        print(f"{path}: {len(made)} pictures, {path.stat().st_size / 1e6:.2f} MB, {time.process_time() - start:.0f} CPU s", flush=True)


if __name__ == "__main__":
    main()
