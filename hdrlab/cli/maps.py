"""Commands that begin with a radiance map, or say what a file is."""

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from hdrlab.cli import common, terminal
from hdrlab.errors import InputError
from hdrlab.pipeline import catalogue

TO = ["picture", "ultrahdr", "png", "avif", "jxl"]
WAY = common.choice("--way", ["hue", "ratio"], help="Of colour, see above.")


@common.command()
@click.argument("source", type=common.FILE)
@click.option(
    "-o", "--out", required=True, type=common.OUT, help="Picture: .png, .jpg, .tif; .avif, .jxl."
)
@common.choice("--to", TO, help="All but picture light up on a bright screen, see above.")
@click.option("--headroom", default=8.0, help="Of a bright screen: the brightest light over white.")
@common.choice("--primaries", ["bt2020", "p3"], help="Of png and avif, see above.")
@common.operator("--operator")
@click.option(
    "--set", "knobs", multiple=True, metavar="KNOB=VALUE", help="A knob of the operator: key=0.36."
)
@click.option(
    "--saturation", type=float, help="1: the colours' ratios, 0: gray.  [default: the operator's]"
)
@WAY
@common.CLEAN
def tonemap(asked: Any) -> None:
    """Make a picture of the radiance map SOURCE.

    Bright colours may want more of a channel than a display has. By --way hue they become a little
    darker and a little paler, and keep their hue. By --way ratio the channel is clipped: the
    picture stays colourful, but a bright blue turns toward cyan.

    An Ultra HDR picture (ISO 21496-1) is the picture for any program, with gains that lead from it
    to the map, up to --headroom, for screens that can be brighter than white. Such a .jpg can be
    SOURCE as well.

    By --to png (16 bits) and avif (10 bits) the light of the map itself is coded by PQ (SMPTE ST
    2084), with white at 203 cd/m2 and as bright as the operator made it; a program that knows no PQ
    shows it pale. By --to jxl it is kept for the archive, as floats without loss or headroom. A
    suffix .avif or .jxl is enough.
    """
    from hdrlab import pipeline
    from hdrlab.cli.terminal import elapsed
    from hdrlab.io import photos as files, screens as codes
    from hdrlab.io.maps import ultrahdr
    from hdrlab.pipeline import screens
    from hdrlab.pipeline.pictures import find_operator

    by_suffix = {".avif": "avif", ".jxl": "jxl"}.get(asked.out.suffix.lower(), "picture")
    to = by_suffix if asked.to == "picture" else asked.to
    E = common.read_map(asked.source, asked.clean)
    settings = dict(common.knob(one) for one in asked.knobs)
    check_knobs("tonemap", find_operator(asked.operator), settings)
    with elapsed(asked.operator):
        settings |= {"saturation": asked.saturation, "way": asked.way}
        made = pipeline.develop_and_describe(E, asked.operator, **settings)
        if to == "ultrahdr":
            ultrahdr.write_picture(asked.out, made.picture, E, headroom=asked.headroom)
        elif to == "picture":
            files.write_picture(asked.out, made.picture)
        elif to == "jxl":
            codes.write_jxl(asked.out, screens.light(made.picture, E))
        else:
            light = screens.light(made.picture, E, headroom=asked.headroom)
            v = screens.signal(light, primaries=asked.primaries)
            (codes.write_png if to == "png" else codes.write_avif)(
                asked.out, v, primaries=asked.primaries
            )
    click.echo(f"{asked.out}: {E.shape[1]} x {E.shape[0]}, {made.settings}")


def check_knobs(chapter: str, name: str | Callable[..., Any], knobs: dict[str, Any]) -> None:
    """Raise a ValueError that lists a method's knobs where one of `knobs` is not among them."""
    known = inspect.getfullargspec(catalogue.method(chapter, name)).kwonlyargs
    for knob in knobs:
        if knob not in known:
            name = name if isinstance(name, str) else name.__module__.rpartition(".")[2]
            raise InputError(f"expected a knob of {name} out of {', '.join(known)}, got {knob!r}")


@common.command()
@click.argument("source", type=common.FILE)
@click.option("-o", "--out", required=True, type=common.OUT, help="Contact sheet to write: .png.")
@click.option(
    "--operators", metavar="NAME,...", help="Which of them, in which order. [default: all]"
)
@click.option(
    "--size", type=click.IntRange(16), default=1024, help="Most pixels along a side, see above."
)
@WAY
@common.CLEAN
def compare(
    source: Path, out: Path, operators: str | None, size: int, way: str, clean: bool
) -> None:
    """Make a contact sheet of the radiance map SOURCE under every operator, with time and quality.

    The operators see the map at up to --size pixels along a side: time and quality are of that
    size. For --way see `hdrlab tonemap --help`.
    """
    from hdrlab.show.pages import contact, sheet
    from hdrlab.show.plots import figures

    sheet.check_suffix(out)
    names = operators.replace(" ", "").split(",") if operators else common.OPERATORS
    E = figures.fit(common.read_map(source, clean), size)
    entries = common.one_by_one(contact.entry_steps(E, names, way=way), names)
    sheet.write_sheet(out, sheet.draw(entries, title=f"{source.name}, {common.size(E)}"))
    click.echo(f"{out}: {len(names)} operators, {common.size(E)}")


@common.command()
@click.argument("source", type=common.FILE)
@click.argument("target", type=common.OUT)
@click.option(
    "--half", is_flag=True, help="Half floats in .exr: half the size, values up to 65504."
)
@common.CLEAN
def convert(source: Path, target: Path, half: bool, clean: bool) -> None:
    """Write the radiance map SOURCE in the format of TARGET: .hdr, .exr, .pfm or .tif."""
    from hdrlab.io import radiance

    E = common.read_map(source, clean)
    radiance.write_radiance(target, E, half=half)
    click.echo(f"{target}: {common.size(E)}")


@common.command()
@click.argument("files", nargs=-1, required=True, type=common.FILE)
def info(files: tuple[Path, ...]) -> None:
    """Say what FILES are: radiance maps or photographs, their size, values and exposure."""
    from hdrlab.show.describe import describe_file

    for file in files:
        said = describe_file(file)
        click.echo(said.pop("file"))
        for key, value in said.items():
            click.echo(f"  {key:<12} {terminal.visible(value)}")
