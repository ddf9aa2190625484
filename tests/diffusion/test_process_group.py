import pytest

from pipeline.diffusion.process_group import ProcessGroup
from pipeline.errors import SfgenError


def test_shares_cover_a_batch_once():
    rows = [i for rank in range(4) for i in range(64)[ProcessGroup(rank, 4).share(64)]]
    assert rows == list(range(64))


def test_a_batch_that_cannot_be_shared_is_refused():
    with pytest.raises(SfgenError, match="cannot be shared"):
        ProcessGroup(0, 3).share(64)
