"""rejects: one row per thing that was left out or tried in vain, with its reason."""

import pyarrow as pa

from schemas.table import Column, Table

REJECTS = Table(
    "rejects",
    "One row per thing that was dropped, repaired or tried in vain.",
    (
        Column("what", pa.string(), "kind of thing: house, room, object, model, joint, home ..."),
        Column("where", pa.string(), "its id, or path relative to the source folder"),
        Column("reason", pa.string(), "reason code, a slug; docs/reasons.md lists them all"),
        Column("detail", pa.string(), "one line for a person"),
    ),
)
