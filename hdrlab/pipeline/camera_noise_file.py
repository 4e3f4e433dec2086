"""The file of a camera's noise, which `hdrlab noise` writes and `hdrlab assemble --noise` reads.

It is JSON, and states its format and version. Each figure has a value and its 95 % interval. A
number that is unknown or infinite is null: the value of a read noise that rounding hides, and the
upper limit of a full well that no flat reached.
"""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from hdrlab.diagnostics.camera_noise import ChannelNoise, Interval, NoiseWarning
from hdrlab.errors import FileFormatError
from hdrlab.io import files
from hdrlab.pipeline.camera_noise import QUANTITIES, CameraNoise

FORMAT = "hdrlab camera noise"
VERSION = 1


def write_camera_noise(path: str | Path, noise: CameraNoise) -> Path:
    """Write the noise of a camera as JSON, whole or not at all, and return the path."""
    content = {
        "format": FORMAT,
        "version": VERSION,
        "camera": noise.camera,
        "iso": noise.iso,
        "kind": noise.kind,
        "units": QUANTITIES,
        "confidence": 0.95,
        "channels": [_as_json(channel) for channel in noise.channels],
        "warnings": [{"kind": one.kind, "text": one.text} for one in noise.warnings],
        "notes": list(noise.notes),
    }
    text = json.dumps(content, ensure_ascii=False, indent=1, allow_nan=False)
    return files.write(path, text + "\n")


def _as_json(channel: ChannelNoise) -> dict[str, Any]:
    """Return a channel as JSON holds it: unknown and infinite numbers are null."""
    table: dict[str, Any] = {"name": channel.name}
    for quantity in QUANTITIES:
        interval = getattr(channel, quantity)
        table[quantity] = dict(zip(Interval._fields, map(_or_none, interval), strict=True))
    table["full_level"] = _or_none(channel.full_level)
    table["signal"] = channel.S.tolist()
    table["variance"] = channel.V.tolist()
    table["used"] = channel.used.tolist()
    table["pixel_count"] = channel.pixel_count
    return table


def _or_none(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def read_camera_noise(path: str | Path) -> CameraNoise:
    """Read the noise of a camera from a file that `write_camera_noise` wrote.

    Raises
    ------
    FileFormatError
        For a file that is no such JSON, or of a newer version.
    """
    files.require_no_folder(path, "a file of noise")
    expected = f"{path}: expected a file that hdrlab noise wrote"
    try:
        content = json.loads(Path(path).read_text("utf8"))
        if content["format"] != FORMAT:
            raise FileFormatError(f"{expected}, got {str(content['format'])[:40]!r}")
        if content["version"] != VERSION:
            raise FileFormatError(
                f"{path}: its version is {content['version']}, and this hdrlab reads version {VERSION}; "
                "measure the noise again, or update hdrlab"
            )
        noise = CameraNoise(
            camera=str(content["camera"]),
            iso=None if content["iso"] is None else float(content["iso"]),
            kind=str(content["kind"]),
            channels=tuple(_from_json(table) for table in content["channels"]),
            warnings=tuple(NoiseWarning(**table) for table in content["warnings"]),
            notes=tuple(content["notes"]),
        )
    except FileFormatError:
        raise
    except KeyError as error:
        raise FileFormatError(f"{expected}; it lacks {error}") from None
    except (ValueError, TypeError, AttributeError) as error:
        raise FileFormatError(f"{expected}; {error}") from None
    for channel in noise.channels:
        _require_positive(path, channel)
    return noise


def _from_json(table: dict[str, Any]) -> ChannelNoise:
    """Return a channel from its JSON."""
    intervals = {}
    for quantity in QUANTITIES:
        numbers = table[quantity]
        high = numbers["high"]
        intervals[quantity] = Interval(
            math.nan if numbers["value"] is None else float(numbers["value"]),
            float(numbers["low"]),
            math.inf if high is None else float(high),
        )
    full_level = table["full_level"]
    return ChannelNoise(
        name=str(table["name"]),
        full_level=math.nan if full_level is None else float(full_level),
        S=np.array(table["signal"], np.float64),
        V=np.array(table["variance"], np.float64),
        used=np.array(table["used"], bool),
        pixel_count=int(table["pixel_count"]),
        **intervals,
    )


def _require_positive(path: str | Path, channel: ChannelNoise) -> None:
    """Raise a FileFormatError for figures that no sensor has."""
    if not 0 < channel.gain.value < math.inf or not 0 <= channel.read_noise.high < math.inf:
        raise FileFormatError(
            f"{path}: expected a positive gain and read noise of {channel.name}, got "
            f"{channel.gain.value:g} and {channel.read_noise.value:g}"
        )
