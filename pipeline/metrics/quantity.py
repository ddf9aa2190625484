"""Object quantity control: SR(N), the share of rooms with exactly the number of objects that was asked for (paper eq.)."""

from collections.abc import Iterable, Sequence

from pipeline.metrics.intervals import Rate, rate
from pipeline.metrics.rows import Row


def success_rates(asked: Sequence[int], actual: Sequence[int]) -> dict[str, Rate]:
    """Return SR(N) for each N that was asked for, ascending, keyed by N as text (JSON has no other keys)."""
    rates: dict[str, Rate] = {}
    for target in sorted(set(asked)):
        counts = [m for a, m in zip(asked, actual, strict=True) if a == target]
        rates[str(target)] = rate(sum(c == target for c in counts), len(counts))
    return rates


def from_rooms(rooms: Iterable[Row]) -> dict[str, Rate]:
    """Return SR(N) from rows of the rooms table that carry an asked number."""
    wanted = [(int(r["asked_objects"]), int(r["objects"])) for r in rooms if r["asked_objects"] is not None]
    return success_rates([a for a, _ in wanted], [m for _, m in wanted])
