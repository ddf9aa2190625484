"""What a phrase means."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Meaning:
    """What a phrase means: its kind (section of the lexicon), a value within it, a number where there is one."""

    kind: str
    value: str = ""
    number: float = 0.0
    plural: bool = False
