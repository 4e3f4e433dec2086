"""What does hdrlab do with a damaged file: does it refuse it, or read wrong pixels without a word?

    python -m benchmarks damage

Each format that hdrlab reads gets the same DAMAGES, as disks, cards and downloads make them.

refused       the file is an error that names it
same pixels   the damage did no harm: the pixels are those of the sound file
wrong pixels  the file was read with other pixels, and nobody said so

Formats with checksums or with strict codes have no wrong pixels. JPEG has no checksum: a flipped bit
may give another valid code. WebP, AVIF, HEIC and uncompressed pixels have nothing but their length.

The rows `bands-...` have brackets of which one photo has a damaged band of rows, as such formats are
read: in every photo of four scenes once, from a tripod and from a hand that moves by up to so many
pixels each way. Sound brackets of the same scenes are the control.

found         hdrlab names the damaged photo and no other one
missed        it names none
wrong photo   it names a sound photo
"""

import io
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import tifffile
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from benchmarks.experiments import Experiment, Found, Skipped, at_most
from benchmarks.fuzz import seeds
from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.core.optional import OpenEXR, imagecodecs
from hdrlab.errors import HdrlabError
from hdrlab.io import photos, radiance
from hdrlab.io.damaged_bands import find_damaged_bands

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


BAND_SHAPE = (288, 432)
BAND_SCENES = (*scenes.PLACES, "room")
BAND_PHOTOS = 4
BAND_STOPS = 1.5
DAMAGED_ROWS = slice(120, 180)
GRAY_LEVEL = 128
SHIFT_COLUMNS = 37
HAND_PIXELS = (0, 2, 5)
# Sound brackets of each scene.
SOUND_COUNT = 6
Photo = NDArray[np.uint8]


def make_rows_gray(photo: Photo) -> None:
    """Make the damaged rows gray, as decoders fill what is missing."""
    photo[DAMAGED_ROWS] = GRAY_LEVEL


def shift_rows(photo: Photo) -> None:
    """Shift the damaged rows to the side, as missing bytes do."""
    photo[DAMAGED_ROWS] = np.roll(photo[DAMAGED_ROWS], SHIFT_COLUMNS, axis=1)


def overwrite_rows(photo: Photo) -> None:
    """Fill the damaged rows with bytes from elsewhere."""
    rows = photo[DAMAGED_ROWS]
    rows[:] = np.random.default_rng(2).integers(0, 256, rows.shape)


BAND_DAMAGES: dict[str, Callable[[Photo], None]] = {
    "gray": make_rows_gray,
    "shifted": shift_rows,
    "overwritten": overwrite_rows,
}


def shoot_photos(scene: str, hand_pixels: int, draw: int) -> NDArray[np.uint8]:
    """Return the photos (P, H, W, 3) of a sound bracket."""
    rng = np.random.default_rng((BAND_SCENES.index(scene), hand_pixels, draw))
    E = getattr(scenes, scene)(BAND_SHAPE)
    times = camera.times_around(E, BAND_PHOTOS, stops=BAND_STOPS)
    offsets = camera.shake(BAND_PHOTOS, radius=hand_pixels, rng=rng) if hand_pixels else None
    return camera.shoot(E, times, offsets=offsets, rng=rng).images


def judge_bands(_: Path, *, hand_pixels: int) -> dict[str, ArrayLike]:
    """Return how many damaged bands are found, missed, or blamed on a sound photo."""
    counts = {damage: Counter[str]() for damage in BAND_DAMAGES}
    false_alarms = 0
    for scene in BAND_SCENES:
        sound = [shoot_photos(scene, hand_pixels, draw) for draw in range(SOUND_COUNT)]
        false_alarms += sum(bool(find_damaged_bands(images)) for images in sound)
        for frame in range(BAND_PHOTOS):
            for damage, apply in BAND_DAMAGES.items():
                images = sound[0].copy()
                apply(images[frame])
                named = {band.frame for band in find_damaged_bands(images)}
                if not named:
                    counts[damage]["missed"] += 1
                elif named == {frame}:
                    counts[damage]["found"] += 1
                else:
                    counts[damage]["wrong photo"] += 1
    bands: dict[str, ArrayLike] = {
        f"{damage}: found, missed, wrong photo": [
            count["found"], count["missed"], count["wrong photo"],
        ]
        for damage, count in counts.items()
    }  # fmt: skip
    return bands | {FALSE_ALARMS: false_alarms}


FALSE_ALARMS = f"sound brackets of {SOUND_COUNT * len(BAND_SCENES)} with a false alarm"
BAND_ROWS = tuple(
    Experiment(
        "bands-tripod" if pixels == 0 else f"bands-hand-{pixels}",
        f"a damaged band in one of {BAND_PHOTOS} photos, {BAND_PHOTOS * len(BAND_SCENES)} bands of a kind",
        partial(judge_bands, hand_pixels=pixels),
        (at_most(FALSE_ALARMS, 0),),
    )
    for pixels in HAND_PIXELS
)
ROWS = (*(row(name) for name in FORMATS), *BAND_ROWS)
