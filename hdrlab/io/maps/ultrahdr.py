"""Ultra HDR: a JPEG for any screen, with a gain map from which a bright screen makes more of it.

The file is two JPEGs, one behind the other. The first is the picture that every program shows, the
second the gain map of `core.gainmap`, gray or RGB, often smaller. An index in the first says where
the second is (MPF, CIPA DC-007). What the gains mean stands in the second: in binary, as ISO
21496-1 has it, and in XMP, as telephones had it before. Apple's own gain maps are others, and are
not read.
"""

import io
import re
import struct
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from hdrlab.core import colour, gainmap
from hdrlab.core.arrays import F32, Array, ArrayLike, as_picture, as_radiance, describe
from hdrlab.errors import FileFormatError
from hdrlab.io import decode, files, web
from hdrlab.io.codecs import DECODERS, jpeg_end
from hdrlab.io.photos import PICTURES, read_photo

ISO, ADOBE, INDEX = b"urn:iso:std:iso:ts:21496:-1\0", b"http://ns.adobe.com/xap/1.0/\0", b"MPF\0"
# of XMP, in the order of ISO, and what they are where nothing is said: headrooms, then of each
# channel
NAMES = {"HDRCapacityMin": 0.0, "HDRCapacityMax": np.nan, "GainMapMin": 0.0, "GainMapMax": np.nan}
NAMES |= {"Gamma": 1.0, "OffsetSDR": 1 / 64, "OffsetHDR": 1 / 64}
# flags: three channels, gains of the picture's own primaries, and one denominator as libultrahdr
# writes it
THREE, OWN, ONE = 0x80, 0x40, 0x08
UNIT = 1 << 20  # of the fractions that are written
STOPS = 64.0  # the largest gain
FINEST = {
    "quality": 100,
    "subsampling": 0,
    "keep_rgb": True,
}  # as YCbCr gains would be rounded once more


def read(path: str | Path) -> F32:
    """Read what the brightest screen shows of an Ultra HDR picture: radiance, in units of white.

    Parameters
    ----------
    path : the file

    Returns
    -------
    (H, W, 3) or (H, W) float32, upright, with the primaries of sRGB

    Raises
    ------
    ValueError
        For a file that is no JPEG, is damaged, or has no gain map.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "lamp.jpg"
    >>> write_picture(file, np.full((8, 8), 188, np.uint8), np.full((8, 8), 3.0))
    >>> read(file).round(2)[0, 0].tolist()
    [0.5, 0.5, 0.5]
    """
    sdr, header = colour.decode_srgb(read_photo(path) / np.float32(255)), decode.look(path)
    try:
        part = _find(Path(path).read_bytes())
        return np.maximum(gainmap.apply_gain(sdr, _decode(header, part), **_meaning(part)), 0)
    except Exception as error:  # on damaged files the codecs raise what they like
        raise FileFormatError(
            f"{path}: expected a JPEG with a gain map, ISO's or hdrgm ({error!s:.99})"
        ) from None


def write_picture(
    path: str | Path, picture: ArrayLike, E: ArrayLike, *, headroom: float = 8.0
) -> None:
    """Write a picture as JPEG with the gains that lead from it to the scene, whole or not at all.

    Parameters
    ----------
    path : a .jpg or .jpeg file; what it held is replaced
    picture : (H, W) or (H, W, 3) uint8, by any operator: what is shown where gains are not known;
        gray becomes RGB, for other decoders refuse gray
    E : same shape, the radiance of which the picture was made
    headroom : the brightest light that is kept, over white; a screen that has less shows a part of
        the gains

    Raises
    ------
    ValueError
        For another suffix, shapes that do not fit together, or a headroom that is not above 1.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "wall.jpg"
    >>> write_picture(file, np.full((4, 6), 128, np.uint8), np.ones((4, 6)))
    >>> read_photo(file).shape
    (4, 6, 3)
    """
    how = PICTURES[files.require_suffix(path, (".jpg", ".jpeg"), "an Ultra HDR picture")]
    picture, E = web.as_rgb(as_picture(picture)), web.as_rgb(as_radiance(E))
    if picture.shape != E.shape or not 1 < headroom <= 2**16:
        got = f"{describe(picture)}, {describe(E)} and {headroom}"
        raise FileFormatError(
            f"expected picture and radiance of one shape, headroom of 1 to 65536; got {got}"
        )
    sdr = colour.decode_srgb(DECODERS["JPEG"](_jpeg(picture, how), None) / np.float32(255))
    hdr = gainmap.expose(E, sdr, headroom)
    low, high = gainmap.find_range(gainmap.log_gain(sdr, hdr))
    g = np.rint(255 * gainmap.gain_map(sdr, hdr, low, high)).astype(np.uint8)
    channels = np.vstack(np.broadcast_arrays(low, high, 1, *gainmap.OFFSETS))
    gains = _jpeg(g, FINEST, _tell(np.log2(headroom), channels))
    said = _segment(b"\xe1", ADOBE + _xmp("picture", length=len(gains))) + _segment(
        b"\xe2", ISO + bytes(4)
    )
    first = _jpeg(picture, how, said + _segment(b"\xe2", INDEX + _index(0, 0, 0)))
    at = first.index(INDEX) + len(INDEX)
    files.write(path, first.replace(_index(0, 0, 0), _index(len(first), len(gains), at)) + gains)


def _jpeg(image: Array, how: dict[str, Any], segments: bytes = b"") -> bytes:
    file = io.BytesIO()
    Image.fromarray(image).save(file, "JPEG", extra=segments, **how)
    return file.getvalue()


def _segment(marker: bytes, body: bytes) -> bytes:
    return b"\xff" + marker + struct.pack(">H", len(body) + 2) + body


def _xmp(what: str, **values: object) -> bytes:
    return (
        Path(__file__).with_name(f"ultrahdr_{what}.xmp").read_text("utf8").format(**values).encode()
    )


def _tell(headroom: float, channels: Array) -> bytes:
    """Return the segments that say what gains mean: headroom in stops; low, high, gamma and k, (5, 3)."""
    numbers = np.concatenate([[0, headroom], channels.T.ravel()])
    fractions = np.stack([np.rint(numbers * UNIT), np.full(len(numbers), UNIT)], axis=-1).astype(
        ">i4"
    )
    seqs = ["".join(f"<rdf:li>{one:.6f}</rdf:li>" for one in row) for row in channels]
    text = _xmp("gains", headroom=f"{headroom:.6f}", **dict(zip([*NAMES][2:], seqs, strict=True)))
    binary = struct.pack(">2HB", 0, 0, OWN | THREE) + fractions.tobytes()
    return _segment(b"\xe1", ADOBE + text) + _segment(b"\xe2", ISO + binary)


def _index(first: int, second: int, at: int) -> bytes:
    """Return the index of two JPEGs of so many bytes; it counts from its own place [CIPA DC-007 5.2]."""
    tags = (0xB000, 7, 4, b"0100", 0xB001, 4, 1, 2, 0xB002, 7, 32, 50, 0)
    entries = struct.pack(">3L4x3L4x", 0x030000, first, 0, 0, second, first - at)
    return struct.pack(">2sHLH2HL4s2H2L2H2LL", b"MM", 42, 8, 3, *tags) + entries


def _find(data: bytes) -> bytes:
    """Return the first JPEG behind the picture that says what its gains mean."""
    at = jpeg_end(data)
    while (start := data.find(b"\xff\xd8\xff", at)) >= 0:
        at = jpeg_end(data, start)
        if ISO in data[start:at] or b"hdrgm:GainMapMax" in data[start:at]:
            return data[start:at]
    raise FileFormatError(
        "no second JPEG says what its gains mean; Apple's do not: take a bracket, or RAW"
    )


def _meaning(part: bytes) -> dict[str, Any]:
    """Return the knobs of `gainmap.apply_gain`, each for one channel or for three."""
    at = part.find(ISO)
    values = _from_xmp(part) if at < 0 else _from_binary(part[at + len(ISO) :])
    (least, most), (low, high, gamma, *k) = (
        values[:2],
        values[2:].reshape(-1, 5).T.astype(np.float32),
    )
    within = np.all(np.abs(values) <= STOPS) and np.all(low <= high) and np.all(gamma > 1 / STOPS)
    if not (within and least < most):
        raise FileFormatError(
            f"expected gains within {STOPS:.0f} stops, toward more light, got {values.tolist()}"
        )
    return {"low": low, "high": high, "gamma": gamma, "k": k}


def _from_binary(body: bytes) -> Array:
    count, shared = 17 if body[4] & THREE else 7, body[4] & ONE
    numbers = np.frombuffer(body, ">i4", count + 1 if shared else 2 * count, 5).astype(np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        return numbers[1:] / numbers[0] if shared else numbers[::2] / numbers[1::2]


def _from_xmp(part: bytes) -> Array:
    said = []
    for name, usual in NAMES.items():
        found = re.search(
            rf'hdrgm:{name}(?:="([^"]*)"|>(.*?)</hdrgm:{name}>)'.encode(), part, re.DOTALL
        )
        text = re.sub(rb"<[^>]*>", b" ", found[1] or found[2]) if found else b""
        said.append([float(one) for one in text.split()] or [usual])
    return np.concatenate([*said[:2], np.transpose(np.broadcast_arrays(*said[2:])).ravel()])


def _decode(header: decode.Header, part: bytes) -> F32:
    """Return the gain map, upright and of the picture's size and channels."""
    height, width = header.shape[:2] if header.orientation < 5 else header.shape[1::-1]
    # of what Pillow thinks odd in a gain map's own EXIF nobody is to be told
    with (
        warnings.catch_warnings(action="ignore"),
        Image.open(io.BytesIO(part), formats=("JPEG",)) as image,
    ):
        least = image.height * image.width // decode.BEST_COMPRESSION_RATIO
        files.check_size(header.path, *image.size[::-1], least, available=len(part))
        g = image.convert("L" if len(header.shape) == 2 else "RGB").resize((width, height))
    return decode.upright(np.asarray(g, np.float32) / 255, header.orientation)
