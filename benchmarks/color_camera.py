"""A simulated camera with a color matrix, which clips before it converts colors, as real ones do.

E   radiance           (H, W, 3), linear sRGB
A   to the camera      (3, 3), from linear sRGB to balanced channels of the camera; white stays white
C   to the screen      (3, 3), the inverse of A
X   exposure           (H, W, 3), of the balanced channels: 1 fills the well

    E -> A -> exposure, photons, readout, clipping at 1 -> C -> clipping to [0, 1] -> response -> Z

A channel of the camera that is clipped makes all three channels of the photo wrong, because each of
them is a mixture. The photo may show no clipped value there: 1.7 R - 0.6 G of a full R stays below 1.
"""

from dataclasses import replace

import numpy as np

from hdrlab.capture import camera, development, responses
from hdrlab.capture.camera import Camera
from hdrlab.capture.sensor import Seed, quantise
from hdrlab.core.arrays import F32, F64, ArrayLike
from hdrlab.core.bracket import Bracket, bracket

# From XYZ to the channels of a Canon EOS 5D Mark III: ColorMatrix of its DNG files, as dcraw and
# LibRaw have it. Notebook 26 develops a photo with it.
CANON_5D_MARK_3 = (
    (0.6722, -0.0635, -0.0963),
    (-0.4287, 1.2460, 0.2028),
    (-0.0908, 0.2162, 0.5668),
)
SENSOR_BITS = 16
LARGEST_SENSOR_VALUE = 2**SENSOR_BITS - 1


def shoot(
    E: ArrayLike, times: ArrayLike, model: Camera, color_matrix: ArrayLike, *, rng: Seed = 0
) -> Bracket:
    """Photograph a scene as `camera.shoot` does, with a color matrix behind the sensor.

    Parameters
    ----------
    E : (H, W, 3)
        Radiance, linear sRGB.
    times : (P,)
        Seconds.
    model : Camera
        Its response follows the color matrix.
    color_matrix : (3, 3)
        From XYZ under D65 to the channels of the camera, as in a DNG.
    rng : seed or generator
    """
    C = development.screen_from_camera(color_matrix, development.XYZ_OF_SRGB)
    in_camera_space = np.asarray(E) @ np.linalg.inv(C).T
    sensor = replace(model, response="linear", bits=SENSOR_BITS)
    taken = camera.shoot(np.maximum(in_camera_space, 0).astype(np.float32), times, sensor, rng=rng)
    response = responses.as_response(model.response)
    images = [quantise(response.f(develop(image, C)), bits=model.bits) for image in taken.images]
    return bracket(np.stack(images), taken.times)


def develop(image: ArrayLike, C: F64) -> F32:
    """Return linear sRGB (H, W, 3) from 0 to 1 of balanced channels (H, W, 3) uint16."""
    return development.convert(np.asarray(image, np.float32) / LARGEST_SENSOR_VALUE, C)
