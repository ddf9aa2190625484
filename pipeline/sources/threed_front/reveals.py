"""Which pieces of evidence are one opening of a 3D-FRONT house, and how wide it is: reveals from both rooms, frames, thresholds, leaves."""

import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from shapely.geometry import LineString, Point

from pipeline.sources.threed_front.opening_evidence import FLAT, LEAST, MIN_PANE, ORIGINS, SAME, Evidence, OpeningEvidence

WIDER = 0.4  # [m] a frame is at most so much wider than what it frames; what is wider is an opening of its own
AJAR, FARTHEST_LEAF = 0.9, 0.8  # of the reveal's width, and [m]: how far the middle of a leaf that is drawn open lies from it
JAMB_HEIGHT = 1.5  # [m] a lower reveal is no jamb of a door
JAMBS_APART = (0.5, 2.5)  # [m] widths of what two jambs may enclose
ADJOIN = 0.15  # [m] panes of a bay whose ends are this near meet at a corner
MULLION = 0.1  # [m] between windows whose widths the file does not say


def group_evidence(evidence: Sequence[OpeningEvidence]) -> tuple[list[OpeningEvidence], list[OpeningEvidence]]:
    """Return openings as the evidence has them, and what is none: thresholds without a reveal, jambs without another."""
    narrow, wide = ([h for h in evidence if (h.width < LEAST[h.evidence]) is less] for less in (True, False))
    between, odd = jambs(narrow, merge(wide))
    holes = merge([*wide, *between])
    flat = [h for h in holes if h.flat]
    upright = [replace(h, evidence="door") if h.evidence == "hole" and any(_ends(h, n) for n in narrow) else h for h in holes if not h.flat]
    return _apart(upright), [h for h in (*flat, *odd) if not any(hole.reaches(h.centre) for hole in upright)]


def _ends(hole: OpeningEvidence, jamb: OpeningEvidence) -> bool:
    """Whether a jamb of a door ends a hole, which then is that door's."""
    along, across = map(abs, hole.offset(jamb.centre))
    beside = abs(along - hole.width / 2)
    return jamb.evidence == "door" and not jamb.flat and beside < ADJOIN and across < hole.depth / 2 + ADJOIN


def merge(holes: Iterable[OpeningEvidence]) -> list[OpeningEvidence]:
    """Join evidence of the same opening. What only thresholds tell of stays flat."""
    groups: list[list[OpeningEvidence]] = []
    for hole in sorted(holes, key=lambda h: (h.origin == "record", h.flat, -h.width, tuple(np.round(h.centre, 3)))):
        mine = [(gap, k) for k, group in enumerate(groups) if (gap := _gap(hole, group)) < math.inf]
        if mine:
            groups[min(mine)[1]].append(hole)
        else:
            groups.append([hole])
    return sorted(map(_merge_group, groups), key=lambda h: (h.origin == "record", -round(h.width, 3), tuple(np.round(h.centre, 3))))


def _gap(hole: OpeningEvidence, group: Sequence[OpeningEvidence]) -> float:
    """Return how far a hole is from the middle of the opening that a group shows [m]; infinite where it is none of that opening."""
    first = group[0]
    along, across = map(abs, first.offset(hole.centre))
    slack = FLAT if hole.flat or first.flat else 0.0
    # how high a record's origin lies says nothing of a leaf or pane that stands in a reveal
    stacked = hole.origin == "record" or (hole.sill < first.top + slack and first.sill < hole.top + slack)
    same_wall = hole.origin == "record" or hole.flat or abs(float(hole.along @ first.along)) > 0.9
    if across < SAME and along < max(SAME, first.width / 2 - 0.1) and same_wall and stacked:
        return math.hypot(across, along)
    ajar = hole.origin == "record" and hole.evidence == "door" and first.origin != "record" and first.evidence != "window"
    if ajar and LineString(first.ends).distance(Point(hole.centre)) < min(AJAR * first.width, FARTHEST_LEAF):
        return math.hypot(across, along)
    return math.inf


def _merge_group(group: Sequence[OpeningEvidence]) -> OpeningEvidence:
    """Return a group as one hole: measures of the best meshes in it, the depth of all, the kind from whoever knows it."""
    ranked = sorted(group, key=lambda h: (h.flat, ORIGINS.index(h.origin)))
    standing = [h.evidence for h in ranked if not h.flat] or [ranked[0].evidence]
    evidence: Evidence = next((kind for kind in standing if kind != "hole"), "hole")
    upright = [h for h in ranked if h.origin != "record" and not h.flat]
    if not upright:
        thresholds = [h for h in group if h.origin != "record"]
        leaf = next((h for h in ranked if h.origin == "record"), None)
        if thresholds and leaf:  # a leaf by itself: the threshold says how wide its door is
            return replace(thresholds[0], evidence=evidence, sill=leaf.sill, top=leaf.top, origin="record")
        return replace(group[0], evidence=evidence)
    widest, best = max(upright, key=lambda h: h.width), [h for h in upright if h.origin == upright[0].origin]
    low, high = _common([widest.span(h) for h in best])
    opening = widest
    if widest.width - (high - low) <= WIDER:
        opening = replace(widest.between(low, high), sill=max(h.sill for h in best), top=min(h.top for h in best))
    # in the middle of the wall that the reveals go through together, as deep as they are
    depths = [(opening.offset(h.centre)[1], h.depth / 2) for h in ([h for h in best if h.depth > 0.0] or upright)]
    back, front = min(at - half for at, half in depths), max(at + half for at, half in depths)
    centre = opening.centre + opening.across * (back + front) / 2
    return replace(opening, evidence=evidence, origin=best[0].origin, centre=centre, depth=front - back)


def _common(spans: list[tuple[float, float]]) -> tuple[float, float]:
    """Return what several meshes of one opening leave clear: those upon each other by what they share, those side by side by what they span."""
    intervals: list[tuple[float, float]] = []
    for low, high in sorted(spans):
        if intervals:
            a, b = intervals[-1]
            shared = min(b, high) - max(a, low)
            if shared > 0.5 * min(b - a, high - low):
                intervals[-1] = (max(a, low), min(b, high))
                continue
        intervals.append((low, high))
    return min(low for low, _ in intervals), max(high for _, high in intervals)


def _apart(holes: list[OpeningEvidence]) -> list[OpeningEvidence]:
    """Narrow what has no width of its own until it stands clear of its neighbours in the same wall."""
    clear_holes = []
    for hole in holes:
        half = hole.width / 2
        if not hole.sized:
            for other in holes:
                along, across = map(abs, hole.offset(other.centre))
                if other is not hole and across < SAME and abs(float(other.along @ hole.along)) > 0.9:
                    half = min(half, (along / 2 if not other.sized else along - other.width / 2) - MULLION / 2)
        if half >= MIN_PANE / 2:  # else there is no room for it beside the other: the two are one
            clear_holes.append(replace(hole, width=2 * half))
    return clear_holes


def jambs(narrow: Sequence[OpeningEvidence], wide: Sequence[OpeningEvidence]) -> tuple[list[OpeningEvidence], list[OpeningEvidence]]:
    """Return (holes, rest): door jambs that face each other make a hole, where no wider reveal is there already.

    Two narrow reveals of one kind and height are a pair when each is the other's nearest.
    """
    tall = [
        h
        for h in narrow
        if h.evidence != "window" and h.top - h.sill >= JAMB_HEIGHT and not any(w.reaches(h.centre) for w in wide if not w.flat)
    ]
    nearest = [
        min(((_jamb_distance(a, b), k) for k, b in enumerate(tall) if b is not a), default=(math.inf, i))[1] for i, a in enumerate(tall)
    ]
    holes: list[OpeningEvidence] = []
    used: set[int] = set()
    for i, k in enumerate(nearest):
        a, b = tall[i], tall[k]
        if i >= k or nearest[k] != i or not JAMBS_APART[0] <= _jamb_distance(a, b) <= JAMBS_APART[1]:
            continue
        along = (b.centre - a.centre) / _jamb_distance(a, b)
        middle, sill, top = (a.centre + b.centre) / 2, max(a.sill, b.sill), min(a.top, b.top)
        holes.append(OpeningEvidence(a.evidence, middle, along, _jamb_distance(a, b), sill, top, max(a.width, b.width), a.origin))
        used |= {id(a), id(b)}
    return holes, [h for h in narrow if id(h) not in used]


def _jamb_distance(a: OpeningEvidence, b: OpeningEvidence) -> float:
    """Return how far two jambs are apart in plan [m]; infinite where they are not of one kind and height."""
    alike = a.evidence == b.evidence and abs(a.sill - b.sill) < 0.1 and abs(a.top - b.top) < 0.1
    return float(np.hypot(*(a.centre - b.centre))) if alike else math.inf


def bays(panes: Sequence[OpeningEvidence]) -> list[OpeningEvidence]:
    """Return windows of which only parts stand out of the wall: panes that adjoin at their corners, as one window around them."""
    ends = [h.ends for h in panes]
    groups: list[set[int]] = []
    for i, j in itertools.combinations(range(len(panes)), 2):
        if np.hypot(*(ends[i][:, None] - ends[j][None]).reshape(-1, 2).T).min() < ADJOIN:
            mine = [g for g in groups if i in g or j in g]
            groups = [g for g in groups if g not in mine] + [set().union({i, j}, *mine)]
    windows = []
    for group in groups:
        longest = max((panes[k] for k in sorted(group)), key=lambda h: h.width)
        points = np.concatenate([ends[k] for k in sorted(group)]) - longest.centre
        (low, back), (high, front) = (f(points @ np.stack([longest.along, longest.across], 1), axis=0) for f in (np.min, np.max))
        centre = longest.centre + (low + high) / 2 * longest.along + (back + front) / 2 * longest.across
        sill, top = max(panes[k].sill for k in group), min(panes[k].top for k in group)
        windows.append(replace(longest, centre=centre, width=float(high - low), depth=float(front - back), sill=sill, top=top))
    return windows
