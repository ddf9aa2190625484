"""Nets that differ from the layout model's in one thing."""

from __future__ import annotations

from collections.abc import Callable

import torch
from torch import Tensor, nn

from pipeline.diffusion.batch import Objects, RoomBatch
from pipeline.diffusion.codec import YAW, Codec, Normalisation
from pipeline.diffusion.loss import Draw, Loss
from pipeline.diffusion.schedule import FIRST, LAST, alpha_sigma, levels
from pipeline.diffusion.set_transformer import FloorCode, Pass, SetTransformer
from pipeline.diffusion.settings import ModelSettings, TrainSettings

LossOf = Callable[[SetTransformer, RoomBatch, Objects, Draw, TrainSettings], tuple[Loss, ...]]
STEP = (LAST - FIRST) / 11  # lambda between two of twelve evaluations
HALF = 0.5  # share of the rooms of a step that are trained on what a sampler would hold


class Forgetful(SetTransformer):
    """Does not know what it expected before: the layout model without self-conditioning, which the other nets here have not either."""

    def expected(
        self, x: Tensor, classes: Tensor, level: Tensor, rooms: RoomBatch, code: FloorCode | None = None, before: Tensor | None = None
    ) -> Tensor:
        """Return the expected clean channels."""
        return super().expected(x, classes, level, rooms, code)


class ExpectsClean(Forgetful):
    """Answers with the clean channels themselves."""

    def clean(self, x: Tensor, answer: Tensor, alpha: Tensor, sigma: Tensor) -> Tensor:
        """Return the clean channels that an answer stands for."""
        return answer


class ExpectsNoise(Forgetful):
    """Answers with the noise."""

    def clean(self, x: Tensor, answer: Tensor, alpha: Tensor, sigma: Tensor) -> Tensor:
        """Return the clean channels that an answer stands for."""
        return (x - sigma * answer) / alpha


class MaskedKinds(nn.Embedding):
    """Embeds categories, those that are not decided yet as one more category."""

    def __init__(self, kinds: int, width: int) -> None:
        super().__init__(kinds + 1, width)
        self.hidden: Tensor | None = None

    def forward(self, classes: Tensor) -> Tensor:
        """Embed classes (B, N), of which `hidden` (B, N) are not known."""
        return super().forward(classes if self.hidden is None else torch.where(self.hidden, self.num_embeddings - 1, classes))


class MaskedCodec(Codec):
    """Reads what is not decided yet in the mean of all categories."""

    hidden: Tensor | None = None

    def metric(self, channels: Tensor, classes: Tensor) -> Tensor:
        """Undo the normalisation as far as the classes are known."""
        return super().metric(channels, classes if self.hidden is None else torch.where(self.hidden, self.classes, classes))


class DiscreteChain(Forgetful):
    """Categories are a chain of their own beside the geometry, in which each of a told number of objects is masked until it is decided.

    As in MiDiffusion (Hu et al. 2024), with masks alone: at lambda an object is masked with the share of the way that is left. What is
    decided stays.
    """

    def __init__(self, norm: Normalisation, layouts: int, settings: ModelSettings) -> None:
        super().__init__(norm, layouts, settings)
        self.kind = MaskedKinds(len(norm.classes) + 1, settings.width)
        self.decide = nn.Linear(settings.width, len(norm.classes))
        self.tokens = torch.zeros(0)
        self.passes[-1].register_forward_hook(self._keep)

    def _keep(self, look: Pass, given: object, answer: tuple[Tensor, Tensor]) -> None:
        self.tokens = answer[0]

    def _apply(self, fn: object, recurse: bool = True) -> SetTransformer:
        super()._apply(fn, recurse)
        self.codec = MaskedCodec(self.norm, self.slot.weight.device)
        return self

    def hide(self, hidden: Tensor | None) -> None:
        """Mask objects (B, N)."""
        self.kind.hidden = self.codec.hidden = hidden  # type: ignore[assignment,attr-defined]

    @staticmethod
    def masked(level: Tensor) -> Tensor:
        """Return the share of objects that are masked at levels."""
        return ((LAST - level) / (LAST - FIRST)).clamp(0, 1)

    @torch.no_grad()
    def draw(self, rooms: RoomBatch, occupied: Tensor, rng: torch.Generator, evaluations: int) -> tuple[Tensor, Tensor]:
        """Draw classes (B, N) and clean channels (B, N, 40) of `occupied` (B, N) slots."""
        device = occupied.device
        classes = torch.where(occupied, 0, self.codec.classes)
        hidden, at = occupied.clone(), levels(evaluations)
        x = torch.randn(*occupied.shape, self.slot.in_features, generator=rng).to(device)
        ones = torch.ones(len(occupied), device=device)
        for number, level in enumerate(at):
            self.hide(hidden)
            x0 = self.expected(x, classes, level * ones, rooms)
            now = ones * level
            after = ones * (at[number + 1] if number + 1 < len(at) else LAST)
            stays = (self.masked(after) / self.masked(now).clamp_min(1e-6))[:, None]
            decided = hidden & (torch.rand(occupied.shape, generator=rng).to(device) >= stays)
            chance = self.decide(self.tokens).softmax(-1).flatten(0, 1).cpu()
            drawn = torch.multinomial(chance, 1, generator=rng).view(occupied.shape).to(device)
            classes = torch.where(decided, drawn, classes)
            hidden = hidden & ~decided
            if number + 1 < len(at):
                x = renoised(x, x0, now, after, torch.randn(x.shape, generator=rng).to(device))
        self.hide(None)
        return classes, x0


def renoised(x: Tensor, x0: Tensor, level: Tensor, following: Tensor, noise: Tensor) -> Tensor:
    """Take DDPM's step from levels (B,) to later ones: x_t ~ q(x_t | x_s, x0)."""
    (alpha, sigma), (alpha_next, sigma_next) = ([v[:, None, None] for v in alpha_sigma(at)] for at in (level, following))
    fresh = sigma_next * (-torch.expm1(level - following))[:, None, None].clamp_min(0).sqrt()
    kept = (sigma_next**2 - fresh**2).clamp_min(0).sqrt()
    return alpha_next * x0 + kept * (x - alpha * x0) / sigma + fresh * noise


def as_loss(error: Tensor, occupied: Tensor) -> Loss:
    """Average squared errors (B, N, 40) over a room's objects."""
    count = occupied.sum((1, 2)).clamp_min(1)
    error = error * occupied
    return Loss(error[..., : YAW.stop].mean(-1).sum(1) / count, error[..., YAW.stop :].mean(-1).sum(1) / count)


def plain_loss(net: SetTransformer, rooms: RoomBatch, objects: Objects, drawn: Draw, settings: TrainSettings) -> tuple[Loss, ...]:
    """Return squared errors in what the net answers: the noise, the clean channels, or v."""
    alpha, sigma = (v[:, None, None] for v in alpha_sigma(drawn.level))
    occupied = (objects.classes < net.codec.classes)[..., None]
    x0, noise = objects.channels, drawn.noise
    target = x0 if isinstance(net, ExpectsClean) else noise if isinstance(net, ExpectsNoise) else alpha * noise - sigma * x0
    answers = net(alpha * x0 + sigma * noise, objects.classes, drawn.level, rooms)
    return tuple(as_loss((target - answer) ** 2, occupied) for answer in answers)


def clean_as_v(net: SetTransformer, rooms: RoomBatch, objects: Objects, drawn: Draw, settings: TrainSettings) -> tuple[Loss, ...]:
    """Return the errors of clean channels as v's, at most 25 times as much: an error of v is that of x0 over sigma."""
    sigma = alpha_sigma(drawn.level)[1].clamp_min(0.2)
    return tuple(Loss(*(term / sigma**2 for term in loss)) for loss in plain_loss(net, rooms, objects, drawn, settings))


def unrolled(net: SetTransformer, rooms: RoomBatch, objects: Objects, drawn: Draw, settings: TrainSettings) -> tuple[Loss, ...]:
    """Return the errors where half of the rooms hold what a sampler makes of them: noised one step further, expected, and taken back."""
    occupied = (objects.classes < net.codec.classes)[..., None]
    alpha, sigma = (v[:, None, None] for v in alpha_sigma(drawn.level))
    before = (drawn.level - STEP).clamp_min(FIRST)
    wide_alpha, wide_sigma = (v[:, None, None] for v in alpha_sigma(before))
    with torch.no_grad():
        x = wide_alpha * objects.channels + wide_sigma * drawn.noise
        held = renoised(x, net.expected(x, objects.classes, before, rooms), before, drawn.level, torch.randn_like(x))
    stepped = ((torch.arange(len(x), device=x.device) % 2 == 0) & (drawn.level > FIRST + STEP))[:, None, None]
    x = torch.where(stepped, held, alpha * objects.channels + sigma * drawn.noise)
    target = (alpha * x - objects.channels) / sigma
    error = [(target - answer) ** 2 * (sigma**2 / sigma.clamp_min(0.2) ** 2) for answer in net(x, objects.classes, drawn.level, rooms)]
    return tuple(as_loss(e, occupied) for e in error)


def discrete(net: SetTransformer, rooms: RoomBatch, objects: Objects, drawn: Draw, settings: TrainSettings) -> tuple[Loss, ...]:
    """Return the errors where objects are masked as at these levels; what is masked is asked for."""
    assert isinstance(net, DiscreteChain)
    occupied = objects.classes < net.codec.classes
    chance = net.masked(drawn.level)[:, None]
    hidden = occupied & (torch.rand(occupied.shape).to(occupied.device) < chance)
    net.hide(hidden)
    losses = plain_loss(net, rooms, objects, drawn, settings)
    net.hide(None)
    asked = nn.functional.cross_entropy(
        net.decide(net.tokens).transpose(1, 2), objects.classes.clamp_max(net.codec.classes - 1), reduction="none"
    )
    wrong = (asked * hidden).sum(1) / occupied.sum(1).clamp_min(1)
    return (*losses[:-1], losses[-1]._replace(geometry=losses[-1].geometry + 0.1 * wrong))
