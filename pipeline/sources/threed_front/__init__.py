"""3D-FRONT houses and 3D-FUTURE models."""
