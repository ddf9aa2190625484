"""Documented defaults: what is filled in when a request leaves it open. Those of each type of room stand in manifests/rooms.yaml."""

from pipeline import taxonomy

DEFAULTS = taxonomy.load().types
PRIMARY_BEDROOM = 16.0  # the first of several bedrooms that is not a child's or a guest's, or one that is called main, master or primary
EATIN_KITCHEN = 16.0
LIVING_DINING = 24.0  # a living room of a home in which one dines nowhere else
OUTSIDE = frozenset({"balcony", "garage"})  # not part of the total area
HUBS = ("hallway", "entry", "living_room", "family_room", "studio_room", "dining_room", "kitchen", "office")
DOOR, DOOR_HEIGHT = 0.8, 2.05
INTO = ("entry", "hallway", "living_room", "studio_room", "family_room", "kitchen", "dining_room", "office")  # what one enters, best first
