from __future__ import annotations

from dataclasses import replace
from io import BytesIO

import numpy as np
from PIL import Image

from pipeline.entities.asset import Asset, Material, Mesh
from pipeline.rendering.boxes import solid_link
from pipeline.rendering.palette import display
from pipeline.rendering.surface_colour import LINEAR, face_colours


def quilt(blob):
    """A sheet of two triangles: one over the texture's lower left quarter, one over its upper right."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 2, 0], [3, 2, 0], [2, 3, 0]], np.float32)
    uv = np.array([[0.1, 0.1], [0.4, 0.1], [0.1, 0.4], [0.6, 0.6], [0.9, 0.6], [0.6, 0.9]], np.float32)
    mesh = Mesh("sheet", vertices, np.array([[0, 1, 2], [3, 4, 5]], np.int32), 0, uv)
    link = solid_link("base", (mesh,), (mesh,), 1.0)
    return Asset(
        "quilt",
        "plant",
        np.ones(3),
        (link,),
        (),
        (Material("cloth", (0.3, 0.3, 0.3), texture="t.png"),),
        "t",
        "1",
        "x",
        textures={"t.png": blob},
    )


def png(pixels):
    buffer = BytesIO()
    Image.fromarray(np.asarray(pixels, np.uint8)).save(buffer, "PNG")
    return buffer.getvalue()


def test_v_runs_upwards_and_colours_are_linear():
    pixels = np.zeros((64, 64, 3))
    pixels[32:, :32] = (188, 0, 0)  # lower left of the picture
    pixels[:32, 32:] = (0, 0, 255)
    colours = face_colours(quilt(png(pixels)))
    assert np.allclose(colours, [[0.503, 0, 0], [0, 0, 1]], atol=0.002)
    assert np.allclose(display(colours)[0, 0], 188 / 255, atol=1e-3)


def test_large_textures_are_averaged():
    stripes = np.zeros((1024, 1024, 3))
    stripes[::2] = 255
    spread = np.ptp(face_colours(quilt(png(stripes)))[:, 0])
    assert spread < 0.02


def test_large_triangles_of_a_pattern_are_of_one_colour():
    """Squares of 8 texels in two colours: where a spot falls is chance, what lies under a triangle is not."""
    squares = np.kron(np.indices((8, 8)).sum(axis=0) % 2, np.ones((8, 8)))[..., None] * np.full(3, 255)
    turned = [[0, 0], [4.3, 0.2], [0.1, 3.9], [0.6, 0.6], [7.9, 0.66], [7.6, 0.9]]  # many repeats; the second a sliver
    sheet = quilt(png(squares))
    (link,) = sheet.links
    mesh = replace(link.visuals[0], uv=np.array(turned, np.float32))
    colours = face_colours(replace(sheet, links=(replace(link, visuals=(mesh,)),)))
    grey = LINEAR[127]
    assert np.allclose(colours, grey, atol=0.02)


def test_what_is_no_picture_leaves_the_material_s_colour():
    assert np.allclose(face_colours(quilt(b"nonsense")), 0.3)
    assert np.allclose(face_colours(replace(quilt(b""), textures={})), 0.3)
