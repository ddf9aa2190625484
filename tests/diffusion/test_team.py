import pytest

from pipeline.diffusion.team import Team, team_size
from pipeline.errors import SfgenError


@pytest.mark.parametrize(("batch", "cores", "size"), [(64, 2, 2), (64, 3, 2), (64, 16, 8), (4, 2, 1), (30, 3, 3), (17, 2, 1)])
def test_every_member_gets_the_same_and_enough(batch, cores, size):
    assert team_size(batch, cores) == size


def test_shares_cover_a_batch_once():
    rows = [i for rank in range(4) for i in range(64)[Team(rank, 4).share(64)]]
    assert rows == list(range(64))


def test_a_batch_that_cannot_be_shared_is_refused():
    with pytest.raises(SfgenError, match="multiple"):
        Team(0, 3).share(64)
