"""Mesh files of several formats, and what is made of them: visual meshes, convex colliders, masses."""
