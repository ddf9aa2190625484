"""The top view of a home: ceiling off, walls cut, doors with their swing, furniture shaded, rooms labelled."""

import itertools
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from pipeline.entities.asset import Asset
from pipeline.entities.home import Home, Placement
from pipeline.geometry.walls import Shell, levels, shell
from pipeline.preview.building import building, is_hanging
from pipeline.preview.labels import SMALL, draw_label, summed_area_table
from pipeline.preview.symbols import draw_openings, draw_reach
from pipeline.rendering.above import draw_from_above
from pipeline.rendering.raster import Frame, View, darken_edges, render, top_down

MARGIN = 0.45  # around the outer walls [m]
BACKGROUND = (0.955, 0.955, 0.945)
SAMPLES = 2  # per pixel and axis
BANDS = 4  # of a picture, drawn one after the other


def top_view(home: Home, assets: Mapping[str, Asset], size: int = 1024, *, reaches: bool = True) -> Image.Image:
    """Draw every storey side by side; the longer side of the image has `size` pixels. `reaches`: with how far doors and drawers of furniture open."""
    shells = [shell(home.plan, level) for level in levels(home.plan)]
    bounds = np.array([s.outline.bounds for s in shells])
    low, high = bounds[:, :2].min(axis=0) - MARGIN, bounds[:, 2:].max(axis=0) + MARGIN
    span = (high - low) * np.array([len(shells), 1])
    scale = size / span.max()
    width, height = (max(16, round(s * scale)) for s in (high - low))
    image = Image.new("RGB", (width * len(shells), height))
    for i, (level, built) in enumerate(zip(levels(home.plan), shells, strict=True)):
        view = top_down(low, high, SAMPLES * width, SAMPLES * height)
        image.paste(_storey(home, assets, level, built, view, reaches=reaches), (i * width, 0))
    return image


def _storey(home: Home, assets: Mapping[str, Asset], level: int, built: Shell, view: View, *, reaches: bool) -> Image.Image:
    ids = {room.room_id for room in home.plan.rooms if room.level == level}
    placed = [p for p in home.placements if p.room_id in ids and p.asset_id in assets]
    standing = [p for p in placed if not is_hanging(p)]
    image, depth, item = _solids(home, assets, level, built, view, standing)
    draw = ImageDraw.Draw(image)

    def project(points: NDArray[np.float64]) -> list[tuple[float, float]]:
        flat = np.column_stack([points, np.zeros(len(points))])
        return [(float(u), float(v)) for u, v, _ in view.project(flat)]

    line = max(2, view.width // 900)
    draw_openings(draw, built, project, line)
    for placement in standing if reaches else ():
        draw_reach(draw, placement, assets[placement.asset_id], project, line)
    for placement in filter(is_hanging, placed):
        draw.line(project(placement.footprint()[[0, 1, 2, 3, 0]]), fill=(150, 150, 150), width=line)
    image = _shade(image.reduce(SAMPLES), depth, item)
    size = max(9, round(0.26 * view.scale / SAMPLES))
    if size >= SMALL:
        busy = summed_area_table(item > 0)
        for room in home.plan.rooms:
            if room.level == level:
                draw_label(image, room, np.array(project(room.polygon)) / SAMPLES, busy, min(size, 22))
    return image


def _solids(
    home: Home, assets: Mapping[str, Asset], level: int, built: Shell, view: View, standing: Sequence[Placement]
) -> tuple[Image.Image, NDArray[np.float32], NDArray[np.int32]]:
    """Draw walls, floors and what stands on them: the fine image, and depths and items at the final resolution.

    Drawn in BANDS, one below the other: the fine depths and items of a whole picture would take 20 MB.
    """
    ground, elevation = building(home.plan, level, built), level * home.plan.storey_height
    image = Image.new("RGB", (view.width, view.height))
    depths, items = [], []
    edges = SAMPLES * np.linspace(0, view.height // SAMPLES, BANDS + 1).astype(int)
    for top, bottom in itertools.pairwise(edges.tolist()):
        band = view.rows(top, bottom)
        frame = render(band, ground.faces, ground.colours, ground.items, BACKGROUND)
        for number, p in enumerate(standing, 1):
            draw_from_above(frame, band, assets[p.asset_id], p.position - (0.0, 0.0, elevation), p.yaw, p.scale, number)
        image.paste(Image.fromarray(frame.colour), (0, top))
        depths.append(frame.depth[::SAMPLES, ::SAMPLES].copy())
        items.append(frame.item[::SAMPLES, ::SAMPLES].copy())
    return image, np.concatenate(depths), np.concatenate(items)


def _shade(image: Image.Image, depth: NDArray[np.float32], item: NDArray[np.int32]) -> Image.Image:
    """Add the soft shadows that a depth buffer (H, W) gives, at the final resolution."""
    coarse = Frame(np.asarray(image), depth, item)
    return Image.fromarray(darken_edges(coarse, max(2, image.width // 120), 0.38, reach=1.4, ground=0.0).colour)
