"""Pictures of students, made anew: decoded to pixels, brought to two sizes, and encoded again.

So whatever else a file holds (scripts, another format behind the first, where it was taken) stays
behind. Its header is judged before anything of the size that it claims is allocated.
"""

from pathlib import Path
from typing import NamedTuple

from hdrlab.core.arrays import to_256
from hdrlab.errors import InputError
from hdrlab.io import decode, photos, web
from hdrlab.io.files import write
from hdrlab.show.plots.figures import fit

SIZES = {"small": 720, "large": 2400}  # pixels along a side, at most
MOST_BYTES = 80_000_000
MOST_PIXELS = 64_000_000


class Prepared(NamedTuple):
    """A picture as WebP, by size, and the pixels (width, height) of the large one."""

    files: dict[str, bytes]
    width: int
    height: int


def prepare(path: str | Path) -> Prepared:
    """Read an artifact and make its pictures.

    Raises
    ------
    ValueError
        For what is no JPEG, PNG or TIFF picture, is damaged, or is too large.
    """
    path = Path(path)
    if not path.is_file() or path.is_symlink():
        raise InputError(f"{path.name}: expected a picture, this is no plain file")
    if (size := path.stat().st_size) > MOST_BYTES:
        raise InputError(f"{path.name}: expected at most {MOST_BYTES} bytes, got {size}")
    header = decode.read_header(path)
    if header.kind not in ("JPEG", "PNG", "TIFF"):
        raise InputError(f"{path.name}: expected a JPEG, PNG or TIFF picture, got {header.kind}")
    if header.shape[0] * header.shape[1] > MOST_PIXELS:
        raise InputError(
            f"{path.name}: expected at most {MOST_PIXELS} pixels, the header has {header.shape}"
        )
    image = to_256(photos.read_photo(path))
    brought = {name: fit(image, side) for name, side in SIZES.items()}
    height, width = brought["large"].shape[:2]
    return Prepared(
        {name: web.encode_webp(one, quality=88) for name, one in brought.items()}, width, height
    )


def keep(folder: Path, id: str, prepared: Prepared) -> None:
    """Write the pictures of an artifact into the gallery's folder."""
    for name, data in prepared.files.items():
        write(place(folder, id, name), data).chmod(0o644)


def place(folder: Path, id: str, size: str) -> Path:
    """Return where a picture is kept."""
    return folder / f"{id}-{size}.webp"
