"""The numbers of training and sampling that stand in params.yaml."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

Target = Literal["v", "x0", "eps"]
Articulation = Literal["none", "heuristic", "joints"]


@dataclass(frozen=True, slots=True)
class ModelSettings:
    """The denoiser's shape."""

    width: int = 96
    layers: int = 4
    heads: int = 4
    relation: int = 24  # channels of the pairwise geometric features
    target: Target = "v"  # what the network predicts for the continuous channels


@dataclass(frozen=True, slots=True)
class TrainSettings:
    """How the denoiser is trained (section `train` of params.yaml)."""

    model: ModelSettings = field(default_factory=ModelSettings)
    slots: int = 24
    few_slots: int = 12  # slots of rooms that hold little; most training steps see such rooms alone
    few_share: float = 0.7  # share of the steps that do; 0: every step sees all rooms, with all slots
    timesteps: int = 1000
    steps: int = 1500
    epochs: int = 0  # > 0: so many passes instead of `steps`
    batch: int = 64
    optimiser: Literal["muon", "adamw"] = "muon"
    learning_rate: float = 4e-3
    warmup: int = 60
    decay: Literal["cosine", "linear", "step"] = "cosine"
    decay_every: int = 20000  # step decay: epochs between halvings
    weight_decay: float = 0.0
    clip: float = 1.0
    ema: float = 0.998
    low_noise: float = 0.5  # share of the batch whose t is drawn log-uniformly instead of uniformly
    count_known: float = 0.5  # share of the batch that is told the number of objects
    class_weight: float = 0.3  # weight of the class cross-entropy beside eq. 1
    latent_weight: float = 0.25  # weight of the shape latent's channels in eq. 1
    constraint: bool = True  # eq. 1 with its constraint term
    constraint_scale: float = 1.0  # lambda of eq. 1
    constraint_below: int = 100  # noise levels t below which the term acts
    tilt: float = 0.0  # augmentation: largest extra rotation [rad]
    checkpoint_every: int = 250
    validate_every: int = 500
    threads: int = 1  # torch threads of each process, part of the checkpoint's digest; 0: one per core
    workers: int = 0  # processes that share each batch, on machines without a GPU; 0: one per core

    @property
    def many_batch(self) -> int:
        """Rooms of a step that sees rooms with all slots: as many slots as a step with few."""
        return max(1, self.batch * min(self.few_slots, self.slots) // self.slots) if self.few_share else self.batch


@dataclass(frozen=True, slots=True)
class SampleSettings:
    """How rooms are sampled (section `sample` of params.yaml). Window limits are levels of T = 1000."""

    sampler: Literal["ddim", "ancestral"] = "ddim"
    steps_coarse: int = 14  # DDIM evaluations at t >= 100
    steps_middle: int = 11  # evaluations at 10 <= t < 100
    steps_fine: int = 11  # evaluations at t < 10
    batch: int = 8  # rooms per padded batch
    count_condition: bool = True  # tell the denoiser the number of objects, beside the quantity guidance
    quantity: bool = True  # guide the number of objects
    quantity_scale: float = 1.0  # step along the descent of phi_quantity, in channel units
    quantity_below: int = 100
    articulation: Articulation = "joints"  # what counts as extended state: joints' sweeps, the paper's heuristic, or no guidance
    articulation_scale: float = 0.5  # step along the descent of phi_articoll [m per m]
    articulation_below: int = 10
    turn_scale: float = 0.1  # step of the yaw, per step of the position
    clip: float = 0.15  # largest move in one guided step [m]
    snap_below: int = 30  # from this level on slots take the size of the asset that they would retrieve
