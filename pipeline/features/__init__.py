"""Nets that turn pictures of rooms into features, for FID, KID and SCA: one of our own, and Inception from the user's file."""
