"""Read a dataset, such as `python examples/load_dataset.py data/shards`."""

import sys
from collections import Counter

import sfgen


def main(folder: str) -> None:
    """Count rooms and furniture, and list what a robot can open."""
    homes = sfgen.load(folder)
    print(f"{len(homes)} homes, licence {homes.header['licence']}")

    rooms = Counter(room.type for home in homes for room in home.rooms)
    print("rooms:", ", ".join(f"{count} {kind}" for kind, count in rooms.most_common(5)))

    home = homes[0]
    print(f"{home.scene_id}: {home.prompt or 'from the prior'}")
    for room in home.rooms:
        print(f"  {room.room_id} ({room.type}), {room.area:.1f} m2: {', '.join(o.category for o in home.in_room(room.room_id)) or 'empty'}")
    for joint in home.joints:
        if joint.stand is not None:
            x, y, yaw = joint.stand
            print(
                f"  {joint.object_id}/{joint.joint_id} opens to {joint.clear_upper:.2f}; stand at ({x:.2f}, {y:.2f}), turned {yaw:.2f} rad"
            )
    if home.usd:
        print(f"  stage: {home.usd}")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "data/shards")
