"""Metrics: one module per family, pure functions over table rows. They import nothing of what they judge."""
