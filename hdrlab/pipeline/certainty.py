"""How sure each pixel of a map is, by the noise that its own photographs tell of.

E, s   radiance and its standard deviation   (h, w) or (h, w, 3)
"""

import numpy as np

from hdrlab.core.threads import map_in_threads
from hdrlab.diagnostics.noise import estimate_noise
from hdrlab.pipeline.assembly import Assembly
from hdrlab.radiance.merge import Quality
from hdrlab.radiance.uncertainty import merge_with_deviation

# that are merged by one thread at a time
ROWS = 64


def measure_deviation(state: Assembly) -> Assembly:
    """Return a finished Assembly with E by inverse variance, and s.

    s is infinite, and E as it was, where no frame measures, something moved or glare was removed;
    and everywhere, with a note, where the photographs do not tell their noise.
    """
    images, times, _, valid, _ = state.bracket
    if valid is not None:  # what shows nothing measures as little as what clips
        images = images.copy()
        images[~valid] = np.iinfo(images.dtype).max
    try:
        noise = estimate_noise(images, times, state.g, state.E)
    except ValueError as error:
        return state._replace(
            s=np.full_like(state.E, np.inf), notes=(*state.notes, f"not sure: {error}")
        )
    strips = np.array_split(images, range(ROWS, len(state.E), ROWS), axis=1)
    merged = map_in_threads(lambda one: merge_with_deviation(one, times, state.g, *noise), strips)
    E, s = (np.concatenate(parts) for parts in zip(*merged, strict=True))
    changed = [one > 0 for one in (state.moving, state.glare) if one is not None]
    s[np.any([state.quality != Quality.MEASURED, *changed], axis=0)] = np.inf
    return state._replace(E=np.where(np.isfinite(s), E, state.E), s=s)
