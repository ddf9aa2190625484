"""Plans as SVG, as images and in a terminal."""
