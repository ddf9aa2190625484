"""Explicit randomness: every generator is derived from (seed, name, keys); nothing draws from a global one."""

import hashlib

import numpy as np


def key(seed: int, name: str, *keys: int | str) -> int:
    """Derive a 128-bit key from `seed`, the drawing step's `name` and its `keys`; stable across machines."""
    text = "\x1f".join([str(int(seed)), name, *map(str, keys)])
    return int.from_bytes(hashlib.blake2b(text.encode(), digest_size=16).digest(), "little")


def generator(seed: int, name: str, *keys: int | str) -> np.random.Generator:
    """Return a numpy generator (Philox) for one step, e.g. `generator(seed, "plan", index, attempt)`."""
    return np.random.Generator(np.random.Philox(key=key(seed, name, *keys)))
