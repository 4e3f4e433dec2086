"""Camera responses, with their inverses: what a calibration is to find.

X  exposure at the sensor, 0 to 1, where 1 fills the well
M  brightness, 0 to 1: the pixel level over the highest one
f  response, M = f(X), rising, f(0) = 0 and f(1) = 1
g  ln f^-1 (n,) over the pixel levels, g[n / 2] = 0
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F64, Array
from hdrlab.core.colour import decode_srgb, encode_srgb
from hdrlab.errors import InputError

Curve = Callable[[Array], Array]


class Response(NamedTuple):
    """A response f and its inverse, both on arrays of 0 to 1."""

    f: Curve
    inverse: Curve


def film(X: Array, *, a: float = 0.1, gamma: float = 1.2) -> Array:
    """Return (1 + a) X^gamma / (a + X^gamma): an S over ln X, with the toe and the shoulder of film."""
    p = X**gamma
    return (1 + a) * p / (a + p)


def film_inverse(M: Array, *, a: float = 0.1, gamma: float = 1.2) -> Array:
    """Return (a M / (1 + a - M))^(1 / gamma)."""
    return (a * M / (1 + a - M)) ** (1 / gamma)


def cubic(X: Array) -> Array:
    """Return 2/3 sinh(arsinh(18 X) / 3), the real root M of M + 3 M^3 = 4 X."""
    return 2 / 3 * np.sinh(np.arcsinh(18 * X) / 3)


RESPONSES = {
    "linear": Response(lambda X: X, lambda M: M),
    "gamma": Response(lambda X: X ** (1 / 2.2), lambda M: M**2.2),
    "srgb": Response(encode_srgb, decode_srgb),
    "film": Response(film, film_inverse),
    # a polynomial of order 3, as [Cerman06 sec. 4.2] uses
    "cubic": Response(cubic, lambda M: (M + 3 * M**3) / 4),
}


def bisect(f: Curve) -> Curve:
    """Return the inverse of a rising f, found by halving [0, 1] until it is exact in float64."""

    def inverse(M: Array) -> Array:
        low = np.zeros(np.shape(M))
        high = np.ones(np.shape(M))
        for _ in range(60):
            middle = (low + high) / 2
            below = f(middle) < M
            low = np.where(below, middle, low)
            high = np.where(below, high, middle)
        return high

    return inverse


def as_response(response: str | Curve | Response | None) -> Response:
    """Return the Response of that name (None: "linear"), or of a rising function from [0, 1] into [0, 1]."""
    if response is None or isinstance(response, str):
        if (response or "linear") not in RESPONSES:
            raise InputError(
                f"expected one of the responses {', '.join(RESPONSES)}, got {response!r}"
            )
        return RESPONSES[response or "linear"]
    made = response if isinstance(response, Response) else Response(response, bisect(response))
    M = np.asarray(made.f(np.linspace(0, 1, 1025)))
    if M.shape != (1025,) or not (np.all(np.diff(M) >= 0) and 0 <= M[0] < M[-1] <= 1):
        raise InputError("expected a rising response from [0, 1] to [0, 1]")
    return made


def true_g(response: str | Curve | Response | None = "film", n: int = 256) -> F64:
    """Return g = ln f^-1, what a calibration of this camera should find.

    Parameters
    ----------
    response : as in `camera.shoot`
    n : levels, 256 or 65536

    Returns
    -------
    g : (n,) ln exposure of each pixel level, with g[n // 2] = 0. Level 0 holds the brightnesses
        from 0 to
        half a level; it gets the middle of them, for ln 0 has no number.

    Examples
    --------
    >>> g = true_g("gamma")
    >>> bool(g[128] == 0), round(float(np.exp(g[64] - g[128])), 4), round(0.5**2.2, 4)
    (True, 0.2176, 0.2176)
    """
    M = np.arange(n) / (n - 1)
    M[0] = 0.25 / (n - 1)
    g = np.log(as_response(response).inverse(M))
    return g - g[n // 2]
