"""What the stages are made of. No stage and no command line in here."""
