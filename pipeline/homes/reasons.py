"""Why something was left out, exchanged or tried again while homes were made: the reason codes of `rejects`."""

from __future__ import annotations

from pipeline.entities.reason import Reason

REASONS: dict[str, Reason] = {
    "no_asset": Reason("object", "dropped", "retrieval has nothing of that category"),
    "exchanged_for_floor": Reason("object", "repaired", "a smaller asset takes its place, so that more floor is free (paper, algorithm 2)"),
    "shrunk_to_fit": Reason(
        "object", "repaired", "a smaller asset takes its place, for there was no free place for the one that was asked for"
    ),
    "unplaceable": Reason("object", "dropped", "no free place in the room"),
    "outside_room": Reason("object", "dropped", "reaches beyond the walls"),
    "collision": Reason("object, home", "dropped", "in another object; the smaller of the two goes (of a home: the home is tried again)"),
    "unsupported": Reason("object, home", "dropped", "floats, or sticks through the ceiling"),
    "blocks_joint": Reason("object", "dropped", "a door, drawer or lid stops at it"),
    "blocks_way": Reason("object", "dropped", "nobody could enter the room for it"),
    "count_missed": Reason("room", "tried again", "not the number of objects that was asked for"),
    "category_missed": Reason("room", "tried again", "more or fewer objects of a category than was asked for"),
    "openable_missed": Reason("room", "tried again", "fewer objects that open than was asked for"),
    "walkable_missed": Reason("room", "tried again", "less free floor than was asked for"),
    "lacks_essential": Reason("room", "tried again", "without what makes the room: a bedroom without a bed"),
    "too_few_left": Reason("room", "tried again", "too many of its objects had to go"),
    "joint_blocked": Reason("home", "tried again", "a joint does not move through its range"),
    "out_of_reach": Reason(
        "room, home",
        "tried again",
        "a robot cannot use what makes the room; of a home: opens a smaller share of what opens than the policy asks for",
    ),
    "room_cut_off": Reason("home", "tried again", "a room cannot be reached from the entrance"),
    "refused": Reason(
        "index", "left empty", "the request cannot be met: it contradicts itself, or asks for what no plan or no library has"
    ),
    "attempts_spent": Reason("index", "left empty", "every plan that was tried failed; the detail names the last reason"),
    "deadline": Reason("index", "left empty", "took longer than `shard.home_seconds`"),
    "internal": Reason("index", "left empty", "an error that the factory does not know; please report it"),
    "worker_lost": Reason("index", "left empty", "three workers died at it, or kept silent for longer than `shard.home_seconds`"),
}
