"""Tiny folders in the formats of 3D-FRONT, 3D-FUTURE and PartNet-Mobility / GAPartNet, made by code."""

import io
import json
from pathlib import Path

import numpy as np
from PIL import Image

BED, LAMP, CHAIR, TABLE, STAND = (f"{n:08d}-1111-4222-8333-{n:012d}" for n in range(1, 6))
SIZES = {  # w, d, h in our order
    BED: (1.8, 2.2, 1.1),
    LAMP: (0.6, 0.6, 0.5),
    CHAIR: (0.5, 0.55, 0.85),
    TABLE: (1.6, 0.9, 0.75),
    STAND: (0.5, 0.4, 0.5),
}
NAMES = {BED: "King-size Bed", LAMP: "Pendant Lamp", CHAIR: "Dining Chair", TABLE: "Dining Table", STAND: "Nightstand"}


def box_obj(size, *, at=(0.0, 0.0, 0.0), mtl="model.mtl", group="solid_001", quads=True, scale=1.0, uv=True):
    """An OBJ of a box in the file frame (y up): `size` is (w, d, h), `at` the middle of its bottom."""
    w, d, h = size
    x, y, z = at
    corners = [(x + sx * w / 2, y + sy * h, z + sz * d / 2) for sx in (-1, 1) for sy in (0, 1) for sz in (-1, 1)]
    lines = [f"mtllib {mtl}"] if mtl else []
    lines += [f"v {a * scale:.6f} {b * scale:.6f} {c * scale:.6f}" for a, b, c in corners]
    if uv:
        lines += ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1"]
    lines += [f"g {group}", "usemtl plain"]
    sides = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    for side in sides:
        words = [f"{v}/{k + 1}" if uv else str(v) for k, v in enumerate(side)]
        if quads:
            lines.append("f  " + " ".join(words))
        else:
            lines += ["f " + " ".join(words[:3]), "f " + " ".join([words[0], *words[2:]])]
    return "\n".join(lines) + "\n"


def png(width=8, height=8, color=(200, 120, 40)):
    out = io.BytesIO()
    Image.new("RGB", (width, height), color).save(out, "PNG")
    return out.getvalue()


def write_model(root, jid, text=None, *, texture=None, mtl=None):
    folder = Path(root) / "3D-FUTURE-model" / jid
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "raw_model.obj").write_text(text if text is not None else box_obj(SIZES[jid]))
    (folder / "model.mtl").write_text(mtl or "newmtl plain\nKd 0.5 0.4 0.3\nmap_Kd texture.png\n")
    (folder / "texture.png").write_bytes(texture or png())
    return folder


def info(jid, category=None, **more):
    return {
        "model_id": jid,
        "super-category": "Others",
        "category": category if category is not None else NAMES.get(jid),
        "style": "Modern",
        "theme": None,
        "material": "Wood",
        **more,
    }


def write_library(root, jids=tuple(SIZES), entries=None):
    for jid in jids:
        write_model(root, jid)
    (Path(root) / "3D-FUTURE-model" / "model_info.json").write_text(json.dumps(entries or [info(j) for j in jids]))


def floor(uid, x0, z0, x1, z1, y=0.0):
    corners = [(x0, z0), (x1, z0), (x1, z1), (x0, z1)]
    xyz = [v for k in (0, 2, 1, 0, 3, 2) for v in (corners[k][0], y, corners[k][1])]
    return {
        "uid": uid,
        "jid": "",
        "aid": [],
        "type": "Floor",
        "xyz": xyz,
        "normal": [0, 1, 0] * 6,
        "uv": [None] * 12,
        "faces": list(range(6)),
    }


def slab(uid, kind, low, high):
    """A mesh of type `kind` that fills the box from `low` to `high` (file frame)."""
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])], float)
    return {"uid": uid, "type": kind, "xyz": corners.ravel().tolist(), "faces": [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5], "material": "m"}


def child(ref, instance, pos=(0, 0, 0), yaw=0.0, scale=(1, 1, 1), rot=None):
    turn = [0, round(float(np.sin(yaw / 2)), 5), 0, round(float(np.cos(yaw / 2)), 5)]
    return {"ref": ref, "instanceid": instance, "pos": list(pos), "rot": list(rot) if rot is not None else turn, "scale": list(scale)}


def chair_record(uid, jid, variant="plain", *, valid=True):
    """A furniture record of one of the variants of the release."""
    w, d, h = SIZES.get(jid, (1.0, 1.0, 1.0))
    record = {"uid": uid, "jid": jid, "aid": []}
    if variant == "plain":
        record |= {
            "size": [w, d, h],
            "sourceCategoryId": "1",
            "title": "decor/unknown",
            "type": "standard",
            "bbox": [w, d, h],
            "valid": valid,
        }
    elif variant == "nested":
        record |= {"size": [w, d, h], "sourceCategoryId": "1", "category": NAMES.get(jid, ""), "bbox": [[w, h, d]], "valid": valid}
    elif variant == "later":
        record |= {"uid": uid, "category": NAMES.get(jid, ""), "bbox": [w, h, d], "valid": valid}
    return record


def house(uid, dialect="0.11", rooms=(), furniture=(), meshes=(), doors=()):
    """A house file as a tree; `rooms` are (type, number, children)."""
    tree = {
        "uid": uid,
        "design_version": "0.1" if dialect == "0.4" else "0.11",
        "code_version": dialect,
        "north_vector": [0, 1, 0],
        "version": "2.0",
        "furniture": list(furniture),
        "mesh": list(meshes),
        "material": [],
        "extension": {"door": list(doors), "pano": [], "area": []},
        "scene": {
            "ref": "-1",
            "pos": [0, 0, 0],
            "rot": [0, 0, 0, 1],
            "scale": [1, 1, 1],
            "room": [
                {
                    "type": t,
                    "instanceid": f"{t}-{n}",
                    "pos": [0, 0, 0],
                    "rot": [0, 0, 0, 1],
                    "scale": [1, 1, 1],
                    "empty": 0,
                    "children": list(c),
                }
                for t, n, c in rooms
            ],
        },
    }
    if dialect == "0.11":
        tree |= {"jobid": "", "lights": [], "groups": [], "materialList": []}
        tree["scene"]["boundingBox"] = {"min": {"x": 0, "y": 0, "z": 9}, "max": {"x": 9, "y": 3, "z": 0}}
    return tree


def two_rooms(uid="house-a", dialect="0.11", extra=(), more_furniture=(), more_meshes=(), variant="plain"):
    """A bedroom (x 0..4, z 0..4) and a hall (x 4.12..6, z 0..4), a door between, an entrance and a window.

    The bed stands with its head at the wall z = 0, facing +z in the file.
    """
    meshes = [
        floor("f1", 0, 0, 4, 4),
        floor("f2", 4.12, 0, 6, 4),
        {**slab("c1", "Ceiling", (0, 2.8, 0), (4, 2.8, 4))},
        slab("d1", "Door", (4, 0, 1), (4.12, 2.1, 1.9)),
        slab("e1", "Hole" if dialect == "0.4" else "Door", (6, 0, 2), (6.24, 2.1, 3)),
        slab("w1", "Window", (1, 0.9, 4), (2.5, 2.2, 4.24)),
        *more_meshes,
    ]
    furniture = [
        chair_record("b/model", BED, variant),
        chair_record("s/model", STAND, variant),
        chair_record("l/model", LAMP, variant),
        {"uid": "g/model", "jid": "gone", "aid": [], **({"title": "door/single swing door"} if dialect == "0.11" else {})},
        *more_furniture,
    ]
    bedroom = [
        child("f1", "mesh/0"),
        child("c1", "mesh/1"),
        child("d1", "mesh/2"),
        child("w1", "mesh/3"),
        child("b/model", "furniture/0", (2, 0, 1.1)),
        child("s/model", "furniture/1", (3.4, 0, 0.3)),
        child("l/model", "furniture/2", (2, 2.0, 2)),
        child("g/model", "furniture/3", (4.06, 0, 1.45), np.pi / 2),
        *extra,
    ]
    hall = [child("f2", "mesh/0"), child("e1", "mesh/1")]
    doors = [{"type": "entryDoor", "roomId": "Hallway-2", "dir": "innerLeft", "ref": []}]
    return house(uid, dialect, [("MasterBedroom", 1, bedroom), ("Hallway", 2, hall)], furniture, meshes, doors)


def write_house(root, tree, name=None):
    folder = Path(root) / "3D-FRONT"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name or tree['uid']}.json"
    path.write_text(json.dumps(tree) if not isinstance(tree, (str, bytes)) else tree)
    return path


# A cabinet in PartNet's mesh frame (x right, y up, z front): a carcass with a door hinged at its left (-x) front edge
# and a drawer below it. Half extents are chosen so that the shape is of about unit size.
W, H, D = 0.9, 1.8, 0.5  # width, height, depth in units
DOOR = ((-W / 2, -0.2, D / 2), (W / 2, 0.9, D / 2 + 0.03))  # low, high corner
DRAWER = ((-W / 2, -0.9, -D / 2 + 0.05), (W / 2, -0.25, D / 2 + 0.03))
HANDLE = ((W / 2 - 0.1, 0.2, D / 2 + 0.03), (W / 2 - 0.05, 0.5, D / 2 + 0.07))


def corner_obj(low, high):
    size = (high[0] - low[0], high[2] - low[2], high[1] - low[1])
    return box_obj(size, at=((low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2), mtl="original-0.mtl", uv=False)


def write_partnet(root, name="40000", *, model_cat="StorageFurniture", gapartnet=True, joints=None, urdf=None, parts=None, **meta):
    """An object's folder, `meta` in its meta.json. `joints` replaces the XML of the two joints, `urdf` the whole file."""
    folder = Path(root) / name
    meshes = folder / "textured_objs"
    meshes.mkdir(parents=True, exist_ok=True)
    boards = parts or {
        "back": ((-W / 2, -0.9, -D / 2), (W / 2, 0.9, -D / 2 + 0.03)),
        "left": ((-W / 2, -0.9, -D / 2), (-W / 2 + 0.03, 0.9, D / 2)),
        "right": ((W / 2 - 0.03, -0.9, -D / 2), (W / 2, 0.9, D / 2)),
        "door": DOOR,
        "drawer": DRAWER,
        "handle": HANDLE,
    }
    for key, (low, high) in boards.items():
        (meshes / f"{key}.obj").write_text(corner_obj(low, high))
    (meshes / "original-0.mtl").write_text("newmtl plain\nKd 0.6 0.5 0.4\n")
    hinge = (-W / 2, 0.0, D / 2)
    xml = urdf or partnet_urdf(hinge, joints)
    (folder / ("mobility_annotation_gapartnet.urdf" if gapartnet else "mobility.urdf")).write_text(xml)
    (folder / "meta.json").write_text(json.dumps({"model_cat": model_cat, "anno_id": name, "user_id": "1", **meta}))
    (folder / "semantics.txt").write_text("link_0 hinge door\nlink_1 slider drawer\nlink_2 heavy furniture_body\n")
    if gapartnet:
        entries = [("link_0", "hinge_door"), ("link_1", "slider_drawer"), ("link_3", "line_fixed_handle"), ("link_2", "")]
        text = json.dumps([{"link_name": n, "is_gapart": bool(c), "category": c, "bbox": []} for n, c in entries])
        (folder / "link_annotation_gapartnet.json").write_text(text)
    return folder


def element(kind, key, origin=(0, 0, 0)):
    xyz = " ".join(str(-v) for v in origin)
    return f'<{kind} name="{key}-1"><origin xyz="{xyz}"/><geometry><mesh filename="textured_objs/{key}.obj"/></geometry></{kind}>'


def link_xml(name, keys, origin=(0, 0, 0)):
    return f'<link name="{name}">' + "".join(element(k, key, origin) for k in ("visual", "collision") for key in keys) + "</link>"


def partnet_urdf(hinge, joints=None):
    """World of PartNet (z up, front -x): the door turns about mesh +y at the left, the drawer slides along mesh +z."""
    moving = joints or (
        f'<joint name="joint_0" type="revolute"><child link="link_0"/><parent link="link_2"/><origin xyz="{hinge[0]} {hinge[1]} {hinge[2]}"/>'
        '<axis xyz="0 -1 0"/><limit lower="0" upper="1.57"/></joint>'
        '<joint name="joint_1" type="prismatic"><child link="link_1"/><parent link="link_2"/><origin xyz="0 0 0"/>'
        '<axis xyz="0 0 1"/><limit lower="0" upper="0.4"/></joint>'
    )
    return (
        '<?xml version="1.0"?><robot name="partnet_x"><link name="base"/>'
        + link_xml("link_0", ["door"], hinge)
        + link_xml("link_1", ["drawer"])
        + link_xml("link_2", ["back", "left", "right"])
        + link_xml("link_3", ["handle"], hinge)
        + '<joint name="joint_2" type="fixed"><origin xyz="0 0 0" rpy="1.570796326794897 0 -1.570796326794897"/>'
        '<child link="link_2"/><parent link="base"/></joint>'
        + moving
        + '<joint name="joint_3" type="fixed"><origin xyz="0 0 0"/><child link="link_3"/><parent link="link_0"/></joint></robot>'
    )
