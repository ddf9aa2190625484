"""The pose class of an object: free of the walls, turned against them, or at them by its back, in a corner, by another side.

Which tables stand at a wall and which chairs are turned are rare modes that a diffusion of a dozen evaluations misses, as it misses numbers of
objects. So they are drawn before it, object after object, by a small network, and told to the denoiser:
p(poses | room, inventory) = product over objects of p(pose_k | room, inventory, poses before).
"""

from __future__ import annotations

import copy

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from pipeline.relations.arrangement import Arrangement
from pipeline.relations.walls import AROUND, STRAIGHT, measure
from pipeline.tensors import advance, cosine, generator

POSES = ("untold", "free", "turned", "back", "corner", "side")
UNTOLD, FREE, TURNED, BACK, CORNER, SIDE = range(len(POSES))
CHECK, PATIENCE = 25, 12  # steps between looks at the rooms that are held out, and looks without a gain after which training stops
AT_WALL = 0.1  # a side that is this near to a wall stands at it [m]
RAREST = 0.01  # share of a class' objects below which a pose weighs no more


def pose_classes(room: Arrangement) -> NDArray[np.int64]:
    """Return the pose class (N,) of each object, an index into POSES."""
    if not len(room.yaw):
        return np.zeros(0, np.int64)
    gap, turn = measure(room)
    skew = np.abs(turn[np.arange(len(gap)), gap.argmin(1)])
    near = gap < AT_WALL
    back, beside = near[:, AROUND.index("back")], near[:, [AROUND.index("left"), AROUND.index("right")]].any(1)
    poses = np.select([back & beside, back, near.any(1)], [CORNER, BACK, SIDE], FREE)
    return np.where((skew > STRAIGHT) | ~np.isfinite(gap).any(1), TURNED, poses)


def pose_weights(classes: Tensor, poses: Tensor, padding: int) -> Tensor:
    """Return weights (R, N) of the errors of objects of `classes` (R, N) that stand in `poses` (R, N): by the root of how rare a pose is in its class, 1 in a class' mean.

    The error of a rare pose is a small part of a class' error, and so the last to be learnt. Where the pose is told, weights by it change nothing of what is expected.
    """
    cell = classes * len(POSES) + poses
    count = torch.bincount(cell.flatten(), minlength=(padding + 1) * len(POSES)).view(-1, len(POSES)).float()
    share = count / count.sum(1, keepdim=True).clamp_min(1)
    weight = share.clamp_min(RAREST) ** -0.5
    return (weight / (share * weight).sum(1, keepdim=True).clamp_min(RAREST)).flatten()[cell]


class PoseModel(nn.Module):
    """Logits of each object's pose class, given the room, what it holds, and the pose classes of the objects before it; `features` are those of the room."""

    def __init__(self, classes: int, layouts: int, features: int, width: int) -> None:
        super().__init__()
        self.layout = nn.Embedding(layouts, width)
        self.room = nn.Sequential(nn.Linear(features, width), nn.SiLU(), nn.Linear(width, width))
        self.held = nn.Embedding(classes + 1, width, padding_idx=classes)
        self.asked = nn.Embedding(classes + 1, width)
        self.stands = nn.Parameter(torch.zeros(classes + 1, len(POSES), width))  # what an object's pose says to those after it
        self.think = nn.Sequential(nn.Linear(width, 2 * width), nn.SiLU(), nn.Linear(2 * width, width), nn.SiLU())
        self.out = nn.Linear(width, len(POSES))
        self.own = nn.Parameter(
            torch.zeros(classes + 1, layouts, len(POSES))
        )  # how objects of a class stand in rooms of a type, all else unknown
        nn.init.normal_(self.stands, std=0.1)
        nn.init.zeros_(self.out.weight)
        nn.init.zeros_(self.out.bias)

    def about(self, features: Tensor, layout: Tensor, classes: Tensor) -> Tensor:
        """Return what is known of rooms (B, d) from their features (B, F), types (B,) and the classes (B, N) of their objects."""
        known: Tensor = self.room(features) + self.layout(layout) + self.held(classes).sum(1) / 4
        return known

    def logits(self, about: Tensor, before: Tensor, layout: Tensor, classes: Tensor) -> Tensor:
        """Return logits (B, K, POSES) of objects of `classes` (B, K); `before` (B, K, d) sums what the poses of earlier objects say."""
        hidden = nn.functional.layer_norm(about[:, None] + before + self.asked(classes), about.shape[-1:])
        answer: Tensor = self.out(self.think(hidden)) + self.own[classes, layout[:, None]]
        return answer

    def forward(self, features: Tensor, layout: Tensor, classes: Tensor, poses: Tensor) -> Tensor:
        """Return the log-likelihood (B,) of pose classes (B, N) of objects of `classes` (B, N), C for padding."""
        there = classes < len(self.own) - 1
        says = self.stands[classes, poses] * there[..., None]
        scores = self.logits(self.about(features, layout, classes), says.cumsum(1) - says, layout, classes).log_softmax(-1)
        return (scores.gather(-1, poses[..., None])[..., 0] * there).sum(1)

    def learn_shares(self, layouts: Tensor, classes: Tensor, poses: Tensor) -> None:
        """Set in place how often objects of each class stand in each pose, by room type, in rooms (n,), (n, N), (n, N)."""
        kinds, types, _ = self.own.shape
        cell = (classes * types + layouts[:, None]) * len(POSES) + poses
        share = torch.bincount(cell.flatten(), minlength=self.own.numel()).view(kinds, types, len(POSES)).float()
        share = (
            share + 2 * share.sum(1, keepdim=True) / share.sum((1, 2))[:, None, None].clamp_min(1) + 0.02
        )  # two objects of all types beside
        with torch.no_grad():
            self.own.copy_((share / share.sum(-1, keepdim=True)).log())


def fit_poses(net: PoseModel, rooms: tuple[Tensor, ...], steps: int, batch: int, rate: float, seed: int) -> None:
    """Train a pose model in place on the features, types, classes and pose classes of rooms: AdamW, a cosine to zero, stopped early.

    A tenth of the rooms is held out, and what is best on them is kept: what decides between corner and wall is seldom in a room's features, so that a
    few thousand rooms are soon learnt by heart.
    """
    rng = generator(seed, "poses")
    order = torch.randperm(len(rooms[0]), generator=rng)
    held, used = (tuple(part[rows] for part in rooms) for rows in (order[: len(order) // 10], order[len(order) // 10 :]))
    if not len(held[0]):
        return
    optimiser = torch.optim.AdamW(net.parameters(), weight_decay=1e-3)
    best, kept, since = _held_out_loss(net, held), copy.deepcopy(net.state_dict()), 0
    for step in range(steps):
        rows = torch.randint(len(used[0]), (min(batch, len(used[0])),), generator=rng)
        (-net(*(part[rows] for part in used)).mean()).backward()
        advance(optimiser, rate * min(1.0, (step + 1) / 50) * cosine(step / steps), 1.0)
        if (step + 1) % CHECK and step + 1 < steps:
            continue
        loss, since = _held_out_loss(net, held), since + 1
        if loss < best:
            best, kept, since = loss, copy.deepcopy(net.state_dict()), 0
        if since == PATIENCE:
            break
    net.load_state_dict(kept)


@torch.no_grad()
def _held_out_loss(net: PoseModel, rooms: tuple[Tensor, ...]) -> float:
    return float(-net(*rooms).mean())


@torch.inference_mode()
def draw_poses(net: PoseModel, features: Tensor, layout: Tensor, classes: Tensor, uniform: NDArray[np.float64]) -> Tensor:
    """Draw the pose classes (B, N) of objects of `classes` (B, N), C for padding behind them, which stays UNTOLD; `uniform` (B, N) in [0, 1) is all the randomness."""
    padding = len(net.own) - 1
    about, poses = net.about(features, layout, classes), torch.full_like(classes, UNTOLD)
    before = torch.zeros_like(about)
    for k in range(int((classes < padding).sum(1).max())):
        own = classes[:, k]
        chance = net.logits(about, before[:, None], layout, own[:, None])[:, 0].softmax(-1).double().numpy()
        chance[:, UNTOLD] = 0.0
        ladder = np.cumsum(chance, 1)
        picked = torch.from_numpy((ladder <= uniform[:, k, None] * ladder[:, -1:]).sum(1).clip(FREE, len(POSES) - 1))
        poses[:, k] = torch.where(own < padding, picked, UNTOLD)
        before = before + net.stands[own, poses[:, k]] * (own < padding)[:, None]
    return poses
