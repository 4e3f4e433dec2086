"""A radiance map becomes a picture, by an operator of `tonemap` or a function of yours."""

from collections.abc import Callable
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core import colour
from hdrlab.pipeline import catalogue
from hdrlab.pipeline.assembly import Method


def develop(
    E: ArrayLike,
    tonemap: Method = "reinhard",
    *,
    saturation: float | None = None,
    way: str = "ratio",
    **knobs: Any,
) -> NDArray[np.uint8]:
    """Return the picture of a radiance map: tone-mapped luminance, its colours, sRGB in 8 bits.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance, any linear unit.
    tonemap : str or function
        A method of `tonemap`, or your own `tonemap(L, **knobs) -> Ld` in [0, 1].
    saturation : float, optional
        1 keeps the ratios of the channels, 0 is gray; the SATURATION of the operator's module, or else 1.
    way : {"ratio", "chroma"}
        How colour comes back, and what becomes of colours beyond the display: "ratio" clips a channel,
        "chroma" keeps hue and luminance and gives up saturation, see `core.colour`.
    **knobs
        Those of the operator.

    Returns
    -------
    (H, W) or (H, W, 3) uint8

    Raises
    ------
    ValueError
        For radiance that is not finite or negative, and for knobs out of their range.
    """
    operator = catalogue.method("tonemap", tonemap)
    saturation = own_saturation(operator) if saturation is None else saturation
    L = colour.luminance(E)
    return colour.render(E, L, operator(L, **knobs), saturation=saturation, way=way)


def own_saturation(operator: Callable[..., Any]) -> float:
    """Return the SATURATION that the chapter's module of an operator states, or 1."""
    module = operator.__module__.replace("hdrlab.fast.", "hdrlab.tonemap.")
    return float(getattr(import_module(module), "SATURATION", 1.0))
