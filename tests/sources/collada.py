"""COLLADA files of one box, made by code."""

import numpy as np

SIDES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
TRIANGLES = [f for a, b, c, d in SIDES for f in ((a, b, c), (a, c, d))]
MATERIALS = (
    '<library_images><image id="picture"><init_from>{image}</init_from></image></library_images>'
    '<library_effects><effect id="paint"><profile_COMMON>'
    '<newparam sid="surface"><surface type="2D"><init_from>picture</init_from></surface></newparam>'
    '<newparam sid="sampler"><sampler2D><source>surface</source></sampler2D></newparam>'
    '<technique sid="common"><phong><diffuse>{diffuse}</diffuse>{more}</phong></technique></profile_COMMON></effect></library_effects>'
    '<library_materials><material id="red" name="Red"><instance_effect url="#paint"/></material></library_materials>'
)
RED = '<color sid="diffuse">1 0 0 1</color>'
TEXTURE = '<texture texture="sampler" texcoord="UV"/>'


def corners(size=(1.0, 1.0, 1.0)):
    """The box's corners (8, 3), its bottom in the middle of z = 0."""
    w, d, h = size
    return np.array([[x, y, z] for x in (-w / 2, w / 2) for y in (-d / 2, d / 2) for z in (0, h)])


def words(lists):
    """Corners as indices of vertex, normal (always 0) and uv."""
    return " ".join(f"{v} 0 {k % 4}" for corners in lists for k, v in enumerate(corners))


def primitive(kind="triangles"):
    """The box's faces as one of COLLADA's primitives."""
    given = '<input semantic="VERTEX" source="#v" offset="0"/><input semantic="NORMAL" source="#n" offset="1"/>'
    given += '<input semantic="TEXCOORD" source="#t" offset="2" set="0"/>'
    body = {
        "triangles": f"<p>{words(TRIANGLES)}</p>",
        "polylist": f"<vcount>{'4 ' * 6}</vcount><p>{words(SIDES)}</p>",
        "polygons": "".join(f"<p>{words([side])}</p>" for side in SIDES),
        "trifans": "".join(f"<p>{words([side])}</p>" for side in SIDES),
        "tristrips": "".join(f"<p>{words([(a, b, d, c)])}</p>" for a, b, c, d in SIDES),
    }[kind]
    return f'<{kind} count="6" material="symbol">{given}{body}</{kind}>'


def source(name, values, width):
    flat = " ".join(f"{v:.9g}" for v in np.ravel(values))
    count = np.size(values) // width
    return (
        f'<source id="{name}"><float_array id="{name}-a" count="{np.size(values)}">{flat}</float_array>'
        f'<technique_common><accessor source="#{name}-a" count="{count}" stride="{width}"/></technique_common></source>'
    )


def dae(
    *,
    size=(1.0, 1.0, 1.0),
    kind="triangles",
    node="",
    asset="<up_axis>Z_UP</up_axis>",
    diffuse=RED,
    more="",
    image="wood.png",
    nodes=None,
    uvs=4,
):
    """A file of one box. `node` are transforms of the node that shows it, `nodes` other nodes in its place, `uvs` how many there are."""
    mesh = source("p", corners(size), 3) + source("n", [[0, 0, 1]], 3) + source("t", [[0, 0], [1, 0], [1, 1], [0, 1]] * (uvs // 4), 2)
    mesh += f'<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>{primitive(kind)}'
    bind = '<bind_material><technique_common><instance_material symbol="symbol" target="#red"/></technique_common></bind_material>'
    shown = nodes or f'<node id="n0">{node}<instance_geometry url="#box">{bind}</instance_geometry></node>'
    return (
        '<?xml version="1.0" encoding="utf-8"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">'
        f"<asset>{asset}</asset>{MATERIALS.format(image=image, diffuse=diffuse, more=more)}"
        f'<library_geometries><geometry id="box" name="box"><mesh>{mesh}</mesh></geometry></library_geometries>'
        f'<library_visual_scenes><visual_scene id="scene">{shown}</visual_scene></library_visual_scenes>'
        '<scene><instance_visual_scene url="#scene"/></scene></COLLADA>'
    ).encode()
