import pytest

from pipeline.diffusion.codec import Normalisation
from pipeline.diffusion.rooms import stacked_classes, stacked_rows
from tests.diffusion.small_world import CLASSES, make_examples


@pytest.fixture(scope="session")
def examples():
    return make_examples(24)


@pytest.fixture(scope="session")
def norm(examples):
    return Normalisation.of(stacked_rows(examples), stacked_classes(examples), CLASSES)
