"""Option types, file checks, messages and progress that the commands share."""

import itertools
import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from hdrlab.errors import InputError
from hdrlab.pipeline import catalogue

if TYPE_CHECKING:
    from hdrlab.core.arrays import F32

Item = TypeVar("Item")
Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

INPUT_PATH = click.Path(path_type=Path)


class OutputPath(click.Path):
    """The path of a file or folder to write. `Command` checks it before the command starts.

    Parameters
    ----------
    check
        Raises an error if the command cannot write under a path.
    """

    def __init__(self, check: Callable[[Path], object] | None = None) -> None:
        super().__init__(path_type=Path)
        self.check = check


def _require_file(path: Path) -> None:
    """Raise an error if the folder of a file to write is missing, or the file is a folder."""
    from hdrlab.io import files

    files.require_replaceable(path)


def _require_map(path: Path) -> None:
    """Raise an error if a radiance map cannot be written under this name."""
    from hdrlab.io import radiance

    radiance.require_writable(path)
    _require_file(path)


def _require_picture(path: Path) -> None:
    """Raise an error if a tone-mapped image cannot be written under this name."""
    from hdrlab.io import photos

    photos.require_writable(path)
    _require_file(path)


OUTPUT_PATH = OutputPath()
OUTPUT_FILE = OutputPath(_require_file)
OUTPUT_MAP = OutputPath(_require_map)
OUTPUT_PICTURE = OutputPath(_require_picture)
EXISTING_FILE = click.Path(path_type=Path, exists=True, dir_okay=False)
EXISTING_FOLDER = click.Path(path_type=Path, exists=True, file_okay=False)

OPERATORS = ["photograph", *catalogue.names("tonemap")]
MAP_SUFFIXES = ".hdr, .exr, .pfm or .tif"

# options that had another name before, by command, and what to use instead
REPLACEMENTS = {
    ("assemble", "--tonemap"): "--operator",
    ("tonemap", "--way"): "--gamut",
    ("compare", "--way"): "--gamut",
    ("calibrate", "--estimate-times"): "--correct-times",
    ("correct", "--way"): "--skin",
    ("check", "--page"): "--report",
    ("lab", "--folder"): "-o",
    ("new-task", "--folder"): "-o",
}

# how NumPy says how much memory it could not get
NUMPY_MEMORY_NEED = re.compile(r"Unable to allocate (\d[\d.]* \w+)")


@dataclass
class Settings:
    """Global options of one run of the command line."""

    debug: bool = False


def _set_debug(ctx: click.Context, param: click.Parameter, value: bool) -> None:
    """Store --debug where `run` finds it when the command has failed."""
    if value:
        ctx.find_root().ensure_object(Settings).debug = True


def debug_option(*, hidden: bool) -> click.Option:
    """Return the option --debug, which every command accepts and only `hdrlab --help` lists."""
    return click.Option(
        ["--debug"],
        is_flag=True,
        is_eager=True,
        expose_value=False,
        hidden=hidden,
        callback=_set_debug,
        help="Show the traceback of every error.",
    )


def _require_existing(path: Path) -> None:
    """Raise an error if a file or folder to read does not exist."""
    if not path.exists():
        raise InputError(f"{path} does not exist; pass a file or a folder that exists")


class Command(click.Command):
    """A command that checks the names of its outputs, and never overwrites a file that it reads."""

    def __init__(self, *arguments: Any, **keywords: Any) -> None:
        super().__init__(*arguments, **keywords)
        self.params.append(debug_option(hidden=True))

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the words after the command; a path that does not exist is the first error."""
        try:
            return super().parse_args(ctx, args)
        except click.NoSuchOption as error:
            replacement = REPLACEMENTS.get((str(self.name), error.option_name))
            if replacement is None:
                raise
            raise InputError(f"{error.option_name} has a new name: use {replacement}") from None
        except click.MissingParameter:
            for param in self.params:
                if isinstance(param, click.Argument) and param.type is INPUT_PATH:
                    for path in _paths(ctx.params.get(str(param.name))):
                        _require_existing(path)
            raise

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command, or raise an error if it cannot write one of its outputs.

        This happens before the command starts, because some commands work for minutes.
        """
        from hdrlab.io.files import require_distinct, require_other
        from hdrlab.io.temporary import remove_leftovers

        written: list[Path] = []
        read: list[Path] = []
        checks: list[Callable[[], object]] = []
        for param in self.params:
            paths = _paths(ctx.params.get(str(param.name)))
            if not isinstance(param.type, OutputPath):
                read.extend(paths)
                continue
            written.extend(paths)
            if param.type.check is not None:
                checks += [partial(param.type.check, path) for path in paths]
        if written:
            require_distinct(written)
            existing = [path for path in written if path.exists()]
            photos = [photo for path in read for photo in _find_photos(path, existing)]
            require_other(written, [*read, *photos])
        for check in checks:
            check()
        for path in written:
            remove_leftovers(path.parent)
        try:
            return super().invoke(ctx)
        except MemoryError as error:
            raise MemoryError(describe_memory_error(error, self)) from error


def describe_memory_error(error: MemoryError, command: click.Command) -> str:
    """Return how much memory a command needs, as far as NumPy says it, and what the user can do."""
    names = {param.name for param in command.params}
    advice = ["close other programs"]
    if "size" in names:
        advice.insert(0, "pass a smaller --size")
    if "photos" in names:
        advice.insert(0, "use fewer or smaller photos")
    need = NUMPY_MEMORY_NEED.search(str(error))
    reason = (
        f"not enough memory: {need[1]} more are needed at once" if need else "not enough memory"
    )
    return f"{reason}; {', or '.join(advice)}"


class Group(click.Group):
    """A group whose commands and subgroups are of these classes too."""

    command_class = Command
    group_class = type


def _paths(value: object) -> list[Path]:
    """Return what the value of an option, or each of its values, may name."""
    values = value if isinstance(value, tuple) else (value,)
    return [Path(item) for item in values if isinstance(item, str | Path)]


def _find_photos(folder: Path, outputs: list[Path]) -> list[Path]:
    """Return the photos in a folder that are among the outputs of a command. Files have none.

    A command that gets the folder reads these photos. Pictures that hdrlab wrote there, and radiance
    maps, are no photos, so that a command can be repeated.
    """
    if not outputs or not os.path.isdir(folder):
        return []
    from hdrlab.io import album
    from hdrlab.io.own_pictures import is_own_picture, is_radiance_map

    found = []
    for path in folder.iterdir():
        if path.suffix.lower() not in album.SUFFIXES or not path.exists():
            continue
        is_output = any(os.path.samefile(path, output) for output in outputs)
        if is_output and not is_own_picture(path) and not is_radiance_map(path):
            found.append(path)
    return found


def choice_option(
    name: str, values: Sequence[str], default: str | None = None, help: str | None = None
) -> Decorator:
    """Return an option that takes one of some values, by default the first."""
    return click.option(name, type=click.Choice(values), default=default or values[0], help=help)


map_output_option = click.option(
    "-o",
    "--out",
    required=True,
    type=OUTPUT_MAP,
    help=f"Radiance map to write: {MAP_SUFFIXES}.",
)
operator_option = choice_option(
    "--operator",
    OPERATORS,
    help="Tone-mapping operator. photograph adapts its settings to the map. The others use the "
    "settings of their papers.",
)
mask_option = click.option(
    "--mask",
    metavar="RRGGBB",
    help="Ignore pixels of exactly this color, such as the border of a scan.",
)
clean_option = click.option(
    "--clean", is_flag=True, help="Repair a map even if most of its pixels are NaN or negative."
)


def tier_error(reason: str) -> InputError:
    """Return the error for a sandbox tier that this machine cannot run, with what to do."""
    from hdrlab.course.grading import doctor

    first_line = reason.strip().partition("\n")[0].rstrip(".")
    advice = "run hdrlab doctor for details"
    remedy = doctor.find_remedy(reason)
    if remedy:
        advice = f"{remedy}; {advice}"
    message = f"{first_line}; {advice}"
    if "practice" not in first_line:
        message += "; or grade without credit: pass --tier practice"
    return InputError(message)


def require_modules(extra: str, names: Iterable[str]) -> None:
    """Raise InputError with the command to install an extra, if any of its modules is missing."""
    missing = [name for name in names if find_spec(name) is None]
    if missing:
        names_missing = ", ".join(missing)
        raise InputError(f'missing {names_missing}; run: pip install "hdrlab[{extra}]"')


def echo_notes(notes: Iterable[object]) -> None:
    """Print each note on standard error, after the word "note"."""
    for note in notes:
        click.echo(f"note: {note}", err=True)


def echo_details(details: Iterable[object]) -> None:
    """Print each detail on standard error, after the word "detail"."""
    for detail in details:
        click.echo(f"detail: {detail}", err=True)


def echo_warnings(warnings: Iterable[object]) -> None:
    """Print each warning on standard error, after the word "warning"."""
    for warning in warnings:
        click.echo(f"warning: {warning}", err=True)


def echo_paths(paths: Iterable[Path]) -> None:
    """Print the path of each file as soon as it is written."""
    for path in paths:
        click.echo(path)


def progress(items: Iterable[Item], what: str, total: int | None = None) -> Iterable[Item]:
    """Return `items` behind a progress bar. It appears after a second, and only on a terminal."""
    if not sys.stderr.isatty():
        # importing tqdm takes a tenth of a second
        return items
    from tqdm import tqdm

    return tqdm(items, what, total, leave=False, delay=1)


def one_by_one(items: Iterable[Item], names: Sequence[str]) -> Iterator[Item]:
    """Yield all `items`, and show on a terminal which of `names` is computed, and for how long.

    A progress bar moves when an item is done, so it stands still where each item takes seconds.
    Items beyond the last name are shown under that name.
    """
    from hdrlab.cli.terminal import elapsed

    iterator = iter(items)
    for number in itertools.count(1):
        name = names[min(number, len(names)) - 1]
        count = max(number, len(names))
        with elapsed(f"{number} of {count}, {name}"):
            try:
                item = next(iterator)
            except StopIteration:
                return
        yield item


def read_map(source: Path, clean: bool) -> "F32":
    """Read a radiance map, repair it, and print a note about the repair.

    Raises
    ------
    InputError
        If half of the pixels or more need a repair, unless `clean`.
    """
    from hdrlab.io import radiance

    sanitized = radiance.read_sanitized(source)
    E = sanitized.E
    count_by_repair = {
        "unknown pixels": sanitized.unknown,
        "infinite values": sanitized.infinite,
        "pixels with a negative channel": sanitized.negative,
        "pixels below black": sanitized.black,
    }
    repairs = ", ".join(f"{count} {name}" for name, count in count_by_repair.items() if count)
    pixels = E.shape[0] * E.shape[1]
    channels = E.size / pixels
    invalid = sanitized.unknown + sanitized.black + sanitized.infinite / channels
    if not clean and 2 * invalid >= pixels:
        raise InputError(
            f"{source}: most of the {pixels} pixels have no valid radiance ({repairs}); "
            "pass --clean to repair them"
        )
    if repairs:
        click.echo(f"note: {source}: repaired {repairs}, out of {pixels} pixels", err=True)
    elif clean:
        click.echo(f"{source}: nothing to repair, all values are valid")
    return E


def parse_color(text: str | None) -> tuple[int, int, int] | None:
    """Return the three pixel values of a color RRGGBB; None stays None."""
    if text is None:
        return None
    try:
        red, green, blue = bytes.fromhex(text.removeprefix("#"))
    except ValueError:
        raise InputError(
            f"--mask: expected a color as RRGGBB, such as 0000FF, got {text!r}"
        ) from None
    return red, green, blue


def parse_meter_reading(text: str) -> tuple[int, int, float]:
    """Return the place and the luminance of a meter reading X,Y=CD."""
    match = re.fullmatch(r"(\d{1,6}),(\d{1,6})=(\d{1,9}(?:\.\d{1,9})?)", text, re.ASCII)
    if not match:
        raise InputError(f"--calibrate: expected X,Y=CD, such as 640,360=125, got {text[:40]!r}")
    return int(match[1]), int(match[2]), float(match[3])


def parse_pixel(text: str) -> tuple[int, int]:
    """Return the column and the row of a pixel X,Y.

    Examples
    --------
    >>> parse_pixel("640,360")
    (640, 360)
    """
    match = re.fullmatch(r"(\d{1,6}),(\d{1,6})", text, re.ASCII)
    if not match:
        raise InputError(f"expected a pixel as X,Y, such as 640,360, got {text[:40]!r}")
    return int(match[1]), int(match[2])


def parse_setting(text: str) -> tuple[str, float | str | bool | None]:
    """Return the name and the value of a setting NAME=VALUE.

    Examples
    --------
    >>> parse_setting("key=0.36"), parse_setting("passes=3"), parse_setting("local=true")
    (('key', 0.36), ('passes', 3), ('local', True))
    """
    name, equals, value = text.partition("=")
    if not equals or not name.isidentifier():
        raise InputError(f"--set: expected NAME=VALUE, such as key=0.36, got {text!r}")
    words: dict[str, bool | None] = {"true": True, "false": False, "none": None}
    if value in words:
        return name, words[value]
    try:
        number = float(value)
    except ValueError:
        return name, value
    return name, int(number) if value.lstrip("+-").isdigit() else number
