"""The file in which a rendered place travels: OpenEXR, a part for each layer, read by `io.maps.layers`."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from hdrlab.core.arrays import ArrayLike, describe
from hdrlab.core.optional import OpenEXR
from hdrlab.io.files import replacing
from hdrlab.io.maps.exr import LARGEST_HALF
from hdrlab.io.maps.layers import CHANNEL_NAMES


def write_layers(path: str | Path, layers: Mapping[str, ArrayLike]) -> None:
    """Write layers as the parts of an OpenEXR file of 16-bit floats, whole or not at all.

    Parameters
    ----------
    path : the file; what it held is replaced
    layers : (H, W), (H, W, 3) or (H, W, 4) each, of one size, finite, not negative, up to 65504;
        the first
        is what programs see that know of one part alone

    Raises
    ------
    ValueError
        For layers of different size or other channels, or values that half floats cannot hold.
    """
    arrays = {name: np.asarray(layer, np.float32) for name, layer in layers.items()}
    if len({layer.shape[:2] for layer in arrays.values()}) != 1:
        raise ValueError(
            f"expected layers of one size, got {[layer.shape for layer in arrays.values()]}"
        )
    parts = []
    for name, layer in arrays.items():
        if layer.ndim not in (2, 3) or layer[0, 0].size not in CHANNEL_NAMES:
            raise ValueError(f"expected {name} to have 1, 3 or 4 channels, got shape {layer.shape}")
        if not (layer.min() >= 0 and layer.max() <= LARGEST_HALF):  # NaN fails as well
            raise ValueError(f"expected {name} in 0 to {LARGEST_HALF:.0f}, got {describe(layer)}")
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        pixels = np.ascontiguousarray(layer, np.float16)
        parts.append(OpenEXR.Part(header, {CHANNEL_NAMES[layer[0, 0].size]: pixels}, name))
    with replacing(path) as temporary, OpenEXR.File(parts) as file:
        file.write(str(temporary))
