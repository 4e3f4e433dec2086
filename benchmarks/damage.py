"""What does hdrlab do with a damaged file: does it refuse it, or read wrong pixels without a word?

    python -m benchmarks damage

Each format that hdrlab reads gets the same DAMAGES, as disks, cards and downloads make them.

refused       the file is an error that names it
same pixels   the damage did no harm: the pixels are those of the sound file
wrong pixels  the file was read with other pixels, and nobody said so

Formats with checksums or with strict codes have no wrong pixels. JPEG has no checksum: a flipped bit
may give another valid code. WebP, AVIF, HEIC and uncompressed pixels have nothing but their length.
"""

import io
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import tifffile
from numpy.typing import NDArray
from PIL import Image

from benchmarks.experiments import Experiment, Found, Skipped, at_most
from benchmarks.fuzz import seeds
from hdrlab.core.optional import OpenEXR, imagecodecs
from hdrlab.errors import HdrlabError
from hdrlab.io import photos, radiance

HEIGHT_PIXELS = 192
WIDTH_PIXELS = 256
SECTOR_BYTES = 512
BLOCK_BYTES = 4096
REFUSED = "refused"
SAME = "same pixels"
WRONG = "wrong pixels"
# Damages that no decoder can find in a format without checksums, among the DAMAGES.
FLIPPED_BITS = 2
DAMAGES_THAT_KEEP_THE_LENGTH = 8
# The later scans of a progressive JPEG, where any bits are valid.
DAMAGES_OF_REFINING_SCANS = 3

Pixels = NDArray[np.generic]
Damage = Callable[[bytes], bytes]


def _scene() -> NDArray[np.uint8]:
    rows, columns = np.mgrid[:HEIGHT_PIXELS, :WIDTH_PIXELS]
    noise = np.random.default_rng(4).normal(0, 12, rows.shape)
    red = 128 + 90 * np.sin(rows / 17 + columns / 29) + noise
    green = 128 + 80 * np.cos(rows / 23) + noise
    return np.dstack([red, green, columns / 2 + 60]).clip(0, 255).astype(np.uint8)


RGB = _scene()
LIGHT = (RGB / 255).astype(np.float32)


def _zeros(share: float, size: int = SECTOR_BYTES) -> Damage:
    def damage(data: bytes) -> bytes:
        place = int(share * len(data))
        return (data[:place] + bytes(size) + data[place + size :])[: len(data)]

    return damage


def _cut(share: float) -> Damage:
    return lambda data: data[: int(share * len(data))]


def _cut_and_close(share: float) -> Damage:
    """Cut the file, and append the last bytes of the sound one, as recovery programs do."""
    return lambda data: data[: int(share * len(data))] + _end_marker(data)


def _end_marker(data: bytes) -> bytes:
    if data.startswith(b"\x89PNG"):
        return data[-12:]
    return data[-2:]


def _missing(share: float, size: int) -> Damage:
    def damage(data: bytes) -> bytes:
        place = int(share * len(data))
        return data[:place] + data[place + size :]

    return damage


def _flipped(share: float) -> Damage:
    def damage(data: bytes) -> bytes:
        place = int(share * len(data))
        return data[:place] + bytes([data[place] ^ 0x10]) + data[place + 1 :]

    return damage


def _repeated(data: bytes) -> bytes:
    place = len(data) // 2
    return data[:place] + data[place - SECTOR_BYTES : place] + data[place:]


DAMAGES: dict[str, Damage] = {
    "cut at 10 %": _cut(0.1),
    "cut at 60 %": _cut(0.6),
    "cut at 95 %": _cut(0.95),
    "last byte missing": lambda data: data[:-1],
    "cut at 10 % and closed": _cut_and_close(0.1),
    "cut at 60 % and closed": _cut_and_close(0.6),
    "cut at 95 % and closed": _cut_and_close(0.95),
    "sector of zeros at the beginning": _zeros(0.0),
    "sector of zeros at 30 %": _zeros(0.3),
    "sector of zeros at 60 %": _zeros(0.6),
    "sector of zeros at 90 %": _zeros(0.9),
    "block of zeros at 50 %": _zeros(0.5, BLOCK_BYTES),
    "second half zeros": lambda data: data[: len(data) // 2] + bytes(len(data) - len(data) // 2),
    "sector missing at 40 %": _missing(0.4, SECTOR_BYTES),
    "block missing at 60 %": _missing(0.6, BLOCK_BYTES),
    "byte missing at 50 %": _missing(0.5, 1),
    "sector repeated at 50 %": _repeated,
    "bit flipped at 30 %": _flipped(0.3),
    "bit flipped at 70 %": _flipped(0.7),
    "sector of zeros after the end": lambda data: data + bytes(SECTOR_BYTES),
}


def _by_pillow(form: str, **options: object) -> bytes:
    file = io.BytesIO()
    Image.fromarray(RGB).save(file, form, **options)
    return file.getvalue()


def _tiff(compression: str | None) -> bytes:
    file = io.BytesIO()
    tifffile.imwrite(file, RGB, photometric="rgb", compression=compression, rowsperstrip=16)
    return file.getvalue()


def _dng(folder: Path) -> bytes:
    if find_spec("rawpy") is None:
        raise Skipped("rawpy is not installed")
    path = folder / "sound.dng"
    seeds.write_dng(path, 64 + 15 * RGB[..., 1].astype(np.uint16))
    return path.read_bytes()


def _heic() -> bytes:
    if find_spec("pillow_heif") is None:
        raise Skipped("pillow_heif is not installed")
    import pillow_heif

    file = io.BytesIO()
    pillow_heif.from_pillow(Image.fromarray(RGB)).save(file)
    return file.getvalue()


def _map(suffix: str, folder: Path) -> bytes:
    path = folder / f"sound{suffix}"
    radiance.write_radiance(path, LIGHT)
    return path.read_bytes()


def _exr(compression: str, folder: Path) -> bytes:
    path = folder / "sound.exr"
    header = {
        "type": OpenEXR.scanlineimage,
        "compression": getattr(OpenEXR, f"{compression}_COMPRESSION"),
    }
    with OpenEXR.File(header, {"RGB": LIGHT}) as file:
        file.write(str(path))
    return path.read_bytes()


@dataclass(frozen=True)
class Format:
    """A format, and how many of the DAMAGES cannot be found in it.

    Attributes
    ----------
    suffix
        The suffix of its files.
    make
        Returns a sound file; it may write into the folder that it is given.
    is_map
        Whether it holds a radiance map.
    max_wrong
        So many damages may give wrong pixels, because the format has no checksum.
    """

    suffix: str
    make: Callable[[Path], bytes]
    is_map: bool = False
    max_wrong: int = 0

    def read(self, path: Path) -> Pixels:
        """Return the pixels of a file."""
        return radiance.read_radiance(path) if self.is_map else photos.read_photo(path)


FORMATS: dict[str, Format] = {
    "jpeg": Format(".jpg", lambda _: _by_pillow("JPEG", quality=92), max_wrong=FLIPPED_BITS),
    "jpeg-progressive": Format(
        ".jpg",
        lambda _: _by_pillow("JPEG", quality=92, progressive=True),
        max_wrong=FLIPPED_BITS + DAMAGES_OF_REFINING_SCANS,
    ),
    "jpeg-restart": Format(
        ".jpg",
        lambda _: _by_pillow("JPEG", quality=92, restart_marker_rows=1),
        max_wrong=FLIPPED_BITS,
    ),
    "png": Format(".png", lambda _: _by_pillow("PNG")),
    "tiff-plain": Format(".tif", lambda _: _tiff(None), max_wrong=DAMAGES_THAT_KEEP_THE_LENGTH),
    "tiff-deflate": Format(".tif", lambda _: _tiff("deflate")),
    "tiff-lzw": Format(".tif", lambda _: _tiff("lzw"), max_wrong=FLIPPED_BITS),
    "webp": Format(
        ".webp", lambda _: _by_pillow("WEBP", quality=90), max_wrong=DAMAGES_THAT_KEEP_THE_LENGTH
    ),
    "webp-lossless": Format(
        ".webp", lambda _: _by_pillow("WEBP", lossless=True), max_wrong=DAMAGES_THAT_KEEP_THE_LENGTH
    ),
    "avif": Format(
        ".avif", lambda _: _by_pillow("AVIF", quality=90), max_wrong=DAMAGES_THAT_KEEP_THE_LENGTH
    ),
    "heic": Format(".heic", lambda _: _heic(), max_wrong=DAMAGES_THAT_KEEP_THE_LENGTH),
    "jxl": Format(".jxl", lambda _: imagecodecs.jpegxl_encode(RGB, distance=1.0)),
    "jxl-lossless": Format(".jxl", lambda _: imagecodecs.jpegxl_encode(RGB, lossless=True)),
    "dng-plain": Format(".dng", _dng, max_wrong=DAMAGES_THAT_KEEP_THE_LENGTH),
    "hdr": Format(".hdr", lambda folder: _map(".hdr", folder), is_map=True, max_wrong=FLIPPED_BITS),
    "pfm": Format(
        ".pfm",
        lambda folder: _map(".pfm", folder),
        is_map=True,
        max_wrong=DAMAGES_THAT_KEEP_THE_LENGTH,
    ),
    "exr-zip": Format(".exr", lambda folder: _exr("ZIP", folder), is_map=True),
    "exr-piz": Format(
        ".exr", lambda folder: _exr("PIZ", folder), is_map=True, max_wrong=FLIPPED_BITS
    ),
    "exr-plain": Format(
        ".exr",
        lambda folder: _exr("NO", folder),
        is_map=True,
        max_wrong=DAMAGES_THAT_KEEP_THE_LENGTH,
    ),
}


def judge(name: str, folder: Path) -> Mapping[str, str]:
    """Return the verdict on each damage of a format: REFUSED, SAME or WRONG."""
    form = FORMATS[name]
    data = form.make(folder)
    sound = folder / f"sound{form.suffix}"
    sound.write_bytes(data)
    expected = form.read(sound)
    damaged = folder / f"damaged{form.suffix}"
    verdicts = {}
    for damage, apply in DAMAGES.items():
        damaged.write_bytes(apply(data))
        try:
            is_same = np.array_equal(form.read(damaged), expected)
            verdicts[damage] = SAME if is_same else WRONG
        except HdrlabError as error:
            if damaged.name not in str(error):
                raise
            verdicts[damage] = REFUSED
    return verdicts


def row(name: str) -> Experiment:
    """Return the row of a format."""

    def run(folder: Path) -> Found:
        counts = Counter(judge(name, folder).values())
        return {verdict: (float(counts[verdict]),) for verdict in (REFUSED, SAME, WRONG)}

    title = f"{len(DAMAGES)} damages of a file"
    return Experiment(name, title, run, (at_most(WRONG, FORMATS[name].max_wrong),))


ROWS = tuple(row(name) for name in FORMATS)
