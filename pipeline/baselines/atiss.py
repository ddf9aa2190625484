"""ATISS-type autoregressive transformer: objects one after the other, in any order, until it says that the room is done.

Paschalidou et al. 2021: the encoder sees the floor and the objects so far without an order; a query token becomes the next
object, attribute by attribute (class, centre, yaw, size), each given those before; an end class closes the room. Trained
on a random prefix of a random permutation. It has no shape latent: assets would be looked up by size.
"""

import math

import torch
from torch import Tensor, nn

from pipeline.baselines.rooms import BOX, PLACE, SIZE, BaselineSettings, Found, Furniture, Outlines, Scaling
from pipeline.baselines.transformer import Block, FloorEncoder, sines

MIXTURES = 10
RATES = 16  # sines per attribute
BIN = 2 / 255  # width of a bin of [-1, 1]
NARROWEST = -6.0  # least log scale
ATTRIBUTES = 7  # centre 3, yaw 1, size 3, all in [-1, 1]


class Autoregressive(nn.Module):
    """Chances of the next object, given a room and what stands there already."""

    def __init__(self, scaling: Scaling, layouts: int, settings: BaselineSettings) -> None:
        super().__init__()
        width, classes = settings.width, len(scaling.classes)
        self.scaling, self.settings = scaling, settings
        self.floor = FloorEncoder(width, layouts, scaling.high[0])
        self.kind, self.query = nn.Embedding(classes, width), nn.Parameter(0.02 * torch.randn(width))
        self.enter = nn.Linear(2 * RATES * ATTRIBUTES, width)
        self.blocks = nn.ModuleList(Block(width, settings.heads, conditioned=False) for _ in range(settings.layers))
        self.norm, self.classes = nn.LayerNorm(width), nn.Linear(width, classes + 1)  # the last: the room is done
        given = 2 * width
        self.place, self.yaw, self.size = (
            nn.Sequential(nn.Linear(given + 2 * RATES * known, width), nn.ReLU(), nn.Linear(width, 3 * MIXTURES * own))
            for known, own in ((0, 3), (3, 1), (4, 3))
        )

    def attributes(self, boxes: Tensor) -> Tensor:
        """Return centre, yaw, size (..., 7), each min-max scaled, of slots' box channels (..., 8)."""
        yaw = torch.atan2(boxes[..., 7:8], boxes[..., 6:7]) / math.pi
        return torch.cat([boxes[..., PLACE], yaw, boxes[..., SIZE]], -1)

    def sines(self, values: Tensor) -> Tensor:
        """Return the sines (..., 2 RATES k) of k attributes (..., k)."""
        return sines(values, RATES, math.pi / 2, 64 * math.pi).flatten(-2)

    def next(self, floor: Tensor, kinds: Tensor, values: Tensor, there: Tensor) -> Tensor:
        """Return the code (B, d) of the next object, from those (B, N) that `there` marks."""
        tokens = self.kind(kinds) + self.enter(self.sines(values))
        ones = torch.ones_like(there[:, :1])
        x = torch.cat([floor[:, None], self.query.expand(len(floor), 1, -1), tokens], 1)
        mask = torch.cat([ones, ones, there], 1)
        for block in self.blocks:
            x = block(x, mask=mask)
        code: Tensor = self.norm(x[:, 1])
        return code

    def mixtures(self, head: nn.Module, code: Tensor, kind: Tensor, known: Tensor) -> Tensor:
        """Return the mixtures (B, own, 3, K) of a head's attributes given the class (B,) and the attributes (B, known) before."""
        given = torch.cat([code, self.kind(kind), self.sines(known)], -1)
        parameters: Tensor = head(given).unflatten(-1, (-1, 3, MIXTURES))
        return parameters


def loss(net: Autoregressive, rooms: Outlines, things: Furniture, rng: torch.Generator) -> Tensor:
    """Return the mean negative log-likelihood of the next object after a random prefix of a random order."""
    count, slots = (things.classes < len(net.scaling.classes)).sum(1), things.classes.shape[1]
    order = torch.rand(things.classes.shape, generator=rng)
    order = torch.where(things.classes < len(net.scaling.classes), order, 2.0).argsort(1)  # objects first, mixed
    kinds = things.classes.gather(1, order)
    boxes = net.scaling.encode(things)[..., :BOX].gather(1, order[..., None].expand(-1, -1, BOX))
    values = net.attributes(boxes)
    before = (torch.rand(len(kinds), generator=rng) * (count + 1)).long()  # 0..count, all alike
    there = torch.arange(slots)[None] < before[:, None]
    code = net.next(net.floor(rooms), kinds.clamp_max(len(net.scaling.classes) - 1), values, there)
    rooms_done = before == count
    row, column = torch.arange(len(kinds)), before.clamp_max(slots - 1)
    kind = torch.where(rooms_done, len(net.scaling.classes), kinds[row, column])
    total = nn.functional.cross_entropy(net.classes(code), kind, reduction="none")
    more = ~rooms_done
    kind, value, code = kind[more], values[row, column][more], code[more]
    likely = [
        log_likelihood(net.mixtures(net.place, code, kind, value[:, :0]), value[:, :3]).sum(-1),
        log_likelihood(net.mixtures(net.yaw, code, kind, value[:, :3]), value[:, 3:4]).sum(-1),
        log_likelihood(net.mixtures(net.size, code, kind, value[:, :4]), value[:, 4:]).sum(-1),
    ]
    return (total.sum() - torch.stack(likely).sum()) / len(kinds)


def log_likelihood(parameters: Tensor, value: Tensor) -> Tensor:
    """Return the log of the chance under mixtures of discretised logistics (Salimans et al. 2017) (...) of the bin about `value` (...) in [-1, 1]; the outermost bins reach to infinity.

    `parameters` (..., 3, K): logits of the components, their means, their log scales.
    """
    weight, mean, scale = _parts(parameters)
    off = value[..., None] - mean
    upper = torch.sigmoid((off + BIN / 2) * torch.exp(-scale))
    lower = torch.sigmoid((off - BIN / 2) * torch.exp(-scale))
    upper = torch.where(value[..., None] > 1 - BIN / 2, torch.ones_like(upper), upper)
    lower = torch.where(value[..., None] < -1 + BIN / 2, torch.zeros_like(lower), lower)
    return torch.logsumexp(weight + (upper - lower).clamp_min(1e-10).log(), -1)


def draw(parameters: Tensor, rng: torch.Generator) -> Tensor:
    """Draw values (...) in [-1, 1] from mixtures (..., 3, K)."""
    weight, mean, scale = _parts(parameters)
    chosen = torch.multinomial(weight.exp().flatten(0, -2), 1, generator=rng).view(*weight.shape[:-1], 1)
    even = torch.rand(weight.shape[:-1], generator=rng).clamp(1e-5, 1 - 1e-5)
    mean, scale = mean.gather(-1, chosen)[..., 0], scale.gather(-1, chosen)[..., 0]
    return (mean + scale.exp() * torch.logit(even)).clamp(-1, 1)


def _parts(parameters: Tensor) -> tuple[Tensor, Tensor, Tensor]:
    weight, mean, scale = parameters.unbind(-2)
    return weight.log_softmax(-1), mean, scale.clamp_min(NARROWEST)


@torch.no_grad()
def sample(net: Autoregressive, rooms: Outlines, rng: torch.Generator) -> Found:
    """Furnish rooms, object by object, until each is done or full."""
    slots, classes, batch = net.settings.slots, len(net.scaling.classes), len(rooms)
    floor = net.floor(rooms)
    kinds, boxes = torch.zeros(batch, slots, dtype=torch.long), torch.zeros(batch, slots, BOX)
    values, there = torch.zeros(batch, slots, ATTRIBUTES), torch.zeros(batch, slots, dtype=torch.bool)
    going = torch.ones(batch, dtype=torch.bool)
    for k in range(slots):
        code = net.next(floor, kinds, values, there)
        chosen = torch.multinomial(net.classes(code).softmax(-1), 1, generator=rng)[:, 0]
        going &= chosen < classes
        if not going.any():
            break
        kind = chosen.clamp_max(classes - 1)
        place = draw(net.mixtures(net.place, code, kind, values[:, 0, :0]), rng)
        yaw = draw(net.mixtures(net.yaw, code, kind, place), rng)
        size = draw(net.mixtures(net.size, code, kind, torch.cat([place, yaw], -1)), rng)
        kinds[:, k], there[:, k], values[:, k] = kind, going, torch.cat([place, yaw, size], -1)
        boxes[:, k] = torch.cat([place, size, (math.pi * yaw).cos(), (math.pi * yaw).sin()], -1)
    return Found(there, kinds, net.scaling.metric(boxes))
