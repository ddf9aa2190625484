"""Settings of the layout model: its shape, its training, how it is sampled."""

from dataclasses import dataclass, field
from typing import Literal

from pipeline.errors import ContentError

Articulation = Literal["none", "heuristic", "joints"]
MOST_SLOTS = 32  # objects that rooms are padded to at most, in training and sampling


@dataclass(frozen=True, slots=True)
class ModelSettings:
    """The denoiser's shape."""

    width: int = 96
    passes: int = 2  # looks at the room: the second sees it as the first has arranged it
    layers: int = 2  # of each pass
    heads: int = 4
    relation: int = 24  # channels of the pairwise geometric features


@dataclass(frozen=True, slots=True)
class InventorySettings:
    """The model of what a room holds."""

    width: int = 96
    steps: int = 1200
    batch: int = 96  # rooms
    learning_rate: float = 3e-3
    count_known: float = 0.3  # share of the rooms of which the number of objects is told


@dataclass(frozen=True, slots=True)
class TuneSettings:
    """How far the released weights go on training on the data at hand."""

    steps: int = 200
    learning_rate: float = 5e-4
    inventory_steps: int = 40


@dataclass(frozen=True, slots=True)
class TrainSettings:
    """How the layout model is trained (section `train` of params.yaml)."""

    model: ModelSettings = field(default_factory=ModelSettings)
    inventory: InventorySettings = field(default_factory=InventorySettings)
    start: Literal["released", "scratch"] = "scratch"  # released: from the weights in weights/, by `tune`
    tune: TuneSettings = field(default_factory=TuneSettings)
    slots: int = 24  # most objects in a room; rooms with more are left out
    steps: int = 1500
    epochs: int = 0  # > 0: so many passes instead of `steps`
    objects: int = 640  # objects that a step sees, padding included
    optimiser: Literal["muon", "adamw"] = "muon"
    learning_rate: float = 4e-3
    warmup: int = 60
    decay: Literal["cosine", "step"] = "cosine"
    decay_every: int = 20000  # step decay: epochs between halvings
    clip: float = 1.0
    ema: float = 0.998
    latent_weight: float = 0.25  # weight of the shape latent's channels in eq. 1
    constraint: bool = True  # eq. 1 with its constraint term
    constraint_scale: float = 1.0  # lambda of eq. 1
    constraint_below: int = 100  # noise levels t below which the term acts
    checkpoint_every: int = 250
    validate_every: int = 500
    threads: int = 1  # torch threads of each process, part of the checkpoint's digest; 0: one per core
    workers: int = 0  # processes that share each batch, on machines without a GPU; 0: one per core

    def __post_init__(self) -> None:
        if not 1 <= self.slots <= MOST_SLOTS:
            raise ContentError(f"train.slots is {self.slots}", f"give 1 to {MOST_SLOTS} in params.yaml")


@dataclass(frozen=True, slots=True)
class SampleSettings:
    """How rooms are sampled (section `sample` of params.yaml). Window limits are levels of T = 1000."""

    evaluations: int = 20  # of the denoiser; 0: the paper's thousand levels, the reference
    eta: float = 1.0  # noise of each step: 1 as in DDPM, 0 none (DDIM)
    batch: int = 32  # rooms that are sampled together
    quantity: bool = True  # draw exactly as many objects as are asked for
    articulation: Articulation = "joints"  # what counts as extended state: joints' sweeps, the paper's heuristic, or no guidance
    articulation_scale: float = 0.5  # step along the descent of phi_articoll [m per m]
    articulation_below: float = 10.0
    articulation_steps: int = 10  # descents at each of these levels
    redraws: int = 2  # times a room is drawn again whose things are still pressed; the draw that is pressed least is kept
    turn_scale: float = 0.1  # step of the yaw, per step of the position
    clip: float = 0.15  # largest move in one guided step [m]
    snap_below: float = 100.0  # from this level on objects take the size of the asset that they would retrieve
