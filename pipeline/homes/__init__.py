"""Composes homes: plan, layout, retrieval, arrangement, verification, export. What every command calls."""
