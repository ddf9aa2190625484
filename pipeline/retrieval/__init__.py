"""From what the layout model asked for to what the library has."""
