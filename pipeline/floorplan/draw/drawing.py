"""Drawings of a plan: SVG text, and a PIL image, of the same marks."""

import io
import math
from html import escape

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from pipeline.entities.plan import Plan
from pipeline.floorplan.draw.elements import Area, Line, Words, marks

FINER = 2  # drawn large and reduced: smooth lines


def svg(plan: Plan, scale: float = 60.0) -> str:
    """Return the plan as SVG; `scale` in pixels a metre."""
    elements, width, height = marks(plan)

    def text(points: np.ndarray) -> str:
        return " ".join(f"{x * scale:.1f},{(height - y) * scale:.1f}" for x, y in points)

    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width * scale:.0f} {height * scale:.0f}">',
        '<rect width="100%" height="100%" fill="#ffffff"/>',
        '<g font-family="sans-serif" text-anchor="middle" stroke-linejoin="round">',
    ]
    for mark, shift in elements:
        if isinstance(mark, Area):
            path = " ".join(f"M {text(ring + shift)} Z" for ring in mark.rings)
            edge = f' stroke="{mark.edge}" stroke-width="1"' if mark.edge else ""
            lines.append(f'<path d="{path}" fill="{mark.fill}" fill-rule="evenodd"{edge}/>')
        elif isinstance(mark, Line):
            stroke = f'stroke="{mark.colour}" stroke-width="{mark.width * scale:.1f}"'
            lines.append(f'<polyline points="{text(mark.points + shift)}" fill="none" {stroke}/>')
        else:
            x, y = (mark.at[0] + shift[0]) * scale, (height - (mark.at[1] + shift[1])) * scale
            turn = f' transform="rotate(-90 {x:.1f} {y:.1f})"' if mark.turned else ""
            size = mark.size * scale
            place = f'x="{x:.1f}" y="{y + 0.35 * size:.1f}" font-size="{size:.1f}"'
            lines.append(f'<text {place} fill="{mark.colour}"{turn}>{escape(mark.text)}</text>')
    return "\n".join([*lines, "</g></svg>"]) + "\n"


def image(plan: Plan, scale: float = 60.0) -> Image.Image:
    """Return the plan as an image; `scale` in pixels a metre."""
    elements, width, height = marks(plan)
    fine = scale * FINER
    picture = Image.new("RGB", (math.ceil(width * scale) * FINER, math.ceil(height * scale) * FINER), "white")
    pen = ImageDraw.Draw(picture)

    def at(points: np.ndarray) -> list[tuple[float, float]]:
        return [(float(x) * fine, (height - float(y)) * fine) for x, y in points]

    for mark, shift in elements:
        if isinstance(mark, Area):
            pen.polygon(at(mark.rings[0] + shift), fill=mark.fill, outline=mark.edge or None, width=FINER)
            for ring in mark.rings[1:]:
                pen.polygon(at(ring + shift), fill="white")
        elif isinstance(mark, Line):
            pen.line(at(mark.points + shift), fill=mark.colour, width=max(1, round(mark.width * fine)), joint="curve")
        else:
            ((x, y),) = at(mark.at + shift[None])
            _write(picture, pen, mark, fine, x, y)
    return picture.resize((picture.width // FINER, picture.height // FINER), Image.Resampling.LANCZOS)


def _write(picture: Image.Image, pen: ImageDraw.ImageDraw, mark: Words, scale: float, x: float, y: float) -> None:
    """Write words with their middle at (x, y) [pixels]."""
    font = ImageFont.load_default(size=mark.size * scale)
    if not mark.turned:
        plain = mark.text.removesuffix("²")  # Pillow's own font, the same on every machine, has no such sign
        small = ImageFont.load_default(size=0.62 * mark.size * scale)
        start = x - (font.getlength(plain) + (small.getlength("2") if plain != mark.text else 0.0)) / 2
        pen.text((start, y), plain, fill=mark.colour, font=font, anchor="lm")
        if plain != mark.text:
            pen.text((start + font.getlength(plain), y - 0.22 * mark.size * scale), "2", fill=mark.colour, font=small, anchor="lm")
        return
    left, top, right, bottom = font.getbbox(mark.text)
    flat = Image.new("L", (math.ceil(right - left) + 2, math.ceil(bottom - top) + 2), 0)
    ImageDraw.Draw(flat).text((1 - left, 1 - top), mark.text, fill=255, font=font)
    upright = flat.transpose(Image.Transpose.ROTATE_90)
    picture.paste(Image.new("RGB", upright.size, mark.colour), (round(x - upright.width / 2), round(y - upright.height / 2)), upright)


def png(plan: Plan, scale: float = 60.0) -> bytes:
    """Return the plan as PNG bytes."""
    buffer = io.BytesIO()
    image(plan, scale).save(buffer, format="PNG")
    return buffer.getvalue()
