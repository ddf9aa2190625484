"""How things stand to each other, learnt from furnished rooms: no list of pairs is written by hand.

    rooms = rooms_of(root / "data/tables", "train")                   # Arrangements: polygon, things, openings
    known = learning.fit(rooms)
    known = Relations.load(root / "data/tables/relations.json")       # what stage `preprocess` learnt from split train

    known.pair("double_bed", "nightstand")     # PairRelation or None: modes, share, chance, strength
    known.walls["wardrobe"]                    # WallRelations: which side is at the wall, how near, how often, how often by chance

A relation is that of a member to an anchor, in the anchor's frame, and knows both sizes: on which side the member stands, the
gap between the facing sides, its offset along that side (from the middle, from either end, or as a share of the side),
and the turn of its front (from the anchor's, or from the way that leads to the anchor). Each number is a `Span`: where
90 % of the cases lie, and their median. A thing that stands within all three spans of a mode holds the relation.

`share` is how many members hold it at the nearest anchor of their room, `chance` how many do when the member is mirrored
in its room (walls stay where they were, other things do not), `strength` the difference. Relations between things that
merely stand along the same walls have none.
"""
