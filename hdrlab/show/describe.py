"""Describe an image file from its header, for `hdrlab info`."""

from collections.abc import Callable
from dataclasses import astuple
from pathlib import Path
from typing import Any

import numpy as np

from hdrlab.io import decode, radiance
from hdrlab.io.maps import exr, layers, pfm, rgbe
from hdrlab.show.pages import wording


def describe_file(path: str | Path) -> dict[str, Any]:
    """Return what the header of a photo or of a radiance file states, in the order to print it.

    Parameters
    ----------
    path : a file that `read_photo` or `read_radiance` reads

    Returns
    -------
    dict of `file`, `format`, `width`, `height`, `channels`, `values`, and more that depends on the
    format

    Raises
    ------
    InputError
        For a file of another kind, or whose header is damaged.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "light.pfm"
    >>> pfm.write(file, [[0.25, 1e6]])
    >>> describe_file(file)["width"]
    2
    """
    module = radiance.READ.get(Path(path).suffix.lower())
    describe: Callable[[str | Path], dict[str, Any]]
    if module is rgbe:
        describe = _describe_rgbe
    elif module is pfm:
        describe = _describe_pfm
    elif module is exr:
        describe = _describe_exr
    else:
        describe = _describe_photo
    return {"file": str(path), **describe(path)}


def _describe_photo(path: str | Path) -> dict[str, Any]:
    header = decode.read_header(path, samples="any")
    height, width = header.shape[:2]
    channels = header.shape[2] if len(header.shape) == 3 else 1
    description = {
        "format": header.kind,
        **_size(height, width, channels, np.dtype(header.dtype).name),
        "orientation": header.orientation,
    }
    if header.processing:
        description["processing"] = header.processing
    if header.comments:
        description["comments"] = header.comments
    exposure = header.exposure._asdict()
    stated = {name: value for name, value in exposure.items() if value is not None}
    return description | (stated or {"exposure": "the file states none"})


def _describe_rgbe(path: str | Path) -> dict[str, Any]:
    header = rgbe.read_header(path)
    return {
        "format": "Radiance RGBE",
        **_size(header.height, header.width, 3, "8-bit mantissas, shared exponent"),
        "axes": header.axes,
        "exposure": header.exposure.tolist(),
        "header": list(header.lines),
    }


def _describe_pfm(path: str | Path) -> dict[str, Any]:
    header = pfm.read_header(path)
    return {
        "format": "PFM",
        **_size(header.height, header.width, 3 if header.colour else 1, "float32"),
        "endian": "little" if header.scale < 0 else "big",
        "scale": abs(header.scale),
    }


def _describe_exr(path: str | Path) -> dict[str, Any]:
    headers = exr.read_headers(path)
    first = headers[0]
    channels = ", ".join(first.channels)
    dtypes = ", ".join(sorted(set(exr.read_dtypes(path))))
    description = {
        "format": "OpenEXR",
        **_size(first.display.height, first.display.width, channels, dtypes),
        "compression": first.attributes["compression"].name.removesuffix("_COMPRESSION"),
    }
    if first.data != first.display:
        description["data window"] = astuple(first.data)
    if len(headers) > 1:
        names = tuple(header.attributes.get("name", "") for header in headers)
        description["layers"] = ", ".join(names)
        if names == layers.UNCERTAINTY_LAYERS:
            E, s = layers.read_layers(path).values()
            description["certainty"] = wording.certainty(E, s)
    if "comments" in first.attributes:
        description["comments"] = first.attributes["comments"]
    return description


def _size(height: int, width: int, channels: int | str, values: str) -> dict[str, Any]:
    return {"width": width, "height": height, "channels": channels, "values": values}
