import pytest

from pipeline.diffusion.codec import Normalisation
from pipeline.diffusion.rooms import stacked
from tests.diffusion.small_world import CLASSES, make_examples


@pytest.fixture(scope="session")
def examples():
    return make_examples(24)


@pytest.fixture(scope="session")
def norm(examples):
    return Normalisation.of(*stacked(examples), CLASSES)
