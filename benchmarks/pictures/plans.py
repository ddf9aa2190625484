"""Draws the plans of docs/images/plans.png: `python benchmarks/pictures/plans.py docs/images`."""

import io
import sys
from pathlib import Path
from textwrap import fill

from matplotlib.font_manager import findfont
from PIL import Image, ImageDraw, ImageFont

from pipeline.floorplan import request, solve
from pipeline.floorplan.draw.drawing import png

PROMPTS = (
    "a two-bedroom flat of 75 m2 with an open kitchen, a hallway, one bathroom and a balcony off the living room",
    "Vierzimmerwohnung, 110 m², Flur, von dem alle Zimmer abgehen, Küche, Bad, Gäste-WC, Abstellraum",
    "casa con tres dormitorios, dos baños, cocina con despensa, salón comedor, lavadero junto a la cocina y garaje",
    "a house on two floors: living room, kitchen and guest toilet downstairs, three bedrooms and a bathroom upstairs",
    "L-shaped bungalow, 3 bedrooms, 2 baths, kitchen next to the dining room, an office far from the bedrooms",
    "five bedrooms off a long corridor, two bathrooms, one kitchen, no living room",
)
COLUMNS, CELL, GAP, LINE = 3, (620, 560), 20, 84  # plans a row; their size, what is between them and the height of a caption [px]
WIDTH = 60  # of a caption, in characters


def main(folder: Path) -> None:
    """Write plans.png: each plan under its prompt."""
    rows = -(-len(PROMPTS) // COLUMNS)
    sheet = Image.new("RGB", (COLUMNS * (CELL[0] + GAP) + GAP, rows * (CELL[1] + LINE + GAP) + GAP), "white")
    pen = ImageDraw.Draw(sheet)
    font = ImageFont.truetype(findfont("DejaVu Sans"), 19)  # matplotlib brings it along
    for k, prompt in enumerate(PROMPTS):
        drawn = Image.open(io.BytesIO(png(solve(request(prompt), 0)))).convert("RGB")
        drawn.thumbnail(CELL, Image.Resampling.LANCZOS)
        x, y = GAP + k % COLUMNS * (CELL[0] + GAP), GAP + k // COLUMNS * (CELL[1] + LINE + GAP)
        pen.multiline_text((x, y), fill(prompt, WIDTH), fill="#333333", font=font)
        sheet.paste(drawn, (x + (CELL[0] - drawn.width) // 2, y + LINE))
    sheet.save(folder / "plans.png", optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
