"""The training loss: paper eq. 1 on the channels of objects whose classes are known."""

from typing import NamedTuple

import torch
from torch import Tensor

from pipeline.diffusion.articulated_collision import Furniture, Obstacles, articulated_collision
from pipeline.diffusion.batch import Objects, RoomBatch
from pipeline.diffusion.codec import CHANNELS, YAW, Codec
from pipeline.diffusion.schedule import FIRST, LAST, alpha_sigma, lambda_of
from pipeline.diffusion.set_transformer import SetTransformer
from pipeline.diffusion.settings import TrainSettings

MOST_SHIFT = 0.1  # largest change of a clean channel that the constraint term may ask for
MIDDLE, BREADTH = 0.5, 2.5  # mean and deviation of the levels at which rooms take shape
UNIFORM = 0.5  # share of the levels that is drawn evenly from all that a sampler meets
TOLD = 0.9  # share of the rooms whose poses are told
SEEN = 0.5  # share of the rooms that have been looked at before, as all have but at a sampler's first step


class Draw(NamedTuple):
    """What one step draws: levels lambda (B,), noise (B, N, 40), which rooms (B,) have been looked at before, and of which the poses are told."""

    level: Tensor
    noise: Tensor
    seen: Tensor
    told: Tensor


class Loss(NamedTuple):
    """Terms per room (B,): eq. 1 on geometry and on shape latents."""

    geometry: Tensor
    shape: Tensor


def draw(rng: torch.Generator, batch: int, slots: int) -> Draw:
    """Draw the randomness of one step. Half of the levels are even in lambda, as samplers take them, half lie where arrangement is decided."""
    even = FIRST + (LAST - FIRST) * torch.rand(batch, generator=rng)
    middle = (MIDDLE + BREADTH * torch.randn(batch, generator=rng)).clamp(FIRST, LAST)
    level = torch.where(torch.rand(batch, generator=rng) < UNIFORM, even, middle)
    noise, seen = torch.randn(batch, slots, CHANNELS, generator=rng), torch.rand(batch, generator=rng) < SEEN
    return Draw(level, noise, seen, torch.rand(batch, generator=rng) < TOLD)


def constraint_descent(x0: Tensor, classes: Tensor, codec: Codec, rooms: RoomBatch, sweeps: Tensor) -> Tensor:
    """Return g = -grad phi_articoll (B, N, 40) at clean channels x0; only position x, y and yaw have any."""
    boxes = codec.metric(x0[..., : YAW.stop], classes).detach().double().cpu().numpy()
    furniture = Furniture.of((classes < codec.classes).cpu().numpy(), sweeps.double().cpu().numpy())
    gradient = torch.from_numpy(articulated_collision(boxes, furniture, Obstacles.of(rooms))[1]).to(x0)
    g = torch.zeros_like(x0)
    g[..., :2], g[..., YAW] = -gradient[..., :2] * codec.reach, -gradient[..., YAW]
    return g


def denoising_loss(net: SetTransformer, rooms: RoomBatch, objects: Objects, drawn: Draw, settings: TrainSettings) -> tuple[Loss, ...]:
    """Return the loss terms of a batch for each pass of the net, the last one being what samplers use.

    Eq. 1: || (eps - lambda Sigma g) - eps_theta ||^2, with g the DESCENT -grad phi at the model's own x0 (the printed
    +grad would teach it to seek collisions), for t < `constraint_below`. Sigma is the posterior variance of the paper's
    step there. Changing eps by delta changes x0 by -sigma / alpha delta at the same x_t, so the term is carried over to
    v = alpha eps - sigma x0, which the net predicts; with v the squared error is that of eps divided by alpha^2.
    """
    codec, classes = net.codec, objects.classes
    alpha, sigma = (v[:, None, None] for v in alpha_sigma(drawn.level))
    occupied = (classes < codec.classes)[..., None]
    xt = alpha * objects.channels + sigma * drawn.noise
    poses = objects.poses * drawn.told[:, None]
    weights = occupied * torch.where(drawn.told[:, None], objects.weights, 1.0)[..., None]
    answers = net(xt, classes, drawn.level, rooms, before=expected_before(net, xt, objects, rooms, drawn), poses=poses)
    noise = drawn.noise
    near = torch.nonzero(drawn.level > lambda_of(settings.constraint_below))[:, 0]
    if settings.constraint and len(near):
        guess = (alpha * xt - sigma * answers[-1].detach())[near]
        g = constraint_descent(guess, classes[near], codec, rooms.rows(near), objects.sweeps[near])
        shift = settings.constraint_scale * _step_variance(drawn.level[near])[:, None, None] * g
        most = MOST_SHIFT * (alpha / sigma)[near]
        noise = noise.clone()
        noise[near] -= shift.clamp(-most, most)
    target = alpha * noise - sigma * (xt - sigma * noise) / alpha
    count = occupied.sum((1, 2)).clamp_min(1)
    terms = []
    for answer in answers:
        error = (target - answer) ** 2 * weights
        terms.append(Loss(error[..., : YAW.stop].mean(-1).sum(1) / count, error[..., YAW.stop :].mean(-1).sum(1) / count))
    return tuple(terms)


@torch.no_grad()
def expected_before(net: SetTransformer, xt: Tensor, objects: Objects, rooms: RoomBatch, drawn: Draw) -> Tensor:
    """Return the boxes (B, N, 8) that the first pass is shown: of rooms that were seen before what the net then expected, of others what xt says."""
    before = alpha_sigma(drawn.level)[0][:, None, None] * xt[..., : YAW.stop]
    rows = torch.nonzero(drawn.seen)[:, 0]
    if len(rows):
        poses = objects.poses[rows] * drawn.told[rows, None]
        seen = net.expected(xt[rows], objects.classes[rows], drawn.level[rows], rooms.rows(rows), poses=poses)
        before[rows] = seen[..., : YAW.stop]
    return before


def _step_variance(level: Tensor) -> Tensor:
    """Return Sigma of the paper's own step at levels: beta_t (1 - abar_{t-1}) / (1 - abar_t), in the limit of small steps beta_t.

    With abar = sigmoid(lambda) and the paper's linear beta, beta_t is read off where ln abar_t = -sum of the betas before.
    """
    retained_log = torch.nn.functional.logsigmoid(level)
    first, slope = 1e-4, (0.02 - 1e-4) / 999
    step = (-first + torch.sqrt(first**2 - 2 * slope * retained_log)) / slope  # solves first t + slope t^2 / 2 = -ln abar
    return first + slope * step
