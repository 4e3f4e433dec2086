"""Read and write OpenEXR files of several parts: named images of one size that belong together.

Programs that do not know about parts read the first, as `hdrlab.io.maps.exr` and most viewers do.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from hdrlab.core.arrays import F32, ArrayLike, describe
from hdrlab.errors import FileFormatError, InputError
from hdrlab.io.maps import exr, scanlines

# The channels of images with so many of them; a single channel is a depth.
CHANNEL_NAMES = {1: "Z", 3: "RGB", 4: "RGBA"}
# The layers that `assemble --uncertainty` writes.
UNCERTAINTY_LAYERS = ("radiance", "standard deviation")


def read_layers(path: str | Path) -> dict[str, F32]:
    """Read all parts of an OpenEXR file.

    Parameters
    ----------
    path : the file

    Returns
    -------
    layers : the pixels (H, W), (H, W, 3) or (H, W, 4) float32 of each part, by its name

    Raises
    ------
    FileFormatError
        For a file that is not OpenEXR or is damaged, and for parts with other channels or of
        different sizes.

    Examples
    --------
    >>> from hdrlab.scenes.places import FOLDER
    >>> {name: layer.shape for name, layer in read_layers(FOLDER / "street.exr").items()}
    {'radiance': (512, 768, 3), 'depth': (512, 768), 'mover': (512, 768, 4)}
    """
    exr.read_headers(path)  # refuses absurd sizes before pixels are read
    layers: dict[str, F32] = {}
    for number, (header, planes) in enumerate(exr.read_parts(path)):
        name = header.get("name", f"part {number}")
        channels = CHANNEL_NAMES.get(len(planes), "")
        if set(planes) != set(channels):
            raise FileFormatError(
                f"{path}: expected {name} to have RGB, RGBA or Z, got {', '.join(planes)}"
            )
        layers[name] = exr.stack_channels(planes, channels)
    sizes = {layer.shape[:2] for layer in layers.values()}
    if len(sizes) > 1:
        raise FileFormatError(f"{path}: expected parts of one size, got {sorted(sizes)}")
    return layers


def write_layers(
    path: str | Path, layers: Mapping[str, ArrayLike], *, comments: Sequence[str] = ()
) -> None:
    """Write images of one size as parts of an OpenEXR file of float32, completely or not at all.

    Parameters
    ----------
    path : the file; an existing one is replaced
    layers : images (H, W), written as Z, (H, W, 3) or (H, W, 4), by the names of their parts;
        infinite values are kept
    comments : sentences for the attribute `comments` of the first part

    Raises
    ------
    InputError
        For no layers, for arrays of other shapes, and for layers of different sizes.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "known.exr"
    >>> layers = {"radiance": np.ones((2, 3, 3)), "standard deviation": np.full((2, 3), np.inf)}
    >>> write_layers(file, layers)
    >>> read_layers(file)["standard deviation"].tolist()
    [[inf, inf, inf], [inf, inf, inf]]
    """
    parts: list[scanlines.NewPart] = []
    for name, layer in layers.items():
        pixels = np.ascontiguousarray(layer, np.float32)
        channels = CHANNEL_NAMES.get(1 if pixels.ndim == 2 else pixels.shape[-1])
        if pixels.ndim not in (2, 3) or not pixels.size or channels is None:
            raise InputError(
                f"expected {name} as (H, W), (H, W, 3) or (H, W, 4), got {describe(pixels)}"
            )
        is_first = not parts
        attributes = {"comments": "\n".join(comments)} if comments and is_first else {}
        planes = exr.split_channels(pixels, channels)
        parts.append(scanlines.NewPart(planes, name, attributes))
    sizes = {np.shape(layer)[:2] for layer in layers.values()}
    if len(sizes) != 1:
        raise InputError(f"{path}: expected layers of one size, got {sorted(sizes)}")
    exr.save_parts(path, parts)
