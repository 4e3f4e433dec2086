"""What a file is, as its header says: for `hdrlab info`."""

from dataclasses import astuple
from pathlib import Path
from typing import Any

import numpy as np

from hdrlab.io import decode, radiance
from hdrlab.io.maps import exr, layers, pfm, rgbe
from hdrlab.show.pages import wording


def describe_file(path: str | Path) -> dict[str, Any]:
    """Return what the header of a photograph or of a radiance file says, in the order to print it.

    Parameters
    ----------
    path : a file that `read_photo` or `read_radiance` reads

    Returns
    -------
    dict of `file`, `format`, `width`, `height`, `channels`, `values`, and what else the format
    states

    Raises
    ------
    ValueError
        For a file that is neither, or whose header is damaged.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "light.pfm"
    >>> pfm.write(file, [[0.25, 1e6]])
    >>> describe_file(file)["width"]
    2
    """
    form = radiance.READ.get(Path(path).suffix.lower(), radiance)
    about = {rgbe: _rgbe, pfm: _pfm, exr: _exr}.get(form, _photo)
    return {"file": str(path), **about(path)}


def _photo(path: str | Path) -> dict[str, Any]:
    header = decode.read_header(path, samples="any")
    height, width, channels = (*header.shape, 1)[:3]
    return {
        "format": header.kind,
        **_size(height, width, channels, np.dtype(header.dtype).name),
        "orientation": header.orientation,
        **{key: value for key in ("processing", "comments") if (value := getattr(header, key))},
        **{key: value for key, value in header.exposure._asdict().items() if value is not None},
    }


def _rgbe(path: str | Path) -> dict[str, Any]:
    header = rgbe.read_header(path)
    return {
        "format": "Radiance RGBE",
        **_size(header.height, header.width, 3, "8-bit mantissas, shared exponent"),
        "axes": header.axes,
        "exposure": header.exposure.tolist(),
        "header": list(header.lines),
    }


def _pfm(path: str | Path) -> dict[str, Any]:
    header = pfm.read_header(path)
    return {
        "format": "PFM",
        **_size(header.height, header.width, 3 if header.colour else 1, "float32"),
        "endian": "little" if header.scale < 0 else "big",
        "scale": abs(header.scale),
    }


def _exr(path: str | Path) -> dict[str, Any]:
    header, *more = exr.read_headers(path)
    names = [one.attributes.get("name", "") for one in (header, *more)] if more else []
    found = layers.read_layers(path) if names == list(layers.UNCERTAINTY_LAYERS) else None
    return {
        "format": "OpenEXR",
        **_size(
            header.display.height,
            header.display.width,
            ", ".join(header.channels),
            ", ".join(sorted({*exr.read_dtypes(path)})),
        ),
        "compression": header.attributes["compression"].name.removesuffix("_COMPRESSION"),
        **({"data window": astuple(header.data)} if header.data != header.display else {}),
        **({"layers": ", ".join(names)} if names else {}),
        **({"certainty": wording.certainty(*found.values())} if found else {}),
        **({"comments": header.attributes["comments"]} if "comments" in header.attributes else {}),
    }


def _size(height: int, width: int, channels: int | str, values: str) -> dict[str, Any]:
    return {"width": width, "height": height, "channels": channels, "values": values}
