"""One file per DVC stage or command: read tables, call the library, write tables."""
