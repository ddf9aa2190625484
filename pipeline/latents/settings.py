"""The numbers of the shape encoder that stand in params.yaml."""

from dataclasses import dataclass
from typing import Literal


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
