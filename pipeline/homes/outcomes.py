"""What becomes of a request: a home that ships, or an index that stays empty with its reason."""

from dataclasses import dataclass, field

from pipeline.entities.home import Home
from pipeline.errors import SfgenError
from pipeline.homes.reasons import REASONS
from pipeline.homes.rows import Row
from pipeline.shards import EMPTY, scene_id
from pipeline.verify import Certificate


@dataclass(frozen=True, slots=True)
class Outcome:
    """A home that ships. `rows` by table, `files` by `<family>/<name>`."""

    home: Home
    certificate: Certificate
    rows: dict[str, list[Row]]
    files: dict[str, bytes]


@dataclass(frozen=True, slots=True)
class Empty:
    """A home that could not be made: the reason code, what a user is told, and the rows of what was tried."""

    index: int
    reason: str
    error: SfgenError
    rejects: list[Row] = field(default_factory=list)

    def rows(self, seed: int) -> dict[str, list[Row]]:
        """Return the rows of rejects. Raises KeyError for a code that REASONS lacks."""
        REASONS[self.reason]  # a typo must not reach the table
        detail = " ".join(str(self.error).split())[:400]
        return {"rejects": [*self.rejects, {"what": EMPTY, "where": scene_id(seed, self.index), "reason": self.reason, "detail": detail}]}
