"""The numbers of the experiments that stand in params.yaml, and which rooms a number of them means."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class MetricsSettings:
    """What the stage `metrics` measures (section `metrics`)."""

    rooms: int = 25  # rooms per condition, from the test split
    all_rooms: int = 400  # most rooms of the split that are furnished for CKL
    counts: tuple[int, ...] = (5, 8, 12, 16)  # N_target of the quantity experiment
    taus: tuple[float, ...] = (0.6, 0.7, 0.8, 0.9)  # thresholds of the walkable-area experiment
    split: str = "test"  # rooms of this split; train where it has too few
    plan_seeds: int = 2  # seeds per benchmark prompt
    gallery: int = 4  # homes that are path-traced
    gallery_samples: int = 48  # light paths per pixel
    gallery_width: int = 800  # px
    inception: str = ""  # TorchScript file of Inception-v3, for FID, KID and SCA with its features beside our own net's; "": none
    baselines: bool = False  # train and compare the layout models of the peers as well (stage `baselines`)


def spread(items: Sequence[T], count: int) -> list[T]:
    """Return `count` of the items, evenly spread over the list."""
    taken = min(count, len(items))
    return [items[i * len(items) // taken] for i in range(taken)]
