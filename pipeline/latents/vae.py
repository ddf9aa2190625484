"""The point-cloud VAE: PointNet encoder, MLP decoder, Chamfer distance and KL; on disk with its settings in the header.

Shapes: clouds (B, P, 3) in the cube [-0.5, 0.5]^3; mean and log-variance (B, 32).
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Literal

import torch
from torch import Tensor, nn

from pipeline.errors import ContentError
from pipeline.manifest import canonical
from pipeline.tensors import build_header, load_state, load_tensors, read_header, save_tensors

FORMAT = "sfgen-vae-1"
REMEDY = "run `dvc repro encode`"
COUNTS = ("points", "train_points", "decoded_points", "width", "latent", "batch")  # settings of which there must be some


@dataclass(frozen=True, slots=True)
class EncodeSettings:
    """How the point-cloud VAE is trained and used (section `encode` of params.yaml)."""

    start: Literal["released", "scratch"] = "scratch"  # released: the encoder in weights/ as it is
    points: int = 2048  # points of a surface sample
    train_points: int = 512  # random subset of it that one training step sees
    decoded_points: int = 384  # points that the decoder makes
    width: int = 64
    latent: int = 32  # dimensions of the latent
    steps: int = 300
    batch: int = 32
    learning_rate: float = 3e-3
    kl_weight: float = 0.001
    threads: int = 0  # torch threads, part of the digest; 0: all cores

    def __post_init__(self) -> None:
        if low := [name for name in COUNTS if getattr(self, name) < 1]:
            raise ContentError(f"encode.{low[0]} is {getattr(self, low[0])}", "give 1 or more")


class Encoder(nn.Module):
    """Per-point MLP on coordinates and their Fourier features, pooled by maximum and mean (permutation-invariant)."""

    frequencies: Tensor

    def __init__(self, width: int, latent: int) -> None:
        super().__init__()
        self.register_buffer("frequencies", torch.tensor([1.0, 2.0, 4.0]) * torch.pi, persistent=False)
        self.points = nn.Sequential(nn.Linear(21, width), nn.SiLU(), nn.Linear(width, width), nn.SiLU(), nn.Linear(width, 2 * width))
        self.pooled = nn.Sequential(nn.Linear(4 * width, 2 * width), nn.SiLU(), nn.Linear(2 * width, 2 * latent))

    def forward(self, cloud: Tensor) -> tuple[Tensor, Tensor]:
        """Return the posterior's mean and log-variance."""
        angles = (cloud[..., None, :] * self.frequencies[:, None]).flatten(-2)
        features = self.points(torch.cat([2 * cloud, angles.sin(), angles.cos()], -1))
        mean, logvar = self.pooled(torch.cat([features.amax(1), features.mean(1)], -1)).chunk(2, -1)
        return mean, logvar.clamp(-12, 6)


class Decoder(nn.Module):
    """MLP from the latent to a fixed number of points."""

    def __init__(self, width: int, latent: int, points: int) -> None:
        super().__init__()
        self.count = points
        last = nn.Linear(4 * width, 3 * points)
        nn.init.uniform_(last.bias, -0.4, 0.4)  # the first cloud fills the cube, so that no point starts idle
        self.net = nn.Sequential(nn.Linear(latent, 2 * width), nn.SiLU(), nn.Linear(2 * width, 4 * width), nn.SiLU(), last)

    def forward(self, latent: Tensor) -> Tensor:
        """Return a cloud (B, points, 3)."""
        points: Tensor = self.net(latent).unflatten(-1, (self.count, 3))
        return points


class PointVae(nn.Module):
    """Encoder and decoder."""

    def __init__(self, width: int = 64, latent: int = 32, decoded_points: int = 384) -> None:
        super().__init__()
        self.encoder = Encoder(width, latent)
        self.decoder = Decoder(width, latent, decoded_points)

    @classmethod
    def of(cls, settings: EncodeSettings) -> PointVae:
        """Build the net that the settings describe."""
        return cls(settings.width, settings.latent, settings.decoded_points)


def chamfer(a: Tensor, b: Tensor) -> Tensor:
    """Return the Chamfer distance (B,) of clouds (B, P, 3) and (B, Q, 3): mean distance to the nearest, both ways summed.

    The neighbours are found without a gradient, so that the backward pass never sees the P x Q matrix.
    """
    with torch.no_grad():
        squared = torch.baddbmm((b**2).sum(-1)[:, None], a, b.transpose(1, 2), alpha=-2) + (a**2).sum(-1)[:, :, None]
        there, back = squared.min(2).indices, squared.min(1).indices  # argmin takes half as long again
    return _mean_distance(a, b, there) + _mean_distance(b, a, back)


def _mean_distance(a: Tensor, b: Tensor, nearest: Tensor) -> Tensor:
    """Return the mean distance (B,) of the points a (B, P, 3) to b's points (B, Q, 3) of the given indices (B, P)."""
    apart = a - b.gather(1, nearest[..., None].expand(-1, -1, 3))
    return ((apart**2).sum(-1) + 1e-10).sqrt().mean(1)


def kl_to_standard_normal(mean: Tensor, logvar: Tensor) -> Tensor:
    """Return KL(N(mean, exp(logvar)) || N(0, I)) per cloud (B,) [nats]."""
    return 0.5 * (mean**2 + logvar.exp() - 1 - logvar).sum(-1)


def save_vae(path: Path, net: PointVae, settings: EncodeSettings) -> None:
    """Write the weights (atomically)."""
    save_tensors(path, net.state_dict(), {"vae": canonical({"format": FORMAT, "settings": asdict(settings)}).decode()})


def load_vae(path: Path) -> tuple[PointVae, EncodeSettings]:
    """Read the weights. Raises ContentError when the file is missing, truncated, of another format, or tells no settings that a net can have."""
    tensors, headers = load_tensors(path, REMEDY)
    header = read_header(path, headers, "vae", FORMAT, REMEDY)
    settings = build_header(EncodeSettings, header.get("settings"), "settings", path, REMEDY)
    net = PointVae.of(settings)
    load_state(net, tensors, path, REMEDY)
    return net.eval(), settings
