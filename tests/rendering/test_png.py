"""Pictures are read back as they were."""

import io

import numpy as np
import pytest
from PIL import Image

from pipeline.rendering.png import png


@pytest.mark.parametrize("shape", [(1, 1, 3), (7, 5, 3), (40, 64, 3)])
def test_what_is_written_is_read_back(shape):
    pixels = np.random.default_rng(3).integers(0, 256, shape, np.uint8)
    made = Image.open(io.BytesIO(png(Image.fromarray(pixels))))
    made.verify()  # the checksums of all parts
    made = Image.open(io.BytesIO(png(Image.fromarray(pixels))))
    assert (made.format, made.mode) == ("PNG", "RGB")
    assert np.array_equal(np.asarray(made), pixels)
