"""Parametric furniture: what models there are (catalogue) and what they look like and how they move (build)."""
