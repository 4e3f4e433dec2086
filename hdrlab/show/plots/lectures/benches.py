"""Two experiments for `widgets.tune`: functions that simulate photos, and plots of the results.

meter_scene       meter a scene in a mode, take the photo, and find the pixels that it lost
calibrate_shaken  take a hand-held bracket, align it, calibrate it, and compare with the truth
draw_reading      draw one step of automatic exposure

E    radiance  (H, W, 3), cd/m^2
at   place of the spot: (down, right), as fractions of the image
EV   exposure value, stops
"""

from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

from hdrlab import pipeline
from hdrlab.capture import autoexposure, camera, exposure, metering, ranges, responses
from hdrlab.capture.sensor import Sensor
from hdrlab.core.bracket import Bracket
from hdrlab.core.colour import encode_srgb, luminance
from hdrlab.fast import debevec
from hdrlab.scenes.subjects import Subject
from hdrlab.show.plots import curves, figures
from hdrlab.show.plots.lectures import sensors

F_NUMBER = 8.0
# A meter needs no more pixels along the longer side.
METERED_SIDE = 96
CALIBRATION_SAMPLES = 500
DEFAULT_SENSOR = Sensor()
NOISY_CAMERA = camera.Camera(full_well=20_000, read_noise=5)


@dataclass(frozen=True)
class Shot:
    """A photo with the exposure that the meter chose, and the pixels that it lost.

    Attributes
    ----------
    picture : (H, W, 3), sRGB
    full : (H, W), whether a channel is clipped
    noise : (H, W), whether the signal is not above the noise
    metered : (H, W), pixels with a large weight in the metering mode
    EV : exposure value
    off : stops by which the subject is too bright
    """

    picture: NDArray[np.uint8]
    full: NDArray[np.bool_]
    noise: NDArray[np.bool_]
    metered: NDArray[np.bool_]
    EV: float
    off: float


def meter_scene(
    scene: Subject,
    mode: str = "spot",
    at: metering.At = (0.5, 0.5),
    *,
    sensor: Sensor = DEFAULT_SENSOR,
    rng: int = 0,
) -> Shot:
    """Return the photo of a scene that automatic exposure takes in a metering mode."""
    coarse = figures.fit(scene.E, METERED_SIDE)
    photograph = partial(autoexposure.measure_brightness, aperture=F_NUMBER)
    EV = autoexposure.expose(coarse, mode, at=at, photograph=photograph)
    time = F_NUMBER**2 / 2.0**EV
    sensitivity = 1 / float(exposure.saturating_luminance(1.0, F=F_NUMBER))
    simulated = camera.Camera(response="srgb", sensitivity=sensitivity, sensor=sensor)
    picture = camera.shoot(scene.E, [time], simulated, rng=rng).images[0]
    L = luminance(scene.E)
    subject_brightness = float(L[scene.mask].mean()) * time * sensitivity
    weights = metering.weights(photograph(coarse, EV), mode, at=at)
    return Shot(
        picture=picture,
        full=np.any(picture == 255, axis=-1),
        noise=ranges.expose_levels(L, time, sensor, sensitivity=sensitivity).noise,
        metered=_enlarge(_has_large_weight(weights), L.shape),
        EV=EV,
        off=float(exposure.stops(subject_brightness, scene.rho)),
    )


def _has_large_weight(w: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return where a weight is at least half of the largest one."""
    return w >= w.max() / 2


def _enlarge(mask: NDArray[np.bool_], shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Return a mask enlarged to the size of an image."""
    height, width = shape
    rows = np.arange(height) * mask.shape[0] // height
    columns = np.arange(width) * mask.shape[1] // width
    return mask[rows][:, columns]


def draw_shot(shot: Shot) -> Axes:
    """Draw a photo with its exposure, its lost pixels marked, and a ring around metered pixels."""
    time = F_NUMBER**2 / 2.0**shot.EV
    shutter = f"f/{F_NUMBER:g}, 1/{1 / time:.0f} s" if time < 1 else f"{time:.1f} s"
    lost = f"full {shot.full.mean():.1%} (orange), lost in noise {shot.noise.mean():.1%} (blue)"
    direction = "too bright" if shot.off > 0 else "too dark"
    subject = f"subject {abs(shot.off):.1f} stops {direction}"
    text = f"EV {shot.EV:.1f}: {shutter}; {subject}\n{lost}"
    marked = sensors.mark_lost(shot.picture, shot.full, shot.noise)
    return sensors.draw_titled(marked, text, ring=shot.metered)


def draw_reading(state: autoexposure.State) -> Axes:
    """Draw one shot of automatic exposure, its reading, its next EV, and a ring as in `draw_shot`."""
    Z = np.round(255 * encode_srgb(state.B)).astype(np.uint8)
    full = f"{np.mean(state.B >= 1):.0%} of the pixels full"
    text = f"EV {state.EV:.2f}: reading {state.B_pre:.3f}, {full}\n"
    text += f"target {metering.MIDDLE_GRAY}: next EV {state.EV_opt:.2f}"
    return sensors.draw_titled(Z, text, ring=_has_large_weight(state.w))


@dataclass(frozen=True)
class Calibrated:
    """A hand-held bracket, and its calibration without and with alignment.

    Attributes
    ----------
    bracket : the photos
    wrong : number of photos whose estimated offset is not exact
    shot : (256,) g without alignment
    aligned : (256,) g after alignment
    truth : (256,) the camera's own g
    """

    bracket: Bracket
    wrong: int
    shot: NDArray[np.float64]
    aligned: NDArray[np.float64]
    truth: NDArray[np.float64]


def calibrate_shaken(
    E: ArrayLike, *, radius: int = 6, count: int = 5, stops: float = 2.0
) -> Calibrated:
    """Calibrate from `count` gray photos, `stops` apart, shifted by up to `radius` pixels."""
    L = luminance(E)
    offsets = camera.shake(count, radius=radius)
    times = camera.times_around(L, count, stops=stops)
    bracket = camera.shoot(L, times, NOISY_CAMERA, offsets=offsets)
    alignment = pipeline.align_bracket(bracket, "mtb")
    relative_offsets = alignment.offsets - alignment.offsets[count // 2]
    return Calibrated(
        bracket=bracket,
        wrong=int(np.any(relative_offsets != offsets, axis=1).sum()),
        shot=_recover(bracket),
        aligned=_recover(alignment.bracket),
        truth=responses.true_g(),
    )


def _recover(bracket: Bracket) -> NDArray[np.float64]:
    """Return the response of a bracket by Debevec's method."""
    return debevec.recover(bracket.images, bracket.times, samples=CALIBRATION_SAMPLES)


def draw_calibrated(calibration: Calibrated) -> Axes:
    """Draw the errors of both curves in stops; the title counts the photos with correct offsets."""
    count = len(calibration.bracket.images)
    ax = curves.deviations(
        {"as shot": calibration.shot, "aligned": calibration.aligned},
        calibration.truth,
        limit=1.0,
    )
    ax.set_title(f"{count - calibration.wrong} of {count} photos aligned to the pixel", fontsize=10)
    return ax
