"""Commands that begin with photographs."""

from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hdrlab.cli import common, curves
from hdrlab.errors import InputError
from hdrlab.pipeline import catalogue

if TYPE_CHECKING:
    from hdrlab.core.bracket import Bracket
    from hdrlab.pipeline.assembly import Assembly
    from hdrlab.pipeline.pictures import Developed

WORDS = ("exif", "stated", "estimate")
FUSION = "the picture is an exposure fusion of the photographs"


@common.command()
@click.argument("photos", nargs=-1, required=True, type=common.FILE)
@click.option(
    "-o", "--out", required=True, type=common.OUT, help=f"Radiance map: {common.SUFFIXES}."
)
@click.option(
    "--times", metavar="exif|stated|estimate|FILE", default="exif", help="Exposure, see above."
)
@click.option("--keep-times", is_flag=True, help="Take the times of a FILE as they are, too.")
@click.option(
    "--stops", type=click.FloatRange(0, min_open=True), help="No times, but frames so far apart."
)
@common.MASK
@common.choice(
    "--align", ["auto", *catalogue.names("align"), "none"], help="What may move, see above."
)
@click.option(
    "--response", type=curves.Response(), default="auto", help="A method, or a saved curve."
)
@common.choice("--weight", ["gaussian", "hat", "flat", "snr"])
@common.choice("--merge", ["log", "likelihood", "mean", "shot"])
@common.choice(
    "--ghosts", ["none", "auto", "regions", "reference"], "auto", help="What moved, see above."
)
@common.choice(
    "--flare", ["none", "glare"], help="Remove veiling glare, the light that the lens scattered."
)
@click.option(
    "--calibrate", metavar="X,Y=CD", help="What a meter read at a pixel, cd/m^2: the map's unit."
)
@common.operator("--tonemap")
@click.option(
    "--picture", type=common.OUT, help="Picture to write as well, tone-mapped: .png, .jpg or .tif."
)
@click.option(
    "--report", type=common.FILE, help="Folder for report.html: bracket, response, map, picture."
)
@click.option(
    "--uncertainty", type=common.OUT, help="Map and standard deviation as two layers: .exr."
)
@click.option(
    "--strict", is_flag=True, help="Exit with 3 where the map is doubtful; it is written, too."
)
def assemble(asked: Any) -> None:
    """Assemble PHOTOS (files, or one folder) into a radiance map.

    Exposure comes from EXIF (time, ISO, f-number), or from a list in the folder. The pixels correct
    its times (--times exif), or leave them as they are (stated), or are asked for all of them
    (estimate). A FILE is a list with lines such as `a.jpg 1/60`; one that is called exif or
    estimate is reached as ./exif.

    By --align mtb the photographs are shifted onto each other; cerman rotates them, too, and
    homography tilts them; auto is mtb, and more where that is too little. By --ghosts regions, what
    moved is taken region by region from the photograph that exposed it best, with auto only if much
    moved; by reference, all of it from the middle photograph.

    The map is written even where it is doubtful: then warnings say why and what to do, the report
    and the header of .hdr and .exr repeat them, and --strict makes them an exit code.
    """
    from hdrlab import pipeline
    from hdrlab.io import photos as files, radiance
    from hdrlab.io.files import require_suffix
    from hdrlab.io.maps import layers
    from hdrlab.show.pages import wording

    recover = curves.method_or_curve(asked.response)
    metered = asked.calibrate and common.reading(asked.calibrate)
    radiance.format_of(asked.out)  # an unknown suffix is better known before the work than after it
    if asked.uncertainty:
        require_suffix(asked.uncertainty, [".exr"], "a map with its standard deviation")
    kept = "stated" if asked.keep_times or asked.times == "stated" else "correct"
    methods = {stage: getattr(asked, stage) for stage in ("align", "weight", "ghosts", "flare")}
    methods |= {"method": asked.merge, "times": "estimate" if asked.times == "estimate" else kept}
    knobs = {"response": recover, "release": not (asked.report or asked.uncertainty)}
    assembly = _assembled(
        read_bracket(asked.photos, asked.times, asked.mask, asked.stops), methods | knobs
    )
    if asked.uncertainty:
        assembly = pipeline.measure_deviation(assembly)
    if metered:
        assembly = pipeline.calibrate(assembly, *metered)
    if assembly.fallback and (asked.picture or asked.report):
        assembly = assembly._replace(notes=(*assembly.notes, f"{FUSION}, for {assembly.fallback}"))
    common.say("note", assembly.notes)
    common.say("warning", _shorten(assembly.doubts))
    comments = ["unit: cd/m^2"] * bool(metered) + [f"doubt: {doubt}" for doubt in assembly.doubts]
    with ThreadPoolExecutor(1) as beside:  # the picture, and without one that fails
        writing = beside.submit(radiance.write_radiance, asked.out, assembly.E, comments=comments)
        size = beside.submit(common.size, assembly.E)
        shown = _develop(assembly, asked.tonemap) if asked.picture or asked.report else None
        if asked.uncertainty and assembly.s is not None:
            both = dict(zip(layers.CERTAIN, (assembly.E, assembly.s), strict=True))
            layers.write_layers(asked.uncertainty, both, comments=comments)
            click.echo(f"{asked.uncertainty}: {wording.certainty(assembly.E, assembly.s)}")
        if shown and asked.picture:
            files.write_picture(asked.picture, shown.picture)
            click.echo(f"{asked.picture}: {shown.settings}")
        if shown and asked.report:
            from hdrlab.show.pages.report import write_report

            recipe = {"response": asked.response} | methods | {"tonemap": shown.settings}
            write_report(asked.report, assembly, shown.picture, recipe=recipe)
        writing.result()
    click.echo(f"{asked.out}: {size.result()}, {common.agreement(assembly.spread)}")
    if asked.strict and assembly.doubts:
        click.get_current_context().exit(3)


def _develop(assembly: "Assembly", tonemap: str) -> "Developed":
    """Return the picture of a map, or where it is worth none of the photographs, fused."""
    import numpy as np

    from hdrlab.pipeline import pictures

    if not assembly.fallback:
        return pictures.develop_and_describe(assembly.E, tonemap)
    from hdrlab.fast import mertens

    fused = np.rint(255 * mertens.fuse(assembly.bracket.images).clip(0, 1)).astype(np.uint8)
    return pictures.Developed(fused, FUSION)


def read_bracket(
    photos: tuple[Path, ...], times: str, mask: str | None, stops: float | None
) -> "Bracket":
    """Return the bracket of PHOTOS with times by --times or --stops; all are 1 where there are none."""
    from hdrlab import pipeline
    from hdrlab.io import album, photos as files
    from hdrlab.io.decode import look

    colour, (paths, _) = common.colour(mask), album.select(photos)
    given: Any = None if times in WORDS else Path(times)
    if stops:
        given = [1.0] * len(paths)
    elif given is None and not all(look(path).exposure.seconds for path in paths):
        given = _find_list(paths)
        if given:
            click.echo(f"note: the exposure times are those of {given}", err=True)
        elif times == "estimate":
            given = [1.0] * len(paths)
    bracket = files.read_bracket(
        photos,
        given,
        mask=colour,
        note=lambda said: click.echo(f"note: {said}", err=True),
        progress=lambda some: common.progress(some, "reading"),
    )
    return pipeline.space_by_stops(bracket, stops) if stops else bracket


def _find_list(paths: list[Path]) -> Path | None:
    """Return the list of times that lies beside photographs and names all of them, or None."""
    from hdrlab.io.exif_exposure import Exposure
    from hdrlab.io.times import bracket_times

    folder = paths[0].parent
    for file in sorted([*folder.glob("*.csv"), *folder.glob("*.txt")]):
        # A file that is no list of times, a folder, and a file that is not ours to read.
        with suppress(InputError, OSError):
            bracket_times([path.name for path in paths], [Exposure()], file)
            return file
    return None


def _shorten(doubts: tuple[str, ...], most: int = 3) -> tuple[str, ...]:
    """Return the doubts in at most so many lines; the last one counts those that are left out."""
    if len(doubts) <= most:
        return doubts
    return *doubts[
        : most - 1
    ], f"{len(doubts) - most + 1} more doubts stand in the report (--report FOLDER)"


def _assembled(bracket: "Bracket", methods: dict[str, Any]) -> "Assembly":
    """Return what the pipeline makes of a bracket, with progress."""
    from hdrlab import pipeline
    from hdrlab.core.steps import last
    from hdrlab.pipeline.alignment import SEARCHES

    steps = pipeline.assemble_steps(bracket, in_place=True, **methods)
    asked = sum(methods[stage] != "none" for stage in ("ghosts", "flare"))
    count = len(pipeline.STAGES) - (methods["times"] == "stated") + asked
    if methods["align"] in SEARCHES:  # the first stage takes seconds a photograph
        return last(common.one_by_one(steps, ["aligning", *["the map"] * (count - 1)]))
    return last(common.progress(steps, "assembling", count))
