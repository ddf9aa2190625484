"""The embedded corpus: parametric furniture and furnished houses, written in the formats of the real sets."""
