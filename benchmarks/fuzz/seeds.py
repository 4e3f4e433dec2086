"""Small good files of each kind, by the project's own writers: what is mutated is read at first."""

import contextlib
import io
import shutil
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import tifffile
from numpy.typing import NDArray
from PIL import Image

from hdrlab.core.optional import OpenEXR, imagecodecs
from hdrlab.io import photos, radiance, response_files, sequence, web
from hdrlab.io.maps import rgbe, ultrahdr

RGB = np.random.default_rng(0).integers(0, 256, (12, 17, 3), np.uint8)
RGB[:, 5:12] = 90
E = (RGB / 255).astype(np.float32)
G = 2.2 * np.log(np.maximum(np.arange(256), 1) / 128)
# the metadata of a small sensor: its colour filter, black, white, matrix and white balance
SENSOR = [
    (33421, "H", 2, (2, 2), True),
    (33422, "B", 4, (0, 1, 1, 2), True),
    (33434, "2I", 1, (1, 60), True),
    (50706, "B", 4, (1, 4, 0, 0), True),
    (50708, "s", 0, "Synthetic", True),
    (50714, "H", 1, 64, True),
    (50717, "H", 1, 4095, True),
    (50721, "2i", 9, (1, 1, 0, 1, 0, 1, 0, 1, 1, 1, 0, 1, 0, 1, 0, 1, 1, 1), True),
    (50728, "2I", 3, (1, 2, 1, 1, 2, 3), True),
    (50778, "H", 1, 21, True),
]


@contextmanager
def removed(folder: Path) -> Iterator[Path]:
    """Yield a folder's name, and remove what is there at the end."""
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def maps(folder: Path) -> None:
    """Write radiance maps of each format, coded and plain, gray and in colour."""
    for suffix in radiance.SUFFIXES:
        radiance.write_radiance(folder / f"colour{suffix}", E)
        radiance.write_radiance(folder / f"gray{suffix}", E[..., 1])
    plain = (
        b"#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 12 +X 17\n"
        + rgbe.to_pixels(E).tobytes()
    )
    (folder / "plain.hdr").write_bytes(plain)
    tifffile.imwrite(
        folder / "tiled.tif", E.astype(">f8"), photometric="rgb", tile=(16, 16), byteorder=">"
    )
    tifffile.imwrite(
        folder / "deflated.tif", E.astype(np.float16), photometric="rgb", compression="deflate"
    )
    if OpenEXR:
        for kind in ("NO", "RLE", "PIZ", "PXR24", "B44", "DWAA"):
            header = {
                "type": OpenEXR.scanlineimage,
                "compression": getattr(OpenEXR, f"{kind}_COMPRESSION"),
            }
            with OpenEXR.File(
                header, {"RGBA": np.dstack([E, E[..., 0]]).astype(np.float16)}
            ) as file:
                file.write(str(folder / f"{kind}.exr"))


def gains(folder: Path) -> None:
    """Write Ultra HDR pictures, one of which says in XMP alone what its gains mean."""
    for name, light in (("a", E), ("b", E**3)):
        ultrahdr.write_picture(folder / f"{name}.jpg", RGB, light)
    data = (folder / "b.jpg").read_bytes()
    (folder / "b.jpg").write_bytes(data.replace(ultrahdr.ISO, ultrahdr.ISO.swapcase()))


def telephones(folder: Path) -> None:
    """Write photographs as telephones do: other formats, colour profiles, a film behind."""
    image = Image.fromarray(RGB)
    how: dict[str, Any] = {"exif": _exif(), "icc_profile": imagecodecs.cms_profile("adobergb")}
    for suffix in (".webp", ".avif"):
        image.save(folder / f"small{suffix}", **how)
        image.convert("RGBA").save(folder / f"alpha{suffix}")
    if find_spec("pillow_heif"):
        import pillow_heif

        pillow_heif.from_pillow(image).save(folder / "small.heic", exif=_exif().tobytes())
    ten_bits: dict[str, Any] = {"bitspersample": 10, "primaries": 1, "transfer": 13, "matrix": 0}
    deep = RGB.astype(np.uint16) * 4
    (folder / "deep.avif").write_bytes(imagecodecs.avif_encode(deep, pixelformat="444", **ten_bits))
    image.save(folder / "moving.jpg", **how)
    with open(folder / "moving.jpg", "ab") as file:
        file.write(bytes(4) + b"ftypmp42" + np.random.default_rng(1).bytes(600))


def jpegxl(folder: Path) -> None:
    """Write JPEG XL of each kind of sample, bare and in boxes, by libjxl."""
    for name, pixels in (
        ("light", E),
        ("half", E[..., 1].astype(np.float16)),
        ("deep", RGB * np.uint16(257)),
    ):
        (folder / f"{name}.jxl").write_bytes(imagecodecs.jpegxl_encode(pixels, lossless=True))
    (folder / "lossy.jxl").write_bytes(imagecodecs.jpegxl_encode(RGB, distance=2.0))
    (folder / "gray.jxl").write_bytes(imagecodecs.jpegxl_encode(RGB[..., 1], usecontainer=True))
    file = io.BytesIO()
    Image.fromarray(RGB).save(file, "JPEG", exif=_exif())
    (folder / "was.jxl").write_bytes(imagecodecs.jpegxl_encode_jpeg(file.getvalue()))
    packed = b"Exif" + imagecodecs.brotli_encode(bytes(4) + _exif().tobytes()[6:])
    boxes = [(b"JXL ", b"\r\n\x87\n"), (b"ftyp", b"jxl \0\0\0\0jxl "), (b"brob", packed)]
    boxes += [(b"jxlc", imagecodecs.jpegxl_encode(RGB))]
    data = b"".join(
        struct.pack(">I4s", 8 + len(content), name) + content for name, content in boxes
    )
    (folder / "packed.jxl").write_bytes(data)


def _exif() -> Image.Exif:
    tags = Image.Exif()
    tags[0x0112] = 6
    tags[0x010F] = "Maker"
    tags.get_ifd(0x8769).update({33434: 0.5, 33437: 8.0, 34855: 100, 0xA431: "7"})
    tags.get_ifd(0x8825).update({1: "N", 2: (1.0, 2.0, 3.0)})
    return tags


def photographs(folder: Path) -> None:
    """Write photographs of 8 and 16 bits, with and without EXIF."""
    image = Image.fromarray(RGB)
    for suffix in photos.PICTURES:
        photos.write_picture(folder / f"plain{suffix}", RGB)
        image.save(folder / f"exif{suffix}", exif=_exif())
    image.save(folder / "progressive.jpg", progressive=True, optimize=True)
    image.convert("L").save(folder / "gray.jpg")
    image.convert("L").save(folder / "gray.png")
    tifffile.imwrite(
        folder / "deep.tif", RGB.astype(np.uint16) * 257, photometric="rgb", compression="lzw"
    )
    tifffile.imwrite(folder / "tiled.tif", RGB, photometric="rgb", tile=(16, 16), byteorder=">")


def raw(folder: Path) -> None:
    """Write a small DNG."""
    write_dng(folder / "a.dng", np.linspace(64, 4095, 32 * 32).reshape(32, 32).astype(np.uint16))


def write_dng(path: Path, sensor: NDArray[np.uint16]) -> None:
    """Write values of a sensor (H, W) as an uncompressed DNG."""
    tifffile.imwrite(path, sensor, photometric=32803, extratags=SENSOR, metadata=None)


def films(folder: Path) -> None:
    """Write a film where there is a codec."""
    frames = [np.roll(np.tile(RGB, (2, 2, 1)), k, axis=1) for k in range(3)]
    with contextlib.suppress(ValueError, ImportError):
        sequence.write(folder / "film.mp4", iter(frames))


def pages(folder: Path) -> None:
    """Write pictures as they are in pages."""
    for lossless in (False, True):
        (folder / f"{lossless}.webp").write_bytes(web.encode_webp(RGB, lossless=lossless))


def settings(folder: Path) -> None:
    """Write EXIF alone."""
    (folder / "a.exif").write_bytes(_exif().tobytes().removeprefix(b"Exif\0\0"))


def times(folder: Path) -> None:
    """Write lists of times in their forms."""
    forms = {
        "plain": 'a.jpg 1/60 s\nb c.jpg 0,5\nd.jpg 2"\n',
        "headed": "file,exposure_time_s,f_number,iso\na.jpg,0.5,8,100\nb.jpg,1/30,8,200\n",
        "debevec": "# Number of Images\na.ppm 1 0.03125 8 0 0\nb.ppm 1 0.0625 8 0 0\n",
        "rates": "image;1/shutter_speed\na.png;60\nb.png;30\n",
    }
    for name, text in forms.items():
        (folder / f"{name}.txt").write_text(text, encoding="utf8")


def curves(folder: Path) -> None:
    """Write a response in each format."""
    for suffix in response_files.FORMS:
        response_files.write_curve(folder / f"gray{suffix}", G)
        response_files.write_curve(
            folder / f"colour{suffix}", np.stack([G, G + 0.1, 0.9 * G], axis=-1)
        )
