"""SceneFoundry as printed: guidance by quantity and by articulated collision, and training that anticipates it.

Where the print and its words disagree, the words are followed:
- eq. guided_step and algorithm 1 add lambda Sigma grad phi to the mean. phi is a penalty (a cross-entropy, a sum of
  overlaps), and adding its gradient would climb it. Here the gradient is taken off. The same holds for g in eq. denoising_loss.
- eq. num_control compares logits of "empty" with T, which "specifies which slots should be non-empty". Here the target of
  an empty logit is 1 - T.
Not printed, and so settings: gamma_1, gamma_2 and lambda (`quantity_scale` is lambda gamma_1, `articulation_scale` is lambda
gamma_2; eq. 1 has a pair of its own, since what steers well at the last levels swamps the noise at the first). Which slots T marks is not said: here those that are least empty at that step.
"""

from dataclasses import dataclass, replace

import torch
from torch import Tensor

from pipeline.baselines.boxes import boxes_of, extend_front, mates, overlaps
from pipeline.baselines.diffuscene import Denoiser, add_noise, clean, denoising
from pipeline.baselines.rooms import BOX, BaselineSettings, Furniture, Outlines, Scaling


def quantity_target(empty: Tensor, count: Tensor) -> Tensor:
    """Return which slots (B, N) should be empty, 1 or 0: all but the `count` (B,) least empty ones. Ties go to the earlier slot."""
    order = empty.argsort(dim=1, stable=True)
    rank = torch.empty_like(order).scatter_(1, order, torch.arange(order.shape[1], device=order.device).expand_as(order))
    return (rank >= count[:, None]).to(empty.dtype)


def quantity(empty: Tensor, count: Tensor) -> Tensor:
    """Return phi_quantity (B,), eq. num_control: binary cross-entropy of the empty logits (B, N) against their target, mean over slots.

    Rooms with count < 0 are asked nothing, and cost nothing.
    """
    target = quantity_target(empty.detach(), count)
    penalty = torch.nn.functional.binary_cross_entropy_with_logits(empty, target, reduction="none").mean(1)
    return torch.where(count >= 0, penalty, torch.zeros_like(penalty))


def articulated_collision(metric: Tensor, occupied: Tensor, opens: Tensor) -> Tensor:
    """Return phi_articoll (B,), eq. articoll: the sum over ordered pairs of IoU3D(b'_i, b_j), b' the extended state.

    `metric` (B, N, 8) boxes in metres; `occupied` and `opens` (B, N) say which slots hold something, and something articulated.
    """
    boxes = boxes_of(metric)
    return overlaps(extend_front(boxes, opens), boxes, mates(occupied))


@dataclass(frozen=True, slots=True)
class Constraints:
    """phi = gamma_1 phi_quantity + gamma_2 phi_articoll of a batch: `counts` (B,), -1 for none; `opens` (C,) by class."""

    scaling: Scaling
    settings: BaselineSettings
    counts: Tensor
    opens: Tensor

    def descent(self, x: Tensor) -> Tensor:
        """Return -lambda grad phi (B, N, D) at slots x."""
        s, at = self.settings, x.detach()
        direction = torch.zeros_like(at)
        if bool((self.counts >= 0).any()):
            empty = at[..., self.scaling.empty].requires_grad_()
            with torch.enable_grad():
                (slope,) = torch.autograd.grad(quantity(empty, self.counts).sum(), empty)
            direction[..., self.scaling.empty] = -s.quantity_scale * slope
        boxes = at[..., :BOX].clone().requires_grad_()
        with torch.enable_grad():
            phi = articulated_collision(self.scaling.metric(boxes), self.scaling.occupied(at), self.opens[self.scaling.labels(at)])
            (slope,) = torch.autograd.grad(phi.sum(), boxes)
        direction[..., :BOX] = -s.articulation_scale * slope
        return direction

    def __call__(self, mean: Tensor, _t: int, variance: float) -> Tensor:
        """Return what one step of algorithm 1 adds to the mean: -lambda Sigma grad phi, taken at the mean."""
        return variance * self.descent(mean)


def loss(net: Denoiser, rooms: Outlines, things: Furniture, rng: torch.Generator, opens: Tensor) -> Tensor:
    """Return eq. denoising_loss: || (eps - lambda Sigma g) - eps_theta ||^2, with g = -grad phi at the expected x0.

    The number asked for is the room's own. The guided noise is larger where the descent is: x0 = (x_t - sigma eps) / alpha
    moves along -sigma / alpha times it, so eps minus lambda Sigma g means that x0 moves along g, down the penalty.
    """
    _, t, noise, x = add_noise(net, things, rng)
    raw = net(x, t, net.floor(rooms))
    alpha, sigma = net.levels.of(t)
    expected = clean(raw.detach(), x, alpha, sigma).clamp(-1, 1)
    counts, s = (things.classes < len(net.scaling.classes)).sum(1), net.settings
    learnt = replace(s, quantity_scale=s.train_quantity_scale, articulation_scale=s.train_articulation_scale)
    shift = net.levels.variance[t][:, None, None] * Constraints(net.scaling, learnt, counts, opens).descent(expected)
    guided = noise - shift
    return denoising(net, raw, (x - sigma * guided) / alpha, guided, t)
