"""What samplers, guidance and the loss ask of a network; `checkpoint.build_net` chooses which one answers."""

from typing import Any, Protocol

from torch import Tensor

from pipeline.diffusion.batch import RoomBatch
from pipeline.diffusion.codec import Codec


class Denoiser(Protocol):
    """Expects the clean channels of objects whose classes are known; `set_transformer.SetTransformer` is ours."""

    codec: Codec

    def floor_code(self, rooms: RoomBatch, classes: Tensor) -> Any:
        """Encode what no noise level changes: the rooms and what they will hold, `classes` (B, N)."""
        ...

    def __call__(self, x: Tensor, classes: Tensor, level: Tensor, rooms: RoomBatch, code: Any = None) -> tuple[Tensor, ...]:
        """Return answers (B, N, 40), the best one last: v = alpha eps - sigma x0 of noisy channels x (B, N, 40) at levels lambda (B,)."""
        ...

    def expected(self, x: Tensor, classes: Tensor, level: Tensor, rooms: RoomBatch, code: Any = None) -> Tensor:
        """Return the expected clean channels x0 (B, N, 40)."""
        ...
