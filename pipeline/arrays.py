"""Names of arrays by what they hold. Shapes, units and frames stand in the docstrings of what takes and returns them."""

import numpy as np
from numpy.typing import NDArray

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
