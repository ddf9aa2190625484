"""Room labels: type and area, placed where they hide least."""

import functools

import numpy as np
import shapely
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont
from shapely.geometry import Polygon

from pipeline.entities.plan import Room

INK = (38, 40, 46)
PEOPLE = frozenset({"child", "elder", "carer"})  # roles of bedrooms that name somebody
FULL = 0.9999  # share of its bounding box that a rectangle has
SMALL = 14  # points below which labels are no longer readable, so they are left out [pixels]


@functools.cache
def font(size: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    """Return Pillow's own font, the same on every machine."""
    return ImageFont.load_default(size)


def summed_area_table(mask: NDArray[np.bool_]) -> NDArray[np.int32]:
    """Return the summed-area table (H + 1, W + 1) of a mask (H, W)."""
    table = np.zeros((mask.shape[0] + 1, mask.shape[1] + 1), np.int32)
    np.cumsum(mask, axis=0, dtype=np.int32, out=table[1:, 1:])
    np.cumsum(table[1:, 1:], axis=1, out=table[1:, 1:])
    return table


def draw_label(
    image: Image.Image, room: Room, pixels: NDArray[np.float64], busy: NDArray[np.int32], size: int
) -> tuple[int, int, int, int] | None:
    """Write a room's name, with whose it is, and area inside its outline `pixels` (n, 2), where least is below it.

    `busy` (H + 1, W + 1) is the summed-area table of furniture pixels.

    Returns the label's box [pixels], or None where the room is too small for one.
    """
    draw = ImageDraw.Draw(image, "RGBA")
    name = room.type.replace("_", " ")
    whose = f"{room.role}'s" if room.role in PEOPLE else room.role
    for text in (f"{whose} {name}".lstrip() + f"\n{room.area:.1f} m2", f"{name}\n{room.area:.1f} m2", f"{room.area:.0f} m2"):
        box = draw.multiline_textbbox((0, 0), text, font=font(size), spacing=2, align="center")
        width, height = int(box[2] - box[0]) + size // 2, int(box[3] - box[1]) + size // 2
        corner = _corner(Polygon(pixels), busy, width, height)
        if corner is not None:
            x, y = corner
            draw.rounded_rectangle((x, y, x + width, y + height), radius=size // 3, fill=(255, 255, 255, 178))
            draw.multiline_text((x + size // 4 - box[0], y + size // 4 - box[1]), text, INK, font(size), spacing=2, align="center")
            return x, y, x + width, y + height
    return None


def _corner(polygon: Polygon, busy: NDArray[np.int32], width: int, height: int) -> tuple[int, int] | None:
    """Return the upper left corner of the emptiest box of that size in the polygon, the nearer to its middle the better."""
    left, top, right, bottom = polygon.bounds
    xs, ys = np.arange(left + 2, right - width - 1, max(4, width // 8)), np.arange(top + 2, bottom - height - 1, max(4, height // 4))
    if not (len(xs) and len(ys)):
        return None
    gx, gy = (g.ravel().astype(int) for g in np.meshgrid(xs, ys))
    if polygon.area < FULL * (right - left) * (bottom - top):  # no rectangle along the axes, in which all of them lie
        inside = shapely.contains(polygon, shapely.box(gx, gy, gx + width, gy + height))
        gx, gy = gx[inside], gy[inside]
    if not len(gx):
        return None
    covered = busy[gy + height, gx + width] - busy[gy, gx + width] - busy[gy + height, gx] + busy[gy, gx]
    middle = np.array([polygon.centroid.x - width / 2, polygon.centroid.y - height / 2])
    away = np.hypot(gx - middle[0], gy - middle[1]) / max(right - left, bottom - top)
    best = int(np.argmin(covered / (width * height) + 0.25 * away))
    return int(gx[best]), int(gy[best])
