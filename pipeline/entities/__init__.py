"""What the factory is about: assets, plans, homes. Frozen records with shapes, units and frames; no algorithms.

World frame: metres, Z up, right-handed; plan coordinates are (x, y); yaw in radians in (-pi, pi], right-handed
about +Z. Object frame: x = width, y = depth, z = height; at yaw 0 the front faces -Y; the origin is the bottom
centre of the object's box with all joints at 0.
"""
