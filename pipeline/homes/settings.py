"""The numbers of home making that stand in params.yaml, and how the sections of a run are read together."""

from dataclasses import dataclass
from pathlib import Path

from pipeline.errors import ContentError
from pipeline.homes.request import MOST_ATTEMPTS, Request
from pipeline.shards import read_mix


@dataclass(frozen=True, slots=True)
class ShardSettings:
    """How datasets are cut and what a home may cost (section `shard`)."""

    homes: int = 64  # homes per shard
    chunk: int = 16  # homes that are sampled together
    room_attempts: int = 5  # tries of one room before the best of them is taken
    home_attempts: int = 8  # plans tried for one index before it stays empty
    plan_draws: int = 8  # drawings of one of them that the judge may find unsound
    home_seconds: float = 300.0  # CPU seconds that one home may take, and seconds that a worker may keep silent [s]
    shard_seconds: float = 30.0  # CPU seconds that the homes of a shard may take in the mean: beyond it the others of it stay empty [s]
    licence: str = "CC0-1.0"  # of what is made; with research-only assets, name theirs
    preview: int = 768  # side of the top views [px], 0: none; `sfgen shard --preview` says otherwise

    def __post_init__(self) -> None:
        if not 1 <= self.room_attempts <= MOST_ATTEMPTS:
            raise ContentError(f"shard.room_attempts is {self.room_attempts}", f"give 1 to {MOST_ATTEMPTS} in params.yaml")


@dataclass(frozen=True, slots=True)
class DatasetSettings:
    """The dataset that `dvc repro` makes (section `dataset`)."""

    homes: int = 24
    prompts: str = "manifests/prompts/mix.txt"  # one prompt a line
    prompted: float = 0.5  # share of the homes that take a prompt, in turn; the others draw their program from the prior


def requests_of(settings: DatasetSettings, root: Path, seed: int) -> tuple[Request, ...]:
    """Return what each home of the dataset is asked to be. Raises ContentError for a prompt file that cannot be read."""
    if settings.homes < 1 or not 0 <= settings.prompted <= 1:
        raise ContentError("params.yaml: dataset.homes must be 1 or more, dataset.prompted within 0 and 1", "mend section dataset")
    mix = read_mix(root / settings.prompts)
    # Home i takes a prompt whenever i * share passes a whole number: evenly spread, and independent of the count.
    turns = [int((i + 1) * settings.prompted) - int(i * settings.prompted) for i in range(settings.homes)]
    return tuple(Request(i, mix.prompt(seed, sum(turns[:i])) if turn else "") for i, turn in enumerate(turns))
