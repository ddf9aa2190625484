"""What hangs on walls: pictures, mirrors, clocks. The back is at the wall (+y)."""

import numpy as np

from pipeline.corpus.furniture.bent import turns
from pipeline.corpus.furniture.finishes import FABRICS, MIRROR, PAPER, Finish, Pattern, Scheme, one_of, pick, shade
from pipeline.corpus.furniture.intervals import Interval, around, polar
from pipeline.corpus.furniture.panels import Rect, frame
from pipeline.corpus.furniture.shape import Pieces, Shape, Size, pieces
from pipeline.corpus.furniture.solids import Solid, Vector, box, circle, revolve, ring, rod, slab, standing
from pipeline.style import Color

INKS: tuple[tuple[Color, Color], ...] = (
    ((0.75, 0.70, 0.60), (0.05, 0.08, 0.14)),
    ((0.72, 0.66, 0.55), (0.45, 0.12, 0.05)),
    ((0.10, 0.16, 0.22), (0.78, 0.62, 0.38)),
    ((0.78, 0.75, 0.70), (0.04, 0.18, 0.14)),
    ((0.68, 0.42, 0.30), (0.82, 0.78, 0.68)),
    ((0.80, 0.79, 0.76), (0.03, 0.03, 0.035)),
)


def frame_boards(w: float, h: float, wide: float, y: Interval, bevel: float = 0.002) -> list[Solid]:
    """Return four boards around a rectangle `w` x `h` whose lower edge is at z = 0."""
    x = w / 2
    return frame(Rect((-x, x), (0.0, h), y[0]), Rect(around(x - wide), (wide, h - wide), y[0]), y, bevel)


def picture(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a framed print with a mount, a bare canvas, or a pair of prints."""
    w, d, h = size
    back = d / 2
    pattern: Pattern = pick(rng, "art_blocks art_hills art_circles art_lines")  # type: ignore[assignment]
    ground, ink = one_of(rng, INKS)
    art = Finish("print", ground, 0.7, pattern=pattern, density=400, second=ink)
    if form == "canvas":
        return Shape(pieces("canvas", box(around(w / 2), (-back, back), (0.0, h), 0.003), art))
    frame = scheme.timber if rng.random() < 0.5 else scheme.handle
    spans = [(-w / 2, w / 2)] if form == "framed" else [(-w / 2, -0.02 * w), (0.02 * w, w / 2)]
    parts: Pieces = ()
    for k, (x0, x1) in enumerate(spans):
        wide = x1 - x0
        rim = 0.018 + 0.02 * scheme.manner.ornament
        at = np.array([(x0 + x1) / 2, 0.0, 0.0])
        mount = 0.12 * min(wide, h)
        sheet = box(around(wide / 2 - rim), (back - 0.008, back), (rim, h - rim))
        inner = box(around(wide / 2 - rim - mount), (back - 0.011, back - 0.008), (rim + mount, h - rim - mount))
        parts += pieces(f"frame_{k}", [s.moved(at) for s in frame_boards(wide, h, rim, (-back, back))], frame)
        parts += pieces(f"mount_{k}", sheet.moved(at), PAPER) + pieces(f"print_{k}", inner.moved(at), art)
    return Shape(parts)


def mirror(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a mirror in a rectangular or a round frame, or in a sunburst."""
    w, d, h = size
    back = d / 2
    frame = scheme.handle if rng.random() < 0.55 else scheme.timber
    if form == "rectangle":
        rim = 0.02 + 0.035 * scheme.manner.ornament
        glass = box(around(w / 2 - rim), (back - 0.012, back - 0.004), (rim, h - rim))
        return Shape(pieces("frame", frame_boards(w, h, rim, (-back, back), 0.004), frame) + pieces("mirror", glass, MIRROR))
    r = min(w, h) / 2
    rim = 0.6 * r if form == "sunburst" else 0.93 * r
    outer = 1.06 * rim if form == "sunburst" else r
    parts = pieces("mirror", standing([slab(circle(rim, 36), (0.0, 0.006))], (0, back - 0.004, h / 2)), MIRROR)
    parts += pieces("frame", standing(ring((outer, outer), (rim, rim), (0.0, d), 36), (0, back, h / 2)), frame)
    if form != "sunburst":
        return Shape(parts)
    y, lengths = back - 0.012, (r, 0.84 * r)
    rays = [rod(_upright(outer, a, y, h / 2), _upright(lengths[k % 2], a, y, h / 2), 0.007, 0.002, 6) for k, a in enumerate(turns(24))]
    return Shape(parts + pieces("rays", rays, frame))


def clock(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a round wall clock with a dial, or one with bare marks on a ring."""
    w, d, h = size
    back, r = d / 2, w / 2
    at = (0, back, h / 2)
    rim = scheme.handle if rng.random() < 0.6 else scheme.timber
    if form == "dial":
        light = rng.random() < 0.7
        face: tuple[Color, Color] = ((0.82, 0.81, 0.78), (0.03, 0.03, 0.03)) if light else ((0.04, 0.04, 0.045), (0.85, 0.83, 0.78))
        dial = Finish("dial", face[0], 0.5, pattern="dial", density=900, second=face[1])
        parts = pieces("dial", standing([slab(circle(0.9 * r, 32), (0.0, 0.5 * d))], at), dial)
        return Shape(parts + pieces("rim", standing(ring((r, 0.97 * r), (0.9 * r, 0.9 * r), (0.0, d), 32), at), rim))
    hub = standing(revolve([(0.2 * r, 0.0), (0.2 * r, 0.7 * d), (0.12 * r, d)], 20), at)
    hoop = standing(ring((0.86 * r, 0.86 * r), (0.8 * r, 0.8 * r), (0.0, 0.4 * d), 32), at)
    y, bar_y = (back - 0.8 * d, back - 0.4 * d), (back - 0.6 * d, back - 0.45 * d)
    marks = [box(around(0.02 * r), y, (0.74 * r, r)).turned("y", a).moved((0, 0, h / 2)) for a in turns(12)]
    hands = [box(around(0.015 * r), bar_y, (0.2 * r, q * r)).turned("y", a).moved((0, 0, h / 2)) for q, a in ((0.5, 1.05), (0.72, -1.05))]
    spokes = [(_upright(0.2 * r, a, back - 0.15 * d, h / 2), _upright(0.8 * r, a, back - 0.15 * d, h / 2)) for a in turns(4)]
    parts = pieces("ring", hoop, rim) + pieces("hub", hub, rim)
    parts += pieces("spokes", [rod(*ends, 0.1 * d, n=6) for ends in spokes], rim) + pieces("marks", marks, rim)
    return Shape(parts + pieces("hands", hands, Finish("marks", shade(rng, FABRICS["charcoal"], 0.1), 0.5, density=900)))


def _upright(radius: float, angle: float, y: float, z: float) -> Vector:
    """Return the point at an angle around (y, z), in a plane that faces the front."""
    x, up = polar(radius, angle)
    return (x, y, z + up)
