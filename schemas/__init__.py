"""What a table is: one module per table, columns with type, unit, frame and doc. Standard library and pyarrow only."""
