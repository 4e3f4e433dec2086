"""Select the photos of one bracket from a folder.

The folder of a camera holds more than the bracket: a RAW file and a JPEG of each photo, thumbnails,
edited copies, side-car files. From a folder, hdrlab uses the photos that form one bracket and lists
the ones it skipped.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Hashable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from hdrlab.errors import FileFormatError, InputError
from hdrlab.io import decode, files, raw, splitting
from hdrlab.io.own_pictures import is_own_picture, is_radiance_map

SUFFIXES = raw.SUFFIXES | {
    ".jpg",
    ".jpeg",
    ".jfif",
    ".png",
    ".tif",
    ".tiff",
    ".webp",
    ".avif",
    ".heic",
    ".heif",
    ".hif",
    ".jxl",
}
MIN_PHOTOS = 2
MAX_LISTED_BRACKETS = 10
# What programs append to the name of a photo that they have edited: IMG_1-edited, IMG_1~2.
EDITED_NAME = re.compile(
    r"(.+?)([-_ .]*(edit|edited|bearbeitet|hdr|thumb|thumbnail|small|preview)|~\d+)", re.I
)
# Apple inserts an E: IMG_E0001 is IMG_0001, edited.
APPLE_EDITED_NAME = re.compile(r"(img_)e(\d{4})", re.I)

Paths = str | Path | Sequence[str | Path]
# The photos, and a sentence on each group of photos that was skipped.
KeptAndNotes = tuple[list[Path], list[str]]
# The header of each photo, or an error that says which pixels it has instead of gray or RGB.
StatedHeaders = dict[Path, decode.PhotoHeader | files.OtherPixels]


@dataclass(frozen=True)
class Selection:
    """The photos of a bracket.

    Attributes
    ----------
    headers
        What each photo states before its pixels.
    notes
        A sentence on each group of photos that was skipped.
    damaged
        The error of each photo that was left out because its header is damaged.
    details
        A sentence on each picture that was skipped because hdrlab made it.
    """

    headers: list[decode.PhotoHeader]
    notes: list[str]
    damaged: list[FileFormatError]
    details: tuple[str, ...] = ()

    @property
    def paths(self) -> list[Path]:
        """The photos."""
        return [header.path for header in self.headers]


def select(paths: Paths, *, split: bool = True) -> Selection:
    """Return the photos of one bracket, and why others were skipped.

    Photos with a damaged header are left out, if two or more others remain. Otherwise, several
    paths are used as they are. From a folder, hdrlab skips

    - pictures that hdrlab wrote, and radiance maps,
    - photos whose names say that they are edited copies of others,
    - all but one of the photos that differ by their suffix alone, as a RAW file and a JPEG do,
    - images with a palette, or of CMYK,
    - photos of another size or kind than more than half of them, as thumbnails are,
    - all brackets but the first, if the photos are several brackets, see `hdrlab.io.splitting`.

    Parameters
    ----------
    paths
        A folder, or photos.
    split
        Whether a folder may hold several brackets, of which the first is used.

    Raises
    ------
    InputError
        For a folder among other paths, and if fewer than two photos are left.
    FileFormatError
        For a damaged photo, if fewer than two others are left.
    OtherPixels
        For a photo among several paths that has other pixels than gray or RGB.
    """
    brackets, selection = select_brackets(paths)
    if not split or len(brackets) == 1:
        return selection
    notes = [*selection.notes, _describe_brackets(brackets)]
    return replace(selection, headers=brackets[0], notes=notes)


def select_brackets(paths: Paths) -> tuple[list[list[decode.PhotoHeader]], Selection]:
    """Return the photos of each bracket of a folder, and the selection of all of them.

    `select` has the parameters and errors. Several paths are one bracket.
    """
    selected, stated, damaged = _read_headers(photographs(paths))
    is_folder = isinstance(paths, str | Path) or len(paths) == 1
    if not is_folder:
        headers = [_require_header(stated[path]) for path in selected]
        return [headers], Selection(headers, [], damaged)
    selected, skipped = _skip_own_pictures(selected, stated)
    details = tuple(skipped)
    notes: list[str] = []
    for skip in (_skip_edited_copies, _skip_other_formats):
        selected, more_notes = skip(selected)
        notes += more_notes
    headers, more_notes = _skip_other_sizes({path: stated[path] for path in selected})
    notes += more_notes
    _require_two([header.path for header in headers], [*details, *notes, *map(str, damaged)])
    groups = splitting.split_into_brackets(headers)
    brackets = [
        sorted(group, key=lambda header: header.path)
        for group in groups
        if len(group) >= MIN_PHOTOS
    ]
    if not brackets or len(groups) == 1:
        return [headers], Selection(headers, notes, damaged, details)
    for group in groups:
        if len(group) < MIN_PHOTOS:
            notes.append(f"{group[0].path.name}: skipped, because it belongs to no bracket")
    used = [header for bracket in brackets for header in bracket]
    return brackets, Selection(used, notes, damaged, details)


def _describe_brackets(brackets: list[list[decode.PhotoHeader]]) -> str:
    """Return the note that lists the brackets of a folder, of which hdrlab uses the first."""
    ranges = [
        f"{bracket[0].path.name} to {bracket[-1].path.name}"
        for bracket in brackets[:MAX_LISTED_BRACKETS]
    ]
    if len(brackets) > MAX_LISTED_BRACKETS:
        ranges.append(f"{len(brackets) - MAX_LISTED_BRACKETS} more")
    listed = "; ".join(ranges)
    return (
        f"the folder holds {len(brackets)} brackets, and hdrlab uses the first: {listed}; "
        "assemble --all makes a map of each"
    )


def photographs(paths: Paths) -> list[Path]:
    """Return the given paths, or all photos of a folder, sorted by name.

    Raises
    ------
    InputError
        For a folder among other paths or without photos, and for fewer than two photos.
    """
    listed = [Path(paths)] if isinstance(paths, str | Path) else [Path(path) for path in paths]
    if len(listed) == 1 and listed[0].is_dir():
        listed = list_folder(listed[0])
    for path in listed:
        if path.is_dir():
            raise InputError(
                f"{path}: a folder among other paths; pass either photos or one folder"
            )
    _require_two(listed)
    return listed


def list_folder(folder: Path) -> list[Path]:
    """Return the photos of a folder, sorted by name."""
    found = [
        path
        for path in sorted(folder.iterdir())
        if path.suffix.lower() in SUFFIXES and path.is_file() and not path.name.startswith(".")
    ]
    if not found:
        subfolders = sorted(path.name for path in folder.iterdir() if path.is_dir())
        hint = f"; it has the folders {', '.join(subfolders)}" if subfolders else ""
        raise InputError(f"{folder}: there are no photos in this folder{hint}")
    return found


def _require_two(paths: list[Path], notes: Sequence[str] = ()) -> None:
    if len(paths) < MIN_PHOTOS:
        got = "; ".join([", ".join(map(str, paths)) or "none", *notes])
        raise InputError(f"expected two photographs or more, got {got}")


def _skip_own_pictures(paths: list[Path], stated: StatedHeaders) -> KeptAndNotes:
    """Skip pictures that hdrlab wrote, and radiance maps, whoever wrote them."""
    kept = []
    notes = []
    for path in paths:
        if is_own_picture(path):
            notes.append(f"{path.name}: skipped, because hdrlab made this picture")
        elif isinstance(stated[path], files.OtherPixels) and is_radiance_map(path):
            notes.append(f"{path.name}: skipped, because it is a radiance map, not a photo")
        else:
            kept.append(path)
    return kept, notes


def _read_headers(
    paths: list[Path],
) -> tuple[list[Path], StatedHeaders, list[FileFormatError]]:
    """Return the photos whose headers can be read, their headers, and the errors of the others."""
    kept = []
    stated: StatedHeaders = {}
    errors = []
    for path in paths:
        try:
            stated[path] = decode.read_header(path)
        except files.OtherPixels as error:  # the photo is not damaged
            stated[path] = error
        except FileFormatError as error:
            errors.append(error)
            continue
        kept.append(path)
    require_enough_sound(errors, len(kept))
    return kept, stated, errors


def _require_header(stated: decode.PhotoHeader | files.OtherPixels) -> decode.PhotoHeader:
    """Return the header of a photo, or raise the error that says which pixels it has instead."""
    if isinstance(stated, files.OtherPixels):
        raise stated
    return stated


def require_enough_sound(errors: Sequence[FileFormatError], count: int) -> None:
    """Raise a FileFormatError that names a damaged photo, if fewer than two others are left."""
    if errors and count < MIN_PHOTOS:
        raise FileFormatError(
            f"{errors[0]}; only {count} of the {count + len(errors)} photos can be read, "
            "a map needs two or more"
        )


def _skip_edited_copies(paths: list[Path]) -> KeptAndNotes:
    """Skip photos whose names say that they are edited copies of others."""
    stems = {path.stem.lower(): path.stem for path in paths}
    kept = []
    notes = []
    for path in paths:
        original = stems.get(_original_stem(path.stem).lower())
        if original is None:
            kept.append(path)
        else:
            notes.append(f"{path.name}: skipped, its name says that it is a copy of {original}")
    return kept, notes


def _original_stem(stem: str) -> str:
    """Return the name of the photo that a name says it is a copy of, or nothing."""
    edited = EDITED_NAME.fullmatch(stem)
    if edited:
        return edited[1]
    apple = APPLE_EDITED_NAME.fullmatch(stem)
    return apple[1] + apple[2] if apple else ""


def _skip_other_formats(paths: list[Path]) -> KeptAndNotes:
    """From photos that differ by suffix alone, keep the most frequent suffix, and RAW in a tie."""
    by_stem = defaultdict(list)
    for path in paths:
        by_stem[path.stem.lower()].append(path)
    frequency = Counter(path.suffix.lower() for path in paths)

    def rank(path: Path) -> tuple[int, bool]:
        suffix = path.suffix.lower()
        return frequency[suffix], suffix in raw.SUFFIXES

    kept = [max(group, key=rank) for group in by_stem.values()]
    chosen = [max(group, key=rank) for group in by_stem.values() if len(group) > 1]
    if not chosen:
        return kept, []
    suffixes = ", ".join(sorted({path.suffix.lower() for path in chosen}))
    return kept, [f"{len(chosen)} photos exist in several formats; hdrlab uses {suffixes}"]


def _skip_other_sizes(stated: StatedHeaders) -> tuple[list[decode.PhotoHeader], list[str]]:
    """Keep the photos of one size and kind, if these are more than half of them."""
    kinds: dict[Path, Hashable] = {}
    headers: list[decode.PhotoHeader] = []
    skipped: dict[str, list[Path]] = defaultdict(list)
    for path, header in stated.items():
        if isinstance(header, files.OtherPixels):
            skipped[str(header).removeprefix(f"{path}: ")].append(path)
            continue
        sides = tuple(sorted(header.shape[:2]))
        kinds[path] = (sides, header.shape[2:], header.dtype, header.kind == "RAW")
        headers.append(header)
    sentences = [f"{_name_group(group)}: {reason}" for reason, group in skipped.items()]
    if not kinds and len(sentences) == 1:
        raise files.OtherPixels(sentences[0])
    notes = [f"{sentence}: skipped" for sentence in sentences]
    if not kinds:
        return [], notes
    most_frequent, count = Counter(kinds.values()).most_common(1)[0]
    if count <= max(1, len(kinds) / 2):
        return headers, notes
    kept = []
    for header in headers:
        if kinds[header.path] == most_frequent:
            kept.append(header)
        else:
            notes.append(
                f"{header.path.name}: skipped, because its size or type differs from the other photos"
            )
    return kept, notes


def _name_group(paths: list[Path]) -> str:
    """Return the first of some paths, and how many more there are."""
    return str(paths[0]) if len(paths) == 1 else f"{paths[0]} (and {len(paths) - 1} more)"


def turn_alike(headers: list[decode.PhotoHeader]) -> tuple[list[decode.PhotoHeader], list[str]]:
    """Give all photos of one stored size the orientation that most of them state, with a note.

    A camera that looks straight down or up does not know which way is up, so that its EXIF changes
    from frame to frame.
    """
    stored_shapes = set()
    for header in headers:
        height, width = header.shape[:2]
        stored_shapes.add((height, width) if header.orientation < 5 else (width, height))
    upright_shapes = {header.shape[:2] for header in headers}
    if len(stored_shapes) != 1 or len(upright_shapes) == 1:
        return headers, []
    orientation, _ = Counter(header.orientation for header in headers).most_common(1)[0]
    shape = next(header.shape[:2] for header in headers if header.orientation == orientation)
    turned = [
        replace(header, orientation=orientation, shape=(*shape, *header.shape[2:]))
        for header in headers
    ]
    odd = [header.path.name for header in headers if header.orientation != orientation]
    note = f"{', '.join(odd)}: turned as the other photos are, although EXIF states otherwise"
    return turned, [note]
