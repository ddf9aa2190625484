"""Why something was left out, repaired or set aside: the reason codes of the readers, and the rows that carry them."""

from __future__ import annotations

from typing import Any

from pipeline.entities.reason import Reason
from pipeline.errors import ContentError

Row = dict[str, Any]

# A quarantined file or folder is not used at all; a dropped thing is missing from the tables, the rest of its file is
# used; a repaired thing is in the tables, and the row says what was changed.
REASONS: dict[str, Reason] = {
    # files
    "unsafe_path": Reason("house, model", "quarantined", "a path that leaves the folder: absolute, `..`, a scheme, or a link to elsewhere"),
    "missing_file": Reason("house, model", "quarantined", "a file that is needed is not there or is no regular file"),
    "too_large": Reason("house, room, model", "quarantined", "the file, or a count in it, is beyond the reader's limits"),
    "not_json": Reason("house, model", "quarantined", "the content is not JSON: empty, truncated, gzip, HTML, NaN, too deep"),
    "bad_structure": Reason("house, model", "quarantined", "the JSON lacks what the format promises, or has it in another type"),
    "not_obj": Reason("model", "quarantined", "the mesh file cannot be read: empty, truncated, bad numbers or indices, no faces"),
    "not_urdf": Reason("model", "quarantined", "the URDF is not XML, has a DTD or entities, or is not a tree of links"),
    "bad_number": Reason("house, model, object", "dropped", "a number that is not finite or not a number (of a file: quarantined)"),
    "out_of_time": Reason("house, model", "quarantined", "reading took more processor time than a file may cost (preprocess.budget)"),
    "out_of_memory": Reason("house, model", "quarantined", "reading took more memory than a file may cost (preprocess.budget)"),
    "reader_died": Reason("house, model", "quarantined", "the process that read the file ended, and so did others that tried again"),
    "internal": Reason("house, model", "quarantined", "the reader failed in a way it does not know; please report it"),
    # houses
    "no_rooms": Reason("house", "dropped", "no usable room is left"),
    "no_objects": Reason("house", "dropped", "no usable object is left in any room"),
    "uid_mismatch": Reason("house", "repaired", "the uid in the file is not the file's name; the name is used"),
    "duplicate_house": Reason(
        "house", "dropped", "the same uid, floors and furniture as those of a house before it, in a file of another name"
    ),
    "duplicate_record": Reason("house", "repaired", "several furniture or mesh records share a uid; the first is used"),
    # rooms
    "no_floor": Reason("room", "dropped", "no floor mesh with an area (the pseudo-room OtherRoom, most often)"),
    "too_small": Reason("room", "dropped", "floor area below `min_room_area`"),
    "duplicate_room": Reason("room", "dropped", "a room on the same floor was read before in this house"),
    "unknown_room_type": Reason("room", "repaired", "the room type is not in the taxonomy; it gets no layout type"),
    "floor_pieces": Reason("room", "repaired", "the floor has several pieces or holes; the largest outline is used"),
    "area_mismatch": Reason("room", "repaired", "the floor's area is not the room's `size` in the file; the floor is used"),
    # objects
    "dangling_ref": Reason(
        "room", "dropped", "children that refer to nothing (decor that was never released); one row per room, with the count"
    ),
    "built_in": Reason(
        "room", "dropped", "fixed parts without a model: curtains, pipes (doors and windows become openings); one row per room"
    ),
    "invalid_flag": Reason("object", "dropped", "the furniture record says `valid: false`"),
    "unknown_category": Reason("object, model", "dropped", "no category of the taxonomy for it"),
    "no_model_info": Reason("model", "dropped", "the model's folder has no entry in model_info.json, and no house says what it is"),
    "category_inferred": Reason(
        "object, model",
        "repaired",
        "model_info.json names no category, or one that cannot be where it stands; the houses' records do, or the size within its super-category decides",
    ),
    "unknown_name": Reason("model", "repaired", "a style or material that the taxonomy does not list; left empty"),
    "missing_model": Reason("object", "dropped", "its model is not among the assets (missing, or rejected itself)"),
    "size_from_bbox": Reason(
        "object, room", "repaired", "no model; size from the declared box (`keep_without_model`, or the peers' rooms)"
    ),
    "bad_scale": Reason("object", "dropped", "a component of scale is about 0 or above `max_scale`"),
    "bad_size": Reason("object, model", "dropped", "the box is flat, or larger than any furniture"),
    "tilted": Reason("object", "dropped", "turned about another axis than the vertical, or upside down"),
    "bad_height": Reason("object", "dropped", "reaches below the floor or above `max_top`"),
    "outside_room": Reason("object", "dropped", "less than `min_inside` of its footprint lies in the room"),
    "other_room": Reason("object", "repaired", "filed under another room than the one in which it lies; it is in the latter"),
    "not_placed": Reason("object", "dropped", "a furniture record, valid or not, that no room of the file refers to"),
    "duplicate": Reason("object, model", "dropped", "the same model at the same pose was read before"),
    "overlap": Reason("object", "dropped", "shares more than `max_overlap` of its volume with a larger object"),
    "no_support": Reason("object", "dropped", "a small thing whose support was left out: it would hang in the air"),
    "mirrored": Reason(
        "object", "repaired", "mirrored scale: the model's mirror image stands there, an asset of its own whose id ends in `_mirrored`"
    ),
    "centimetres": Reason("model", "repaired", "the model is not in metres; scaled once, by 0.01 or 100, for all its placements"),
    # openings
    "opening_unresolved": Reason(
        "opening",
        "dropped",
        "door, window or hole that lies at no room; a threshold without a door above it; a leaf drawn open, away from any door",
    ),
    # models
    "missing_texture": Reason("model", "repaired", "a texture or material file is missing or unreadable; plain colour instead"),
    "colliders_capped": Reason("model", "repaired", "more pieces than `max_pieces`; the smallest have no collider"),
    "hull_collider": Reason(
        "model",
        "repaired",
        "parts that are not convex and that were not cut (see `cut`, or an object of very many parts) collide as their convex hulls",
    ),
    "looks_differ": Reason("model", "repaired", "the URDF for looks does not have the annotated one's bodies in its places; not used"),
    "looks_from_colliders": Reason("model", "repaired", "a body without visual meshes that can be read shows its collision meshes"),
    "base_made": Reason("model", "repaired", "a door without a frame: a post along its hinge is made to be its base"),
    "part_box_refused": Reason("model", "repaired", "the annotated box of a part is no box; that of its geometry is used"),
    "inertial_used": Reason("model", "repaired", "a body weighs what the URDF says of it, not what its volume does at a usual density"),
    "mass_used": Reason(
        "model", "repaired", "a body weighs what the URDF says; its inertia there is a placeholder, that of its volume is used"
    ),
    "refitted": Reason(
        "model",
        "repaired",
        "drawn open, lying, along its depth or of unusual proportions: folded, turned or scaled as its category is built",
    ),
    "inertial_refused": Reason(
        "model",
        "repaired",
        "the URDF's mass or inertia of a body cannot be: not positive, moments that no body has, a mass beyond all densities",
    ),
    "angle_snapped": Reason("model", "repaired", "angles that are nearly right ones, such as 1.565, are taken as right"),
    "missing_mesh": Reason("model", "repaired", "a mesh file that the URDF names is missing; the rest is used"),
    "no_metric_fit": Reason("model", "dropped", "no scale makes it fit the sizes of a category that it may serve as"),
    "no_base": Reason("model", "dropped", "the root body has no geometry"),
    # the peers' cached format
    "bad_boxes": Reason("room", "quarantined", "boxes.npz is unreadable, lacks an array, or needs pickle, which is never loaded"),
    "peers_filter": Reason(
        "room", "dropped", "`sfgen peers` left the room out: one of the peers' filters, or nothing of their classes in it"
    ),
    "peers_class": Reason("room", "dropped", "objects that the peers have no class for; the room is written without them"),
    # joints
    "joint_unsupported": Reason("joint", "repaired", "planar, floating or unknown joint: taken as fixed"),
    "joint_no_range": Reason("joint", "repaired", "limits are missing or leave no range: taken as fixed"),
    "joint_limits_found": Reason("joint", "repaired", "limits are missing or leave no range: those of mobility_v2.json are used"),
    "joint_flipped_limits": Reason("joint", "repaired", "lower above upper: exchanged"),
    "joint_rest_shifted": Reason("joint", "repaired", "0 is not within the limits, or a door or lid is drawn open: it is closed at rest"),
    "joint_mimic": Reason("joint", "repaired", "a joint that the URDF lets follow another one: it moves by itself"),
    "joint_moves_nothing": Reason("joint", "repaired", "a joint to a body without geometry: left out"),
    "screw_collapsed": Reason("joint", "repaired", "two joints through an empty helper link: the one by which the part is used is kept"),
}


class SourceError(ContentError):
    """A file of a source that is refused: `code` is its reason, `where` its path relative to the source."""

    def __init__(self, code: str, where: str, detail: str) -> None:
        self.code, self.where, self.detail = code, where, detail
        super().__init__(f"{where}: {detail} [{code}]", "fetch the file again, or leave it out; docs/reasons.md explains the code")

    def __reduce__(self) -> tuple[type[SourceError], tuple[str, str, str]]:
        """Pickle by the arguments, so that the error crosses process borders."""
        return type(self), (self.code, self.where, self.detail)


def reject(what: str, where: str, reason: str, detail: str = "") -> Row:
    """Return a row of the rejects table. Raises KeyError for a code that REASONS lacks."""
    REASONS[reason]  # a typo must not reach the table
    return {"what": what, "where": where, "reason": reason, "detail": "".join(c if c.isprintable() else " " for c in detail[:240])}
