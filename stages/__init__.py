"""One file per DVC stage or command: read tables, call the library, write tables."""

from pipeline.execution import pin_instructions

pin_instructions()  # before a stage imports what computes
