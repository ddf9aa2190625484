"""Frames, boxes, polygons, prisms, walls, free floor and kinematics: numpy in, numpy out, nothing of homes or assets' meaning."""
