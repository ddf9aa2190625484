"""How often a class stands in one room: what training rooms of a type never repeat is not sampled twice there.

A group is one class, or all classes of a kind: a bedroom has one bed, of whatever class. The net gives each slot its own chances of classes, as if slots did not know of each other; a kitchen then gets two sinks because each of two slots
may be *the* sink. Here the chances are taken with each other in view: no group stands in the room
more often than it may.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

COUNTED = 3  # classes that may stand in a room more often than this are not counted
RARE = 0.005  # share of a type's rooms that may hold more of a class than its bound
SURE = 1e-9  # least chance that a slot is something else
Held = tuple[tuple[tuple[int, ...], int], ...]  # groups of classes, and how many of each a room holds at most
Asked = tuple[Sequence[int], int]  # classes, and how many of them


def bound(counts: Sequence[int], rooms: int) -> int:
    """Return the least number that all but `RARE` of `rooms` rooms keep to; `counts` are those of the rooms that hold the class."""
    padded = np.sort(np.concatenate([np.zeros(max(rooms - len(counts), 0), int), np.asarray(counts, int)]))
    return max(int(padded[len(padded) - 1 - int(RARE * len(padded))]), 1)


@dataclass(frozen=True, slots=True)
class Bounds:
    """What a batch of rooms may hold: `never` (B, C + 1) masks classes out; `members` (C, G) and `most` (B, G) as in `bounded`."""

    never: Tensor
    members: Tensor
    most: Tensor

    @classmethod
    def of(cls, held: Sequence[Held], demands: Sequence[Sequence[Asked]], classes: int, device: torch.device | None = None) -> Bounds:
        """Take down what each room's type holds, () for anything, and what is demanded: (classes, number), which always finds room."""
        groups = sorted({group for row in held for group, _ in row})
        members = torch.tensor([[k in group for group in groups] for k in range(classes)], dtype=torch.double).reshape(classes, len(groups))
        never = torch.zeros(len(held), classes + 1, dtype=torch.bool)
        most = torch.full((len(held), len(groups)), COUNTED + 1, dtype=torch.long)
        for i, (row, asked) in enumerate(zip(held, demands, strict=True)):
            never[i, :-1] = bool(row)
            for group, count in row:
                never[i, list(group)] = False
                most[i, groups.index(group)] = max(count, sum(n for wanted, n in asked if set(wanted) & set(group)))
            for wanted, _ in asked:
                never[i, list(wanted)] = False
        return cls(never.to(device), members.to(device), most.to(device))

    def applied(self, logits: Tensor) -> Tensor:
        """Return the chances (B, N, C + 1) of logits within these bounds."""
        chance = logits.masked_fill(self.never[:, None], -torch.inf).double().softmax(-1)
        return bounded(chance, self.members, self.most).to(logits.dtype)


def bounded(chance: Tensor, members: Tensor, most: Tensor) -> Tensor:
    """Return the chances (B, N, C + 1) of classes where at most `most` (B, G) slots of a room may take a class of each group.

    `members` (C, G), 0 or 1, says which classes a group has; a bound above `COUNTED` is none.
    Slots choose in the order of how sure they are of a group: p becomes p Pr(S < most), S being the number of surer slots that take it, and what
    it loses goes to the slot's other chances in proportion. (To condition all slots on the bound alike is worse: two that are sure both give way.)
    With odds o = p / (1 - p), Pr(S = k) is the k-th elementary symmetric polynomial of the surer slots' odds times the chance that none takes it.
    """
    held = chance[..., :-1].double()
    p, order = (held @ members.double()).clamp(0, 1).sort(dim=1, descending=True, stable=True)
    others = (1 - p).clamp_min(SURE)
    none = torch.cat([torch.ones_like(p[:, :1]), others[:, :-1].cumprod(1)], 1)
    ways = [torch.ones_like(p)]
    for _ in range(COUNTED - 1):
        product = p / others * ways[-1]
        ways.append(torch.cat([torch.zeros_like(p[:, :1]), product[:, :-1].cumsum(1)], 1))
    below = none * torch.stack(ways).cumsum(0)
    left = below.gather(0, most.clamp(1, COUNTED)[None, :, None, :].expand(1, -1, p.shape[1], -1) - 1)[0]
    left = torch.where(most[:, None] > COUNTED, 1.0, left.clamp(SURE**3, 1))
    kept = (torch.zeros_like(p).scatter(1, order, left).log() @ members.double().T).exp()
    weighed = torch.cat([held * kept, chance[..., -1:].double()], -1)
    return (weighed / weighed.sum(-1, keepdim=True).clamp_min(torch.finfo(torch.double).tiny)).to(chance.dtype)
