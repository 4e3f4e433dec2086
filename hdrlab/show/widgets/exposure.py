"""The range of one photo as a window over a scene's histogram: drag the window, which is the shutter.

E  radiance   (H, W) or (H, W, 3), cd/m²; the page stores it as scaled half floats
L  luminance  of E; X = s t L, exposure, 1 fills the well
t  exposure time, s, one of the marks of a shutter dial

The script uses the formulas of `capture.sensor` and `capture.ranges` for each frame of the display.
A test compares the two.
"""

import numpy as np
import traitlets

from hdrlab.capture import camera, exposure, ranges, responses, sensor as stages
from hdrlab.capture.sensor import Sensor
from hdrlab.core import colour
from hdrlab.core.arrays import ArrayLike, as_radiance
from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.show.pictures import PLOT_PIXEL_DENSITY, Picture, encode, require_alt
from hdrlab.show.plots import seconds
from hdrlab.show.plots.figures import fit
from hdrlab.show.plots.lectures import sensors
from hdrlab.show.widgets.scripts import Widget, script

# A larger map is reduced to the means of k x k pixels.
MAX_MAP_SIDE = 400
# The axis of luminance leaves out the most extreme values at both ends, which are single pixels.
AXIS_QUANTILES = (0.001, 0.999)
RESPONSE = "srgb"
DIAL_SETTINGS_PER_STOP = 3


class ExposureWindow(Widget):
    """A scene, a sensor and a shutter dial; `at` is the index of the dial's setting."""

    _esm = script("half.js", "drag.js", "histogram.js", "exposure.js")
    radiance = traitlets.Bytes().tag(sync=True)  # half floats (H, W, channels)
    scale = traitlets.Float(1.0).tag(sync=True)
    shape = traitlets.List(traitlets.Int()).tag(sync=True)  # (H, W, channels)
    span = traitlets.List(traitlets.Int()).tag(sync=True)  # ends of the axis of log2 L
    sensor = traitlets.Dict().tag(sync=True)
    sensitivity = traitlets.Float(1.0).tag(sync=True)
    # pixel value of each level of the converter, uint8
    pixel_values = traitlets.Bytes().tag(sync=True)
    # exposures X: the least whose noise is not larger than its signal, and the least that is full
    limits = traitlets.List(traitlets.Float()).tag(sync=True)
    shutters = traitlets.List(traitlets.Unicode()).tag(sync=True)
    times = traitlets.List(traitlets.Float()).tag(sync=True)
    at = traitlets.Int(0).tag(sync=True)
    alt = traitlets.Unicode().tag(sync=True)
    pictures = traitlets.List(traitlets.Bytes()).tag(sync=True)  # WebP: the photo, and a plot

    def still(self) -> Picture:
        """Return the photo and the window at the first exposure time."""
        alts = (self.alt, "A histogram of luminance: pixels lost in noise, recorded and full")
        return Picture(tuple(self.pictures), alts, ("", ""), density=PLOT_PIXEL_DENSITY)


def exposure_window(
    E: ArrayLike,
    sensor: Sensor,
    *,
    alt: str,
    time: float,
    sensitivity: float = 1.0,
) -> ExposureWindow:
    """Return a widget in which the range of a photo is dragged along the histogram of a scene.

    The photo has simulated noise. Its full pixels are marked, and those that are lost in noise.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance; a map of more than 400 pixels on a side is reduced to means of k x k pixels.
    sensor : Sensor
    alt : str
        What the scene shows; the widget adds the exposure time.
    time : float
        The first exposure time in seconds; the nearest mark of a dial in thirds of a stop is used.
    sensitivity : float
        s: a pixel is full at L t = 1 / s.

    Raises
    ------
    InputError
        For radiance, a sensor, a time or a sensitivity that mean nothing, a scene without light, or
        an empty alt text.

    Examples
    --------
    >>> E = np.geomspace(1, 2.0**16, 320)[None] * np.ones((240, 1))
    >>> figure = exposure_window(E, Sensor(), alt="A wedge", time=1 / 60, sensitivity=0.001)
    >>> figure.shutters[figure.at], figure.span
    ('1/60 s', [0, 16])
    """
    E = np.asarray(fit(as_radiance(E), MAX_MAP_SIDE))
    sensor = stages.as_sensor(sensor)
    L = colour.luminance(E)
    if not L.any():
        raise InputError("expected a scene with light, got only zeros")
    dial = exposure.shutter_series(DIAL_SETTINGS_PER_STOP)
    at = int(np.argmin(np.abs(np.log(dial.values / exposure.true_time(time)))))
    height, width = L.shape
    data, scale = web.encode_halves(E)
    low, high = np.log2(np.quantile(L[L > 0], AXIS_QUANTILES))
    return ExposureWindow(
        radiance=data,
        scale=scale,
        shape=[height, width, 3 if E.ndim == 3 else 1],
        span=[int(np.floor(low)), int(np.ceil(high))],
        sensor=sensor._asdict(),
        sensitivity=sensitivity,
        pixel_values=_pixel_values(sensor),
        limits=[_darkest_exposure(sensor), stages.full_electrons(sensor) / sensor.full_well],
        shutters=[seconds(exposure.seconds(name)) for name in dial.names],
        times=dial.values.tolist(),
        at=at,
        alt=require_alt(alt),
        pictures=_draw_stills(E, L, float(dial.values[at]), sensor, sensitivity),
    )


def _pixel_values(sensor: Sensor) -> bytes:
    levels = np.arange(2**sensor.bits, dtype=np.uint16)
    X = stages.develop(levels[None], sensor)
    return stages.quantise(responses.as_response(RESPONSE).f(X)).tobytes()


def _darkest_exposure(sensor: Sensor) -> float:
    """Return the X at which N / sqrt(N + NF^2) = 1: signal and noise are equal."""
    N = (1 + np.sqrt(1 + 4 * ranges.noise_floor(sensor) ** 2)) / 2
    return float(N / sensor.full_well)


def _draw_stills(
    E: ArrayLike, L: ArrayLike, time: float, sensor: Sensor, sensitivity: float
) -> list[bytes]:
    L = np.maximum(L, np.finfo(np.float32).tiny)
    taken = camera.Camera(response=RESPONSE, sensor=sensor, sensitivity=sensitivity)
    photo = camera.shoot(E, [time], taken).images[0]
    held = ranges.expose_levels(L, time, sensor, sensitivity=sensitivity)
    marked = sensors.mark_lost(photo, held.full, held.noise)
    held = ranges.expose_levels(L.ravel(), time, sensor, sensitivity=sensitivity)
    plot = sensors.window(L, held)
    return [encode(marked), encode(plot, PLOT_PIXEL_DENSITY)]
