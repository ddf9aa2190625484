import numpy as np
import pytest

from pipeline.retrieval.index import AssetIndex, has_knee_room

DESK = np.array([1.2, 0.6, 0.75])


def drawer(x0, x1, z0, reach):
    """What a drawer sweeps, from x0 to x1, above z0, to `reach` before the front of the desk."""
    return [[x0, -0.3 - reach, z0], [x1, 0.2, z0 + 0.1]]


@pytest.mark.parametrize(
    ("drawers", "seated"),
    [
        ([], True),
        ([drawer(-0.6, 0.6, 0.6, 0.5)], True),  # above the seat
        ([drawer(-0.6, 0.6, 0.4, 0.5)], False),
        ([drawer(-0.6, 0.6, 0.4, 0.3)], True),  # the seat stands behind it
        ([drawer(-0.6, -0.1, z, 0.5) for z in (0.1, 0.3)], True),  # and here beside them
        ([drawer(0.2, 0.6, 0.1, 0.5), drawer(-0.6, -0.2, 0.1, 0.5)], False),  # knees go between, a seat does not
        ([drawer(0.3, 0.6, 0.1, 0.5), drawer(-0.6, -0.3, 0.1, 0.5)], True),
    ],
)
def test_a_seat_goes_below_beside_or_behind_what_opens(drawers, seated):
    assert has_knee_room(DESK, np.array(drawers).reshape(-1, 2, 3)) is seated


def test_desks_without_knee_room_are_not_offered_while_there_are_others():
    rows = [
        {"asset_id": name, "category": "desk", "split": "train", "size": DESK.tolist(), "articulated": True, "openable": True}
        for name in ("closed", "free")
    ]
    latents = [{"asset_id": row["asset_id"], "latent": [0.0] * 32} for row in rows]
    low, high = drawer(-0.6, 0.6, 0.3, 0.5)
    joints = [{"asset_id": "closed", "sweep_min": low, "sweep_max": high}]
    index = AssetIndex.from_tables(rows, latents, joints)
    assert [index.asset_ids[row] for row in index.shelves["desk"]] == ["free"]
    assert index.row("closed") == 0
    alone = AssetIndex.from_tables(rows[:1], latents[:1], joints)
    assert [alone.asset_ids[row] for row in alone.shelves["desk"]] == ["closed"]
