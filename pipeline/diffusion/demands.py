"""Asked-for categories, imposed on the expected clean slots at every step of sampling.

The count of a room is guided by its empty channel (`guidance.quantity_descent`); which categories are in it is settled much
earlier, at high noise, by the class block. So the estimate of x0 that each step goes towards gets the classes that are asked for: the
slots nearest to one take it wholly, what is beyond the most gives it up. From then on the net places those slots as what they are.
"""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor

from pipeline.diffusion.codec import CLASS_SCALE, CONTINUOUS, EMPTY_SCALE
from pipeline.diffusion.context import Demand


def impose(x0: Tensor, demands: Sequence[Sequence[Demand]], classes: Sequence[str]) -> Tensor:
    """Return slots (B, N, D) of which each room meets its demands; rooms without demands are untouched.

    Where demands ask for more things than there are slots, as many as fit are met.
    """
    if not any(demands):
        return x0
    changed = x0.clone()
    order = {name: k for k, name in enumerate(classes)}
    for room, asked in zip(changed, demands, strict=True):
        _impose(room, sorted(asked, key=lambda d: len(d.categories)), order)
    return changed


def _impose(room: Tensor, asked: Sequence[Demand], order: dict[str, int]) -> None:
    """Change one room (N, D) in place; the narrowest demands choose first, and count for wider ones around them."""
    block, empty = room[:, CONTINUOUS:-1], room[:, -1]
    held: dict[int, int] = {}  # slot -> the class that it has been given
    for demand in asked:
        mine = torch.tensor(sorted({order[c] for c in demand.categories if c in order}), dtype=torch.long, device=room.device)
        if not len(mine):
            continue
        inside = block[:, mine].amax(1)
        rest = block.clone()
        rest[:, mine] = -torch.inf
        liking = inside - rest.amax(1) - 2 * CLASS_SCALE / EMPTY_SCALE * empty.clamp(-EMPTY_SCALE, EMPTY_SCALE)
        ranked = [k for k in torch.argsort(liking, descending=True, stable=True).tolist() if k not in held]
        met = sum(c in mine.tolist() for c in held.values())
        lacking = max(demand.least - met, 0)
        for slot in ranked[:lacking]:
            held[slot] = int(mine[block[slot, mine].argmax()])
            block[slot] = 0.0
            block[slot, held[slot]] = CLASS_SCALE
            empty[slot] = -EMPTY_SCALE / 2
        if demand.most is not None:
            spare = max(demand.most - met - min(lacking, len(ranked)), 0)
            mine_now = [k for k in ranked[lacking:] if int(block[k].argmax()) in mine.tolist() and empty[k] < 0]
            for slot in ranked[lacking:]:
                if slot not in mine_now[:spare]:
                    block[slot, mine] = block[slot].amin().clamp_max(0.0) - CLASS_SCALE
