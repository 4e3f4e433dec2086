"""What the commands share: kinds of options, progress, and text that becomes values."""

import inspect
import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from importlib.util import find_spec
from pathlib import Path
from types import SimpleNamespace
from typing import Any, TypeVar

import click

from hdrlab import __version__
from hdrlab.errors import InputError
from hdrlab.pipeline import catalogue

Item = TypeVar("Item")
Option = Callable[[Callable[..., Any]], Callable[..., Any]]
FILE = click.Path(path_type=Path)
OUT = click.Path(path_type=Path)  # what is written: it may be nothing that the same command reads
OPERATORS = ["photograph", *catalogue.names("tonemap")]
SUFFIXES = ".hdr, .exr, .pfm or .tif"
PIXELS = 400_000  # of a map, on an even grid, by which its range is told
MASK = click.option(
    "--mask", metavar="RRGGBB", help="Exactly this colour is no picture (borders of scans)."
)
CLEAN = click.option(
    "--clean", is_flag=True, help="Repair even a map of which most is NaN or below 0."
)


def choice(
    name: str, values: Sequence[str], default: str | None = None, help: str | None = None
) -> Option:
    """Return the option that takes one of some values, by default the first."""
    return click.option(name, type=click.Choice(values), default=default or values[0], help=help)


def operator(name: str) -> Option:
    """Return the option that names a tone mapping operator."""
    said = "photograph chooses its settings by the map; the others have their papers'."
    return choice(name, OPERATORS, help=said)


class Command(click.Command):
    """A command that writes over nothing that it reads; one of many options gets them by name, as `asked`."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command, or raise a ValueError where an output is one of the files that it would read."""
        from hdrlab.io.files import require_other

        given = [(one.type is OUT, _paths(ctx.params.get(str(one.name)))) for one in self.params]
        written = [path for is_out, paths in given if is_out for path in paths]
        read = [path for is_out, paths in given if written and not is_out for path in paths]
        require_other(written, [file for path in read for file in (path, *_photographs(path))])
        if "asked" in inspect.signature(self.callback or print).parameters:
            ctx.params = {"asked": SimpleNamespace(**ctx.params)}
        return super().invoke(ctx)


class Group(click.Group):
    """A group of such commands, and of such groups."""

    command_class = Command
    group_class = type


@click.group(
    cls=Group, context_settings={"help_option_names": ["-h", "--help"], "show_default": True}
)
@click.version_option(__version__, prog_name="hdrlab")
def main() -> None:
    """High dynamic range imaging: photographs to a radiance map to a picture."""


command = main.command


def _paths(value: Any) -> list[Path]:
    """Return what the value of an option, or each of its values, may name."""
    each = value if isinstance(value, tuple) else (value,)
    return [Path(one) for one in each if isinstance(one, str | Path)]


def _photographs(folder: Path) -> list[Path]:
    """Return the photographs in a folder, which are read where the folder is named; none of a file."""
    from hdrlab.io import album

    inside = folder.iterdir() if os.path.isdir(folder) else ()
    return [path for path in inside if path.suffix.lower() in album.SUFFIXES]


def no_tier(reason: str) -> InputError:
    """Return the error of a tier that cannot be had, with what can be done about it, in one line."""
    from hdrlab.course.sandbox import doctor

    helps = "; ".join(filter(None, (doctor.remedy(reason), "hdrlab doctor says more")))
    line = reason.strip().partition("\n")[0].rstrip(".")
    other = (
        "" if "practice" in line else ". For practice alone, and not for credit: --tier practice"
    )
    return InputError(f"{line}; {helps}{other}")


def require(extra: str, names: Iterable[str]) -> None:
    """Raise a ValueError that says what to install, where modules of an extra are not there."""
    if missing := [name for name in names if find_spec(name) is None]:
        raise InputError(f'expected {", ".join(missing)}: pip install "hdrlab[{extra}]"')


def say(word: str, lines: Iterable[object]) -> None:
    """Print lines beside the results, each after a word: "note" or "warning"."""
    for line in lines:
        click.echo(f"{word}: {line}", err=True)


def list_files(files: Iterable[Path]) -> None:
    """Print the name of each file as soon as it is there."""
    for file in files:
        click.echo(file)


def progress(items: Iterable[Item], what: str, total: int | None = None) -> Iterable[Item]:
    """Return `items` behind a progress bar that appears after a second, on a terminal alone."""
    if (
        not sys.stderr.isatty()
    ):  # where tqdm would say nothing, it takes a tenth of a second to import
        return items
    from tqdm import tqdm

    return tqdm(items, what, total, leave=False, delay=1)


def one_by_one(items: Iterable[Item], names: Sequence[str]) -> Iterator[Item]:
    """Yield `items`, while a terminal shows which of `names` is being made, and for how long.

    A bar moves when an item is done; where there are few and each takes seconds, that looks like
    standstill.
    """
    from hdrlab.cli.terminal import elapsed

    made = iter(items)
    for j, name in enumerate(names, 1):
        with elapsed(f"{j} of {len(names)}, {name}"):
            item = next(made, None)
        if item is None:
            return
        yield item


def read_map(source: Path, clean: bool) -> Any:
    """Return the radiance map of a file, with one line on what was repaired.

    Raises a ValueError where half of the pixels or more hold no light at all, unless `clean`.
    """
    from hdrlab.io import radiance

    E, *counts = radiance.read_sanitized(source)
    unknown, infinite, _, black = counts
    what = (
        "unknown pixels",
        "infinite values",
        "pixels with a negative channel",
        "pixels below black",
    )
    said = ", ".join(f"{count} {name}" for count, name in zip(counts, what, strict=True) if count)
    pixels = E.shape[0] * E.shape[1]
    if not clean and 2 * (unknown + black + infinite / (E.size / pixels)) >= pixels:
        raise InputError(
            f"{source}: expected radiance, got {said} of {pixels} pixels; --clean repairs all"
        )
    if said:
        click.echo(f"note: {source}: cleaned {said}, of {pixels} pixels", err=True)
    elif clean:
        click.echo(f"{source}: cleaned nothing, all is radiance")
    return E


def size(E: Any) -> str:
    """Return what a radiance map is, in words: its size and its decades."""
    from hdrlab.core.extremes import decades

    every = max(1, int((E.shape[0] * E.shape[1] / PIXELS) ** 0.5))
    few = E[::every, ::every]
    return f"{E.shape[1]} x {E.shape[0]}, " + (
        f"{decades(few):.1f} decades" if few.any() else "all black"
    )


def agreement(spread: float) -> str:
    """Return how far the frames of a map agree, in words; a spread of NaN stops could not be measured."""
    if spread != spread:
        return "how far the frames agree could not be measured"
    return f"frames agree to {spread:.3f} stops"


def colour(text: str | None) -> tuple[int, int, int] | None:
    """Return RRGGBB as three levels, or raise a ValueError; None passes."""
    if text is None:
        return None
    try:
        red, green, blue = bytes.fromhex(text.removeprefix("#"))
    except ValueError:
        raise InputError(
            f"--mask: expected a colour as RRGGBB, such as 0000FF, got {text!r}"
        ) from None
    return red, green, blue


def reading(text: str) -> tuple[int, int, float]:
    """Return X,Y=CD as a place and its luminance, or raise a ValueError."""
    found = re.fullmatch(r"(\d{1,6}),(\d{1,6})=(\d{1,9}(?:\.\d{1,9})?)", text, re.ASCII)
    if not found:
        raise InputError(f"--calibrate: expected X,Y=CD, such as 640,360=125, got {text[:40]!r}")
    return int(found[1]), int(found[2]), float(found[3])


def knob(text: str) -> tuple[str, Any]:
    """Return knob=value as a name and a number, a word, True, False or None."""
    name, equals, value = text.partition("=")
    if not equals or not name.isidentifier():
        raise InputError(f"--set: expected knob=value, such as key=0.36, got {text!r}")
    if value in ("true", "false", "none"):
        return name, {"true": True, "false": False, "none": None}[value]
    try:
        number = float(value)
    except ValueError:
        return name, value
    return name, int(number) if value.lstrip("+-").isdigit() else number
