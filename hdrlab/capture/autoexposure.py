"""Automatic exposure: shoot, read, correct, until the reading is right (Battiato et al. 2008, sec. 1.2).

E      radiance      (H, W[, 3]), cd/m^2
EV     exposure value, stops, at the camera's ISO: T = F^2 / 2^EV seconds
B      brightness    (H, W) in [0, 1]: on the sensor, 1 where it was full
w      weight        (H, W), of the metering mode
B_pre  the reading, sum of w B;  B_opt  what it should be

One step is the formula EV_opt = EV_pre + log2 B_pre - log2 B_opt, except that it knows of full
pixels. They stay full until the exposure falls far enough, so the plain formula needs many shots
where a window is bright.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from hdrlab.capture import camera, exposure, metering, sensor
from hdrlab.core import colour, steps
from hdrlab.core.arrays import F32, F64, ArrayLike

# stops: the loop ends when it asks for less than this
STOP_TOLERANCE = 1 / 12


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """One shot of the loop.

    Attributes
    ----------
    EV : exposure value of the shot
    B : (H, W) brightness on the sensor
    w : (H, W) weights of the metering mode
    B_pre : the reading
    EV_opt : exposure value for the next shot
    """

    EV: float
    B: F32
    w: F64
    B_pre: float
    EV_opt: float


def measure_brightness(
    E: ArrayLike,
    EV: float,
    *,
    aperture: float = 8.0,
    iso: float = 100.0,
    full_well: float = np.inf,
    read_noise: float = 0.0,
    rng: sensor.Seed = 0,
) -> F32:
    """Return B (H, W), the luminance of one linear photograph with T = F^2 / 2^EV, where 1 is full."""
    s = 1 / float(exposure.saturating_luminance(1.0, F=aperture, S=iso))
    linear = camera.Camera(
        response="linear", bits=16, sensitivity=s, full_well=full_well, read_noise=read_noise
    )
    shot = camera.shoot(colour.luminance(E), [aperture**2 / 2.0**EV], linear, rng=rng)
    return shot.images[0].astype(np.float32) / 65535


def expose_steps(
    E: ArrayLike,
    mode: str = "centre",
    *,
    at: metering.At = (0.5, 0.5),
    start: float = 12.0,
    target: float = metering.MIDDLE_GRAY,
    max_shots: int = 8,
    photograph: Callable[[ArrayLike, float], F32] = measure_brightness,
) -> Iterator[State]:
    """Yield the State of each shot, until the next one would differ by less than 1/12 stop."""
    EV = start
    for _ in range(max_shots):
        B = photograph(E, EV)
        w = metering.weights(B, mode, at=at)
        EV_opt = EV - metering.correction(B, w, target)
        yield State(EV=EV, B=B, w=w, B_pre=metering.reading(B, w), EV_opt=EV_opt)
        if abs(EV_opt - EV) < STOP_TOLERANCE:
            return
        EV = EV_opt


def expose(
    E: ArrayLike,
    mode: str = "centre",
    *,
    at: metering.At = (0.5, 0.5),
    start: float = 12.0,
    target: float = metering.MIDDLE_GRAY,
    max_shots: int = 8,
    photograph: Callable[[ArrayLike, float], F32] = measure_brightness,
) -> float:
    """Return the EV that automatic exposure settles on.

    Parameters
    ----------
    E : (H, W) or (H, W, 3), radiance, cd/m^2
    mode : one of metering.MODES
    at : (down, right) of the spot or focus point, as parts of the picture
    start : EV of the first shot
    target : B_opt
    max_shots : shots at most
    photograph : (E, EV) -> B, the camera; `measure_brightness` with another aperture, ISO speed or
        noise

    Returns
    -------
    EV : stops

    Raises
    ------
    ValueError
        For radiance, a mode or a place that mean nothing.

    References
    ----------
    Battiato, Messina and Castorina, Exposure correction for imaging devices: an overview, 2008, eq.
    1.2.

    Examples
    --------
    >>> gray = np.full((20, 30), 100.0)
    >>> round(expose(gray) - expose(2 * gray), 2)
    -1.0
    """
    states = expose_steps(
        E, mode, at=at, start=start, target=target, max_shots=max_shots, photograph=photograph
    )
    return steps.last(states).EV_opt
