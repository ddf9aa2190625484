"""The paper's experiments: rooms of the test split furnished under controlled conditions, with and without guidance."""
