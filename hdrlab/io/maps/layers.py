"""OpenEXR files of several parts: pictures of one size that belong together, each with its name.

A program that knows nothing of parts sees the first: `hdrlab.io.maps.exr` and most viewers do.
"""

from pathlib import Path

import numpy as np

from hdrlab.core.types import F32
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
    >>> from hdrlab.scenes.places import FOLDER
    >>> {name: layer.shape for name, layer in read_layers(FOLDER / "street.exr").items()}
    {'radiance': (512, 768, 3), 'depth': (512, 768), 'mover': (512, 768, 4)}
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
