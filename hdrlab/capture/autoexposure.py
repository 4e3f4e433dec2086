"""Automatic exposure: shoot, read, correct, until the reading is right (Battiato et al. 2008, sec. 1.2).

E      radiance      (H, W[, 3]), cd/m^2
EV     exposure value, stops, at the camera's ISO: T = F^2 / 2^EV seconds
B      brightness    (H, W) in [0, 1]: what the sensor saw, 1 where it was full
w      weight        (H, W), whom the metering mode asks
B_pre  the reading, sum of w B;  B_opt  what it should be

One step is the formula EV_opt = EV_pre + log2 B_pre - log2 B_opt, except that it knows of full pixels. They
stay full until the exposure falls far enough, so the plain formula needs many shots where a window is seen.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.capture import camera, exposure
from hdrlab.capture.metering import GRAY, At, Weight, correction, reading, weights
from hdrlab.core.colour import luminance
from hdrlab.core.steps import last

NEAR = 1 / 12  # stops: the loop ends when it asks for less than this


class State(NamedTuple):
    """One shot of the loop."""

    EV: float  # stops, what it was taken with
    B: NDArray[np.float32]  # (H, W), what the sensor saw
    w: Weight  # (H, W), whom the mode asked
    B_pre: float  # what they said
    EV_opt: float  # stops, what to take the next one with


def see(
    E: ArrayLike, EV: float, *, aperture: float = 8.0, iso: float = 100.0, **sensor: Any
) -> NDArray[np.float32]:
    """Return B (H, W), the luminance of one linear photograph with T = F^2 / 2^EV, where 1 is full."""
    fills = float(exposure.saturating_luminance(1.0, F=aperture, S=iso))
    shot = camera.shoot(
        luminance(E), [aperture**2 / 2.0**EV], response="linear", bits=16, sensitivity=1 / fills, **sensor
    )
    return shot.images[0].astype(np.float32) / 65535


def expose_steps(
    E: ArrayLike,
    mode: str = "centre",
    *,
    at: At = (0.5, 0.5),
    start: float = 12.0,
    target: float = GRAY,
    most: int = 8,
    **camera: Any,
) -> Iterator[State]:
    """Yield the State of each shot, until the next one would differ by less than 1/12 stop."""
    EV = start
    for _ in range(most):
        B = see(E, EV, **camera)
        w = weights(B, mode, at=at)
        EV_opt = EV - correction(B, w, target)
        yield State(EV, B, w, reading(B, w), EV_opt)
        if abs(EV_opt - EV) < NEAR:
            return
        EV = EV_opt


def expose(E: ArrayLike, mode: str = "centre", **knobs: Any) -> float:
    """Return the EV that automatic exposure settles on.

    Parameters
    ----------
    E : (H, W) or (H, W, 3), radiance, cd/m^2
    mode : one of metering.MODES
    at : (down, right) of the spot or focus point, as parts of the picture
    start : EV of the first shot
    target : B_opt
    most : shots at most
    aperture, iso : F and S of the camera
    full_well, read_noise, rng : of the sensor, as `camera.shoot` takes them

    Returns
    -------
    EV : stops

    Raises
    ------
    ValueError
        For radiance, a mode or a place that mean nothing.

    References
    ----------
    Battiato, Messina and Castorina, Exposure correction for imaging devices: an overview, 2008, eq. 1.2.

    Examples
    --------
    >>> gray = np.full((20, 30), 100.0)
    >>> round(expose(gray) - expose(2 * gray), 2)
    -1.0
    """
    return last(expose_steps(E, mode, **knobs)).EV_opt
