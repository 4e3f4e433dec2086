"""How certain each pixel of a radiance map is, from the noise of its own photos.

E, s   radiance and its standard deviation   (h, w) or (h, w, 3)
"""

from dataclasses import replace

import numpy as np

from hdrlab.core.arrays import Array
from hdrlab.core.threads import map_in_threads
from hdrlab.diagnostics.noise import estimate_noise
from hdrlab.errors import CalibrationError
from hdrlab.pipeline.assembly import Assembly
from hdrlab.radiance.merge import Quality
from hdrlab.radiance.uncertainty import merge_with_deviation

# rows that one thread merges at a time
ROWS_PER_STRIP = 64


def measure_deviation(state: Assembly) -> Assembly:
    """Return a finished Assembly with E merged by inverse variance, and its standard deviation s.

    s is infinite and E unchanged where no photo measures a pixel, something moved or glare was
    removed. If the noise cannot be estimated from the photos, s is infinite everywhere, and a note
    says so.
    """
    images = state.bracket.images
    times = state.bracket.times
    valid = state.bracket.valid
    if valid is not None:
        # Masked pixels measure as little as clipped ones.
        images = images.copy()
        images[~valid] = np.iinfo(images.dtype).max
    try:
        noise = estimate_noise(images, times, state.g, state.E)
    except CalibrationError as error:
        unknown = replace(state, s=np.full_like(state.E, np.inf))
        return unknown.with_note(f"the uncertainty of the map is unknown: {error}")

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
