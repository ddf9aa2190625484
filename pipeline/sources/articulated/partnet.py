"""PartNet-Mobility and GAPartNet folders to articulated shapes without a metric size.

PartNet's world (z up, front -x) to ours (z up, front -y): (x, y, z) = (-Y, X, Z). The URDF's first fixed joint turns
the mesh frame (y up, front +z) into that world, so mesh (x, y, z) ends as ours (x, -z, y).
"""

from collections.abc import Mapping, Sequence

import numpy as np

from pipeline.sources.articulated.part_boxes import complete_shape
from pipeline.sources.articulated.part_classes import annotated_links, mobility, semantics, text_field
from pipeline.sources.articulated.shape import ArticulatedShape
from pipeline.sources.articulated.shape_reader import Hints, ShapeReader
from pipeline.sources.articulated.urdf import MAX_URDF, parse_urdf
from pipeline.sources.guarded import MIB, Folder, read_json

# By preference: joints and parts from GAPartNet's re-cut file, else from the original.
URDFS = (("mobility_annotation_gapartnet.urdf", "gapartnet"), ("mobility.urdf", "partnet-mobility"))
LOOKS = "mobility_texture_gapartnet.urdf"  # the original meshes with their textures
FROM_PARTNET = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def read_shape(folder: Folder, source_id: str, texture_limit: int, known: Sequence[str] = ()) -> ArticulatedShape:
    """Read the folder of one object. Raises SourceError for what cannot be used.

    Without a category in meta.json it is that of the `known` model categories which the semantics tell.
    """
    words = semantics(folder)
    model_cat = _model_cat(folder, words, known)
    name, source = next(((n, s) for n, s in URDFS if folder.has(n)), ("", ""))
    if not name:
        for candidate, _ in URDFS:
            folder.path(candidate)  # says what is wrong with a link or a pipe of that name
    urdf = parse_urdf(folder.read(name, MAX_URDF), name)
    annotated, odd = annotated_links(folder) if source == "gapartnet" else ({}, [])
    links = {link: word for link, (_, word) in words.items()} if not annotated else {}
    # Links are numbered anew where GAPartNet cut them anew, so PartNet's own words and joints are of the plain URDF only.
    entries = mobility(folder) if source == "partnet-mobility" else {}
    looks = parse_urdf(folder.read(LOOKS, MAX_URDF), LOOKS) if source == "gapartnet" and folder.has(LOOKS) else None
    reader = ShapeReader(folder, "", urdf, FROM_PARTNET, Hints(annotated, links, entries, looks), texture_limit)
    reader.notes += [("model", "part_box_refused", f"{link}: no box of eight corners in order") for link in odd]
    return complete_shape(reader.shape(source, source_id, model_cat))


def _model_cat(folder: Folder, words: Mapping[str, tuple[str, str]], known: Sequence[str]) -> str:
    """Return the model category: of meta.json, else the known one that names the body, as in "oven_body", or the folder."""
    if folder.has("meta.json"):
        model_cat = text_field(read_json(folder, "meta.json", MIB), "model_cat")
        if model_cat:
            return model_cat
    bodies = [word.lower().removesuffix("_body") for _, word in words.values() if word.lower().endswith("_body")]
    by_body = {_plain(word): "StorageFurniture" if word == "furniture" else "" for word in bodies}
    by_name = {_plain(category): category for category in known}
    above = [_plain(part) for part in reversed(folder.root.parts[-4:])]
    return next((by_name[w] for w in (*by_body, *above) if w in by_name), next((c for c in by_body.values() if c), ""))


def stated_category(folder: Folder) -> str:
    """Return the category of ours that meta.json states beside PartNet's (`category`), "" where nobody has said which it is."""
    return text_field(read_json(folder, "meta.json", MIB), "category") if folder.has("meta.json") else ""


def _plain(name: str) -> str:
    return "".join(c for c in name.lower() if c.isalnum())
