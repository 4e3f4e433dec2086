"""The contact sheet: one scene through every operator, with time, quality and statistics under each picture.

E        radiance            (H, W[, 3]), any linear unit
L, Ld    luminance, display luminance     (H, W)

The time is that of the operator alone: its choice of settings, and luminance in, display luminance
out. `sheet` draws what is found here.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from time import perf_counter

from hdrlab import pipeline
from hdrlab.core import colour
from hdrlab.core.arrays import ArrayLike, as_radiance
from hdrlab.core.picture import statistics
from hdrlab.errors import InputError
from hdrlab.pipeline import catalogue
from hdrlab.pipeline.assembly import Method
from hdrlab.show.pages.sheet import Entry
from hdrlab.tonemap import quality


def entry_steps(
    E: ArrayLike, operators: Sequence[str] | Mapping[str, Method] | None = None, *, way: str = "hue"
) -> Iterator[Entry]:
    """Yield the Entry of each operator: its picture, time, TMQI and statistics.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance, any linear unit.
    operators : names, or labels with an operator each; optional
        Which, and in which order: those of `tonemap`, sorted, unless told; "photograph" is another.
        A label's operator is a name or your own function `tonemap(L) -> Ld` in [0, 1].
    way : {"hue", "ratio"}
        What becomes of colours that a display does not have: see `core.colour.render`.

    Raises
    ------
    ValueError
        For radiance that is not finite or negative, and for names that no operator has.

    References
    ----------
    Yeganeh and Wang, Objective quality assessment of tone-mapped images, IEEE TIP 22(2), 2013.

    Examples
    --------
    >>> from hdrlab import scenes
    >>> from hdrlab.show.pages import sheet
    >>> drawn = sheet.draw(entry_steps(scenes.room((48, 72)), ["reinhard"]), title="the room")
    >>> drawn.get_label()[:68]
    'Contact sheet of the room: one scene through 1 tone-mapping operator'
    """
    E = as_radiance(E)
    L = colour.luminance(E)
    for name, tonemap in _methods(
        operators
    ).items():  # imported by now: that is no part of the time
        begun = perf_counter()
        settings, saturation = pipeline.resolve_settings(tonemap, E)
        Ld = tonemap(L, **settings)
        seconds = perf_counter() - begun
        picture = colour.render(E, L, Ld, saturation=saturation, way=way)
        yield Entry(name, picture, seconds, quality.tmqi(L, picture), statistics(picture))


def _methods(
    operators: Sequence[str] | Mapping[str, Method] | None,
) -> dict[str, Callable[..., ArrayLike]]:
    """Return label -> function, or raise a ValueError, before the first operator has run."""
    if operators is None:
        operators = catalogue.names("tonemap")
    if isinstance(operators, str):
        raise InputError(f"expected a list of operators, got the text {operators!r}")
    named = operators if isinstance(operators, Mapping) else {name: name for name in operators}
    if not named:
        raise InputError(
            f"expected operators out of {', '.join(catalogue.names('tonemap'))}, got none"
        )
    return {label: pipeline.find_operator(method) for label, method in named.items()}
