"""The chances of manifests/calibration/rates.yaml."""

import functools
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

PATH = Path(__file__).resolve().parents[3] / "manifests" / "calibration" / "rates.yaml"
Rates = Mapping[str, Any]


@functools.cache
def load() -> Mapping[str, Rates]:
    """Read the manifest: by kind of room, then by decision; a chance, or a mapping of choices to their shares."""
    loaded: dict[str, Rates] = yaml.safe_load(PATH.read_text(encoding="utf-8"))
    return loaded
