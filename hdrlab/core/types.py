"""The types of arrays, once for the whole library."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike as ArrayLike, NDArray as NDArray

Array = NDArray[Any]
F32 = NDArray[np.float32]
F64 = NDArray[np.float64]
Mask = NDArray[np.bool_]
Flags = NDArray[np.uint8]
Labels = NDArray[np.int32]
Indices = NDArray[np.intp]
Image = NDArray[np.uint8] | NDArray[np.uint16]
