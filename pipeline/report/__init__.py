"""The report: figures, tables and pictures of a run, as one HTML page that needs no network."""
