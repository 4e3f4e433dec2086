"""A camera in numbers: from the radiance of a scene to a bracket of photographs.

E        radiance (H, W[, 3]) float32, any linear unit
t        exposure time, s
X        exposure at the sensor, float32: 1 fills the well
M        brightness, 0 to 1
Z        pixel level, 0 to 2^bits - 1
offsets  (P, 2), (dy, dx) pixels: how far frame j must move, down and right, to lie on the reference;
         or homographies (P, 3, 3), see `capture.hand_motion`

The light goes through the camera in this order, one function each, those of the sensor in `capture.sensor`:

    E -> views -> falloff -> exposure -> photons -> readout -> (hot pixels) -> f -> grain ->
    quantise -> Z

A `Sensor` puts a converter with a black level after the readout, and a Bayer mosaic before the
photons.
"""

from dataclasses import dataclass

import numpy as np

from hdrlab.capture import responses, sensor as stages
from hdrlab.capture.hand_motion import views
from hdrlab.capture.sensor import Seed, Sensor
from hdrlab.core.arrays import (
    F32,
    F64,
    Array,
    ArrayLike,
    Mask,
    NDArray,
    as_radiance,
    as_times,
    describe,
)
from hdrlab.core.bracket import Bracket, bracket
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError


def shake(count: int, *, radius: int = 8, rng: Seed = 0) -> NDArray[np.int64]:
    """Return offsets (P, 2) of a shaking hand, up to `radius` pixels each way; frame P // 2 stays at 0."""
    if count < 1 or radius < 0:
        raise InputError(
            f"expected at least one frame and a radius of at least 0, got {count} and {radius}"
        )
    offsets = np.random.default_rng(rng).integers(-radius, radius, (count, 2), endpoint=True)
    offsets[count // 2] = 0
    return offsets


def times_around(
    E: ArrayLike,
    count: int = 7,
    *,
    stops: float = 2.0,
    middle: float = 0.1,
    sensitivity: float = 1.0,
) -> F64:
    """Return `count` times (P,), seconds, `stops` apart, around the one that suits the scene.

    That one brings the log-average luminance, exp(mean ln L), to X = `middle`: a little below half
    the levels of a film or an sRGB picture, with three stops left above it.

    Examples
    --------
    >>> times_around(np.full((2, 2), 0.5), 3, middle=0.5)
    array([0.25, 1.  , 4.  ])
    """
    if count < 1 or not all(0 < knob < np.inf for knob in (stops, middle, sensitivity)):
        got = f"{count}, {stops}, {middle} and {sensitivity}"
        raise InputError(
            f"expected at least one frame, positive stops, middle and sensitivity; got {got}"
        )
    L = luminance(E).astype(np.float64)
    if not L.any():
        raise InputError("expected radiance with positive pixels, got only zeros")
    suitable = middle / (sensitivity * np.exp(np.log(L[L > 0]).mean()))
    return suitable * 2.0 ** (stops * (np.arange(count) - (count - 1) / 2))


@dataclass(frozen=True, kw_only=True)
class Camera:
    """A camera: its sensor, its lens and its response.

    Attributes
    ----------
    response : f, a name in `responses.RESPONSES` (None: "linear"), a Response, or a rising function
        on arrays
        of [0, 1]; `responses.true_g` returns what a calibration should find
    bits : 8 or 16
    sensitivity : s, exposure per (radiance unit x second): E t = 1 / s fills the well
    full_well : electrons a pixel holds, which sets the shot noise; infinitely many have none. A
        phone's pixel
        holds 5 000, a large sensor's 50 000.
    read_noise : electrons, standard deviation; wants a finite full_well
    gray_noise : pixel levels, standard deviation, after the response; 1 is the noise of [Cerman06
        sec. 4.2]
    hot : share of the sensor's elements (pixels of a gray photograph, channels of pixels of RGB)
        stuck at a
        full well, the same ones in every photograph
    vignetting : share of the light that the lens loses in the corners, 0 to 1
    sensor : Sensor with a converter, whose full_well and read_noise count then instead of those
        above
    bayer : the sensor has one colour per pixel, R G / G B, and the others are interpolated; wants a
        sensor
    white : gains (3,) of the channels, as of `sensor.balance`; want a sensor

    Raises
    ------
    ValueError
        For numbers that mean nothing, or do not fit together.

    Examples
    --------
    >>> Camera(response="gamma", full_well=20_000, read_noise=5).bits
    8
    """

    response: str | responses.Curve | responses.Response | None = "film"
    bits: int = 8
    sensitivity: float = 1.0
    full_well: float = np.inf
    read_noise: float = 0.0
    gray_noise: float = 0.0
    hot: float = 0.0
    vignetting: float = 0.0
    sensor: Sensor | None = None
    bayer: bool = False
    white: ArrayLike = (1.0, 1.0, 1.0)

    def __post_init__(self) -> None:
        self._require(self.bits in (8, 16), "8 or 16 bits")
        self._require(0 < self.sensitivity < np.inf, "a positive sensitivity")
        self._require(self.full_well > 0, "a positive full well")
        self._require(
            0 <= self.read_noise < np.inf and 0 <= self.gray_noise < np.inf,
            "read_noise and gray_noise of at least 0",
        )
        self._require(
            0 <= self.hot <= 1 and 0 <= self.vignetting <= 1, "hot and vignetting from 0 to 1"
        )
        self._require(
            not self.read_noise or self.full_well < np.inf,
            "a finite full_well for read_noise, in electrons",
        )
        self._require(
            self.sensor is not None or not self.coloured, "a sensor for a mosaic and white balance"
        )
        self._require(self.sensor is None or self.full_well == np.inf, "one full well, not both")

    def _require(self, is_valid: bool, expected: str) -> None:
        if not is_valid:
            raise InputError(f"expected {expected}, got {self}")

    @property
    def coloured(self) -> bool:
        """Whether it has a mosaic or balances white, for which it needs three channels."""
        return self.bayer or bool(np.any(np.asarray(self.white) != 1))


def shoot(
    E: ArrayLike,
    times: ArrayLike,
    camera: Camera = Camera(),
    *,
    offsets: ArrayLike | None = None,
    rng: Seed = 0,
) -> Bracket:
    """Photograph a scene once per exposure time.

    Parameters
    ----------
    E : (H, W) or (H, W, 3), radiance, any linear unit
    times : (P,) seconds, in any order: the photographs come sorted from short to long
    camera : Camera
    offsets : (P, 2), (dy, dx) of each of the times, or None for a tripod: what `align` should
        answer,
        relative to a frame of (0, 0). Frame j moved by offsets[j] lies on that frame; the radiance
        that it saw is `hand_motion.views(E, offsets)[j]`. Those (P, 3, 3) of `hand_motion.shake`
        turn and tilt.
    rng : seed, or a generator, which is advanced

    Returns
    -------
    bracket : Bracket of images (P, h, w[, 3]) uint8 or uint16, where h = H - (max dy - min dy), w
        likewise;
        `linear` where the response is

    Raises
    ------
    ValueError
        For radiance, times or offsets that mean nothing; it says what was expected and what came.

    Examples
    --------
    >>> b = shoot([[0.1, 0.5, 3.0]], [2.0, 1.0], Camera(response="linear"))
    >>> b.times, b.images[:, 0]
    (array([1., 2.]), array([[ 26, 128, 255],
           [ 51, 255, 255]], dtype=uint8))
    """
    E = as_radiance(E)
    times = np.atleast_1d(np.asanyarray(times))
    times = as_times(times, max(times.size, 1))
    moves = np.zeros((len(times), 2), int) if offsets is None else np.asarray(offsets)
    if moves.shape[:1] != times.shape:
        raise InputError(f"expected {len(times)} offsets, one per time, got {describe(moves)}")
    if E.ndim == 2 and camera.coloured:
        raise InputError(
            f"expected radiance (H, W, 3) for a mosaic and white balance, got {describe(E)}"
        )
    rng = np.random.default_rng(rng)
    order = np.argsort(times, kind="stable")
    light = views(E, moves[order])
    stuck = rng.random(light[0].shape) < camera.hot
    images = []
    for view, time in zip(light, times[order], strict=True):
        images.append(photograph(view, time, camera, stuck, rng))
    linear = responses.as_response(camera.response) is responses.as_response("linear")
    return bracket(np.stack(images), times[order], linear=linear)


def photograph(E: F32, time: float, camera: Camera, stuck: Mask, rng: np.random.Generator) -> Array:
    """Return Z of one photograph, whose hot pixels are `stuck` at a full well."""
    X = stages.exposure(stages.vignette(E, camera.vignetting), time, sensitivity=camera.sensitivity)
    if camera.sensor is not None:
        X = np.where(stuck, 4, X)
        X = stages.filter_bayer(X) if camera.bayer else X
        Z = stages.read(X, camera.sensor, rng=rng)
        X = stages.develop(Z, camera.sensor, white=camera.white, bayer=camera.bayer)
    elif camera.full_well < np.inf:
        N = stages.photons(X, full_well=camera.full_well, rng=rng)
        X = stages.readout(N, read_noise=camera.read_noise, rng=rng) / camera.full_well
    X = np.clip(X, 0, 1)
    if camera.sensor is None:
        X = np.where(stuck, 1, X)
    M = responses.as_response(camera.response).f(X)
    M = stages.grain(M, gray_noise=camera.gray_noise, bits=camera.bits, rng=rng)
    return stages.quantise(M, bits=camera.bits)
