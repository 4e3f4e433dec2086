"""Which files of a folder are the photographs of one bracket.

A camera's folder holds more than the bracket: a RAW file and a JPEG of each photograph, thumbnails,
edited copies, side-car files. What does not belong to it is left out, and a sentence says so.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from hdrlab.errors import InputError
from hdrlab.io import decode, files, raw

SUFFIXES = raw.SUFFIXES | {".jpg", ".jpeg", ".jfif", ".png", ".tif", ".tiff"}
SUFFIXES |= {".webp", ".avif", ".heic", ".heif", ".hif", ".jxl"}
# what programs add to the name of a photograph: IMG_1-edited, IMG_1_thumb, IMG_1~2
EDITED = re.compile(
    r"(.+?)([-_ .]*(edit|edited|bearbeitet|hdr|thumb|thumbnail|small|preview)|~\d+)", re.I
)
# ... and Apple within it: IMG_E0001 is IMG_0001, edited
APPLE = re.compile(r"(img_)e(\d{4})", re.I)

Paths = str | Path | Sequence[str | Path]
Selection = tuple[list[Path], list[str]]  # the photographs, and sentences on what was left out


def select(paths: Paths) -> Selection:
    """Return the paths of a bracket, and notes: those given, or what belongs together of a folder.

    Of a folder files are left out whose names say that they are edited copies of another; all but
    one of those that differ by their suffix alone, as a RAW file and a JPEG do; pictures with a
    palette, of CMYK or of floats; and those of another size or kind than more than half of all, as
    thumbnails are.

    Raises
    ------
    ValueError
        For a folder among others, and where less than two are left.
    """
    given, notes = photographs(paths), list[str]()
    if isinstance(paths, str | Path) or len(paths) == 1:
        for choose in (_originals, _one_of_each, _alike):
            given, said = choose(given)
            notes += said
        if len(given) < 2:
            raise InputError(
                f"expected two photographs or more, got {'; '.join([*map(str, given), *notes])}"
            )
    return given, notes


def photographs(paths: Paths) -> list[Path]:
    """Return the paths given, or those of all photographs of a folder, sorted by name."""
    given = [Path(paths)] if isinstance(paths, str | Path) else [Path(path) for path in paths]
    if len(given) == 1 and given[0].is_dir():
        folder = given[0]
        found = sorted(path for path in folder.iterdir() if path.suffix.lower() in SUFFIXES)
        given = [path for path in found if path.is_file() and not path.name.startswith(".")]
        if not given:
            below = ", ".join(sorted(path.name for path in folder.iterdir() if path.is_dir()))
            where = f", but the folders {below}" if below else ""
            raise InputError(f"{folder}: expected a folder with photographs, it holds none{where}")
    for path in given:
        if path.is_dir():
            raise InputError(
                f"{path}: expected photographs or one folder, this is a folder among others"
            )
    if len(given) < 2:
        raise InputError(
            f"expected two photographs or more, got {', '.join(map(str, given)) or 'none'}"
        )
    return given


def _originals(paths: list[Path]) -> Selection:
    """Leave out what is an edited copy of another, by its name."""
    known = {path.stem.lower(): path.stem for path in paths}

    def origin(path: Path) -> str | None:
        edited, apple = EDITED.fullmatch(path.stem), APPLE.fullmatch(path.stem)
        return known.get(
            (edited[1] if edited else "".join(apple.groups()) if apple else "").lower()
        )

    copies = {path: name for path in paths if (name := origin(path))}
    notes = [
        f"{path.name}: left out, it is named as a copy of {name}" for path, name in copies.items()
    ]
    return [path for path in paths if path not in copies], notes


def _one_of_each(paths: list[Path]) -> Selection:
    """Take of files with one name the suffix that most photographs have, and RAW where that is a tie."""
    each = defaultdict(list)
    for path in paths:
        each[path.stem.lower()].append(path)
    count = Counter(path.suffix.lower() for path in paths)

    def rank(path: Path) -> tuple[int, bool]:
        return count[path.suffix.lower()], path.suffix.lower() in raw.SUFFIXES

    several = [max(group, key=rank) for group in each.values() if len(group) > 1]
    suffixes = ", ".join(sorted({path.suffix.lower() for path in several}))
    notes = [
        f"{len(several)} photographs are there in several formats: {suffixes} is taken"
    ] * bool(several)
    return [max(group, key=rank) for group in each.values()], notes


def _alike(paths: list[Path]) -> Selection:
    """Take those of one size and kind, where these are more than half of all."""
    kinds: dict[Path, tuple[object, ...]] = {}
    notes = []
    for path in paths:
        try:
            shape, dtype = (header := decode.read_header(path)).shape, header.dtype
            kinds[path] = (*sorted(shape[:2]), shape[2:], dtype, header.kind == "RAW")
        except files.OtherPixels as error:
            notes.append(f"{error}: left out")
    most, count = Counter(kinds.values()).most_common(1)[0] if kinds else (None, 0)
    odd = [path for path in kinds if kinds[path] != most and count > max(1, len(kinds) / 2)]
    notes += [f"{path.name}: left out, its size or kind is not that of the others" for path in odd]
    return [path for path in kinds if path not in odd], notes


def turn_alike(headers: list[decode.PhotoHeader]) -> tuple[list[decode.PhotoHeader], list[str]]:
    """Return headers turned as most of them are, and a note, where some of one size stand and some lie.

    A camera that looks straight down or up does not know which way is up, and says now this and now
    that.
    """
    stored = {
        header.shape[:2] if header.orientation < 5 else header.shape[1::-1] for header in headers
    }
    if len(stored) != 1 or len({header.shape[:2] for header in headers}) == 1:
        return headers, []
    most, _ = Counter(header.orientation for header in headers).most_common(1)[0]
    shape = next(header.shape[:2] for header in headers if header.orientation == most)
    odd = [header.path.name for header in headers if header.orientation != most]
    notes = [f"{', '.join(odd)}: turned as the other photographs are, their EXIF says otherwise"]
    return [
        replace(one, orientation=most, shape=(*shape, *one.shape[2:])) for one in headers
    ], notes
