"""Merge a reader's own photos in a browser: `theme/static/photos_worker.js` calls it.

The files are in a folder of the browser's tab. Nothing is sent to a server.
"""

import json
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from hdrlab import pipeline
from hdrlab.core import colour, exposure_text, optional
from hdrlab.core.arrays import F32, Array
from hdrlab.core.bracket import Bracket
from hdrlab.errors import HdrlabError, InputError
from hdrlab.io import album, photos, radiance
from hdrlab.io.decode import PhotoHeader, read_header
from hdrlab.io.exif_exposure import equivalent_seconds, fill_missing, luminance_of_unit
from hdrlab.io.reduce import READABLE_FORMATS, reduce_photo
from hdrlab.io.times import parse_number
from hdrlab.pipeline import Assembly, pictures
from hdrlab.show.pages import wording

MAX_PHOTO_PIXELS = 2_000_000
# of the picture of one exposure, which follows a slider
MAX_PREVIEW_PIXELS = 400_000
MIN_PHOTOS = 2
MAX_PHOTOS = 9
# what a middle gray is in a picture of one exposure, 1 = white
MIDDLE_GRAY = 0.18
MAP_NAME = "radiance_map.hdr"
PICTURE_STEM = "tone_mapped"
PREVIEW_NAME = "one_exposure.jpg"

# what hdrlab does after each stage of `pipeline.assemble_steps`
NEXT_STEP = {
    "align": "Comparing the exposure times with the pixels",
    "times": "Estimating the response of the camera",
    "response": "Merging the photos",
    "merge": "Looking for things that moved, and checking the map",
    "ghosts": "Checking the map",
    "compare": "Tone mapping",
}
# reading, the stages of NEXT_STEP without "ghosts", and aligning
STEPS = 7

# what the page offers in place of the options of `hdrlab assemble` that warnings name
ADVICE_OF_THE_PAGE = {
    "pass --times FILE or --stops": "type the times into the list",
    "pass the true times (--times FILE or --stops)": "type the true times into the list",
}
OPTION = re.compile(r"(?<!\S)--[a-z]")
OPTION_NOTE = (
    "words such as --align are options of the command `hdrlab assemble`; install hdrlab to use them"
)

# called with what hdrlab does now, the number of steps that are done, and that of all steps
Report = Callable[[str, int, int], object]


@dataclass
class OwnPhoto:
    """A photo of the reader: what its file stated, and the header of what is merged, maybe reduced."""

    stated: PhotoHeader
    merged: PhotoHeader


class OwnPhotos:
    """The photos of a reader, and the radiance map that was made of them.

    The methods return JSON for the page. Its field `error` says in words what is wrong.

    Parameters
    ----------
    folder : Path or str
        Where the page finds the results. It writes the photos into the subfolder "photos".
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)
        self.photo_folder = self.folder / "photos"
        self.photo_folder.mkdir(parents=True, exist_ok=True)
        self._photos: dict[str, OwnPhoto] = {}
        self._assembly: Assembly | None = None

    def add(self, name: str) -> str:
        """Read the header of a photo in the folder, and reduce the photo if it is large."""
        return self._answer(lambda: self._add(name))

    def remove(self, name: str) -> None:
        """Forget a photo, and delete its file."""
        self._photos.pop(name, None)
        (self.photo_folder / name).unlink(missing_ok=True)

    def assemble(self, times: str, report: Report, *, align: str = "auto") -> str:
        """Merge the photos, and write the tone-mapped picture.

        Parameters
        ----------
        times : str
            JSON: the exposure time of each photo as its reader sees or wrote it, by file name; ""
            if it is unknown. hdrlab estimates all times if one is unknown.
        report : function
            Called with each step before it begins.
        align : str
            As in `pipeline.assemble`.
        """
        return self._answer(lambda: self._assemble(json.loads(times), report, align))

    def tone_map(self, operator: str) -> str:
        """Write the picture of an operator as PNG and JPEG, and return its settings in words."""
        return self._answer(lambda: self._tone_map(operator))

    def expose(self, stops: float) -> str:
        """Write a small picture of the map as a camera with this exposure compensation takes it."""
        return self._answer(lambda: self._expose(stops))

    def write_map(self) -> str:
        """Write the radiance map, with the warnings in its header."""
        return self._answer(self._write_map)

    def _answer(self, method: Callable[[], dict[str, Any]]) -> str:
        """Return what a method returns as JSON, or its error in words."""
        try:
            return json.dumps(method())
        except optional.MissingPackageError as error:
            return json.dumps({"error": str(error), "isMissing": error.name == "skimage"})
        except HdrlabError as error:
            return json.dumps({"error": str(error).replace(f"{self.photo_folder}/", "")})
        except MemoryError:
            message = "this tab has too little memory; use fewer photos, or install hdrlab"
            return json.dumps({"error": message})

    def _add(self, name: str) -> dict[str, Any]:
        path = self.photo_folder / name
        try:
            stated = read_header(path)
            if stated.kind not in READABLE_FORMATS or stated.dtype != np.uint8:
                raise InputError(f"{name}: this page reads JPEG and 8-bit PNG only; install hdrlab")
            merged = stated
            height, width = stated.shape[:2]
            is_large = height * width > MAX_PHOTO_PIXELS
            if is_large:
                copy = path.with_name(f"{name}.reduced")
                reduced = reduce_photo(stated, copy, MAX_PHOTO_PIXELS)
                copy.replace(path)
                merged = replace(reduced, path=path)
        except HdrlabError:
            path.unlink(missing_ok=True)
            raise
        self._photos[name] = OwnPhoto(stated, merged)
        seconds = stated.exposure.seconds
        merged_height, merged_width = merged.shape[:2]
        return {
            "size": f"{width} x {height}",
            "reducedTo": f"{merged_width} x {merged_height}" if is_large else "",
            "time": exposure_text.seconds(seconds) if seconds else "",
        }

    def _assemble(self, times: dict[str, str], report: Report, align: str) -> dict[str, Any]:
        self._assembly = None
        times = {name: text for name, text in times.items() if name in self._photos}
        chosen = [self._photos[name] for name in times]
        if len(chosen) < MIN_PHOTOS:
            raise InputError("one photo is no bracket; add photos of other exposure times")
        if len(chosen) > MAX_PHOTOS:
            raise InputError(f"expected at most {MAX_PHOTOS} photos, got {len(chosen)}")
        upright, _ = album.turn_alike([photo.stated for photo in chosen])
        photos.require_alike(upright)
        notes: list[str] = []
        bracket, are_known = self._read(chosen, list(times.values()), notes, report)
        report("Aligning the photos", 1, STEPS)
        times_mode = "correct" if are_known else "estimate"
        states = pipeline.assemble_steps(
            bracket, align=align, times=times_mode, in_place=True, release=True
        )
        del bracket
        for done, state in enumerate(states, 2):
            report(NEXT_STEP[state.stage], min(done, STEPS - 1), STEPS)
        self._assembly = replace(state, notes=(*notes, *state.notes))
        tone_mapped = self._tone_map(pictures.AUTO)
        outputs = [
            f"{MAP_NAME} ({wording.describe_map(state.E)})",
            wording.describe_picture(f"{PICTURE_STEM}.png", state, pictures.AUTO),
        ]
        if state.fallback:
            notes.append(f"{pictures.FUSION_NOTE}, because {state.fallback}")
        warnings = [_advise_for_page(text) for text in state.warnings]
        notes = [_advise_for_page(text) for text in (*notes, *state.notes)]
        if any(OPTION.search(text) for text in (*warnings, *notes)):
            notes.append(OPTION_NOTE)
        return {
            "summary": wording.summarize_assembly(state, outputs),
            "warnings": warnings,
            "notes": notes,
            "details": state.details,
            "isFusion": bool(state.fallback),
            **tone_mapped,
        }

    def _read(
        self, chosen: Sequence[OwnPhoto], texts: Sequence[str], notes: list[str], report: Report
    ) -> tuple[Bracket, bool]:
        """Return the bracket, and whether all exposure times are known; add to the notes."""
        names = [photo.stated.path.name for photo in chosen]
        exposures = []
        is_edited = False
        for photo, text in zip(chosen, texts, strict=True):
            exposure = photo.stated.exposure
            stated_text = exposure_text.seconds(exposure.seconds) if exposure.seconds else ""
            if text.strip() != stated_text:
                is_edited = True
                exposure = exposure._replace(seconds=_parse_time(photo.stated.path.name, text))
            exposures.append(exposure)
        are_known = all(exposure.seconds is not None for exposure in exposures)
        times = None
        if not are_known:
            times = [1.0] * len(names)
        elif is_edited:
            exposures, fill_notes = fill_missing(names, exposures)
            notes.extend(fill_notes)
            times = equivalent_seconds(names, exposures)
        headers = [photo.merged for photo in chosen]

        def count(paths: Sequence[Path]) -> Iterator[Path]:
            for number, path in enumerate(paths, 1):
                report(f"Reading photo {number} of {len(paths)}", 0, STEPS)
                yield path

        bracket = photos.read_bracket(
            album.Selection(headers, [], []),
            times,
            note=notes.append,
            warn=lambda text: None,  # the assembly repeats the warnings
            progress=count,
        )
        if is_edited and are_known:
            bracket = replace(bracket, luminance_of_unit=luminance_of_unit(exposures))
        return bracket, are_known

    def _tone_map(self, operator: str) -> dict[str, Any]:
        developed = pictures.develop_assembly(self._require_assembly(), operator)
        for suffix in (".png", ".jpg"):
            path = self.folder / f"{PICTURE_STEM}{suffix}"
            photos.write_picture(path, developed.picture, is_result=True)
        return {"settings": developed.settings}

    def _expose(self, stops: float) -> dict[str, Any]:
        picture = expose(self._require_assembly().E, stops)
        photos.write_picture(self.folder / PREVIEW_NAME, picture, is_result=True)
        return {"settings": f"the map at one exposure, {wording.signed(stops, 1)} stops"}

    def _write_map(self) -> dict[str, Any]:
        assembly = self._require_assembly()
        radiance.write_radiance(
            self.folder / MAP_NAME,
            assembly.E,
            comments=[f"warning: {warning}" for warning in assembly.warnings],
            luminance_of_unit=assembly.bracket.luminance_of_unit,
            max_luminance_of_unit=assembly.bracket.max_luminance_of_unit,
        )
        return {}

    def _require_assembly(self) -> Assembly:
        if self._assembly is None:
            raise InputError("there is no map yet; press Start")
        return self._assembly


def expose(E: F32, stops: float) -> Array:
    """Return a small picture of a map without tone mapping: one exposure, clipped at white.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance.
    stops : float
        With 0, the median luminance becomes a middle gray.

    Returns
    -------
    (h, w) or (h, w, 3) uint8

    Examples
    --------
    >>> E = np.float32([[1, 1, 1, 64]])
    >>> expose(E, 0).tolist(), expose(E, -6).tolist()
    ([[118, 118, 118, 255]], [[9, 9, 9, 118]])
    """
    step = max(1, int(np.ceil((E.shape[0] * E.shape[1] / MAX_PREVIEW_PIXELS) ** 0.5)))
    small = E[::step, ::step]
    L = colour.luminance(small)
    median = float(np.median(L[L > 0])) if (L > 0).any() else 1.0
    return colour.to_8bit(np.minimum(small * (MIDDLE_GRAY / median * 2.0**stops), 1))


def _advise_for_page(text: str) -> str:
    """Return a warning with advice that a reader can follow on the page, if there is any.

    Examples
    --------
    >>> _advise_for_page("the times are estimated, so pass --times FILE or --stops if you know them")
    'the times are estimated, so type the times into the list if you know them'
    """
    for advice, replacement in ADVICE_OF_THE_PAGE.items():
        text = text.replace(advice, replacement)
    return text


def _parse_time(name: str, text: str) -> float | None:
    """Return the seconds that a reader wrote, such as "1/60 s"; None if the field is empty."""
    without_spaces = re.sub(r"\s+(?=[/s])|(?<=/)\s+", "", text.strip())
    return parse_number(name, without_spaces) if without_spaces else None
