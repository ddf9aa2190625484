"""What params.yaml says about the embedded corpus."""

from dataclasses import dataclass

from pipeline.errors import ContentError

MOST_HOUSES = 1_000_000


@dataclass(frozen=True, slots=True)
class CorpusSettings:
    """`houses` in number; `models` as a factor on the catalogue (1 is some hundreds); `corruption`: with the defects of real files."""

    houses: int
    models: float
    corruption: bool

    def __post_init__(self) -> None:
        if not 1 <= self.houses <= MOST_HOUSES:
            raise ContentError(f"params.yaml: corpus.houses = {self.houses} is not valid", f"give a number from 1 to {MOST_HOUSES}")
        if not 0 < self.models <= 100:
            raise ContentError(f"params.yaml: corpus.models = {self.models} is not valid", "give a factor above 0, at most 100")
