"""How certain each pixel of a radiance map is, from the noise of its own photos.

E, s   radiance and its standard deviation   (h, w) or (h, w, 3)
"""

from dataclasses import replace

import numpy as np

from hdrlab.core.arrays import F64, Array, Mask
from hdrlab.core.threads import map_in_threads
from hdrlab.diagnostics.noise import Noise, estimate_noise
from hdrlab.errors import CalibrationError
from hdrlab.pipeline.assembly import Assembly
from hdrlab.radiance.merge import Quality
from hdrlab.radiance.uncertainty import Sure, merge_with_deviation

# rows that one thread merges at a time
ROWS_PER_STRIP = 64


def measure_deviation(state: Assembly, noise: Noise | None = None) -> Assembly:
    """Return a finished Assembly with E merged by inverse variance, and its standard deviation s.

    s is infinite and E unchanged where no photo measures a pixel, something moved or glare was
    removed. If the noise cannot be estimated from the photos, s is infinite everywhere, and a note
    says so.

    Parameters
    ----------
    state : Assembly
        What `assemble` returned.
    noise : Noise, optional
        Electrons N and read noise R of the camera, if they were measured, see
        `camera_noise.noise_of_developed`. The relative error rho is still estimated from the
        photos, because it is that of their response and their times; where they do not show it, it
        is that of `noise`.
    """
    try:
        estimated = estimate_sensor_noise(state)
    except CalibrationError as error:
        if noise is None:
            unknown = replace(state, s=np.full_like(state.E, np.inf))
            return unknown.with_note(f"the uncertainty of the map is unknown: {error}")
        estimated = noise
    noise = estimated if noise is None else noise._replace(rho=estimated.rho)

    if state.record is not None:
        state = replace(state, record=replace(state.record, sensor_noise=noise))
    images = _clip_masked_pixels(state.bracket.images, state.bracket.valid)
    times = state.bracket.times

    def merge_strip(strip: Array) -> tuple[Array, Array]:
        return merge_with_deviation(strip, times, state.g, *noise)

    strips = np.array_split(images, range(ROWS_PER_STRIP, len(state.E), ROWS_PER_STRIP), axis=1)
    merged = list(map_in_threads(merge_strip, strips))
    E = np.concatenate([E_strip for E_strip, _ in merged])
    s = np.concatenate([s_strip for _, s_strip in merged])
    is_unknown = state.quality != Quality.MEASURED
    for changed in (state.moving, state.glare):
        if changed is not None:
            is_unknown = is_unknown | (changed > 0)
    s[is_unknown] = np.inf
    return replace(state, E=np.where(np.isfinite(s), E, state.E), s=s)


def estimate_sensor_noise(state: Assembly) -> Noise:
    """Return the noise of the camera, from the photos of an Assembly and its map.

    Raises
    ------
    CalibrationError
        If two photos measure too few flat pixels.
    """
    bracket = state.bracket
    images = _clip_masked_pixels(bracket.images, bracket.valid)
    E = state.E
    if state.record is not None:
        E = E / np.float32(state.record.unit_factor)
    return estimate_noise(images, bracket.times, state.g, E)


def merge_pixels_with_deviation(
    images: Array, valid: Mask | None, times: F64, g: F64, noise: Noise
) -> Sure:
    """Return the radiance of pixels (P, H, W[, 3]) by inverse variance, and its standard deviation."""
    return merge_with_deviation(_clip_masked_pixels(images, valid), times, g, *noise)


def _clip_masked_pixels(images: Array, valid: Mask | None) -> Array:
    """Return photos whose masked pixels measure as little as clipped ones."""
    if valid is None:
        return images
    images = images.copy()
    images[~valid] = np.iinfo(images.dtype).max
    return images
