"""Measure simulated cameras by `hdrlab noise`, from darks and flats whose truth is known.

One row measures 20 cameras. The other puts each fault into the photos of one camera, such as a tone
curve, and counts whether hdrlab names it. The tests use the same cameras and faults.
"""

import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike
from scipy import ndimage
from tqdm import tqdm

from benchmarks.experiments import Experiment, at_least, at_most
from hdrlab.capture import sensor
from hdrlab.capture.sensor import Sensor
from hdrlab.core.arrays import Array
from hdrlab.diagnostics import camera_noise as kinds
from hdrlab.io import raw
from hdrlab.io.exif_exposure import Exposure
from hdrlab.pipeline.camera_noise import CameraNoise, measure_camera_noise

# from XYZ under D65 to the channels of a Canon EOS 5D Mark II, as its DNG files state it
MATRIX = ((0.4716, 0.0603, -0.0830), (-0.7798, 1.5474, 0.2480), (-0.1496, 0.1937, 0.6651))
PATTERN = ((0, 1), (1, 2))
# light that a channel gets of a white wall
CHANNEL_LIGHT = (0.55, 1.0, 0.7)
GAINS = tuple(1 / light for light in CHANNEL_LIGHT)
SIDE = 400  # pixels
# seconds of the flats; 1 fills the green pixels
TIMES = (0.001, 0.004, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85, 1.0, 1.4, 2.6)
CAMERAS = 20

# A fault changes the levels of a photo: Z, the time (0 for a dark), and 0 or 1, which photo of a pair
Fault = Callable[[Array, float, int], Array]


@dataclass(frozen=True)
class Studio:
    """How the photos of a wall are taken."""

    vignetting: float = 0.4
    iso: float = 100
    camera: str = "Simulated"
    side: int = SIDE
    times: tuple[float, ...] = TIMES


def make_sensor(number: int) -> Sensor:
    """Return one of the simulated sensors, whose gain, noise, well and bits differ."""
    rng = np.random.default_rng(1000 + number)
    bits = 12 if number % 2 else 14
    full_well = float(np.exp(rng.uniform(np.log(4000), np.log(80_000))))
    black = 64 if bits == 12 else 512
    # the well ends at 70 to 130 % of the converter's range
    gain = full_well / (2**bits - 1 - black) / rng.uniform(0.7, 1.3)
    # from half a level, below which rounding hides it
    read_noise = float(rng.uniform(0.7, 3.0) * max(gain, 1.0))
    return Sensor(full_well, read_noise, gain, bits, black)


def white_level(simulated: Sensor) -> int:
    """Return the level at which a pixel of a sensor is full, as an honest file states it."""
    full_electrons = sensor.full_electrons(simulated)
    return round(full_electrons / simulated.gain) + simulated.black


def write_photos(
    folder: Path,
    simulated: Sensor,
    *,
    studio: Studio | None = None,
    fault: Fault | None = None,
    rng: int = 0,
) -> tuple[Path, Path]:
    """Write two darks and a pair of flats of each time as DNG, and return both folders."""
    studio = studio or Studio()
    generator = np.random.default_rng(rng)
    wall = np.full((studio.side, studio.side, 3), CHANNEL_LIGHT, np.float32)
    dark = folder / "dark"
    flat = folder / "flat"
    for path in (dark, flat):
        path.mkdir(parents=True, exist_ok=True)
    for number, time in enumerate((0.0, *studio.times)):
        for which in range(2):
            Z = sensor.raw(
                wall, time, simulated, vignetting=studio.vignetting, bayer=True, rng=generator
            )
            if fault is not None:
                Z = fault(Z, time, which)
            name = f"IMG_{2 * number + which}.dng"
            raw.write_dng(
                (flat if time else dark) / name,
                Z,
                pattern=PATTERN,
                black=simulated.black,
                white=white_level(simulated),
                gains=GAINS,
                matrix=MATRIX,
                exposure=Exposure(time or 0.1, 8.0, studio.iso),
                camera=studio.camera,
            )
    return dark, flat


def make_faults(simulated: Sensor, rng: int = 0) -> dict[str, Fault]:
    """Return what can be wrong with the photos of a sensor, by name."""
    black = simulated.black
    top = white_level(simulated)
    generator = np.random.default_rng(rng)

    def bend(Z: Array, time: float, which: int) -> Array:
        x = (Z.astype(np.float64) - black) / (top - black)
        bent = np.sign(x) * np.abs(x) ** 0.9
        return np.rint(black + (top - black) * bent).astype(np.uint16)

    def bend_softly(Z: Array, time: float, which: int) -> Array:
        x = (Z.astype(np.float64) - black) / (top - black)
        return np.rint(black + (top - black) * (x - 0.05 * x**2)).astype(np.uint16)

    def blur(Z: Array) -> Array:
        smooth = np.empty_like(Z)
        for y in range(2):
            for x in range(2):
                plane = Z[y::2, x::2].astype(np.float64)
                smooth[y::2, x::2] = np.rint(ndimage.uniform_filter(plane, 3))
        return smooth

    def denoise_darks(Z: Array, time: float, which: int) -> Array:
        return Z if time else blur(Z)

    def shrink_darks(Z: Array, time: float, which: int) -> Array:
        return Z if time else np.rint(black + (Z.astype(np.float64) - black) / 4).astype(np.uint16)

    def denoise_all(Z: Array, time: float, which: int) -> Array:
        return blur(Z)

    def clip_early(Z: Array, time: float, which: int) -> Array:
        return np.minimum(Z, round(black + 0.8 * (top - black)))

    def flicker(Z: Array, time: float, which: int) -> Array:
        if not which or not 0.25 < time < 0.35:
            return Z
        return np.rint(black + 0.93 * (Z.astype(np.float64) - black)).astype(np.uint16)

    def flicker_in_bands(Z: Array, time: float, which: int) -> Array:
        if not 0.25 < time < 0.35:
            return Z
        rows = np.arange(len(Z))[:, None]
        wave = 1 + 0.02 * np.sin(2 * np.pi * (rows / 60 + which / 2))
        return np.rint(black + wave * (Z.astype(np.float64) - black)).astype(np.uint16)

    def leak_at_one_side(Z: Array, time: float, which: int) -> Array:
        if time:
            return Z
        slope = np.linspace(0, 1, Z.shape[1]) ** 2
        return _add_light(Z, simulated, 12 * simulated.read_noise**2 * slope, generator)

    def leak_everywhere(Z: Array, time: float, which: int) -> Array:
        return (
            Z if time else _add_light(Z, simulated, np.full(1, simulated.read_noise**2), generator)
        )

    return {
        "tone curve x^0.9": bend,
        "tone curve x - 0.05 x^2": bend_softly,
        "darks denoised by 3 x 3 means": denoise_darks,
        "darks denoised pixel by pixel": shrink_darks,
        "all photos denoised": denoise_all,
        "clipping at 80 % of the white level": clip_early,
        "light changes by 7 % within a pair": flicker,
        "lamp flickers in stripes of 2 %": flicker_in_bands,
        "light leak at one side": leak_at_one_side,
        "light leak everywhere": leak_everywhere,
    }


# the warning that names each fault
FAULT_KINDS = {
    "tone curve x^0.9": kinds.TONE_CURVE,
    "tone curve x - 0.05 x^2": kinds.TONE_CURVE,
    "darks denoised by 3 x 3 means": kinds.DENOISED_DARKS,
    "darks denoised pixel by pixel": kinds.DENOISED_DARKS,
    "all photos denoised": kinds.DENOISED_FLATS,
    "clipping at 80 % of the white level": kinds.EARLY_CLIPPING,
    "light changes by 7 % within a pair": kinds.UNSTEADY_LIGHT,
    "lamp flickers in stripes of 2 %": kinds.UNSTEADY_LIGHT,
    "light leak at one side": kinds.LIGHT_LEAK,
    "light leak everywhere": kinds.LIGHT_LEAK,
}


def _add_light(Z: Array, simulated: Sensor, electrons: Array, rng: np.random.Generator) -> Array:
    """Return levels with the photons of a light leak, by row or column."""
    photons = rng.poisson(np.broadcast_to(electrons, Z.shape))
    levels = np.floor(photons / simulated.gain + rng.random(Z.shape))
    return np.minimum(Z + levels, np.iinfo(np.uint16).max).astype(np.uint16)


@dataclass(frozen=True, kw_only=True)
class Errors:
    """The relative errors of the figures of a camera, and which intervals hold the truth."""

    gain: float
    read_noise: float
    full_well: float
    holds: dict[str, list[bool]]


def compare(measured: CameraNoise, simulated: Sensor) -> Errors:
    """Return the largest errors of the channels against the sensor that was simulated."""
    truth = {
        "gain": simulated.gain,
        "read_noise": simulated.read_noise,
        "full_well": sensor.full_electrons(simulated),
        "black": float(simulated.black),
    }
    worst = dict.fromkeys(truth, 0.0)
    holds: dict[str, list[bool]] = {quantity: [] for quantity in truth}
    for channel in measured.channels:
        for quantity, true in truth.items():
            value, low, high = getattr(channel, quantity)
            worst[quantity] = max(worst[quantity], abs(value / true - 1))
            holds[quantity].append(low <= true <= high)
    return Errors(
        gain=worst["gain"],
        read_noise=worst["read_noise"],
        full_well=worst["full_well"],
        holds=holds,
    )


def measure_cameras(folder: Path) -> Mapping[str, ArrayLike]:
    """Return the errors of all simulated cameras, and how often the intervals hold the truth."""
    errors = []
    false_warnings = 0
    for number in tqdm(range(CAMERAS), "cameras", leave=False):
        simulated = make_sensor(number)
        with tempfile.TemporaryDirectory() as photos:
            measured = measure_camera_noise(*write_photos(Path(photos), simulated, rng=number))
        errors.append(compare(measured, simulated))
        false_warnings += len(measured.warnings)
    results: dict[str, ArrayLike] = {
        "gain": max(error.gain for error in errors),
        "read noise": max(error.read_noise for error in errors),
        "full well": max(error.full_well for error in errors),
        "false warnings": false_warnings,
    }
    for quantity in errors[0].holds:
        held = [is_inside for error in errors for is_inside in error.holds[quantity]]
        results[f"intervals of {quantity} that hold the truth"] = np.mean(held)
    return results


def find_faults(folder: Path) -> Mapping[str, ArrayLike]:
    """Return for each fault of the photos of one camera whether hdrlab names it: 1, or 0."""
    simulated = make_sensor(3)
    results: dict[str, ArrayLike] = {}
    for name, fault in make_faults(simulated).items():
        with tempfile.TemporaryDirectory() as photos:
            measured = measure_camera_noise(*write_photos(Path(photos), simulated, fault=fault))
        results[name] = float(FAULT_KINDS[name] in {warning.kind for warning in measured.warnings})
    return results


ROWS = (
    Experiment(
        "own-camera",
        "hdrlab noise on 20 simulated cameras: largest relative error of a channel",
        measure_cameras,
        (
            at_most("gain", 0.05),
            at_most("read noise", 0.05),
            at_most("full well", 0.05),
            at_most("false warnings", 0),
        ),
    ),
    Experiment(
        "own-camera-faults",
        "hdrlab noise on photos with a fault: 1 if it names the fault",
        find_faults,
        tuple(at_least(name, 1) for name in FAULT_KINDS),
    ),
)
