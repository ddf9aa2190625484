"""What making homes needs: the layout model, the library, the settings; loaded once per process."""

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field

from pipeline.arrange import LearntRelations, PostoptSettings
from pipeline.diffusion.sampling import Sampler
from pipeline.floorplan.program.priors import PriorSettings
from pipeline.homes.library import Library
from pipeline.homes.settings import ShardSettings
from pipeline.retrieval.index import AssetIndex
from pipeline.verify import VerifySettings


@dataclass(frozen=True)
class Resources:
    """Models, library and settings. `learnt` is what the training tables know of relations; `seconds` sums CPU seconds by part."""

    seed: int
    sampler: Sampler
    index: AssetIndex
    library: Library
    shard: ShardSettings
    postopt: PostoptSettings
    verify: VerifySettings
    prior: PriorSettings
    digests: Mapping[str, str]
    learnt: LearntRelations
    seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def time(self, part: str) -> Iterator[None]:
        """Add the CPU seconds (user + system) of the block to `seconds[part]`."""
        start = time.process_time()
        try:
            yield
        finally:
            self.seconds[part] = self.seconds.get(part, 0.0) + time.process_time() - start
