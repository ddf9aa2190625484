"""Plans on a grid of cells: slicing trees, annealing, and the energy that both minimise."""
