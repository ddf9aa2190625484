"""GAPartNet part classes of links: from the annotation, else guessed from PartNet-Mobility's semantics."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pipeline.entities.asset import PART_CLASSES
from pipeline.sources.guarded import MIB, Folder, read_json
from pipeline.sources.reasons import SourceError

FIXED_PARTS = frozenset({"line_fixed_handle", "round_fixed_handle", "slider_button", "hinge_handle", "hinge_knob"})
# Words of PartNet's part names, first match wins; (word, class of a turning part, class of a sliding one).
WORDS = (
    ("drawer", "other", "slider_drawer"),
    ("lid", "hinge_lid", "slider_lid"),
    ("cover", "hinge_lid", "slider_lid"),
    ("seat", "hinge_lid", "slider_lid"),
    ("door", "hinge_door", "other"),
    ("knob", "hinge_knob", "other"),
    ("switch", "hinge_knob", "slider_button"),
    ("button", "other", "slider_button"),
    ("handle", "hinge_handle", "other"),
    ("tray", "other", "slider_drawer"),
    ("shelf", "other", "slider_drawer"),
)


def link_classes(folder: Folder) -> dict[str, str]:
    """Return {link: part class} of link_annotation_gapartnet.json, {} where there is none."""
    name = "link_annotation_gapartnet.json"
    if not folder.has(name):
        return {}
    tree = read_json(folder, name, 16 * MIB)
    if not isinstance(tree, list):
        raise SourceError("bad_structure", name, "is no list of links")
    found = {}
    for entry in tree:
        if isinstance(entry, dict) and isinstance(entry.get("link_name"), str) and entry.get("category") in PART_CLASSES:
            found[entry["link_name"]] = str(entry["category"])
    return found


def semantics(folder: Folder) -> dict[str, str]:
    """Return {link: semantic name} of semantics.txt, whose lines are "<link> <joint> <semantic>"."""
    if not folder.has("semantics.txt"):
        return {}
    text = folder.read("semantics.txt", MIB).decode("utf-8", "replace")
    lines = (line.split() for line in text.splitlines())
    return {words[0]: words[2] for words in lines if len(words) >= 3}


def text_field(tree: Any, key: str) -> str:
    """Return a text of a JSON object, "" where there is none."""
    value = tree.get(key) if isinstance(tree, dict) else None
    return value if isinstance(value, str) else ""


def joint_class(link: str, kind: str, annotated: Mapping[str, str], named: Mapping[str, str]) -> str:
    """Return the part class of what a joint of `kind` moves."""
    if link in annotated:
        return annotated[link]
    name = named.get(link, "").lower()
    for word, turning, sliding in WORDS:
        if word in name:
            return sliding if kind == "prismatic" else turning
    return "other"


def visual_class(link: str, visual: str, annotated: Mapping[str, str], *, moves: bool) -> str:
    """Return the part class of a visual that is fixed to its body: a handle or a button, "" for the rest.

    `moves` says that the link hangs on a moving joint of its own; its class is then the joint's.
    """
    if not moves and annotated.get(link) in FIXED_PARTS:
        return annotated[link]
    return "line_fixed_handle" if visual.lower().startswith("handle") and link not in annotated else ""
