"""How often a class stands in one room: what training rooms of a type never repeat is not sampled twice there.

The net gives each slot its own chances of classes, as if slots did not know of each other; a kitchen then gets two sinks because each of two slots
may be *the* sink. Here the chances are taken given that no class stands in the room more often than it may: exactly, for slots that are
independent but for that, one class after the other.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import torch
from torch import Tensor

COUNTED = 3  # classes that may stand in a room more often than this are not counted
RARE = 0.005  # share of a type's rooms that may hold more of a class than its bound
SURE = 1e-9  # least chance that a slot is something else


def bound(counts: Sequence[int], rooms: int) -> int:
    """Return the least number that all but `RARE` of `rooms` rooms keep to; `counts` are those of the rooms that hold the class."""
    padded = np.sort(np.concatenate([np.zeros(max(rooms - len(counts), 0), int), np.asarray(counts, int)]))
    return max(int(padded[len(padded) - 1 - int(RARE * len(padded))]), 1)


def bounded(chance: Tensor, most: Tensor) -> Tensor:
    """Return the chances (B, N, C + 1) of classes where at most `most` (B, C) slots of a room may take each; above `COUNTED`: any number.

    Slots choose in the order of how sure they are of a class: p becomes p Pr(S < most), S being the number of surer slots that take it, and what
    it loses goes to the slot's other chances in proportion. (To condition all slots on the bound alike is worse: two that are sure both give way.)
    With odds o = p / (1 - p), Pr(S = k) is the k-th elementary symmetric polynomial of the surer slots' odds times the chance that none takes it.
    """
    held = chance[..., :-1].double()
    order = held.argsort(dim=1, descending=True, stable=True)
    p = held.gather(1, order)
    others = (1 - p).clamp_min(SURE)
    none = torch.cat([torch.ones_like(p[:, :1]), others[:, :-1].cumprod(1)], 1)
    ways = [torch.ones_like(p)]
    for _ in range(COUNTED - 1):
        product = p / others * ways[-1]
        ways.append(torch.cat([torch.zeros_like(p[:, :1]), product[:, :-1].cumsum(1)], 1))
    room = none * torch.stack(ways).cumsum(0)
    left = room.gather(0, most.clamp(1, COUNTED)[None, :, None, :].expand(1, -1, p.shape[1], -1) - 1)[0]
    left = torch.where(most[:, None] > COUNTED, 1.0, left).clamp(0, 1)
    kept = torch.zeros_like(p).scatter(1, order, left).to(chance.dtype)
    weighed = torch.cat([chance[..., :-1] * kept, chance[..., -1:]], -1)
    return weighed / weighed.sum(-1, keepdim=True).clamp_min(torch.finfo(chance.dtype).tiny)
