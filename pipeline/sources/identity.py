"""Ids and splits of what comes from a source: functions of its own id alone."""

import re

from pipeline.seeds import key


def split_of(uid: str) -> str:
    """Return train (8 of 10), val or test for a house or model, from its id alone."""
    draw = key(0, "split", uid) % 10
    return "val" if draw == 8 else "test" if draw == 9 else "train"


def slug(prefix: str, name: str) -> str:
    """Return an id that matches [a-z][a-z0-9_]*."""
    return f"{prefix}_{re.sub(r'[^a-z0-9]+', '_', name.lower()).strip('_')}"
