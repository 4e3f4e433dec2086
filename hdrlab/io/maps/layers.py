"""OpenEXR files of several parts: pictures of one size that belong together, each with its name.

A program that knows nothing of parts sees the first: `hdrlab.io.maps.exr` and most viewers do.
"""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from hdrlab.core.arrays import describe
from hdrlab.core.optional import OpenEXR
from hdrlab.core.types import F32
from hdrlab.io.files import replacing
from hdrlab.io.maps import exr

CHANNELS = {1: "Z", 3: "RGB", 4: "RGBA"}  # one channel is a depth


def read_layers(path: str | Path) -> dict[str, F32]:
    """Read all parts of an OpenEXR file.

    Parameters
    ----------
    path : the file

    Returns
    -------
    layers : of each part, under its name, (H, W), (H, W, 3) or (H, W, 4) float32

    Raises
    ------
    ValueError
        For a file that is not one, is damaged, or has parts of other channels or of different size.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "wall.exr"
    >>> write_layers(path, {"radiance": np.ones((2, 4, 3)), "depth": np.full((2, 4), 7.5)})
    >>> {name: layer.shape for name, layer in read_layers(path).items()}
    {'radiance': (2, 4, 3), 'depth': (2, 4)}
    """
    exr.read_headers(path)  # which looks at the sizes that are claimed, before pixels are read
    layers: dict[str, F32] = {}
    for number, (header, planes) in enumerate(exr.parts(path)):
        name, channels = header.get("name", f"part {number}"), next(iter(planes))
        if len(planes) != 1 or channels not in CHANNELS.values():
            raise ValueError(f"{path}: expected {name} to have RGB, RGBA or Z, got {', '.join(planes)}")
        layers[name] = planes[channels].astype(np.float32)
    sizes = {layer.shape[:2] for layer in layers.values()}
    if len(sizes) > 1:
        raise ValueError(f"{path}: expected parts of one size, got {sorted(sizes)}")
    return layers


def write_layers(path: str | Path, layers: Mapping[str, ArrayLike]) -> None:
    """Write layers as the parts of an OpenEXR file of 16-bit floats, whole or not at all.

    Parameters
    ----------
    path : the file; what it held is replaced
    layers : (H, W), (H, W, 3) or (H, W, 4) each, of one size, finite, not negative, up to 65504; the first
        is what programs see that know of one part alone

    Raises
    ------
    ValueError
        For layers of different size or other channels, or values that half floats cannot hold.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "light.exr"
    >>> write_layers(path, {"radiance": np.full((2, 4, 3), 0.25)})
    >>> float(read_layers(path)["radiance"].max())
    0.25
    """
    arrays = {name: np.asarray(layer, np.float32) for name, layer in layers.items()}
    if len({layer.shape[:2] for layer in arrays.values()}) != 1:
        raise ValueError(f"expected layers of one size, got {[layer.shape for layer in arrays.values()]}")
    parts = []
    for name, layer in arrays.items():
        if layer.ndim not in (2, 3) or layer[0, 0].size not in CHANNELS:
            raise ValueError(f"expected {name} to have 1, 3 or 4 channels, got shape {layer.shape}")
        if not (layer.min() >= 0 and layer.max() <= exr.LARGEST_HALF):  # NaN fails as well
            raise ValueError(f"expected {name} in 0 to {exr.LARGEST_HALF:.0f}, got {describe(layer)}")
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        pixels = np.ascontiguousarray(layer, np.float16)
        parts.append(OpenEXR.Part(header, {CHANNELS[layer[0, 0].size]: pixels}, name))
    with replacing(path) as temporary, OpenEXR.File(parts) as file:
        file.write(str(temporary))
