"""The `hdrlab` command: the library's verbs with files around them.

Nothing is computed here. Chapters are imported inside the commands, so that `hdrlab --help` answers at once.
Bad input ends in one line on standard error and exit code 2, Ctrl-C in 130; files are written whole or not at all.
"""

import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import click

from hdrlab import __version__
from hdrlab.core import catalogue

Item = TypeVar("Item")
FILE = click.Path(path_type=Path)
SUFFIXES = ".hdr, .exr or .pfm"
CLEAN = click.option(
    "--clean", is_flag=True, help="Take NaN and negative values for 0, infinite ones for the largest."
)


def progress(items: Iterable[Item], what: str, total: int | None = None) -> Iterable[Item]:
    """Return `items` behind a progress bar that appears after a second, on a terminal alone."""
    from tqdm import tqdm

    return tqdm(items, what, total, leave=False, delay=1, disable=None)


def run(arguments: Sequence[str] | None = None) -> None:
    """Run the command and exit: 0 where all went well, 2 for bad input, 130 after Ctrl-C."""
    try:
        sys.exit(main.main(arguments, prog_name="hdrlab", standalone_mode=False))
    except click.exceptions.Abort:
        click.echo("hdrlab: interrupted", err=True)
        sys.exit(130)
    except click.ClickException as error:
        click.echo(f"hdrlab: {error.format_message()}", err=True)
        sys.exit(error.exit_code)
    except OSError as error:
        about = f"{error.filename}: {error.strerror}" if error.filename else error
        click.echo(f"hdrlab: {about}", err=True)
        sys.exit(2)
    except (ValueError, MemoryError) as error:
        click.echo(f"hdrlab: {error}", err=True)
        sys.exit(2)


@click.group(context_settings={"help_option_names": ["-h", "--help"], "show_default": True})
@click.version_option(__version__, prog_name="hdrlab")
def main() -> None:
    """High dynamic range imaging: photographs to a radiance map to a picture."""


@main.command()
@click.option("--out", type=FILE, default="hdrlab-demo", help="Folder for the results.")
@click.option("--seed", default=1, help="Of noise and hand shake.")
def demo(out: Path, seed: int) -> None:
    """Photograph a room with a bright window, and assemble the photographs again."""
    from hdrlab import demo as room

    for line in progress(room.demo_steps(out, seed=seed), "demo", room.STEPS):
        click.echo(line)


@main.command()
@click.argument("photos", nargs=-1, required=True, type=FILE)
@click.option("-o", "--out", required=True, type=FILE, help=f"Radiance map to write: {SUFFIXES}.")
@click.option("--times", type=FILE, help="Exposure times: a CSV, or lines of `name 1/seconds`. Beats EXIF.")
@click.option(
    "--mask", metavar="RRGGBB", help="Pixels of exactly this colour are no picture (borders of scans)."
)
@click.option("--align", type=click.Choice([*catalogue.names("align"), "none"]), default="mtb")
@click.option("--response", type=click.Choice(["auto", *catalogue.names("response")]), default="auto")
@click.option("--weight", type=click.Choice(["gaussian", "hat", "flat"]), default="gaussian")
@click.option("--merge", type=click.Choice(["log", "likelihood", "mean", "shot"]), default="log")
@click.option("--tonemap", type=click.Choice(catalogue.names("tonemap")), default="reinhard")
@click.option("--picture", type=FILE, help="Picture to write as well, tone-mapped: .png, .jpg or .tif.")
@click.option("--report", type=FILE, help="Folder for report.html: bracket, response, map, picture.")
@click.option("--anyway", is_flag=True, help="Write the map even where the photographs put it in doubt.")
def assemble(
    photos: tuple[Path, ...],
    out: Path,
    times: Path | None,
    mask: str | None,
    tonemap: str,
    picture: Path | None,
    report: Path | None,
    anyway: bool,
    merge: str,
    **methods: str,
) -> None:
    """Assemble PHOTOS (files, or one folder) into a radiance map.

    Exposure comes from EXIF (time, ISO, f-number), or from --times.
    """
    from hdrlab import pipeline
    from hdrlab.core.steps import last
    from hdrlab.io import photos as files
    from hdrlab.io import radiance

    radiance.format_of(out)  # an unknown suffix is better known before the work than after it
    bracket = files.read_bracket(
        photos[0] if len(photos) == 1 else photos,
        times,
        mask=_colour(mask),
        progress=lambda paths: progress(paths, "reading"),
    )
    methods["method"] = merge
    assembly = last(progress(pipeline.assemble_steps(bracket, **methods), "assembling", len(pipeline.STAGES)))
    for note in assembly.notes:
        click.echo(f"note: {note}", err=True)
    if assembly.doubts and not anyway:
        raise ValueError(
            "; ".join(assembly.doubts) + " (nothing was written; --anyway writes the map as it is)"
        )
    for doubt in assembly.doubts:
        click.echo(f"warning: {doubt}", err=True)
    radiance.write_radiance(out, assembly.E)
    if picture or report:
        rendered = pipeline.develop(assembly.E, tonemap)
        if picture:
            files.write_picture(picture, rendered)
        if report:
            from hdrlab.show.report import write_report

            write_report(report, assembly, rendered, recipe=methods | {"tonemap": tonemap})
    click.echo(f"{out}: {_size(assembly.E)}, frames agree to {assembly.spread:.3f} stops")


@main.command()
@click.argument("source", type=FILE)
@click.option("-o", "--out", required=True, type=FILE, help="Picture to write: .png, .jpg or .tif.")
@click.option("--operator", type=click.Choice(catalogue.names("tonemap")), default="reinhard")
@click.option("--set", "knobs", multiple=True, metavar="KNOB=VALUE", help="A knob of the operator: key=0.36.")
@click.option("--saturation", default=1.0, help="1 keeps the colours' ratios, 0 is gray.")
@CLEAN
def tonemap(
    source: Path, out: Path, operator: str, knobs: tuple[str, ...], saturation: float, clean: bool
) -> None:
    """Make a picture of the radiance map SOURCE."""
    from hdrlab import pipeline
    from hdrlab.io import photos as files
    from hdrlab.io import radiance
    from hdrlab.io.terminal import elapsed

    E = radiance.read_radiance(source, clean=clean)
    settings = dict(_knob(one) for one in knobs)
    catalogue.check_knobs("tonemap", operator, settings)
    with elapsed(operator):
        files.write_picture(out, pipeline.develop(E, operator, saturation=saturation, **settings))
    click.echo(f"{out}: {E.shape[1]} x {E.shape[0]}, {operator}")


@main.command()
@click.argument("source", type=FILE)
@click.option("-o", "--out", required=True, type=FILE, help="Contact sheet to write: .png.")
@click.option("--operators", metavar="NAME,...", help="Which of them, in which order. [default: all]")
@click.option("--size", type=click.IntRange(16), default=1024, help="Most pixels along a side, see below.")
@CLEAN
def compare(source: Path, out: Path, operators: str | None, size: int, clean: bool) -> None:
    """Make a contact sheet of the radiance map SOURCE under every operator, with time and quality.

    The operators see the map at up to --size pixels along a side: time and quality are of that size.
    """
    from hdrlab.io import radiance
    from hdrlab.show import contact, figures, sheet

    sheet.check_suffix(out)
    names = operators.split(",") if operators else catalogue.names("tonemap")
    E = figures.fit(radiance.read_radiance(source, clean=clean), size)
    entries = progress(contact.entry_steps(E, names), "comparing", len(names))
    sheet.write_sheet(out, sheet.draw(entries, title=f"{source.name}, {_size(E)}"))
    click.echo(f"{out}: {len(names)} operators, {_size(E)}")


@main.command()
@click.argument("source", type=FILE)
@click.argument("target", type=FILE)
@click.option("--half", is_flag=True, help="Half floats in .exr: half the size, values up to 65504.")
@CLEAN
def convert(source: Path, target: Path, half: bool, clean: bool) -> None:
    """Write the radiance map SOURCE in the format of TARGET: .hdr, .exr or .pfm."""
    from hdrlab.io import radiance

    E = radiance.read_radiance(source, clean=clean)
    radiance.write_radiance(target, E, half=half)
    click.echo(f"{target}: {_size(E)}")


@main.command()
@click.argument("files", nargs=-1, required=True, type=FILE)
def info(files: tuple[Path, ...]) -> None:
    """Say what FILES are: radiance maps or photographs, their size, values and exposure."""
    from hdrlab.io.describe import describe_file

    for file in files:
        said = describe_file(file)
        click.echo(said.pop("file"))
        for key, value in said.items():
            click.echo(f"  {key:<12} {value}")


@main.command()
@click.option("--folder", type=FILE, default="hdrlab-notebooks", help="Your copy of the notebooks.")
@click.option("--copy-only", is_flag=True, help="Copy the notebooks and do not start JupyterLab.")
@click.argument("options", nargs=-1, type=click.UNPROCESSED)
def lab(folder: Path, copy_only: bool, options: tuple[str, ...]) -> None:
    """Open JupyterLab on a copy of the notebooks. What you changed in it stays; OPTIONS go to JupyterLab."""
    import subprocess

    from hdrlab.course import materials

    new = materials.copy_notebooks(folder)
    click.echo(f"{folder}: {len(new)} new notebooks")
    if not copy_only:
        sys.exit(subprocess.call([sys.executable, "-m", "jupyterlab", f"--notebook-dir={folder}", *options]))


def _size(E: Any) -> str:
    from hdrlab.capture.scenes import decades

    return f"{E.shape[1]} x {E.shape[0]}, {decades(E):.1f} decades"


def _colour(text: str | None) -> tuple[int, ...] | None:
    if text is None:
        return None
    try:
        red, green, blue = bytes.fromhex(text.removeprefix("#"))
    except ValueError:
        raise ValueError(f"--mask: expected a colour as RRGGBB, such as 0000FF, got {text!r}") from None
    return red, green, blue


def _knob(text: str) -> tuple[str, Any]:
    name, equals, value = text.partition("=")
    if not equals or not name.isidentifier():
        raise ValueError(f"--set: expected knob=value, such as key=0.36, got {text!r}")
    if value in ("true", "false", "none"):
        return name, {"true": True, "false": False, "none": None}[value]
    try:
        number = float(value)
    except ValueError:
        return name, value
    return name, int(number) if value.lstrip("+-").isdigit() else number
