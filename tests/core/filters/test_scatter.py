"""The glare spread function, compared with the sum of its definition."""

import numpy as np
import pytest

from hdrlab.core.filters.scatter import GlareSpread, scatter, spread_transform, validate_spread


def test_glare_equals_the_double_sum_and_conserves_light_inside_the_frame():
    """K is 0 at its center and outside the frame, and its sum is 1."""
    height = 5
    width = 7
    power = 2.0
    core = 1.5
    E = np.random.default_rng(2).random((height, width)).astype(np.float32)
    dy, dx = np.mgrid[1 - height : height, 1 - width : width]
    K = (1 + (dy**2 + dx**2) / core**2) ** (-power / 2)
    K[height - 1, width - 1] = 0
    K /= K.sum()
    expected = np.zeros_like(E)
    for y, x in np.ndindex(height, width):
        expected += (
            E[y, x] * K[height - 1 - y : 2 * height - 1 - y, width - 1 - x : 2 * width - 1 - x]
        )
    assert np.allclose(scatter(E, spread_transform(E.shape, power, core)), expected, rtol=1e-4)


@pytest.mark.parametrize(
    "spread", [(-0.1,), (1,), (np.nan,), (0.1, 0), (0.1, np.inf), (0.1, 2, 0), (0.1, 2, np.inf)]
)
def test_an_invalid_glare_spread_raises_an_error(spread):
    with pytest.raises(ValueError, match="fraction"):
        validate_spread(GlareSpread(*spread))
