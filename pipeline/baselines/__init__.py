"""The layout models of the peers and of the paper, small and in this code: what ours is compared with in one table."""
