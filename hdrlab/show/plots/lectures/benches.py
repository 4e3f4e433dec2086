"""Two benches, for `widgets.tune`: pure functions that take a photograph, and what they draw.

meter_scene       place the spot on a scene, see the exposure that the mode chooses, shoot, see what was lost
calibrate_shaken  shoot a bracket with an unsteady hand, align it, calibrate it, compare with the truth
draw_reading      one step of automatic exposure

E    radiance  (H, W, 3), cd/m^2
at   (down, right), parts of the picture, 0 to 1
EV   exposure value, stops;  off  by how many stops the subject is too bright
"""

from functools import partial
from typing import NamedTuple

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

F = 8.0  # f-number of the benches
COARSE = 96  # pixels: meters do not look closer, and the picture is only looked at
SAMPLES = 500  # of a calibration: enough for pictures as small as those of the bench
SENSOR = Sensor()
NOISY = camera.Camera(full_well=20_000, read_noise=5)


class Shot(NamedTuple):
    """A photograph as the meter wanted it, and what it lost."""

    picture: NDArray[np.uint8]  # (H, W, 3), sRGB
    full: NDArray[np.bool_]  # (H, W), a channel or more is full
    noise: NDArray[np.bool_]  # (H, W), no more signal than noise
    asked: NDArray[np.bool_]  # (H, W), pixels that the mode listens to
    EV: float
    off: float  # stops, the subject against where it belongs


def meter_scene(
    scene: Subject,
    mode: str = "spot",
    at: metering.At = (0.5, 0.5),
    *,
    sensor: Sensor = SENSOR,
    rng: int = 0,
) -> Shot:
    """Return the photograph that automatic exposure takes of a scene, in a mode, the spot at a place."""
    coarse = figures.fit(scene.E, COARSE)
    photograph = partial(autoexposure.measure_brightness, aperture=F)
    EV = autoexposure.expose(coarse, mode, at=at, photograph=photograph)
    fills = float(exposure.saturating_luminance(1.0, F=F))
    time = F**2 / 2.0**EV
    s = 1 / fills
    lens = camera.Camera(response="srgb", sensitivity=s, sensor=sensor)
    taken = camera.shoot(scene.E, [time], lens, rng=rng)
    L = luminance(scene.E)
    noise = ranges.expose_levels(L, time, sensor, sensitivity=s).noise
    off = float(exposure.stops(float(L[scene.mask].mean()) * time * s, scene.rho))
    asked = metering.weights(photograph(coarse, EV), mode, at=at)
    picture = taken.images[0]
    return Shot(picture, np.any(picture == 255, axis=-1), noise, _enlarged(asked, L.shape), EV, off)


def _enlarged(w: NDArray[np.float64], shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Return where a weight is at least half of the largest one, at the size of the picture."""
    rows, columns = (np.arange(n) * small // n for n, small in zip(shape, w.shape, strict=True))
    return (w >= w.max() / 2)[rows][:, columns]


def draw_shot(shot: Shot) -> Axes:
    """Draw a photograph with its lost pixels marked, and what the mode chose; a ring for whom it asked."""
    time = F**2 / 2.0**shot.EV
    shutter = f"f/{F:g}, 1/{1 / time:.0f} s" if time < 1 else f"{time:.1f} s"
    lost = f"full {shot.full.mean():.1%} (orange), lost in noise {shot.noise.mean():.1%} (blue)"
    aside = "too bright" if shot.off > 0 else "too dark"
    text = f"EV {shot.EV:.1f}: {shutter}; subject {abs(shot.off):.1f} stops {aside}\n{lost}"
    return sensors.draw_titled(
        sensors.mark_lost(shot.picture, shot.full, shot.noise), text, ring=shot.asked
    )


def draw_reading(state: autoexposure.State) -> Axes:
    """Draw one shot of automatic exposure, its reading, and what it asks for next; the ring as above."""
    Z = np.round(255 * encode_srgb(state.B)).astype(np.uint8)
    full = f"{np.mean(state.B >= 1):.0%} of the pixels full"
    text = f"EV {state.EV:.2f}: reading {state.B_pre:.3f}, {full}\n"
    text += f"wanted {metering.MIDDLE_GRAY}: next EV {state.EV_opt:.2f}"
    return sensors.draw_titled(Z, text, ring=state.w >= state.w.max() / 2)


class Calibrated(NamedTuple):
    """A bracket from the hand, and what calibrating it gives as it was shot, and aligned."""

    bracket: Bracket
    wrong: int  # photographs whose offset was not found to the pixel
    shot: NDArray[np.float64]  # (256,) g without aligning
    aligned: NDArray[np.float64]  # (256,) g after it
    truth: NDArray[np.float64]  # (256,) the camera's own


def calibrate_shaken(
    E: ArrayLike, *, radius: int = 6, count: int = 5, stops: float = 2.0
) -> Calibrated:
    """Return a calibration of `count` gray photographs, `stops` apart, shaken by up to `radius` pixels."""
    L = luminance(E)
    offsets = camera.shake(count, radius=radius)
    times = camera.times_around(L, count, stops=stops)
    taken = camera.shoot(L, times, NOISY, offsets=offsets)
    found = pipeline.align_bracket(taken, "mtb")
    wrong = int(np.any(found.offsets - found.offsets[count // 2] != offsets, axis=1).sum())
    both = [
        debevec.recover(one.images, one.times, samples=SAMPLES) for one in (taken, found.bracket)
    ]
    return Calibrated(taken, wrong, both[0], both[1], responses.true_g())


def draw_calibrated(found: Calibrated) -> Axes:
    """Draw how many stops both curves lie off the truth; above, how many photographs found their place."""
    count = len(found.bracket.images)
    ax = curves.deviations(
        {"as shot": found.shot, "aligned": found.aligned}, found.truth, limit=1.0
    )
    ax.set_title(f"{count - found.wrong} of {count} photos aligned to the pixel", fontsize=10)
    return ax
