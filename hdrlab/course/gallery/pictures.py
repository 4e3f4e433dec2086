"""Decode the students' images, and encode them again in two sizes.

Everything else that a file holds is lost: scripts, a second format behind the first, the location.
The header's size is checked before anything of that size is allocated.
"""

from dataclasses import dataclass
from pathlib import Path

from hdrlab.core.arrays import to_256
from hdrlab.errors import InputError
from hdrlab.io import decode, photos, web
from hdrlab.io.files import write
from hdrlab.show.plots.figures import fit

# name of a size -> pixels of the longer side, at most
MAX_SIDE_PIXELS = {"small": 720, "large": 2400}
MAX_FILE_BYTES = 80_000_000
MAX_PIXELS = 64_000_000
ACCEPTED_FORMATS = ("JPEG", "PNG", "TIFF")
WEBP_QUALITY = 88
FILE_MODE = 0o644


@dataclass(frozen=True)
class Prepared:
    """An image as WebP files.

    Attributes
    ----------
    files : the encoded image in each size
    width, height : pixels of the large one
    """

    files: dict[str, bytes]
    width: int
    height: int


def prepare(path: str | Path) -> Prepared:
    """Read an artifact, and encode it in the sizes of the gallery.

    Raises
    ------
    InputError
        For a file that is no JPEG, PNG or TIFF image, is damaged, or is too large.
    """
    path = Path(path)
    if not path.is_file() or path.is_symlink():
        raise InputError(f"{path.name}: expected an image, this is no plain file")
    size = path.stat().st_size
    if size > MAX_FILE_BYTES:
        raise InputError(f"{path.name}: expected at most {MAX_FILE_BYTES} bytes, got {size}")
    header = decode.read_header(path)
    if header.kind not in ACCEPTED_FORMATS:
        raise InputError(f"{path.name}: expected a JPEG, PNG or TIFF image, got {header.kind}")
    if header.shape[0] * header.shape[1] > MAX_PIXELS:
        raise InputError(
            f"{path.name}: expected at most {MAX_PIXELS} pixels, the header has {header.shape}"
        )
    image = to_256(photos.read_photo(path))
    resized = {name: fit(image, side) for name, side in MAX_SIDE_PIXELS.items()}
    height, width = resized["large"].shape[:2]
    files = {
        name: web.encode_webp(pixels, quality=WEBP_QUALITY) for name, pixels in resized.items()
    }
    return Prepared(files=files, width=width, height=height)


def keep(folder: Path, id: str, prepared: Prepared) -> None:
    """Write the files of an artifact into the gallery's folder of pictures."""
    paths = [place(folder, id, size) for size in prepared.files]
    new = [path for path in paths if not path.exists()]
    try:
        for size, data in prepared.files.items():
            write(place(folder, id, size), data).chmod(FILE_MODE)
    except BaseException:  # Ctrl-C as well
        for path in new:
            path.unlink(missing_ok=True)
        raise


def place(folder: Path, id: str, size: str) -> Path:
    """Return the path of an artifact's file in one size."""
    return folder / f"{id}-{size}.webp"
