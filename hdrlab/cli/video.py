"""The command that begins with a film."""

from collections.abc import Iterator
from itertools import chain, islice
from pathlib import Path
from typing import Any

import click

from hdrlab.cli import common, curves
from hdrlab.errors import InputError


@common.command()
@click.argument("frames", type=common.FILE)
@click.option(
    "-o", "--out", required=True, type=common.OUT, help="Film to write, .gif or .mp4; see above."
)
@click.option(
    "--times", required=True, metavar="SECONDS,...", help="Exposure times of a turn: 1/1000,1/60."
)
@click.option(
    "--response", type=curves.Response(), default="auto", help="A method, or a saved curve."
)
@click.option(
    "--rate", type=float, default=25.0, help="Frames a second of the film that is written."
)
@click.option("--key", type=float, default=0.18, help="What the log average of the frames becomes.")
@click.option(
    "--span", type=click.IntRange(0), default=1, help="Frames before and after to adapt to, too."
)
def video(asked: Any) -> None:
    """Make a film of high dynamic range out of FRAMES whose exposures take turns.

    FRAMES is a folder of photographs, sorted by name, or a film, which wants the extra `video`. The
    first frame has the first of --times, the next one the second, and so on in turns.

    Each frame gets from its neighbours what its own exposure lacks, brought along the motion
    between them. An --out of .gif or .mp4 is tone-mapped; a name without a suffix becomes a folder
    of radiance maps, 0001.exr and so on.

    The response is found in the frames of the first turn (auto: in the space of measured curves),
    which should show nearly the same. Better is a curve that `hdrlab calibrate` has saved.
    """
    from hdrlab.beyond import video as merging
    from hdrlab.io import sequence

    turn = seconds(asked.times)
    require = sequence.require_writable if asked.out.suffix else sequence.require_new
    require(asked.out)  # better known before the work
    count, film = sequence.count(asked.frames), sequence.read(asked.frames)
    begun = list(islice(film, len(turn)))
    g = recovered(asked.response, begun, turn)
    steps = merging.merge_steps(chain(begun, film), turn, g)
    maps = (state.E for state in common.progress(steps, "merging", count))
    if asked.out.suffix:
        written = sequence.write(
            asked.out, pictures(maps, key=asked.key, span=asked.span), rate=asked.rate
        )
    else:
        written = sequence.write_maps(asked.out, maps)
    click.echo(f"{asked.out}: {written} frames, {begun[0].shape[1]} x {begun[0].shape[0]}")


def seconds(text: str) -> list[float]:
    """Return times, separated by commas, as seconds; each may be a fraction."""
    from hdrlab.capture import exposure

    try:
        found = [exposure.seconds(one) for one in text.split(",")]
    except ValueError:
        raise InputError(f"--times: expected seconds such as 1/1000,1/60, got {text!r}") from None
    if len(set(found)) < 2:
        raise InputError(f"--times: expected at least two exposures of a turn, got {text!r}")
    return found


def recovered(response: str | Path, frames: list[Any], turn: list[float]) -> Any:
    """Return the response: of a file, or found in the frames of a turn."""
    import numpy as np

    from hdrlab.core.bracket import bracket
    from hdrlab.pipeline import recovery

    if isinstance(response, Path):
        return curves.method_or_curve(response)()  # type: ignore[operator]  # of a file it is a function
    if len(frames) < len(turn):
        raise InputError(f"expected at least a turn of {len(turn)} frames, got {len(frames)}")
    taken = bracket(np.stack(frames), turn)
    method = recovery.find_validated_method("space" if response == "auto" else response)
    return method(taken.images, taken.times)


def pictures(maps: Iterator[Any], *, key: float, span: int) -> Iterator[Any]:
    """Yield the frames as a display shows them, tone-mapped steadily."""
    from hdrlab.beyond import steady
    from hdrlab.core import colour
    from hdrlab.fast import reinhard

    for state in steady.tonemap_steps(maps, reinhard.tonemap, key=key, span=span):
        yield colour.render(state.E, colour.luminance(state.E), state.Ld)
