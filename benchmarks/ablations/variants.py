"""The variants: one thing changed in each."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

import torch

from benchmarks.ablations.nets import (
    DiscreteChain,
    ExpectsClean,
    ExpectsNoise,
    Forgetful,
    LossOf,
    clean_as_v,
    discrete,
    plain_loss,
    unrolled,
)
from pipeline.diffusion import loss as diffusion_loss
from pipeline.diffusion.codec import CHANNELS
from pipeline.diffusion.loss import Draw
from pipeline.diffusion.schedule import FIRST, LAST
from pipeline.diffusion.set_transformer import SetTransformer

DrawOf = Callable[[torch.Generator, int, int], Draw]


def evenly(rng: torch.Generator, batch: int, slots: int) -> Draw:
    """Draw levels that are even in lambda."""
    return Draw(
        FIRST + (LAST - FIRST) * torch.rand(batch, generator=rng),
        torch.randn(batch, slots, CHANNELS, generator=rng),
        torch.zeros(batch, dtype=torch.bool),
    )


def in_the_middle(rng: torch.Generator, batch: int, slots: int) -> Draw:
    """Draw levels where arrangement is decided alone: low noise, that of sizes and last centimetres, is rare."""
    level = (diffusion_loss.MIDDLE + diffusion_loss.BREADTH * torch.randn(batch, generator=rng)).clamp(FIRST, LAST)
    return Draw(level, torch.randn(batch, slots, CHANNELS, generator=rng), torch.zeros(batch, dtype=torch.bool))


def low_noise(rng: torch.Generator, batch: int, slots: int) -> Draw:
    """Draw half of the levels from the last third."""
    drawn = diffusion_loss.draw(rng, batch, slots)
    low = torch.rand(batch, generator=rng)
    late = LAST - (LAST - FIRST) / 3 * torch.rand(batch, generator=rng)
    return drawn._replace(level=torch.where(low < 0.5, late, drawn.level))


@dataclass(frozen=True, slots=True)
class Variant:
    """What one net has of its own. `steps` is a factor; `houses` of the training split (0: all); `model`, `train` are settings."""

    says: str
    steps: float = 1.0
    houses: int = 0
    seed: int = 0
    model: Mapping[str, int] = field(default_factory=dict)
    train: Mapping[str, Any] = field(default_factory=dict)
    net: type[SetTransformer] = Forgetful
    loss: LossOf = plain_loss
    draw: DrawOf = diffusion_loss.draw
    true_share: bool = False  # room types as often as they are, instead of by the square root


PLAIN = Variant("as it is: v, 2 passes of 2 layers, width 96, Muon")
VARIANTS: Mapping[str, Variant] = MappingProxyType(
    {
        "plain": PLAIN,
        "again": replace(PLAIN, says="the same, another seed", seed=1),
        "quarter": replace(PLAIN, says="a fourth of the steps", steps=0.25),
        "half": replace(PLAIN, says="half the steps", steps=0.5),
        "double": replace(PLAIN, says="twice the steps", steps=2.0),
        "houses260": replace(PLAIN, says="208 houses (of 260 in all)", houses=208),
        "houses1500": replace(PLAIN, says="1,200 houses (of 1,500)", houses=1200),
        "width64": replace(PLAIN, says="width 64", model={"width": 64}),
        "width160": replace(PLAIN, says="width 160", model={"width": 160}),
        "pass1": replace(PLAIN, says="one pass of 4 layers", model={"passes": 1, "layers": 4}),
        "layers1": replace(PLAIN, says="2 passes of 1 layer", model={"layers": 1}),
        "layers3": replace(PLAIN, says="2 passes of 3 layers", model={"layers": 3}),
        "passes3": replace(PLAIN, says="3 passes of 2 layers", model={"passes": 3}),
        "x0": replace(PLAIN, says="x0, its error plain", net=ExpectsClean),
        "x0v": replace(PLAIN, says="x0, its error over sigma (v's weights)", net=ExpectsClean, loss=clean_as_v),
        "eps": replace(PLAIN, says="eps", net=ExpectsNoise),
        "even": replace(PLAIN, says="levels even in lambda", draw=evenly),
        "middle": replace(PLAIN, says="levels of the middle alone", draw=in_the_middle),
        "lownoise": replace(PLAIN, says="half of the levels at low noise", draw=low_noise),
        "share": replace(PLAIN, says="room types in their true share", true_share=True),
        "selfcond": replace(PLAIN, says="self-conditioning", net=SetTransformer, loss=diffusion_loss.denoising_loss),
        "unrolled": replace(PLAIN, says="trained on what the sampler holds", loss=unrolled),
        "discrete": replace(PLAIN, says="classes as a discrete chain, the number told", net=DiscreteChain, loss=discrete),
        "adamw": replace(PLAIN, says="AdamW, rate .001", train={"optimiser": "adamw", "learning_rate": 1e-3}),
        "rate2": replace(PLAIN, says="rate .002", train={"learning_rate": 2e-3}),
        "rate8": replace(PLAIN, says="rate .008", train={"learning_rate": 8e-3}),
        "objects160": replace(PLAIN, says="160 objects a step", train={"objects": 160}),
        "objects2560": replace(PLAIN, says="2,560 objects a step", train={"objects": 2560}),
    }
)
