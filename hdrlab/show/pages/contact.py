"""Run tone-mapping operators on one scene for the contact sheet, with time, TMQI and statistics.

E        radiance            (H, W[, 3]), any linear unit
L, Ld    luminance, display luminance     (H, W)

The time of an operator includes its choice of settings, but neither luminance nor the rendering of
colors. `sheet` draws the entries.
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
    E: ArrayLike,
    operators: Sequence[str] | Mapping[str, Method] | None = None,
    *,
    way: str = "hue",
    luminance_of_unit: float | None = None,
) -> Iterator[Entry]:
    """Yield the contact sheet's entry of each operator: its picture, time, TMQI and statistics.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance, any linear unit.
    operators : list of names, or mapping of labels to operators; optional
        The operators, in the order of the sheet; by default all of `hdrlab.tonemap`, sorted.
        "photograph" is another one. In a mapping, an operator is a name or your own function
        `tonemap(L) -> Ld` in [0, 1].
    way : {"hue", "ratio"}
        How colors that a display cannot show are rendered: see `core.colour.render`.
    luminance_of_unit : float, optional
        cd/m^2 of a surface with E = 1. With it, "photograph" keeps a night dark.

    Raises
    ------
    InputError
        For radiance that is not finite or negative, and for names of unknown operators.

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
    # This imports all operators, so that the measured times do not include an import.
    functions = _find_operators(operators)
    for name, tonemap in functions.items():
        start = perf_counter()
        settings, saturation = pipeline.resolve_settings(
            tonemap, E, luminance_of_unit=luminance_of_unit
        )
        view_transform = pipeline.find_view_transform(tonemap)
        if view_transform is not None and E.ndim == 3:
            display = view_transform(E, **settings)
            seconds = perf_counter() - start
            picture = colour.to_8bit(display)
        else:
            Ld = tonemap(L, **settings)
            seconds = perf_counter() - start
            picture = colour.render(E, L, Ld, saturation=saturation, way=way)
        yield Entry(
            name=name,
            picture=picture,
            seconds=seconds,
            quality=quality.tmqi(L, picture),
            statistics=statistics(picture),
        )


def _find_operators(
    operators: Sequence[str] | Mapping[str, Method] | None,
) -> dict[str, Callable[..., ArrayLike]]:
    """Return the operators' functions by label, or raise an InputError before any of them runs."""
    if operators is None:
        operators = catalogue.names("tonemap")
    if isinstance(operators, str):
        raise InputError(f"expected a list of operators, got the text {operators!r}")
    methods = operators if isinstance(operators, Mapping) else {name: name for name in operators}
    if not methods:
        raise InputError(
            f"expected at least one of the operators {', '.join(catalogue.names('tonemap'))}, got none"
        )
    return {label: pipeline.find_operator(method) for label, method in methods.items()}
