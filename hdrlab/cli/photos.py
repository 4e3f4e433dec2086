"""The commands that start from photos: `assemble` and `calibrate`."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hdrlab.cli import brackets, common, terminal
from hdrlab.errors import HdrlabError, InputError
from hdrlab.pipeline import catalogue

if TYPE_CHECKING:
    from collections.abc import Iterable

    from hdrlab.core.bracket import Bracket
    from hdrlab.diagnostics.noise import Noise
    from hdrlab.io.decode import PhotoHeader
    from hdrlab.pipeline.assembly import Assembly

ALIGN_METHODS = ["auto", *catalogue.names("align"), "none"]

# "linear" needs no photos
CALIBRATION_METHODS = [name for name in catalogue.names("response") if name != "linear"]

EXIT_DOUBTFUL_MAP = 3
MAX_WARNING_LINES = 3


@click.command(cls=common.Command)
@click.argument("photos", nargs=-1, required=True, type=common.INPUT_PATH)
@common.map_output_option
@click.option(
    "--times",
    metavar="exif|estimate|FILE",
    default="exif",
    help="Source of the exposure times, see above.",
)
@click.option(
    "--keep-times",
    is_flag=True,
    help="Use the times of EXIF or FILE as they are, even if the pixels contradict them.",
)
@click.option(
    "--stops",
    type=click.FloatRange(0, min_open=True),
    help="Stops between one photo and the next, if no times are known.",
)
@common.mask_option
@common.choice_option("--align", ALIGN_METHODS, help="Alignment method, see above.")
@click.option(
    "--response",
    type=brackets.ResponseType(),
    default="auto",
    help="Method that estimates the response curve, or a file with a saved curve.",
)
@common.choice_option(
    "--weight", ["gaussian", "hat", "flat", "snr"], help="Weight function of the pixel values."
)
@common.choice_option(
    "--merge",
    ["shot", "log", "likelihood", "mean"],
    help="Mean of the exposures. shot and likelihood prefer long exposures, log is the lecture's.",
)
@common.choice_option(
    "--ghosts",
    ["none", "auto", "regions", "reference"],
    "auto",
    help="Removal of moving objects, see above.",
)
@common.choice_option(
    "--flare", ["none", "glare"], help="Removal of veiling glare, the light scattered in the lens."
)
@click.option(
    "--calibrate",
    metavar="X,Y=CD",
    help="Scale the map so that the pixel X,Y has CD cd/m^2, as read from a light meter.",
)
@common.operator_option
@click.option(
    "--picture",
    type=common.OUTPUT_PICTURE,
    help="Tone-mapped image to write as well: .png, .jpg or .tif.",
)
@click.option(
    "--report",
    type=common.INPUT_PATH,
    help="Folder for report.html, which shows photos, response, map and image.",
)
@click.option(
    "--uncertainty",
    type=common.OUTPUT_FILE,
    help="File for the map and its standard deviation, as two layers: .exr.",
)
@click.option(
    "--noise",
    "noise_file",
    type=common.INPUT_PATH,
    help="Noise of the camera for --uncertainty, as measured by hdrlab noise: .json. Without it, "
    "hdrlab estimates the noise from the photos.",
)
@click.option(
    "--why",
    is_flag=True,
    help="Write a file next to the map, with which `hdrlab why` explains its pixels. The file is about "
    "as large as the photos.",
)
@click.option(
    "--strict",
    is_flag=True,
    help=f"Exit with code {EXIT_DOUBTFUL_MAP} if there are warnings. hdrlab still writes the map.",
)
@click.option(
    "--all",
    "all_brackets",
    is_flag=True,
    help="Assemble each bracket of a folder. The name of its first photo is added to each output.",
)
@click.option(
    "-v", "--verbose", is_flag=True, help="Show how hdrlab made the map, and all warnings."
)
@click.pass_context
def assemble(
    ctx: click.Context,
    /,
    *,
    photos: tuple[Path, ...],
    out: Path,
    times: str,
    keep_times: bool,
    stops: float | None,
    mask: str | None,
    align: str,
    response: str | Path,
    weight: str,
    merge: str,
    ghosts: str,
    flare: str,
    calibrate: str | None,
    operator: str,
    picture: Path | None,
    report: Path | None,
    uncertainty: Path | None,
    noise_file: Path | None,
    why: bool,
    strict: bool,
    all_brackets: bool,
    verbose: bool,
) -> None:
    """Assemble PHOTOS (files, or one folder) into a radiance map.

    From a folder, hdrlab uses the photos that form one bracket, and lists the ones it skipped. If
    the folder holds several brackets, hdrlab uses the first, or each with --all. `hdrlab info
    FOLDER` lists the photos and the brackets of a folder.

    --times exif (the default) reads time, ISO and f-number from EXIF. If EXIF has no times, hdrlab
    looks in the folder for a list with lines such as `a.jpg 1/60`. --times FILE reads such a list.
    In both cases, hdrlab corrects times that the pixels contradict, unless you pass --keep-times.
    --times estimate computes all times from the pixels.

    --align mtb shifts the photos onto each other. --align cerman also rotates them, and --align
    homography also corrects perspective. --align auto starts with mtb and uses the other methods
    only if mtb is not enough.

    --ghosts regions finds regions in which something moved, and takes each from the photo that
    exposed it best. --ghosts auto does so if the photos contradict each other somewhere.
    --ghosts reference takes all moving objects from the middle photo.

    If EXIF states time, ISO and f-number, hdrlab knows how bright the scene was, and the image of a
    night stays dark. If ISO or f-number is missing, hdrlab assumes the brightest scene that the
    times allow, with ISO 100 and f/11.

    hdrlab writes the map even if there are warnings. The report and the header of an .hdr or .exr
    file repeat them. If nothing is wrong, hdrlab prints one line that begins with OK.
    """
    from hdrlab import pipeline
    from hdrlab.show.pages import wording

    # bad options are reported before the work starts
    _check_times_options(times, stops)
    recover = brackets.saved_curve(response) if isinstance(response, Path) else response
    meter_reading = common.parse_meter_reading(calibrate) if calibrate else None
    outputs = _Outputs(
        radiance_map=out,
        picture=picture,
        report=report,
        uncertainty=uncertainty,
        evidence=_choose_evidence_path(out) if why else None,
    )
    _check_outputs(outputs)
    if noise_file and not uncertainty:
        raise InputError("--noise is used only with --uncertainty; add it, or leave --noise out")
    measured_noise = _MeasuredNoise(noise_file) if noise_file else None
    if all_brackets:
        _assemble_each(ctx, photos)
        return

    remarks = _Remarks(verbose)
    bracket = brackets.read_bracket(
        photos,
        times,
        mask,
        stops,
        note=remarks.note,
        detail=remarks.detail,
        check=measured_noise.require_same_camera if measured_noise else None,
    )
    noise = measured_noise.of_bracket(bracket, remarks) if measured_noise else None
    if meter_reading:
        _require_inside(meter_reading, bracket)
    times_mode = _choose_times_mode(times, keep_times=keep_times)
    steps = pipeline.assemble_steps(
        bracket,
        in_place=True,
        release=not (report or uncertainty or why),
        align=align,
        response=recover,
        times=times_mode,
        weight=weight,
        merge=merge,
        ghosts=ghosts,
        flare=flare,
    )
    del bracket
    optional_stages = (times_mode != "stated", ghosts != "none", flare != "none")
    stages = len(pipeline.STAGES) - 1 + sum(optional_stages)
    assembly = _run_steps(steps, stages, align)
    if uncertainty:
        assembly = pipeline.measure_deviation(assembly, noise)
    if meter_reading:
        assembly = pipeline.calibrate(assembly, *meter_reading)
    assembly = _print_remarks(assembly, remarks, has_picture=outputs.has_picture)
    common.echo_warnings(assembly.warnings if verbose else _shorten(assembly.warnings))
    recipe: dict[str, object] = {
        "response": response,
        "align": align,
        "weight": weight,
        "ghosts": ghosts,
        "flare": flare,
        "merge": merge,
        "times": times_mode,
    }
    descriptions = _write_outputs(outputs, assembly, operator, recipe, remarks)
    click.echo(wording.summarize_assembly(assembly, descriptions))
    if strict and assembly.warnings:
        ctx.exit(EXIT_DOUBTFUL_MAP)


@dataclass(frozen=True)
class _Outputs:
    """The files that `assemble` writes. A path is None if the user did not ask for the file."""

    radiance_map: Path
    picture: Path | None
    report: Path | None
    uncertainty: Path | None
    evidence: Path | None

    @property
    def has_picture(self) -> bool:
        """Whether the map is tone-mapped, for an image file or for the report."""
        return bool(self.picture or self.report)


def _check_times_options(times: str, stops: float | None) -> None:
    """Raise an InputError if --times has an old value, or contradicts --stops."""
    if times == "stated":
        raise InputError("--times stated has a new name: use --keep-times")
    if stops and times not in brackets.TIMES_KEYWORDS:
        raise InputError(f"--stops and --times {times} exclude each other; pass one of them")


def _choose_evidence_path(map_path: Path) -> Path:
    """Return the path of the file for `hdrlab why`, which belongs to a map."""
    # imported only here, because it imports more of SciPy than the other options need
    from hdrlab.pipeline import evidence_file

    return evidence_file.evidence_path(map_path)


def _check_outputs(outputs: _Outputs) -> None:
    """Raise an InputError if one of the files cannot be written under its name."""
    from hdrlab.io.files import require_folder_name, require_replaceable, require_suffix

    if outputs.report:
        require_folder_name(outputs.report)
    if outputs.uncertainty:
        require_suffix(outputs.uncertainty, [".exr"], "a map with its standard deviation")
    if outputs.evidence:
        require_replaceable(outputs.evidence)


def _require_inside(meter_reading: tuple[int, int, float], bracket: "Bracket") -> None:
    """Raise an InputError if the pixel of a meter reading is outside of the photos."""
    height, width = bracket.images.shape[1:3]
    x, y, _ = meter_reading
    if x >= width or y >= height:
        raise InputError(
            f"--calibrate: pixel {x},{y} is outside of the photos, which have {width} x {height} "
            "pixels"
        )


def _choose_times_mode(times: str, *, keep_times: bool) -> str:
    """Return the value of the pipeline's option `times` for --times and --keep-times."""
    if times == "estimate":
        return "estimate"
    if keep_times:
        return "stated"
    return "correct"


def _print_remarks(assembly: "Assembly", remarks: "_Remarks", *, has_picture: bool) -> "Assembly":
    """Print the notes and details of an assembly, and add those of reading its photos to it."""
    from hdrlab.pipeline import pictures

    if assembly.fallback and has_picture:
        assembly = assembly.with_note(f"{pictures.FUSION_NOTE}, because {assembly.fallback}")
    for note in assembly.notes:
        remarks.note(note)
    for detail in assembly.details:
        remarks.detail(detail)
    return replace(assembly, notes=tuple(remarks.notes), details=tuple(remarks.details))


def _write_outputs(
    outputs: _Outputs,
    assembly: "Assembly",
    operator: str,
    recipe: dict[str, object],
    remarks: "_Remarks",
) -> list[str]:
    """Write all files, and return a description of each."""
    from concurrent.futures import ThreadPoolExecutor

    from hdrlab.io import photos as photo_files, radiance
    from hdrlab.pipeline import pictures
    from hdrlab.show.pages import wording

    comments = [f"warning: {warning}" for warning in assembly.warnings]
    # the map is written while the image is made, and also if making the image fails
    with ThreadPoolExecutor(1) as executor:
        writing = executor.submit(
            radiance.write_radiance,
            outputs.radiance_map,
            assembly.E,
            comments=comments,
            luminance_of_unit=assembly.bracket.luminance_of_unit,
            max_luminance_of_unit=assembly.bracket.max_luminance_of_unit,
        )
        map_description = executor.submit(wording.describe_map, assembly.E)
        developed = None
        if outputs.has_picture:
            developed = pictures.develop_assembly(assembly, operator)
        if outputs.uncertainty:
            _write_uncertainty(outputs.uncertainty, assembly, comments)
        if outputs.evidence:
            from hdrlab.pipeline import evidence_file

            evidence_file.write_evidence(outputs.evidence, assembly)
        if developed and outputs.picture:
            photo_files.write_picture(outputs.picture, developed.picture, is_result=True)
            remarks.detail(f"{outputs.picture}: {developed.settings}")
        if developed and outputs.report:
            from hdrlab.show.pages.report import write_report

            full_recipe = {**recipe, "tonemap": developed.settings}
            write_report(outputs.report, assembly, developed.picture, recipe=full_recipe)
        writing.result()
    descriptions = [f"{outputs.radiance_map} ({map_description.result()})"]
    if outputs.picture:
        descriptions.append(wording.describe_picture(str(outputs.picture), assembly, operator))
    if outputs.uncertainty:
        descriptions.append(_describe_uncertainty(outputs.uncertainty, assembly))
    if outputs.evidence:
        descriptions.append(_describe_evidence(outputs.evidence))
    if outputs.report:
        descriptions.append(str(outputs.report / "report.html"))
    return descriptions


def _write_uncertainty(path: Path, assembly: "Assembly", comments: list[str]) -> None:
    """Write the map and its standard deviation as layers; do nothing if there is no deviation."""
    from hdrlab.io import radiance
    from hdrlab.io.maps import layers

    if assembly.s is None:
        return
    unit = assembly.bracket.luminance_of_unit
    unit_comments = [] if unit is None else [radiance.describe_unit(unit)]
    both = dict(zip(layers.UNCERTAINTY_LAYERS, (assembly.E, assembly.s), strict=True))
    layers.write_layers(path, both, comments=[*unit_comments, *comments])


class _MeasuredNoise:
    """The noise of a camera that --noise names, and the photos of a bracket of this camera."""

    def __init__(self, path: Path) -> None:
        from hdrlab.pipeline import camera_noise_file

        self.path = path
        self.camera = camera_noise_file.read_camera_noise(path)
        self.headers: list[PhotoHeader] = []

    def require_same_camera(self, headers: "list[PhotoHeader]") -> None:
        """Raise an InputError unless the photos are RAW files of this camera and ISO speed."""
        from hdrlab.pipeline import camera_noise

        try:
            camera_noise.require_same_camera(self.camera, headers)
        except InputError as error:
            raise InputError(f"--noise {self.path}: {error}") from None
        self.headers = headers

    def of_bracket(self, bracket: "Bracket", remarks: "_Remarks") -> "Noise":
        """Return the noise of the developed photos; a note repeats the warnings of the file."""
        from hdrlab.pipeline import camera_noise

        for warning in self.camera.warnings:
            remarks.note(f"{self.path}: {warning.text}")
        paths = [header.path for header in self.headers]
        shortest = next(path for path in paths if path.name == bracket.names[0])
        return camera_noise.noise_of_developed(self.camera, shortest)


def _assemble_each(ctx: click.Context, photos: tuple[Path, ...]) -> None:
    """Assemble each bracket of a folder. A bracket that fails does not stop the others."""
    from hdrlab.io import album, files

    if len(photos) != 1 or not photos[0].is_dir():
        raise InputError("--all needs one folder; pass the folder that holds the photos")
    all_headers, selection = album.select_brackets(photos)
    bracket_paths = [[header.path for header in headers] for headers in all_headers]
    common.echo_notes(selection.notes)
    common.echo_warnings(selection.damaged)
    outputs = []
    for paths in bracket_paths:
        named = {}
        for option in ("out", "picture", "uncertainty", "report"):
            path = ctx.params[option]
            named[option] = path and _add_photo_name(path, paths[0], is_folder=option == "report")
        outputs.append(named)
    written = [path for named in outputs for path in named.values() if path]
    files.require_distinct(written)
    files.require_other(written, [path for paths in bracket_paths for path in paths])
    exit_code = 0
    failed = []
    for number, (paths, named) in enumerate(zip(bracket_paths, outputs, strict=True), 1):
        title = f"{paths[0].name} to {paths[-1].name}"
        click.echo(f"bracket {number} of {len(bracket_paths)}: {title}", err=True)
        settings = {**ctx.params, **named, "photos": tuple(paths), "all_brackets": False}
        try:
            ctx.invoke(assemble, **settings)
        except (HdrlabError, OSError, MemoryError) as error:
            failed.append(title)
            reason = str(error)
            if isinstance(error, MemoryError):
                reason = common.describe_memory_error(error, assemble)
            click.echo(f"hdrlab: {terminal.visible(reason)}", err=True)
        except click.exceptions.Exit as stop:
            exit_code = stop.exit_code
    if failed:
        names = "; ".join(failed)
        raise InputError(f"{len(failed)} of {len(bracket_paths)} brackets have no map: {names}")
    ctx.exit(exit_code)


def _add_photo_name(output: Path, photo: Path, *, is_folder: bool) -> Path:
    """Return the path of an output with the name of a bracket's first photo added."""
    if is_folder:
        return output / photo.stem
    return output.with_name(f"{output.stem}_{photo.stem}{output.suffix}")


def _run_steps(steps: "Iterable[Assembly]", count: int, align: str) -> "Assembly":
    """Run the stages of the pipeline, show progress, and return the last state."""
    from hdrlab.core.steps import last
    from hdrlab.pipeline.alignment import SEARCHES

    if align in SEARCHES:
        # these take seconds a photo, in which a bar of stages stands still
        names = ["aligning", *["the map"] * (count - 1)]
        return last(common.one_by_one(steps, names))
    return last(common.progress(steps, "assembling", count))


class _Remarks:
    """The notes and details on a bracket. Each is printed when it comes, details if `verbose`."""

    def __init__(self, verbose: bool) -> None:
        self.verbose = verbose
        self.notes: list[str] = []
        self.details: list[str] = []

    def note(self, text: str) -> None:
        """Print a note, and keep it for the report."""
        common.echo_notes([text])
        self.notes.append(text)

    def detail(self, text: str) -> None:
        """Keep a detail for the report, and print it if details are shown."""
        if self.verbose:
            common.echo_details([text])
        self.details.append(text)


def _describe_uncertainty(path: Path, assembly: "Assembly") -> str:
    """Return the name of the file with the standard deviation, and how large this is."""
    from hdrlab.show.pages import wording

    if assembly.s is None:
        return str(path)
    return f"{path} ({wording.certainty(assembly.E, assembly.s)})"


def _describe_evidence(path: Path) -> str:
    """Return the name of the file for `hdrlab why`, and its size."""
    megabytes = path.stat().st_size / 1e6
    return f"{path} ({megabytes:.2g} MB)" if megabytes < 10 else f"{path} ({megabytes:.0f} MB)"


def _shorten(warnings: tuple[str, ...]) -> tuple[str, ...]:
    """Return at most MAX_WARNING_LINES warnings. The last line counts those that are left out."""
    if len(warnings) <= MAX_WARNING_LINES:
        return warnings
    shown = warnings[: MAX_WARNING_LINES - 1]
    hidden = len(warnings) - len(shown)
    return *shown, f"{hidden} more warnings; pass --verbose to see all of them"


@click.command(cls=common.Command)
@click.argument("photos", nargs=-1, required=True, type=common.INPUT_PATH)
@click.option(
    "-o",
    "--out",
    multiple=True,
    type=common.OUTPUT_FILE,
    help=f"Curve to write: {brackets.CURVE_SUFFIXES}. Repeatable.",
)
@click.option(
    "--times",
    metavar="exif|estimate|FILE",
    default="exif",
    help="Source of the times: EXIF, an estimate from the pixels, or a list in a FILE.",
)
@click.option(
    "--correct-times", is_flag=True, help="Use the pixels to correct the times of EXIF or FILE."
)
@common.mask_option
@common.choice_option("--align", ALIGN_METHODS, "mtb", help="Alignment method, as in assemble.")
@common.choice_option(
    "--response", CALIBRATION_METHODS, "debevec", help="Method that estimates the curve."
)
@click.option(
    "--plot",
    type=common.OUTPUT_FILE,
    help="Figure of the curve and its residuals to write: .png or .svg.",
)
def calibrate(
    *,
    photos: tuple[Path, ...],
    out: tuple[Path, ...],
    times: str,
    correct_times: bool,
    mask: str | None,
    align: str,
    response: str,
    plot: Path | None,
) -> None:
    """Estimate the camera's response curve from PHOTOS.

    PHOTOS are files, or one folder. hdrlab prints a table of the pixel values at which the exposure
    doubles, and how far each photo deviates from the curve.
    """
    from hdrlab import pipeline
    from hdrlab.io import response_files
    from hdrlab.pipeline import recovery
    from hdrlab.show import plots
    from hdrlab.show.plots import calibration

    # bad options are reported before the work starts
    for path in out:
        response_files.suffix_of(path)
    if plot:
        calibration.check_suffix(plot)

    remarks = _Remarks(verbose=True)
    bracket = brackets.read_bracket(
        photos, times, mask, None, note=remarks.note, detail=remarks.note
    )
    last_stage = "align"
    times_mode = "stated"
    if correct_times or times == "estimate":
        last_stage = "times"
        times_mode = "estimate"
    steps = pipeline.assemble_steps(bracket, align=align, response=response, times=times_mode)
    aligned = next(state for state in steps if state.stage == last_stage)
    common.echo_notes([*aligned.notes, *aligned.details, *aligned.warnings])

    # this method keeps only a plausible response
    recover = recovery.find_validated_method(response)
    g = recover(aligned.bracket.images, aligned.bracket.times, valid=aligned.bracket.valid)
    assembly = pipeline.assemble(
        aligned.bracket, align="none", response=lambda *_, **__: g, times="stated"
    )
    common.echo_warnings(assembly.warnings)
    click.echo(f"{response}, from {len(assembly.bracket.times)} photos")
    click.echo(calibration.summary(assembly.g, assembly.medians, assembly.bracket.names))
    for path in out:
        response_files.write_curve(path, assembly.g)
        click.echo(path)
    if plot:
        exposures = plots.exposures(assembly.bracket)
        figure = calibration.calibration(assembly.g, assembly.medians, exposures, title=response)
        calibration.write_plot(plot, figure)
        click.echo(plot)
