"""Furnished houses: plans from the factory's planner, furniture by rules with noise, and the mess of real files."""
