"""The response of a linear camera is the logarithm."""

import numpy as np
import pytest

from hdrlab.capture import responses
from hdrlab.response import linear


@pytest.mark.parametrize("n", [256, 65536])
def test_exposure_is_proportional_to_the_level(n):
    f_inverse = np.exp(linear.curve(n))
    assert np.allclose(f_inverse[1:] * (n // 2), np.arange(1, n)) and linear.curve(n)[n // 2] == 0


@pytest.mark.parametrize("n", [256, 65536])
def test_linear_recover_equals_the_response_of_the_simulated_linear_camera(n):
    assert np.allclose(linear.curve(n), responses.true_g("linear", n), atol=1e-12)


@pytest.mark.parametrize(("dtype", "n"), [(np.uint8, 256), (np.uint16, 65536)])
def test_a_curve_has_as_many_levels_as_the_photographs(dtype, n):
    assert np.array_equal(linear.recover(np.zeros((2, 3, 4, 3), dtype), [1, 2]), linear.curve(n))


def test_a_wrong_number_of_times_raises_an_error():
    with pytest.raises(ValueError, match="2 exposure times"):
        linear.recover(np.zeros((2, 3, 4), np.uint8), [1])
