"""Read a bracket and a response curve as the options of the commands describe them."""

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hdrlab.cli import common
from hdrlab.errors import InputError
from hdrlab.pipeline import catalogue

if TYPE_CHECKING:
    from hdrlab.core.arrays import F64
    from hdrlab.core.bracket import Bracket
    from hdrlab.io.album import Selection
    from hdrlab.io.decode import PhotoHeader

TIMES_KEYWORDS = ("exif", "estimate")
CURVE_SUFFIXES = ".csv or .m (pfstools)"


class ResponseType(click.ParamType):  # type: ignore[type-arg]  # it takes arguments since click 8.4
    """The name of a response method, or a file with a curve."""

    name = "NAME|FILE"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> str | Path:
        """Return the name of a method as it is, and a file with a curve as a path."""
        names = ["auto", *catalogue.names("response")]
        if value in names:
            return str(value)
        from hdrlab.io import response_files

        if str(value).lower().endswith(tuple(response_files.FORMS)):
            return Path(value)
        self.fail(
            f"expected one of {', '.join(names)}, or a file: {CURVE_SUFFIXES}; got {value!r}",
            param,
            ctx,
        )


def saved_curve(path: Path) -> "Callable[..., F64]":
    """Return a response method that ignores the photos and returns the curve of a file."""
    from hdrlab.io.response_files import read_curve

    g = read_curve(path)

    def recover(*arguments: Any, **settings: Any) -> "F64":
        return g

    return recover


def read_bracket(
    photos: tuple[Path, ...],
    times: str,
    mask: str | None,
    stops: float | None,
    *,
    note: Callable[[str], object],
    detail: Callable[[str], object],
    check: "Callable[[list[PhotoHeader]], object] | None" = None,
) -> "Bracket":
    """Read the photos of a bracket, with exposure times from --times or --stops.

    If no times are known and --times estimate asks for none, all times are 1. `note` is called with
    each sentence that users must know, `detail` with each other one. `check` is called with the
    headers of the photos before they are decoded.
    """
    from hdrlab import pipeline
    from hdrlab.io import album, photos as photo_files

    color = common.parse_color(mask)
    selection = album.select(photos)
    if check is not None:
        check(selection.headers)
    bracket = photo_files.read_bracket(
        selection,
        _find_times(selection, times, stops, detail),
        mask=color,
        note=note,
        detail=detail,
        warn=lambda warning: None,  # the assembly repeats the warnings, see Bracket.damaged
        progress=lambda paths: common.progress(paths, "reading"),
    )
    if stops:
        return pipeline.space_by_stops(bracket, stops)
    return bracket


def _find_times(
    selection: "Selection", times: str, stops: float | None, detail: Callable[[str], object]
) -> Path | list[float] | None:
    """Return a list of times, or the file that has one, or None if the photos' EXIF has them."""
    unknown_times = [1.0] * len(selection.headers)
    if stops:
        return unknown_times
    if times not in TIMES_KEYWORDS:
        return Path(times)
    if all(header.exposure.seconds for header in selection.headers):
        return None
    list_file = _find_list(selection.paths)
    if list_file is not None:
        detail(f"the exposure times are those of {list_file}")
        return list_file
    return unknown_times if times == "estimate" else None


def _find_list(paths: list[Path]) -> Path | None:
    """Return the first file next to the photos that lists an exposure time for each of them."""
    from hdrlab.io.exif_exposure import Exposure
    from hdrlab.io.times import bracket_times

    folder = paths[0].parent
    names = [path.name for path in paths]
    for file in sorted([*folder.glob("*.csv"), *folder.glob("*.txt")]):
        # skips other files, folders, and files that cannot be read
        with suppress(InputError, OSError):
            bracket_times(names, [Exposure()], file)
            return file
    return None
