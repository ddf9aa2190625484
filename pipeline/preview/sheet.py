"""Contact sheets: many pictures on one, each with its caption."""

from collections.abc import Sequence

from PIL import Image, ImageDraw

from pipeline.preview.labels import INK, font

PAPER = (244, 244, 241)
GAP = 10  # [pixels]


def contact_sheet(pictures: Sequence[tuple[str, Image.Image]], columns: int = 4, cell: int = 256) -> Image.Image:
    """Lay captioned pictures out in rows; each is shrunk to fit a square of `cell` pixels."""
    size = max(11, cell // 18)
    strip = size + 8
    rows = max(1, -(-len(pictures) // columns))
    sheet = Image.new("RGB", (columns * (cell + GAP) + GAP, rows * (cell + strip + GAP) + GAP), PAPER)
    draw = ImageDraw.Draw(sheet)
    for k, (caption, picture) in enumerate(pictures):
        x, y = GAP + k % columns * (cell + GAP), GAP + k // columns * (cell + strip + GAP)
        small = picture.convert("RGB")
        small.thumbnail((cell, cell), Image.Resampling.LANCZOS, reducing_gap=3.0)
        sheet.paste(small, (x + (cell - small.width) // 2, y + (cell - small.height) // 2))
        fitting = next((n for n in range(size, 7, -1) if draw.textlength(caption, font(n)) <= cell + GAP - 4), 7)
        draw.text((x + cell // 2, y + cell + strip // 2), caption, INK, font(fitting), anchor="mm")
    return sheet
