"""Commands that begin with photographs."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hdrlab.cli import common, curves
from hdrlab.pipeline import catalogue

if TYPE_CHECKING:
    from hdrlab.core.bracket import Bracket
    from hdrlab.pipeline.assembly import Assembly


@click.command()
@click.argument("photos", nargs=-1, required=True, type=common.FILE)
@click.option(
    "-o", "--out", required=True, type=common.FILE, help=f"Radiance map to write: {common.SUFFIXES}."
)
@click.option(
    "--times",
    metavar="exif|estimate|FILE",
    default="exif",
    help="Exposure times: of EXIF; these, corrected by the pixels; a CSV, or lines of `name 1/seconds`.",
)
@click.option("--estimate-times", is_flag=True, help="Correct the times of a FILE by the pixels, too.")
@click.option(
    "--mask", metavar="RRGGBB", help="Pixels of exactly this colour are no picture (borders of scans)."
)
@click.option(
    "--align",
    type=click.Choice(["auto", *catalogue.names("align"), "none"]),
    default="mtb",
    help="mtb shifts; cerman turns, too; homography takes scale and tilt; auto takes what fits best.",
)
@click.option("--response", type=curves.Response(), default="auto", help="A method, or a saved curve.")
@click.option("--weight", type=click.Choice(["gaussian", "hat", "flat", "snr"]), default="gaussian")
@click.option("--merge", type=click.Choice(["log", "likelihood", "mean", "shot"]), default="log")
@click.option(
    "--ghosts",
    type=click.Choice(["none", "regions", "reference"]),
    default="none",
    help="What moved: as it is; each region by its best exposure; all of them by the middle photograph.",
)
@click.option(
    "--flare",
    type=click.Choice(["none", "glare"]),
    default="none",
    help="Remove veiling glare, the light that the lens scattered.",
)
@click.option("--tonemap", type=click.Choice(catalogue.names("tonemap")), default="reinhard")
@click.option(
    "--picture", type=common.FILE, help="Picture to write as well, tone-mapped: .png, .jpg or .tif."
)
@click.option("--report", type=common.FILE, help="Folder for report.html: bracket, response, map, picture.")
@click.option("--force", is_flag=True, help="Write the map even where the photographs put it in doubt.")
def assemble(
    photos: tuple[Path, ...],
    out: Path,
    times: str,
    estimate_times: bool,
    mask: str | None,
    tonemap: str,
    picture: Path | None,
    report: Path | None,
    force: bool,
    merge: str,
    response: str | Path,
    **methods: str,
) -> None:
    """Assemble PHOTOS (files, or one folder) into a radiance map.

    Exposure comes from EXIF (time, ISO, f-number), or from --times. A file that is called exif or estimate is
    reached as ./exif.
    """
    from hdrlab import pipeline
    from hdrlab.io import photos as files
    from hdrlab.io import radiance

    recover = curves.method_or_curve(response)
    radiance.format_of(out)  # an unknown suffix is better known before the work than after it
    bracket = files.read_bracket(
        photos[0] if len(photos) == 1 else photos,
        None if times in ("exif", "estimate") else Path(times),
        mask=common.colour(mask),
        progress=lambda paths: common.progress(paths, "reading"),
    )
    methods["method"] = merge
    methods["times"] = "estimate" if estimate_times or times == "estimate" else "stated"
    assembly = _assembled(bracket, methods | {"response": recover})
    _tell(assembly, force)
    radiance.write_radiance(out, assembly.E)
    if picture or report:
        rendered = pipeline.develop(assembly.E, tonemap)
        if picture:
            files.write_picture(picture, rendered)
        if report:
            from hdrlab.show.pages.report import write_report

            write_report(
                report, assembly, rendered, recipe={"response": response} | methods | {"tonemap": tonemap}
            )
    click.echo(f"{out}: {common.size(assembly.E)}, frames agree to {assembly.spread:.3f} stops")


def _assembled(bracket: "Bracket", methods: dict[str, Any]) -> "Assembly":
    """Return what the pipeline makes of a bracket, with progress."""
    from hdrlab import pipeline
    from hdrlab.core.steps import last
    from hdrlab.pipeline.registration import BY_LIGHT

    steps = pipeline.assemble_steps(bracket, **methods)
    asked = sum(methods[stage] != "none" for stage in ("ghosts", "flare"))
    count = len(pipeline.STAGES) + (methods["times"] == "estimate") + asked
    if methods["align"] in BY_LIGHT:  # the first stage takes seconds a photograph
        return last(common.one_by_one(steps, ["aligning", *["the map"] * (count - 1)]))
    return last(common.progress(steps, "assembling", count))


def _tell(assembly: "Assembly", force: bool) -> None:
    """Print notes and doubts, or raise a ValueError where doubts forbid to write the map."""
    for note in assembly.notes:
        click.echo(f"note: {note}", err=True)
    if assembly.doubts and not force:
        said = "; ".join(assembly.doubts)
        raise ValueError(f"{said} (nothing was written; --force writes the map as it is)")
    for doubt in assembly.doubts:
        click.echo(f"warning: {doubt}", err=True)
