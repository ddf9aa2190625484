"""The numbers of the baselines that stand in params.yaml (section `baselines`)."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class BaselineSettings:
    """How the baselines are built, trained, sampled and compared."""

    seconds: float = 120.0  # CPU seconds of training, the same for each
    width: int = 128  # channels of the transformers
    layers: int = 4
    heads: int = 4
    points: int = 64  # points of a room's outline
    slots: int = 24  # most objects in a room
    timesteps: int = 1000  # T
    batch: int = 64  # rooms per training step
    learning_rate: float = 1e-3  # at the start; it falls to zero along a cosine while the seconds are spent
    clip: float = 10.0  # gradient norm
    ema: float = 0.995  # of the weights that are sampled from
    iou_weight: float = 0.1  # DiffuScene: weight of the boxes' mean overlap in the loss
    rooms: int = 150  # rooms of the split that each baseline furnishes
    count_rooms: int = 40  # rooms per asked number
    counts: tuple[int, ...] = (5, 8, 12, 16)  # N_target
    steps: int = 100  # levels at which the samplers stop, even in log signal-to-noise; T: all, as the peers and the print have it
    sample_batch: int = 50  # rooms that are sampled together
    quantity_scale: float = 200.0  # SceneFoundry: lambda gamma_1
    articulation_scale: float = 20.0  # SceneFoundry: lambda gamma_2
    train_quantity_scale: float = 200.0  # the same in eq. 1
    train_articulation_scale: float = 2.0
