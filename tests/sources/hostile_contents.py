"""Contents made to harm or to confuse, by the kind of file that they stand in, each with the reason for which it is refused."""

import gzip
import json
import struct
import zlib

from tests.sources import collada, making

GOOD = json.dumps(making.two_rooms())
HOUSES = {  # content of a house file -> reason
    "zero_bytes": (b"", "not_json"),
    "blank": (b" \n\t ", "not_json"),
    "truncated": (GOOD[: len(GOOD) // 2].encode(), "not_json"),
    "gzip": (gzip.compress(GOOD.encode()), "not_json"),
    "html": (b"<!DOCTYPE html><html><body>404</body></html>", "not_json"),
    "xml": (b"<?xml version='1.0'?><a/>", "not_json"),
    "binary": (bytes(range(256)) * 64, "not_json"),
    "utf16": (GOOD.encode("utf-16"), "not_json"),
    "latin1": (b'{"uid": "\xe9"}', "not_json"),
    "nan": (GOOD.replace("2.8", "NaN", 1).encode(), "not_json"),
    "infinity": (GOOD.replace("2.8", "-Infinity", 1).encode(), "not_json"),
    "deep_lists": (b"[" * 100_000, "not_json"),
    "deep_objects": (b'{"a":' * 100_000 + b"1" + b"}" * 100_000, "not_json"),
    "many_lists": (b"[" + b"[]," * 3_000_000 + b"[]]", "too_large"),
    "many_numbers": (b"[" + b"0," * 12_000_000 + b"0]", "too_large"),
    "long_integer": (b'{"uid": ' + b"9" * 100_000 + b"}", "not_json"),
    "list": (b"[1, 2]", "bad_structure"),
    "number": (b"7", "bad_structure"),
    "null": (b"null", "bad_structure"),
    "no_scene": (b'{"uid": "house-a"}', "bad_structure"),
    "scene_text": (b'{"scene": "x"}', "bad_structure"),
    "trailing": (GOOD.encode() + b"}", "not_json"),
    "two_documents": (GOOD.encode() + GOOD.encode(), "not_json"),
    "nul_bytes": (b"\x00" * 4096, "not_json"),
}


def crowded(**more):
    tree = making.two_rooms()
    tree |= {k: tree[k] + v for k, v in more.items() if k in tree}
    tree["scene"]["room"] += more.get("rooms", [])
    tree["scene"]["room"][0]["children"] += more.get("children", [])
    return json.dumps(tree).encode()


LONG_HOLE = making.slab("", "Window", (0, 1, 0), (1, 2, 0.1))
HOUSES |= {
    "many_rooms": (crowded(rooms=[{"type": "Bedroom", "instanceid": f"Bedroom-{k}"} for k in range(5000)]), "too_large"),
    "many_children": (crowded(children=[{"ref": "x", "instanceid": ""}] * 30_000), "too_large"),
    "many_holes": (crowded(mesh=[{**LONG_HOLE, "uid": f"h{k}"} for k in range(3000)]), "too_large"),
}

HEAD = '<robot name="r">'
BILLION = "".join(f'<!ENTITY l{k} "{f"&l{k - 1};" * 10}">' for k in range(1, 10))
URDFS = {  # content of a URDF -> reason
    "zero_bytes": ("", "not_urdf"),
    "truncated": (making.partnet_urdf((0, 0, 0))[:500], "not_urdf"),
    "html": ("<!DOCTYPE html><html></html>", "not_urdf"),
    "other_root": ("<sdf/>", "not_urdf"),
    "billion_laughs": (f'<!DOCTYPE r [<!ENTITY l0 "lol">{BILLION}]><robot>&l9;</robot>', "not_urdf"),
    "external_entity": ('<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><robot name="&x;"/>', "not_urdf"),
    "external_dtd": ('<!DOCTYPE r SYSTEM "http://localhost/x.dtd"><robot/>', "not_urdf"),
    "parameter_entity": ('<!DOCTYPE r [<!ENTITY % x SYSTEM "file:///etc/passwd"> %x;]><robot/>', "not_urdf"),
    "undefined_entity": ("<robot>&nothing;</robot>", "not_urdf"),
    "many_elements": (HEAD + "<link/>" * 200_000 + "</robot>", "too_large"),
    "deep_elements": ("<robot>" + "<a>" * 90_000, "not_urdf"),
    "no_geometry": ("<robot><link name='a'/></robot>", "no_base"),
    "nan_origin": (making.partnet_urdf((float("nan"), 0, 0)), "bad_number"),
    "absurd_limit": (making.partnet_urdf((0, 0, 0)).replace('upper="1.57"', 'upper="1e400"'), "bad_number"),
    "nan_axis": (making.partnet_urdf((0, 0, 0)).replace("0 -1 0", "nan 0 0"), "bad_number"),
    "loop": (making.partnet_urdf((0, 0, 0)).replace('<parent link="base"/>', '<parent link="link_0"/>'), "not_urdf"),
    "package": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "package://../../secret.obj"), "unsafe_path"),
    "file_scheme": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "file:///etc/passwd"), "unsafe_path"),
    "http": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "http://localhost/x.obj"), "unsafe_path"),
    "absolute": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "/etc/passwd"), "unsafe_path"),
    "absolute_obj": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "/tmp/x.obj"), "unsafe_path"),
    "parent": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "../../secret.obj"), "unsafe_path"),
    "backslash_parent": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "..\\..\\secret.obj"), "unsafe_path"),
    "home": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "~/secret.obj"), "unsafe_path"),
    "long_path": (making.partnet_urdf((0, 0, 0)).replace("textured_objs/back.obj", "a" * 5000 + ".obj"), "unsafe_path"),
    "huge_scale": (making.partnet_urdf((0, 0, 0)).replace('back.obj"', 'back.obj" scale="1e300 1 1"'), "bad_number"),
}

BOX = making.box_obj((1.8, 2.2, 1.1))
OBJS = {  # content of raw_model.obj -> reason
    "zero_bytes": (b"", "not_obj"),
    "truncated": (BOX[:100].encode(), "not_obj"),
    "gzip": (gzip.compress(BOX.encode()), "not_obj"),
    "html": (b"<html></html>", "not_obj"),
    "nan": (BOX.replace("0.900000", "nan", 1).encode(), "bad_number"),
    "1e400": (BOX.replace("0.900000", "1e400", 1).encode(), "bad_number"),
    "index_beyond": (BOX.encode() + b"f 1 2 99999999\n", "not_obj"),
    "index_zero": (BOX.encode() + b"f 0 1 2\n", "not_obj"),
    "index_huge": (BOX.encode() + b"f 1 2 " + b"9" * 400 + b"\n", "not_obj"),
    "many_vertices": (b"v 0 0 0\n" * 1_500_000 + b"f 1 2 3\n", "too_large"),
    "many_uvs": (BOX.encode() + b"vt 0 0\n" * 4_000_000, "too_large"),
    "many_groups": (BOX.encode() + b"".join(b"g %d\nf 1 2 3\n" % k for k in range(5000)), "too_large"),
    "one_long_face": (BOX.encode() + b"f" + b" 1" * 4_000_000 + b"\n", "too_large"),
    "binary": (bytes(range(256)) * 64, "not_obj"),
    "library_outside": (BOX.replace("model.mtl", "../../../etc/passwd").encode(), "unsafe_path"),
    "library_absolute": (BOX.replace("model.mtl", "/etc/passwd").encode(), "unsafe_path"),
}

TENTHS = range(1, 10)
HOUSES |= {f"truncated_at_{k}0_percent": (GOOD[: len(GOOD) * k // 10].encode(), "not_json") for k in TENTHS}
HOUSES |= {
    "gzip_truncated": (gzip.compress(GOOD.encode())[:30], "not_json"),
    "a_million_digits": (b'{"uid": ' + b"9" * 1_000_000 + b"}", "not_json"),
    "scene_is_a_number": (b'{"uid": "house-a", "scene": 1e400}', "bad_structure"),
    "surrogate": (b'{"uid": "\xed\xa0\x80"}', "not_json"),
    "long_string": (b'{"uid": "' + b"a" * 20_000_000 + b'"}', "bad_structure"),
}

URDF = making.partnet_urdf((0, 0, 0))
CHAIN = "".join(
    f'<link name="c{k}"/><joint name="k{k}" type="revolute"><parent link="{f"c{k - 1}" if k else "link_2"}"/><child link="c{k}"/>'
    f'<origin xyz="1000 0 0"/><axis xyz="0 0 1"/><limit lower="0" upper="1"/></joint>'
    for k in range(999)
)
URDFS |= {f"truncated_at_{k}0_percent": (URDF[: len(URDF) * k // 10], "not_urdf") for k in TENTHS}
URDFS |= {
    "quadratic_entities": (f'<!DOCTYPE r [<!ENTITY a "{"a" * 50_000}">]><robot>{"&a;" * 50_000}</robot>', "not_urdf"),
    "a_million_links": (HEAD + '<link name="a"/>' * 400_000 + "</robot>", "too_large"),
    "a_thousand_links": (HEAD + "".join(f'<link name="a{k}"/>' for k in range(1001)) + "</robot>", "too_large"),
    "kilometres_of_joints": (URDF.replace("</robot>", CHAIN + "</robot>"), "too_large"),
    "long_attribute": (HEAD + f'<link name="{"a" * 5_000_000}"/><link name="b"/></robot>', "not_urdf"),
    "many_shapes": (HEAD + '<link name="a">' + "<visual/>" * 6000 + "</link></robot>", "too_large"),
    "joint_to_itself": (HEAD + '<link name="a"/><joint name="j"><parent link="a"/><child link="a"/></joint></robot>', "not_urdf"),
    "unknown_encoding": ('<?xml version="1.0" encoding="no-such"?>' + URDF[21:], "not_urdf"),
    "unbound_prefix": ("<robot><x:link/></robot>", "not_urdf"),
    "xinclude": (URDF.replace("textured_objs/back.obj", "http://localhost/x.urdf#frag"), "unsafe_path"),
    "two_schemes": (URDF.replace("textured_objs/back.obj", "file:../../secret.obj"), "unsafe_path"),
    "drive": (URDF.replace("textured_objs/back.obj", "C:\\Windows\\x.obj"), "unsafe_path"),
    "percent_parent": (URDF.replace("textured_objs/back.obj", "textured_objs/%2e%2e/../../../../../secret.obj"), "unsafe_path"),
    "newline_in_path": (URDF.replace("textured_objs/back.obj", "a&#10;b.obj"), "unsafe_path"),
    "infinite_box": (URDF.replace('<mesh filename="textured_objs/back.obj"/>', '<box size="inf 1 1"/>'), "bad_number"),
    "empty_box": (URDF.replace('<mesh filename="textured_objs/back.obj"/>', '<box size="0 1 1"/>'), "bad_number"),
    "huge_cylinder": (URDF.replace('<mesh filename="textured_objs/back.obj"/>', '<cylinder radius="1e300" length="1"/>'), "bad_number"),
    "a_thousand_numbers": (URDF.replace('xyz="0 0 1"', f'xyz="{"0 " * 100_000}"'), "bad_number"),
}

OBJS |= {f"truncated_at_{k}0_percent": (BOX[: len(BOX) * k // 10].encode(), None) for k in TENTHS}
OBJS |= {
    "utf16": (BOX.encode("utf-16"), "not_obj"),
    "a_billion_faces_declared": (b"# faces 1000000000\n" + BOX.encode() + b"f 1000000000 999999999 999999998\n", "not_obj"),
    "negative_beyond": (BOX.encode() + b"f -1 -2 -999\n", "not_obj"),
    "far_away": (BOX.replace("0.900000", "1e30", 1).encode(), "bad_number"),
    "only_comments": (b"# nothing\n" * 1000, "not_obj"),
    "library_package": (BOX.replace("model.mtl", "package://x/model.mtl").encode(), "unsafe_path"),
    "library_http": (BOX.replace("model.mtl", "http://localhost/model.mtl").encode(), "unsafe_path"),
    "fraction_index": (BOX.encode() + b"f 1.5 2 3\n", "not_obj"),
}

MTLS = {  # content of model.mtl -> reason; None: not a line of it is of use, which costs the model its colour only
    "map_parent": (b"newmtl plain\nmap_Kd ../../../secret.png\n", "unsafe_path"),
    "map_absolute": (b"newmtl plain\nmap_Kd /etc/passwd\n", "unsafe_path"),
    "map_file": (b"newmtl plain\nmap_Kd file:///etc/passwd\n", "unsafe_path"),
    "map_http": (b"newmtl plain\nmap_Kd http://localhost/x.png\n", "unsafe_path"),
    "map_package": (b"newmtl plain\nmap_Kd package://x/y.png\n", "unsafe_path"),
    "map_home": (b"newmtl plain\nmap_Kd ~/x.png\n", "unsafe_path"),
    "map_backslash": (b"newmtl plain\nmap_Kd ..\\..\\..\\secret.png\n", "unsafe_path"),
    "map_options_parent": (b"newmtl plain\nmap_Kd -s 1 1 1 -o 0 0 0 ../../../secret.png\n", "unsafe_path"),
    "map_nul": (b"newmtl plain\nmap_Kd a\x00b.png\n", "unsafe_path"),
    "map_long": (b"newmtl plain\nmap_Kd " + b"a" * 5000 + b".png\n", "unsafe_path"),
    "map_long_name": (b"newmtl plain\nmap_Kd " + b"a" * 300 + b".png\n", "missing_texture"),
    "map_folder": (b"newmtl plain\nmap_Kd .\n", "missing_texture"),
    "map_mesh": (b"newmtl plain\nmap_Kd raw_model.obj\n", "missing_texture"),
    "binary": (bytes(range(256)) * 64, None),
    "numbers": (b"newmtl plain\nKd nan 1e400 x\nd -1e999\nNs nan\nTr inf\n", None),
    "many_options": (b"newmtl plain\nmap_Kd " + b"-s 1 1 1 " * 20_000 + b"x.png\n", None),
    "many_materials": (b"".join(b"newmtl m%d\nKd 1 0 0\n" % k for k in range(100_000)), None),
}


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height, *more):
    """A PNG that declares a size, and holds next to nothing."""
    head = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + head + b"".join(more) + chunk(b"IDAT", zlib.compress(b"\0" * 99)) + chunk(b"IEND", b"")


SMALL = making.png(64, 64)
TEXTURES = {  # content of texture.png, which costs the model its texture
    "bomb": png(60_000, 60_000),
    "bomb_wide": png(2_000_000_000, 1),
    "bomb_square": png(16_000, 16_000),
    "text_bomb": png(8, 8, chunk(b"zTXt", b"a\0\0" + zlib.compress(b"\0" * 200_000_000))),
    "profile_bomb": png(8, 8, chunk(b"iCCP", b"a\0\0" + zlib.compress(b"\0" * 200_000_000))),
    "zero_bytes": b"",
    "no_size": png(0, 0),
    "html": b"<html></html>",
    "svg": b'<svg xmlns="http://www.w3.org/2000/svg" width="1e9" height="1e9"/>',
    "gif": b"GIF89a" + b"\xff" * 100,
    "tiff": b"II*\0" + b"\xff" * 100,
    "jpeg_head": b"\xff\xd8\xff\xe0" + b"\0" * 64,
    "jpeg_size": b"\xff\xd8\xff\xc0\0\x11\x08\xff\xff\xff\xff\x03\x01\x22\0\x02\x11\x01\x03\x11\x01\xff\xd9",
    **{f"truncated_at_{k}0_percent": SMALL[: len(SMALL) * k // 10] for k in TENTHS},
}

FACET = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
STL = b"\0" * 80 + struct.pack("<I", 4) + FACET * 4
STLS = {  # content of a collision mesh -> reason
    "zero_bytes": (b"", "not_obj"),
    "a_billion_faces_declared": (b"\0" * 80 + struct.pack("<I", 1_000_000_000) + FACET, "not_obj"),
    "no_faces": (b"\0" * 84, "not_obj"),
    "nan": (STL.replace(struct.pack("<f", 1), struct.pack("<f", float("nan"))), "bad_number"),
    "huge": (STL.replace(struct.pack("<f", 1), struct.pack("<f", 1e30)), "bad_number"),
    "html": (b"<html></html>", "not_obj"),
    "text_truncated": (b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0", "not_obj"),
    "text_words": (b"solid x\nfacet normal 0 0 1\nouter loop\nvertex a b c\nendloop\nendfacet\nendsolid x\n", "not_obj"),
    "text_half": (b"solid x\nfacet normal 0 0 1\nvertex 0 0 0\nvertex 1 0 0\nendsolid x\n", "not_obj"),
    "text_inf": (b"solid x\nfacet\nvertex 0 0 0\nvertex 1e400 0 0\nvertex 0 1 0\nendsolid x\n", "bad_number"),
    **{f"truncated_at_{k}0_percent": (STL[: len(STL) * k // 10], "not_obj") for k in TENTHS},
}

NO_JSON = {  # what stands where a JSON file of an object or of the model list should be -> reason
    "zero_bytes": (b"", "not_json"),
    "gzip": (gzip.compress(b"{}"), "not_json"),
    "html": (b"<html></html>", "not_json"),
    "utf16": ("{}".encode("utf-16"), "not_json"),
    "latin1": (b'{"model_cat": "\xe9"}', "not_json"),
    "nan": (b'{"model_cat": NaN}', "not_json"),
    "deep": (b"[" * 100_000 + b"]" * 100_000, "not_json"),
    "many": (b"[" + b"{}," * 400_000 + b"{}]", "too_large"),
    "digits": (b"[" + b"9" * 100_000 + b"]", "not_json"),
    "truncated": (b'{"model_cat": "Oven', "not_json"),
}
NAMES = [
    "..",
    "a/../../b",
    "a\nb",
    'a"b',
    "a'b",
    "a\\b",
    "a\x00b",
    "a" * 300,
    "\u202eabc",
    "",
    " ",
    "\U0001f600",
    "$(x)",
    "%s%n",
    "con",
    "-rf",
]

DAES = {  # content of a mesh of a URDF by itself -> reason
    "zero_bytes": (b"", "not_obj"),
    "entities": (f"<!DOCTYPE a [<!ENTITY l0 'x'>{BILLION}]><COLLADA>&l9;</COLLADA>".encode(), "not_obj"),
    "external": (b'<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/passwd">]><COLLADA>&x;</COLLADA>', "not_obj"),
    "html": (b"<html></html>", "not_obj"),
    "deep": (b"<a>" * 150_000, "not_obj"),
    "many_elements": (b"<COLLADA>" + b"<a/>" * 6_000_000 + b"</COLLADA>", "too_large"),
    "nodes_in_a_loop": (collada.dae(nodes='<node id="a"><instance_node url="#a"/></node>'), "not_obj"),
    "nodes_that_double": (
        collada.dae(
            nodes="".join(f'<node id="n{k}"><instance_node url="#n{k + 1}"/><instance_node url="#n{k + 1}"/></node>' for k in range(60))
            + '<node id="n60"><instance_geometry url="#box"/></node>'
        ),
        "too_large",
    ),
    "uvs_again_and_again": (
        collada.dae(
            nodes='<node><instance_geometry url="#box"/></node>' * 100,
            uvs=20_000,
        ),
        "too_large",
    ),
    "a_billion_values_declared": (collada.dae().replace(b'count="8" stride', b'count="1000000000" stride'), "not_obj"),
    "many_numbers": (collada.dae().replace(b"<p>", b"<p>" + b"0 0 0 " * 2_790_000 + b"9 9 9 "), "not_obj"),
    "nan": (collada.dae().replace(b"-0.5 ", b"nan ", 1), "bad_number"),
    "texture_elsewhere": (collada.dae(diffuse=collada.TEXTURE, image="../../../secret.png"), "unsafe_path"),
    "texture_by_scheme": (collada.dae(diffuse=collada.TEXTURE, image="file:///etc/passwd"), "unsafe_path"),
    **{f"truncated_at_{k}0_percent": ((d := collada.dae())[: len(d) * k // 10], "not_obj") for k in TENTHS},
}
