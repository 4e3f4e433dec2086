"""Tone mapping: a radiance map becomes a picture, by `photograph`, a method of `tonemap` or your function."""

import math
import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core import colour, extremes
from hdrlab.core.arrays import F32, as_radiance
from hdrlab.errors import InputError
from hdrlab.pipeline import catalogue
from hdrlab.pipeline.assembly import Assembly, Method
from hdrlab.pipeline.photograph import choose_settings, measure_scene_ev, photograph

# The default operator, which chooses its settings for the map.
AUTO = "photograph"
DEFAULT_SATURATION = 1.0
FUSION_NOTE = "the image is an exposure fusion of the photos"
# The median of usual maps. Beyond, sums and quotients leave the range of float32.
MIN_USUAL_MEDIAN = 1e-25
MAX_USUAL_MEDIAN = 1e25
MAX_FLOAT32_EXPONENT = 127
# Operators stretch the range of most pixels. Where at most this fraction has any light, this would
# be the range of black, which they would show as white.
MAX_FRACTION_OF_FEW_LIGHTS = 0.5


class Developed(NamedTuple):
    """A picture (H, W[, 3]) uint8, and its settings in words: "photograph, share 0.62, key 0.24, ..."."""

    picture: NDArray[np.uint8]
    settings: str


def develop(
    E: ArrayLike,
    tonemap: Method = AUTO,
    *,
    saturation: float | None = None,
    way: str = "hue",
    luminance_of_unit: float | None = None,
    max_luminance_of_unit: float | None = None,
    **knobs: Any,
) -> NDArray[np.uint8]:
    """Tone-map a radiance map to a picture, sRGB in 8 bits.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance, in any linear unit.
    tonemap : str or function
        "photograph", which chooses its settings for the map; a method of `tonemap`, with the
        defaults of its paper; or your own `tonemap(L, **knobs) -> Ld` in [0, 1].
    saturation : float, optional
        1 keeps the ratios of the channels, 0 is gray. By default, "photograph" chooses it, and
        another operator has the SATURATION of its module, or else 1. A view transform ("agx",
        "khronos") maps colors by itself, and has none.
    way : {"hue", "ratio"}
        How colors are restored, and what happens to colors that the display cannot show: "hue"
        makes them a little darker and paler, "ratio" clips a channel; see `core.colour`. View
        transforms do not use it.
    luminance_of_unit : float, optional
        cd/m^2 of a surface with E = 1. With it, "photograph" knows a night and keeps it dark.
    max_luminance_of_unit : float, optional
        An upper bound of it, which serves the same purpose where `luminance_of_unit` is unknown.
    **knobs
        Settings of the operator; for "photograph" share, key, white and black, instead of what it
        chooses.

    Returns
    -------
    (H, W) or (H, W, 3) uint8

    Raises
    ------
    InputError
        If the radiance is not finite or is negative, or a setting is out of its range.
    """
    return develop_and_describe(
        E,
        tonemap,
        saturation=saturation,
        way=way,
        luminance_of_unit=luminance_of_unit,
        max_luminance_of_unit=max_luminance_of_unit,
        **knobs,
    ).picture


def develop_and_describe(
    E: ArrayLike,
    tonemap: Method = AUTO,
    *,
    saturation: float | None = None,
    way: str = "hue",
    luminance_of_unit: float | None = None,
    max_luminance_of_unit: float | None = None,
    **knobs: Any,
) -> Developed:
    """Return the picture of `develop`, and its settings in words for a report; same parameters.

    Examples
    --------
    >>> E = np.geomspace(1, 1000, 4800, dtype=np.float32).reshape(60, 80)
    >>> develop_and_describe(E).settings
    'photograph, share 0.67, key 0.24, white 4.4, black 0.012, saturation 1'
    >>> develop_and_describe(E, "reinhard", key=0.36).settings
    'reinhard, key 0.36, saturation 1'
    """
    operator = find_operator(tonemap)
    name = _name_operator(tonemap)
    view_transform = find_view_transform(operator)
    if view_transform is not None and saturation is not None:
        raise InputError(f"{name} maps colors by itself and has no saturation; leave it out")
    E, scale = scale_into_range(E)
    is_bound = luminance_of_unit is None
    unit = max_luminance_of_unit if is_bound else luminance_of_unit
    if unit is not None:
        unit = unit / scale
    settings, default_saturation = resolve_settings(operator, E, knobs, unit)
    if view_transform is not None and E.ndim == 3:
        picture = colour.to_8bit(view_transform(E, **settings))
        return Developed(picture, _describe(name, settings))
    if saturation is None:
        saturation = default_saturation
    L = colour.luminance(E)
    Ld = operator(L, **settings)
    if np.count_nonzero(L) <= MAX_FRACTION_OF_FEW_LIGHTS * L.size:
        Ld = np.where(L > 0, Ld, np.float32(0))
    picture = colour.render(E, L, Ld, saturation=float(saturation), way=way)
    description = _describe(name, settings | {"saturation": float(saturation)})
    if operator is photograph and unit is not None:
        at_most = " at most" if is_bound else ""
        description += f", for a scene of EV {measure_scene_ev(E, unit):z.0f}{at_most}"
    return Developed(picture, description)


def develop_assembly(assembly: Assembly, tonemap: Method = AUTO) -> Developed:
    """Return the picture of an assembled map, or a fusion of the photos if the map is not usable.

    A scene whose luminance is known to be low stays dark, see `develop`.
    """
    if not assembly.fallback:
        return develop_and_describe(
            assembly.E,
            tonemap,
            luminance_of_unit=assembly.bracket.luminance_of_unit,
            max_luminance_of_unit=assembly.bracket.max_luminance_of_unit,
        )
    from hdrlab.fast import mertens

    fused = mertens.fuse(assembly.bracket.images).clip(0, 1)
    return Developed(np.rint(255 * fused).astype(np.uint8), FUSION_NOTE)


def scale_into_range(E: ArrayLike) -> tuple[F32, float]:
    """Return a radiance map that operators can compute with in float32, and its factor.

    A map whose median is near the ends of float32 is multiplied by a power of two. The unit of
    radiance does not matter to an operator, and this changes no digit. Other maps stay as they are.

    Examples
    --------
    >>> E, scale = scale_into_range(np.full((2, 3), 3e38))
    >>> bool(1 <= E[0, 0] < 2), bool(E[0, 0] == np.float32(3e38) * scale)
    (True, True)
    """
    E = as_radiance(E)
    median = extremes.positive_median(E)
    if median == 0 or MIN_USUAL_MEDIAN <= median <= MAX_USUAL_MEDIAN:
        return E, 1.0
    exponent_of_largest = math.frexp(float(E.max()))[1]
    exponent = min(1 - math.frexp(median)[1], MAX_FLOAT32_EXPONENT - exponent_of_largest)
    return np.ldexp(E, exponent), 2.0**exponent


def _name_operator(tonemap: Method) -> str:
    if isinstance(tonemap, str):
        return tonemap
    return getattr(tonemap, "__name__", "your own operator")


def _describe(name: str, settings: Mapping[str, Any]) -> str:
    """Return the name of an operator and its settings in words."""
    return ", ".join([name, *(_describe_setting(knob, settings[knob]) for knob in settings)])


def _describe_setting(knob: str, value: object) -> str:
    if isinstance(value, float):
        return f"{knob} {value:.2g}"
    return f"{knob} {value}"


def find_operator(tonemap: Method) -> Callable[..., Any]:
    """Return `photograph` for its name, and else what `catalogue.method` finds."""
    if isinstance(tonemap, str) and tonemap == AUTO:
        return photograph
    return catalogue.method("tonemap", tonemap)


def find_view_transform(operator: Callable[..., Any]) -> Callable[..., Any] | None:
    """Return the function `tonemap_rgb` of an operator that is a view transform, and else None.

    The module that defines such an operator has two functions: `tonemap` maps gray light, and
    `tonemap_rgb` maps colors.

    Examples
    --------
    >>> find_view_transform(find_operator("agx")).__name__
    'tonemap_rgb'
    >>> find_view_transform(find_operator("reinhard")) is None
    True
    """
    if getattr(operator, "__name__", "") != "tonemap":
        return None
    return getattr(_find_module(operator), "tonemap_rgb", None)


def resolve_settings(
    operator: Callable[..., Any],
    E: ArrayLike,
    knobs: Mapping[str, Any] = MappingProxyType({}),
    luminance_of_unit: float | None = None,
) -> tuple[dict[str, Any], float]:
    """Return an operator's settings for a map, and its default saturation.

    The settings are `knobs`, and for `photograph` also those that it chooses.
    """
    if operator is photograph:
        scene_ev = None if luminance_of_unit is None else measure_scene_ev(E, luminance_of_unit)
        settings = choose_settings(E, scene_ev=scene_ev) | dict(knobs)
        saturation = settings.pop("saturation")
        return settings, saturation
    return dict(knobs), _default_saturation(operator)


def _default_saturation(operator: Callable[..., Any]) -> float:
    """Return the SATURATION of the module that defines an operator, or else 1.

    A function of yours may come from a file that is not importable by name, so its own globals
    count.
    """
    own_globals = getattr(operator, "__globals__", {})
    default = own_globals.get("SATURATION", DEFAULT_SATURATION)
    return float(getattr(_find_module(operator), "SATURATION", default))


def _find_module(operator: Callable[..., Any]) -> object:
    """Return the module that defines an operator, or None if it is not imported by name.

    For an operator of `hdrlab.fast`, it is the chapter's module.
    """
    name = getattr(operator, "__module__", None) or ""
    if name.startswith("hdrlab.fast."):
        return import_module(name.replace("hdrlab.fast.", "hdrlab.tonemap."))
    return sys.modules.get(name)
