"""From grids to plans in metres: wall lines, room polygons, doors and windows."""
