"""Rows of like things close beside each other, bottles on a rack, grates of a hob: a block each, for no hand comes between them."""

from collections.abc import Sequence

import numpy as np

from pipeline.sources.meshes.mesh_solids import Part, combine_parts

GAP = (0.002, 0.045)  # [m] between neighbours of a row: what touches is of one thing, a basin of four quarters
LIKE = 0.005  # [m] within which sizes and places are one


def blocks(pieces: Sequence[Part]) -> list[Part]:
    """Return convex pieces [m] with rows of like ones as one: along x, then along y, so that a grid is one block as well."""
    for along in (0, 1):
        pieces = [combine_parts(row) if len(row) > 1 else row[0] for row in _rows(pieces, along)]
    return list(pieces)


def _rows(pieces: Sequence[Part], along: int) -> list[list[Part]]:
    """Return the pieces in rows along an axis, each of one piece at least."""
    across = 1 - along
    rows: list[list[Part]] = []
    last: list[tuple[np.ndarray, np.ndarray]] = []  # box of the last of each row
    for piece in sorted(pieces, key=lambda p: round(float(p.hull[:, along].min()), 6)):
        low, high = piece.hull.min(axis=0), piece.hull.max(axis=0)
        width = high[along] - low[along]
        for k, (low0, high0) in enumerate(last):
            gap = low[along] - high0[along]
            beside = np.abs(np.stack([low - low0, high - high0])[:, [across, 2]]).max() < LIKE
            close = GAP[0] < gap <= min(GAP[1], width)  # two thin boards hold something between them
            if beside and close and abs(width - (high0 - low0)[along]) < LIKE:
                rows[k].append(piece)
                last[k] = low, high
                break
        else:
            rows.append([piece])
            last.append((low, high))
    return rows
