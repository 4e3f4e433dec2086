"""Simulated photos of one textured scene, taken with known offsets between them."""

import numpy as np
from scipy.ndimage import zoom
from skimage.data import astronaut

H = 300  # rows of a photo
W = 420  # columns of a photo
MARGIN = 70  # pixels of the scene around a photo; no offset may be larger
EXPOSURE_PER_SECOND = 0.2  # of a pixel with the median radiance; 1 is white
GAMMA = 2.2  # of the camera's response


def scene_radiance(texture, decades=2.0):
    """Return the radiance of a textured scene, lit from one corner.

    Parameters
    ----------
    texture : (h, w, 3) uint8 image, enlarged to the size of the scene
    decades : the range of the scene

    Returns
    -------
    (H + 2 MARGIN, W + 2 MARGIN, 3) radiance with median 1
    """
    rows = H + 2 * MARGIN
    columns = W + 2 * MARGIN
    scale = max(rows / texture.shape[0], columns / texture.shape[1]) + 0.01
    enlarged = zoom(texture.astype(np.float32) / 255, (scale, scale, 1), order=1)
    reflectance = enlarged[:rows, :columns]
    vertical_light = np.linspace(-0.25, 0.25, rows)[:, None, None]
    horizontal_light = np.linspace(-0.15, 0.15, columns)[None, :, None]
    E = 10 ** (decades * (reflectance - 0.5 + (vertical_light + horizontal_light)))
    return E / np.median(E)


def photograph(E, time, offset=(0, 0), *, rng, dtype=np.uint8, noise=0.004):
    """Return a photo of a scene, taken by a camera that has moved.

    Parameters
    ----------
    E : (H + 2 MARGIN, W + 2 MARGIN, 3) radiance
    time : exposure time, s
    offset : (dy, dx) by which the photo must be shifted to align with one without an offset, pixels
    rng : Generator of the noise
    dtype : uint8 or uint16
    noise : strength of the shot noise, relative to white

    Returns
    -------
    (H, W, 3) photo
    """
    dy, dx = offset
    visible = E[MARGIN + dy : MARGIN + dy + H, MARGIN + dx : MARGIN + dx + W]
    X = EXPOSURE_PER_SECOND * time * visible
    X = X + noise * np.sqrt(X + 0.01) * rng.standard_normal(X.shape)
    white = np.iinfo(dtype).max
    return (np.clip(X, 0, 1) ** (1 / GAMMA) * white + 0.5).astype(dtype)


def bracket(offsets, times, *, texture=None, decades=2.0, dtype=np.uint8, seed=0, noise=0.004):
    """Return photos (P, H, W, 3) of one scene, with an offset and an exposure time for each.

    See `scene_radiance` and `photograph` for the parameters. The default texture is skimage's
    astronaut.
    """
    rng = np.random.default_rng(seed)
    E = scene_radiance(astronaut() if texture is None else texture, decades)
    photos = []
    for time, offset in zip(times, offsets, strict=True):
        photos.append(photograph(E, time, offset, rng=rng, dtype=dtype, noise=noise))
    return np.stack(photos)
