"""Furnished houses: plans of their own, furniture by rules with noise, and the mess of real files."""
