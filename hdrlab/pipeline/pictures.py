"""A radiance map becomes a picture: by `photograph`, an operator of `tonemap` or a function of yours."""

from collections.abc import Callable, Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core import colour
from hdrlab.pipeline import catalogue
from hdrlab.pipeline.assembly import Method
from hdrlab.pipeline.photograph import choose_settings, photograph

# the default: settings from the map, see `photograph`
AUTO = "photograph"


class Developed(NamedTuple):
    """A picture (H, W[, 3]) uint8, and how it was made, in words: "photograph, share 0.62, key 0.24, ..."."""

    picture: NDArray[np.uint8]
    settings: str


def develop(E: ArrayLike, tonemap: Method = AUTO, **options: Any) -> NDArray[np.uint8]:
    """Return the picture of a radiance map: tone-mapped luminance, its colours, sRGB in 8 bits.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance, any linear unit.
    tonemap : str or function
        "photograph", which chooses its settings by the map; a method of `tonemap`, with the
        defaults of its paper; or your own `tonemap(L, **knobs) -> Ld` in [0, 1].
    saturation : float, optional
        1 keeps the ratios of the channels, 0 is gray. By default "photograph" chooses it, and an
        operator has the SATURATION of its module, or else 1.
    way : {"hue", "ratio"}
        How colour comes back, and what becomes of colours beyond the display: "hue" darkens them a
        little and makes them paler, "ratio" clips a channel; see `core.colour`.
    **knobs
        Those of the operator; of "photograph" share, key, white and black, instead of what it
        chooses.

    Returns
    -------
    (H, W) or (H, W, 3) uint8

    Raises
    ------
    ValueError
        For radiance that is not finite or negative, and for knobs out of their range.
    """
    return develop_and_describe(E, tonemap, **options).picture


def develop_and_describe(
    E: ArrayLike,
    tonemap: Method = AUTO,
    *,
    saturation: float | None = None,
    way: str = "hue",
    **knobs: Any,
) -> Developed:
    """Return the picture of `develop`, and its settings in words, for a report; the parameters are the same.

    Examples
    --------
    >>> E = np.geomspace(1, 1000, 4800, dtype=np.float32).reshape(60, 80)
    >>> develop_and_describe(E).settings
    'photograph, share 0.67, key 0.24, white 4.4, black 0.012, saturation 1'
    >>> develop_and_describe(E, "reinhard", key=0.36).settings
    'reinhard, key 0.36, saturation 1'
    """
    operator = find_operator(tonemap)
    settings, own = settle(operator, E, knobs)
    saturation = own if saturation is None else float(saturation)
    L = colour.luminance(E)
    picture = colour.render(E, L, operator(L, **settings), saturation=saturation, way=way)
    name = (
        tonemap if isinstance(tonemap, str) else getattr(tonemap, "__name__", "your own operator")
    )
    said = (
        f"{knob} {value:.2g}" if isinstance(value, float) else f"{knob} {value}"
        for knob, value in (settings | {"saturation": saturation}).items()
    )
    return Developed(picture, ", ".join((name, *said)))


def find_operator(tonemap: Method) -> Callable[..., Any]:
    """Return `photograph` for its name, and else what `catalogue.method` finds."""
    return photograph if tonemap == AUTO else catalogue.method("tonemap", tonemap)


def settle(
    operator: Callable[..., Any], E: ArrayLike, knobs: Mapping[str, Any] = MappingProxyType({})
) -> tuple[dict[str, Any], float]:
    """Return an operator's knobs for a map, those given and what `photograph` chooses, and its saturation.

    That is the SATURATION that the chapter's module of an operator states, or 1.
    """
    if operator is photograph:
        settings = choose_settings(E) | dict(knobs)
        return settings, settings.pop("saturation")
    module = operator.__module__.replace("hdrlab.fast.", "hdrlab.tonemap.")
    return dict(knobs), float(getattr(import_module(module), "SATURATION", 1.0))
