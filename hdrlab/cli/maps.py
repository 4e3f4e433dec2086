"""The commands that start from a radiance map, such as `tonemap`, `compare`, `score` and `convert`."""

import inspect
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hdrlab.cli import common, terminal
from hdrlab.errors import InputError
from hdrlab.pipeline import catalogue

if TYPE_CHECKING:
    from hdrlab.core.arrays import F32, Array

OUTPUT_KINDS = ["picture", "ultrahdr", "png", "avif", "jxl"]

# what --to picture writes for files whose suffix leaves no choice
KIND_BY_SUFFIX = {".avif": "avif", ".jxl": "jxl"}

SUFFIXES_BY_KIND = {
    "ultrahdr": (".jpg", ".jpeg"),
    "png": (".png",),
    "avif": (".avif",),
    "jxl": (".jxl",),
}

gamut_option = common.choice_option(
    "--gamut", ["hue", "ratio"], help="Method for colors outside of the gamut of the display."
)


@click.command(cls=common.Command)
@click.argument("source", type=common.INPUT_PATH)
@click.option(
    "-o",
    "--out",
    required=True,
    type=common.OUTPUT_FILE,
    help="Image to write: .png, .jpg, .tif, .avif or .jxl.",
)
@common.choice_option(
    "--to",
    OUTPUT_KINDS,
    help="Kind of image: picture is for ordinary screens, the others are for HDR screens.",
)
@click.option(
    "--headroom",
    default=8.0,
    help="Peak brightness of the HDR screen, as a multiple of white.",
)
@common.choice_option("--primaries", ["bt2020", "p3"], help="Color primaries for png and avif.")
@common.operator_option
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="NAME=VALUE",
    help="Setting of the operator, such as key=0.36. Repeatable.",
)
@click.option(
    "--saturation",
    type=float,
    help="Color saturation: 1 keeps the map's color ratios, 0 is gray.  [default: the operator's]",
)
@gamut_option
@common.clean_option
def tonemap(
    *,
    source: Path,
    out: Path,
    to: str,
    headroom: float,
    primaries: str,
    operator: str,
    settings: tuple[str, ...],
    saturation: float | None,
    gamut: str,
    clean: bool,
) -> None:
    """Tone-map the radiance map SOURCE to an image.

    A bright color may exceed the range of a display in one channel. --gamut hue keeps its hue and
    makes it a little darker and paler. --gamut ratio clips the channel: the image stays more
    colorful, but a bright blue turns toward cyan. The view transforms agx and khronos map colors by
    themselves: they do not use --gamut, and they have no --saturation.

    --to ultrahdr writes an Ultra HDR .jpg (ISO 21496-1). Every program can show it. On an HDR
    screen, its gain map restores the radiance, up to --headroom. Such a .jpg can also be SOURCE.

    --to png and --to avif store the radiance of the map with PQ (SMPTE ST 2084). White is at 203
    cd/m^2. Programs without PQ show the image with pale colors.

    --to jxl stores the radiance as floating-point values, lossless and with its full range. If the
    output ends in .avif or .jxl, you can omit --to.
    """
    from hdrlab import pipeline
    from hdrlab.cli.terminal import elapsed
    from hdrlab.io import radiance
    from hdrlab.pipeline.pictures import find_operator

    if to == "picture":
        to = KIND_BY_SUFFIX.get(out.suffix.lower(), "picture")
    # bad options are reported before the work starts
    _require_image_suffix(out, to)
    if to == "ultrahdr":
        _require_ultrahdr_headroom(headroom)
    knobs: dict[str, Any] = dict(common.parse_setting(text) for text in settings)
    E = common.read_map(source, clean)
    check_settings("tonemap", find_operator(operator), knobs)
    with elapsed(operator):
        developed = pipeline.develop_and_describe(
            E,
            operator,
            saturation=saturation,
            way=gamut,
            luminance_of_unit=radiance.read_luminance_of_unit(source),
            max_luminance_of_unit=radiance.read_max_luminance_of_unit(source),
            **knobs,
        )
        _write_image(out, to, developed.picture, E, headroom=headroom, primaries=primaries)
    click.echo(f"{out}: {E.shape[1]} x {E.shape[0]}, {developed.settings}")


def _require_image_suffix(out: Path, kind: str) -> None:
    """Raise an InputError if the suffix of `out` does not fit one of OUTPUT_KINDS."""
    from hdrlab.io import files, photos

    if kind == "picture":
        photos.require_writable(out)
    else:
        files.require_suffix(out, SUFFIXES_BY_KIND[kind], f"an image for --to {kind}")


def _require_ultrahdr_headroom(headroom: float) -> None:
    """Raise an InputError if a gain map cannot store this headroom."""
    from hdrlab.io.maps.ultrahdr import MAX_HEADROOM

    if not 1 < headroom <= MAX_HEADROOM:
        raise InputError(
            f"--headroom: expected more than 1 and at most {MAX_HEADROOM}, got {headroom}"
        )


def _write_image(
    out: Path, kind: str, picture: "Array", E: "F32", *, headroom: float, primaries: str
) -> None:
    """Write a tone-mapped image as one of OUTPUT_KINDS."""
    from hdrlab.io import photos, screens as screen_files
    from hdrlab.io.maps import ultrahdr
    from hdrlab.pipeline import screens

    if kind == "picture":
        photos.write_picture(out, picture, is_result=True)
    elif kind == "ultrahdr":
        ultrahdr.write_picture(out, picture, E, headroom=headroom)
    elif kind == "jxl":
        screen_files.write_jxl(out, screens.light(picture, E))
    else:
        light = screens.light(picture, E, headroom=headroom)
        signal = screens.signal(light, primaries=primaries)
        if kind == "png":
            screen_files.write_png(out, signal, primaries=primaries)
        else:
            screen_files.write_avif(out, signal, primaries=primaries)


def check_settings(
    chapter: str, method: str | Callable[..., Any], settings: Mapping[str, Any]
) -> None:
    """Raise InputError with the names of a method's settings, if it has none of a given name."""
    known = inspect.getfullargspec(catalogue.method(chapter, method)).kwonlyargs
    for setting in settings:
        if setting not in known:
            name = method if isinstance(method, str) else method.__module__.rpartition(".")[2]
            raise InputError(
                f"--set: expected a setting of {name} out of {', '.join(known)}, got {setting!r}"
            )


@click.command(cls=common.Command)
@click.argument("source", type=common.INPUT_PATH)
@click.option(
    "-o",
    "--out",
    required=True,
    type=common.OUTPUT_FILE,
    help="Contact sheet to write: .png.",
)
@click.option(
    "--operators", metavar="NAME,...", help="Operators to compare, in this order.  [default: all]"
)
@click.option(
    "--size", type=click.IntRange(16), default=1024, help="Longer side of the images, in pixels."
)
@gamut_option
@common.clean_option
def compare(
    *, source: Path, out: Path, operators: str | None, size: int, gamut: str, clean: bool
) -> None:
    """Show the radiance map SOURCE with every tone-mapping operator.

    hdrlab writes a contact sheet. It also shows the run time and the quality index (TMQI) of each
    operator.

    hdrlab first reduces the map to --size pixels along its longer side. Times and quality indices
    are for that size. `hdrlab tonemap --help` explains --gamut.
    """
    from hdrlab.io import radiance
    from hdrlab.show.pages import contact, sheet, wording
    from hdrlab.show.plots import figures

    sheet.check_suffix(out)
    names = operators.replace(" ", "").split(",") if operators else common.OPERATORS
    E = figures.fit(common.read_map(source, clean), size)
    unit = radiance.read_luminance_of_unit(source)
    if unit is None:
        unit = radiance.read_max_luminance_of_unit(source)
    steps = contact.entry_steps(E, names, way=gamut, luminance_of_unit=unit)
    entries = common.one_by_one(steps, names)
    description = wording.describe_map(E)
    sheet.write_sheet(out, sheet.draw(entries, title=f"{source.name}, {description}"))
    click.echo(f"{out}: {len(names)} operators, {description}")


@click.command(cls=common.Command)
@click.argument("source", type=common.INPUT_PATH)
@click.argument("reference", type=common.INPUT_PATH)
@click.option(
    "--peak",
    type=click.FloatRange(0, min_open=True),
    metavar="CD",
    help="Luminance of the brightest value of REFERENCE, in cd/m^2.  [default: its stated unit]",
)
@click.option(
    "--fit",
    is_flag=True,
    help="First multiply SOURCE by the factor that gives it the exposure of REFERENCE.",
)
@common.clean_option
def score(*, source: Path, reference: Path, peak: float | None, fit: bool, clean: bool) -> None:
    """Compare the radiance map SOURCE with the radiance map REFERENCE, the truth.

    hdrlab prints four scores: PSNR of radiance, PSNR of its logarithm (mu-law with mu = 5000), and
    PSNR and SSIM of perceptually uniform values (PU21). Larger is better. It also prints the
    conditions, because scores under different conditions cannot be compared.

    PU21 needs luminance in cd/m^2. hdrlab uses the unit that REFERENCE states, for example after
    `hdrlab assemble --calibrate`, or --peak. Without either, it prints only the first two scores.
    """
    from hdrlab.io import radiance
    from hdrlab.radiance import pu21, scores

    E = common.read_map(source, clean)
    truth = common.read_map(reference, clean)
    if E.shape != truth.shape:
        raise InputError(
            f"expected two maps of one size, got {_describe_shape(E)} in {source} and "
            f"{_describe_shape(truth)} in {reference}"
        )
    unit = radiance.read_luminance_of_unit(reference)
    source_unit = radiance.read_luminance_of_unit(source)
    factor = 1.0
    exposure = "exposure not fitted"
    if fit:
        factor = pu21.fit_exposure(E, truth)
        exposure = f"exposure fitted, {source} times {factor:.4g}"
    elif unit is not None and source_unit is not None:
        factor = source_unit / unit
    E = E * factor
    click.echo(f"{source} compared with {reference}, {_describe_shape(truth)}")
    click.echo(f"  {'PSNR':<12} {scores.psnr(E, truth):.2f} dB")
    click.echo(f"  {'log PSNR':<12} {scores.log_psnr(E, truth):.2f} dB")
    if peak is not None:
        unit = peak / float(truth.max())
    if unit is None:
        click.echo(f"  {'conditions':<12} {exposure}")
        click.echo(
            f"PU-PSNR and PU-SSIM need cd/m^2, and {reference} is in relative units; pass --peak, "
            "the cd/m^2 of its brightest value"
        )
        return
    click.echo(f"  {'PU-PSNR':<12} {pu21.psnr(E, truth, luminance_of_unit=unit):.2f} dB")
    click.echo(f"  {'PU-SSIM':<12} {pu21.ssim(E, truth, luminance_of_unit=unit):.4f}")
    brightest = unit * float(truth.max())
    source_of_unit = "stated in the map" if peak is None else "from --peak"
    click.echo(
        f"  {'conditions':<12} {exposure}; value 1 is {unit:.6g} cd/m^2 ({source_of_unit}), "
        f"brightest value {brightest:.4g} cd/m^2; PU21 banding_glare, peak 256"
    )


def _describe_shape(E: "F32") -> str:
    """Return the size and the channels of a radiance map in words."""
    height, width = E.shape[:2]
    return f"{width} x {height}, {'color' if E.ndim == 3 else 'gray'}"


@click.command(cls=common.Command)
@click.argument("source", type=common.INPUT_PATH)
@common.map_output_option
@click.option(
    "--half",
    is_flag=True,
    help="Write half-precision floats to .exr, with half the size and values up to 65504.",
)
@common.clean_option
def convert(*, source: Path, out: Path, half: bool, clean: bool) -> None:
    """Convert the radiance map SOURCE to the format that the name of the output states."""
    from hdrlab.io import radiance
    from hdrlab.show.pages import wording

    radiance.require_writable(out, half=half)
    E = common.read_map(source, clean)
    radiance.write_radiance(
        out,
        E,
        half=half,
        luminance_of_unit=radiance.read_luminance_of_unit(source),
        max_luminance_of_unit=radiance.read_max_luminance_of_unit(source),
    )
    click.echo(f"{out}: {wording.describe_map(E)}")


@click.command(cls=common.Command)
@click.argument("source", type=common.INPUT_PATH)
@click.argument("pixel", metavar="X,Y")
def why(*, source: Path, pixel: str) -> None:
    """Explain the pixel X,Y of the radiance map SOURCE.

    X counts the columns from the left, and Y the rows from the top, both from 0, as in `hdrlab
    assemble --calibrate`. hdrlab prints a table of the photos: the pixel values, their weight in the
    merge, the photo's share of the mean, the radiance that it gives, and whether it agrees with the
    map. It also prints the standard deviation, what the other merges would give, and a summary.

    The table needs the photos. `hdrlab assemble PHOTOS -o room.exr --why` stores them aligned in
    room.why.npz, next to the map. Keep the two files together.
    """
    from hdrlab.io import radiance
    from hdrlab.pipeline import evidence_file

    x, y = common.parse_pixel(pixel)
    E = radiance.read_radiance(source)
    path = evidence_file.evidence_path(source)
    if not path.is_file():
        raise InputError(
            f"{source} has no file {path.name} beside it, which holds its photos; "
            "assemble them again with --why"
        )
    explanation = evidence_file.explain_map_pixel(path, E, y, x, map_name=str(source))
    for line in str(explanation).splitlines():
        click.echo(terminal.visible(line))


def _describe_light(path: Path) -> dict[str, str]:
    """Return the range and the unit of a radiance map; nothing for photos and unreadable maps."""
    from hdrlab.core.extremes import decades
    from hdrlab.io import radiance

    if path.suffix.lower() not in radiance.READ:
        return {}
    try:
        E = radiance.read_radiance(path)
        unit = radiance.read_luminance_of_unit(path)
    except InputError:
        return {}  # the header is described, and the other commands say what is wrong
    light = {"range": "all black"}
    if E.any():
        span = decades(E)
        stops = span / math.log10(2)
        light["range"] = f"{stops:.1f} stops ({span:.1f} decades), 0.1 % to 99.9 %"
    light["unit"] = "relative" if unit is None else f"{unit:.6g} cd/m^2"
    return light


@click.command(cls=common.Command)
@click.argument("files", nargs=-1, required=True, type=common.INPUT_PATH)
def info(*, files: tuple[Path, ...]) -> None:
    """Describe FILES, which are radiance maps, photos or folders of photos.

    hdrlab prints the format, size and values of each file, the range and the unit of a map, and
    the exposure of a photo or that it states none. For a folder, it prints a
    table: the exposure of each photo, its exposure value (EV at ISO 100), the camera, and what the
    photo does not state. If the folder holds several brackets, each has its own table.
    """
    from hdrlab.show import bracket_table
    from hdrlab.show.describe import describe_file

    for file in files:
        if file.is_dir():
            click.echo(file)
            for line in bracket_table.describe_folder(file):
                click.echo(f"  {terminal.visible(line)}".rstrip())
            continue
        description = describe_file(file) | _describe_light(file)
        click.echo(description.pop("file"))
        for key, value in description.items():
            click.echo(f"  {key:<12} {terminal.visible(value)}")
