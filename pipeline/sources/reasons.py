"""Why something was left out, repaired or set aside: the reason codes of the readers, and the rows that carry them."""

from __future__ import annotations

from typing import Any

from pipeline.entities.reason import reasons
from pipeline.errors import ContentError

Row = dict[str, Any]

REASONS = reasons("sources")


class SourceError(ContentError):
    """A file of a source that is refused: `code` is its reason, `where` its path relative to the source."""

    def __init__(self, code: str, where: str, detail: str) -> None:
        self.code, self.where, self.detail = code, where, detail
        super().__init__(f"{where}: {detail} [{code}]", "fetch the file again, or leave it out; docs/reasons.md explains the code")

    def __reduce__(self) -> tuple[type[SourceError], tuple[str, str, str]]:
        """Pickle by the arguments, so that the error crosses process borders."""
        return type(self), (self.code, self.where, self.detail)


def reject(what: str, where: str, reason: str, detail: str = "") -> Row:
    """Return a row of the rejects table. Raises KeyError for a code that REASONS lacks."""
    REASONS[reason]  # a typo must not reach the table
    return {"what": what, "where": where, "reason": reason, "detail": "".join(c if c.isprintable() else " " for c in detail[:240])}
