"""Why something was left out, exchanged or tried again while homes were made: the reason codes of `rejects`."""

from pipeline.entities.reason import reasons

REASONS = reasons("homes")
