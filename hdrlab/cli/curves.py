"""The command that finds a camera's response, and what `assemble` needs to use one that was saved."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from hdrlab.cli import common
from hdrlab.pipeline import catalogue

METHODS = [
    name for name in catalogue.names("response") if name != "linear"
]  # which asks no photograph
TIMES = "exif|estimate|FILE"
SUFFIXES = ".csv or .m (pfstools)"


class Response(click.ParamType):  # type: ignore[type-arg]  # it takes arguments since click 8.4
    """The name of a response method, or a file with a curve."""

    name = "NAME|FILE"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> str | Path:
        """Return a method's name as it is, and anything with the suffix of a curve as a path."""
        names = ["auto", *catalogue.names("response")]
        if value in names:
            return str(value)
        from hdrlab.io import response_files

        if str(value).lower().endswith(tuple(response_files.FORMS)):
            return Path(value)
        self.fail(
            f"expected one of {', '.join(names)}, or a file: {SUFFIXES}; got {value!r}", param, ctx
        )


def method_or_curve(response: str | Path) -> str | Callable[..., Any]:
    """Return what `pipeline.assemble` takes: a method's name, or a function that returns a saved curve."""
    if isinstance(response, str):
        return response
    from hdrlab.io.response_files import read_curve

    g = read_curve(response)
    return lambda *_, **__: g


@common.command()
@click.argument("photos", nargs=-1, required=True, type=common.FILE)
@click.option(
    "-o", "--out", multiple=True, type=common.OUT, help=f"Curve to write: {SUFFIXES}. Repeatable."
)
@click.option(
    "--times", metavar=TIMES, default="exif", help="Exposure times: EXIF, corrected, or a list."
)
@click.option(
    "--estimate-times", is_flag=True, help="Correct the times of a FILE by the pixels, too."
)
@common.MASK
@common.choice("--align", ["auto", *catalogue.names("align"), "none"], "mtb")
@common.choice("--response", METHODS, "debevec")
@click.option(
    "--plot", type=common.OUT, help="Picture of the curve and the residuals: .png or .svg."
)
def calibrate(asked: Any) -> None:
    """Find the camera's response in PHOTOS (files, or one folder), and how far it is to be trusted.

    The table says at which levels exposure doubles.
    """
    from hdrlab import pipeline
    from hdrlab.cli.photographs import read_bracket
    from hdrlab.io import response_files
    from hdrlab.pipeline import recovery
    from hdrlab.show.plots import calibration

    for path in asked.out:
        response_files.suffix_of(
            path
        )  # an unknown suffix is better known before the work than after it
    if asked.plot:
        calibration.check_suffix(asked.plot)
    bracket = read_bracket(asked.photos, asked.times, asked.mask, None)
    ready = "times" if asked.estimate_times or asked.times == "estimate" else "align"
    kept = "estimate" if ready == "times" else "stated"
    steps = pipeline.assemble_steps(bracket, align=asked.align, response=asked.response, times=kept)
    state = next(one for one in steps if one.stage == ready)
    common.say("note", (*state.notes, *state.doubts))
    # an aligned bracket under the plausible response that the method finds
    g = recovery.find_validated_method(asked.response)(
        *state.bracket[:2], valid=state.bracket.valid
    )
    found = pipeline.assemble(
        state.bracket, align="none", response=lambda *_, **__: g, times="stated"
    )
    common.say("warning", found.doubts)
    g, medians, (_, seconds, names, *_) = found.g, found.medians, found.bracket
    click.echo(f"{asked.response}, from {len(seconds)} photographs")
    click.echo(calibration.summary(g, medians, names))
    for path in asked.out:
        response_files.write_curve(path, g)
        click.echo(path)
    if asked.plot:
        calibration.write_plot(
            asked.plot, calibration.calibration(g, medians, seconds, title=asked.response)
        )
        click.echo(asked.plot)
