"""What making homes needs: the layout model, the library, the settings; loaded once per process."""

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field

from pipeline.arrange import LearntRelations, PostoptSettings
from pipeline.diffusion.sampling import Sampler
from pipeline.errors import ContentError
from pipeline.floorplan.program.priors import PriorSettings
from pipeline.homes.library import Library
from pipeline.homes.request import MOST_ATTEMPTS
from pipeline.retrieval.index import AssetIndex
from pipeline.verify import VerifySettings


@dataclass(frozen=True, slots=True)
class ShardSettings:
    """How datasets are cut and what a home may cost (section `shard`)."""

    homes: int  # homes per shard
    chunk: int  # homes that are sampled together
    room_attempts: int  # tries of one room before the best of them is taken
    home_attempts: int  # plans tried for one index before it stays empty
    plan_draws: int  # drawings of one of them that the judge may find unsound
    home_seconds: float  # CPU seconds that one home may take, and seconds that a worker may keep silent [s]
    shard_seconds: float  # CPU seconds that the homes of a shard may take in the mean: beyond it the others of it stay empty [s]
    licence: str  # of what is made; with research-only assets, name theirs
    preview: int  # side of the top views [px], 0: none; `sfgen shard --preview` says otherwise

    def __post_init__(self) -> None:
        if not 1 <= self.room_attempts <= MOST_ATTEMPTS:
            raise ContentError(f"shard.room_attempts is {self.room_attempts}", f"give 1 to {MOST_ATTEMPTS} in params.yaml")


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
