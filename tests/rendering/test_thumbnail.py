from __future__ import annotations

from dataclasses import replace

import numpy as np

from pipeline.entities.asset import Asset, Joint, Material
from pipeline.rendering.boxes import box, solid_link
from pipeline.rendering.thumbnail import thumbnail


def chest():
    body, lid = (box("body", (-0.5, -0.3, 0), (0.5, 0.3, 0.5)),), (box("lid", (-0.5, -0.3, 0.5), (0.5, 0.3, 0.53)),)
    joint = Joint("lid", "revolute", 0, 1, np.array([-1.0, 0, 0]), np.array([0, 0.3, 0.5]), 0.0, 1.4, "hinge_lid")
    links = (solid_link("base", body, body, 10.0), solid_link("lid", lid, lid, 2.0))
    return Asset("chest", "cabinet", np.array([1, 0.6, 0.53]), links, (joint,), (Material("red", (0.7, 0.05, 0.05)),), "t", "1", "x")


def test_thumbnails_show_the_asset_in_its_colour_open():
    shut, wide = (np.asarray(thumbnail(chest(), 96, f)).astype(int) for f in (0.0, 1.0))
    assert shut.shape == (96, 96, 3)
    red = shut[..., 0] > shut[..., 1] + 60
    assert 0.2 < red.mean() < 0.9
    assert (np.abs(shut - wide).max(axis=2) > 20).mean() > 0.05


def test_thumbnails_are_the_same_every_time():
    assert thumbnail(chest(), 64).tobytes() == thumbnail(chest(), 64).tobytes()


def test_an_asset_without_meshes_is_an_empty_picture():
    empty = replace(chest(), links=(replace(chest().links[0], visuals=()), replace(chest().links[1], visuals=())))
    assert len(set(thumbnail(empty, 32).getdata())) == 1
