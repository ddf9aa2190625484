"""Lays out docs/images/plans.png, and homes.png from the previews of a dataset.

python benchmarks/pictures/sheets.py docs/images [DATASET SCENE SCENE SCENE SCENE]
"""

import io
import sys
from collections.abc import Sequence
from pathlib import Path
from textwrap import fill
from typing import Any

from matplotlib.font_manager import findfont
from PIL import Image, ImageDraw, ImageFont

from pipeline.floorplan import request, solve
from pipeline.floorplan.draw.drawing import png
from pipeline.preview.sheet import PAPER

PROMPTS = (
    "a two-bedroom flat of 75 m2 with an open kitchen, a hallway, one bathroom and a balcony off the living room",
    "Vierzimmerwohnung, 110 m², Flur, von dem alle Zimmer abgehen, Küche, Bad, Gäste-WC, Abstellraum",
    "casa con tres dormitorios, dos baños, cocina con despensa, salón comedor, lavadero junto a la cocina y garaje",
    "a house on two floors: living room, kitchen and guest toilet downstairs, three bedrooms and a bathroom upstairs",
    "L-shaped bungalow, 3 bedrooms, 2 baths, kitchen next to the dining room, an office far from the bedrooms",
    "five bedrooms off a long corridor, two bathrooms, one kitchen, no living room",
)
GAP, LINE = 20, 84  # what is between pictures, and the height of a caption [px]
WIDTH = 60  # of a caption, in characters


def plans() -> Image.Image:
    """Return each plan under its prompt."""
    drawn = [Image.open(io.BytesIO(png(solve(request(prompt), 0)))) for prompt in PROMPTS]
    return lay_out(drawn, 3, (620, 560), "white", [fill(prompt, WIDTH) for prompt in PROMPTS])


def homes(dataset: Path, scenes: Sequence[str]) -> Image.Image:
    """Return previews of homes of a dataset."""
    return lay_out([Image.open(next((dataset / "previews").rglob(f"{scene}.png"))) for scene in scenes], 2, (480, 410), PAPER)


def lay_out(pictures: Sequence[Image.Image], columns: int, cell: tuple[int, int], paper: Any, captions: Sequence[str] = ()) -> Image.Image:
    """Return pictures in rows, each shrunk to fit a cell [px], under its caption."""
    wide, high, line = cell[0] + GAP, cell[1] + GAP + LINE * bool(captions), LINE * bool(captions)
    sheet = Image.new("RGB", (columns * wide + GAP, -(-len(pictures) // columns) * high + GAP), paper)
    font = ImageFont.truetype(findfont("DejaVu Sans"), 19)  # matplotlib brings it along
    for k, picture in enumerate(pictures):
        small = picture.convert("RGB")
        small.thumbnail(cell, Image.Resampling.LANCZOS)
        x, y = GAP + k % columns * wide, GAP + k // columns * high
        if captions:
            ImageDraw.Draw(sheet).multiline_text((x, y), captions[k], fill="#333333", font=font)
        sheet.paste(small, (x + (cell[0] - small.width) // 2, y + line))
    return sheet


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    plans().save(folder / "plans.png", optimize=True)
    if sys.argv[2:]:
        homes(Path(sys.argv[2]), sys.argv[3:]).save(folder / "homes.png", optimize=True)
