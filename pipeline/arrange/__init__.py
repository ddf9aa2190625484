"""Post-optimisation: walkable area (algorithm 2 of the paper), then what is left of collisions is separated."""
