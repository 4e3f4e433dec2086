"""The sections of a report: rounded numbers, and figures with alt texts.

The letters are those of `pipeline.Assembly`. The template `report.html` calls these functions.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from hdrlab.core import colour, metrics
from hdrlab.core.arrays import F32, F64, Array, Flags, Labels, Mask, to_256
from hdrlab.core.bracket import Bracket
from hdrlab.diagnostics import consistency
from hdrlab.io.web import Image
from hdrlab.radiance.merge import Quality
from hdrlab.show import plots
from hdrlab.show.pages import wording
from hdrlab.show.plots import calibration, figures

MAX_THUMBNAIL_SIDE = 400
MAX_MAP_SIDE = 1000
# The outermost pixels on both ends, in percent, do not count as dynamic range.
DYNAMIC_RANGE_PERCENTILES = (0.1, 99.9)
MIN_ERROR_RATIO = 2.0**-10


def bracket(photographs: Bracket, offsets: Array) -> list[dict[str, Any]]:
    """Return a thumbnail, the name, the exposure and the offset of each photo."""
    frames = []
    exposures = plots.exposures(photographs)
    for j, image in enumerate(photographs.images):
        name = photographs.names[j]
        time = exposures[j]
        small = to_256(figures.fit(image, MAX_THUMBNAIL_SIDE))
        if photographs.linear:  # a screen needs encoded values
            small = colour.to_8bit(small / np.float32(255))
        if photographs.has_relative_times:
            alt = f"Photo {name}, relative exposure {time}"
        else:
            alt = f"Photo {name}, exposed for {time}"
        frames.append(
            {
                "name": name,
                "time": time,
                "offset": wording.offset(offsets[j]),
                "picture": figures.photograph(small, MAX_THUMBNAIL_SIDE, alt),
            }
        )
    return frames


def relative_times(photographs: Bracket) -> str:
    """Return the times of a bracket as multiples of the shortest."""
    ratios = photographs.times / photographs.times.min()
    return ", ".join(f"{ratio:.4g}" for ratio in ratios)


def response(g: F64, medians: F64 | None, truth: metrics.Truth | None) -> dict[str, Any]:
    """Return the plot of the response, with the true one if it is known, and its range in stops.

    The curve is drawn, and its range stated, over the pixel values that occur; over all of them if
    `medians` is None, because the photos are not known.
    """
    curves = g.reshape(len(g), -1)
    levels = None if medians is None else calibration.find_drawn_levels(g, medians)
    ax = plots.axes(4.6, 3.4)
    if truth is not None:
        plots.response(truth.g, label="true", ax=ax)
    plots.response(g, label="" if truth is None else "estimated", levels=levels, ax=ax)
    reach = calibration.measure_reach(g, medians)
    alt = f"Response, pixel value over ln exposure: it rises over {reach}"
    return {
        "plot": figures.plot(ax, alt),
        "low": reach.low,
        "high": reach.high,
        "stops": ", ".join(f"{stops:.1f}" for stops in reach.stops),
        "is_color": curves.shape[1] == 3,
    }


def radiance(E: Array) -> dict[str, Any]:
    """Return the map in false color, its scale, and its dynamic range in stops."""
    ev = figures.stops(E)
    low, high = figures.limits(ev)
    ends = f"from {wording.signed(low)} to {wording.signed(high)} stops around the median luminance"
    alt = f"The radiance map in false color, {ends}"
    dynamic_range = np.ptp(np.nanpercentile(ev, DYNAMIC_RANGE_PERCENTILES))
    return {**_false_color_figure(ev, low, high, alt), "stops": dynamic_range}


def _false_color_figure(
    values: Array, low: float, high: float, alt: str, *, colours: str = "viridis", digits: int = 0
) -> dict[str, Any]:
    """Return values in false color and their scale."""
    small = figures.fit(values, MAX_MAP_SIDE)
    image = figures.false_colour(small, low, high, colours=colours)
    return {
        "picture": figures.photograph(image, MAX_MAP_SIDE, alt),
        "scale": figures.scale(low, high, colours, digits=digits),
    }


def known(quality: Flags, picture: Image) -> dict[str, Any]:
    """Return the pixels of each quality flag, and a figure of the pixels that were not measured."""
    masks = {}
    for flag in (Quality.MEASURED, *figures.FLAG_COLORS):
        mask = quality == flag
        if flag == Quality.MEASURED or mask.any():
            masks[flag] = mask
    illustration = None
    if len(masks) > 1:
        alt = "The picture in pale gray, with dots where a pixel was not measured"
        image = figures.known(picture, quality)
        illustration = figures.photograph(image, MAX_MAP_SIDE, alt)
    return {"masks": masks, "colours": figures.FLAG_COLORS, "picture": illustration}


def certainty(E: F32, s: F32 | None) -> dict[str, Any] | None:
    """Return the standard deviation of the pixels in words and in false color, or None without one."""
    if s is None:
        return None
    summary = wording.certainty(E, s)
    stops = wording.deviation(E, s)
    stops = np.where(np.isfinite(stops), stops, np.nan)
    if not np.isfinite(stops).any():
        return {"summary": summary, "picture": None}
    low, high = np.nanpercentile(stops, [1, 99]).tolist()
    low = min(low, 0.9 * high)  # a nearly uniform map must not look uneven
    ends = f"from ± {low:.2g} to ± {high:.2g} stops; gray where it is not known"
    alt = f"Uncertainty of each pixel in false color, {ends}"
    figure = _false_color_figure(stops, low, high, alt, digits=3)
    scale = figure["scale"]
    ticks = [(place, label.removeprefix("+")) for place, label in scale.ticks]
    return {**figure, "summary": summary, "scale": replace(scale, ticks=ticks)}


def moving(labels: Labels | None, picture: Image) -> dict[str, Any] | None:
    """Return the regions that moved and a figure of them, or None if nothing moved."""
    if labels is None or not labels.any():
        return None
    count = int(labels.max())
    regions = "one region" if count == 1 else f"{count} regions"
    alt = f"The image in pale gray; motion in {regions}, in orange with dark outlines"
    image = figures.regions(picture, labels)
    return {
        "regions": regions,
        "share": wording.share(labels > 0),
        "picture": figures.photograph(image, MAX_MAP_SIDE, alt),
    }


def agreement(photographs: Bracket, medians: F64) -> dict[str, Any]:
    """Return how far each frame deviates from the consensus of all frames, as numbers and bars."""
    is_compared = np.isfinite(medians[..., consistency.LEVELS])
    is_compared &= is_compared.sum(axis=0) >= 2
    counts = is_compared.any(axis=1).sum(axis=1).tolist()
    deviations = consistency.measure_deviations(medians)
    rows = []
    exposures = plots.exposures(photographs)
    for j, deviation in enumerate(deviations):
        is_known = bool(np.isfinite(deviation))
        rows.append(
            {
                "name": photographs.names[j],
                "time": exposures[j],
                "levels": counts[j],
                "is_known": is_known,
                "stops": deviation if is_known else 0.0,
            }
        )
    widest = max(wording.AGREEMENT_STOPS, *(abs(row["stops"]) for row in rows))
    return {"spread": consistency.measure_spread(medians), "widest": widest, "rows": rows}


def against(
    truth: metrics.Truth, photographs: Bracket, offsets: Array, g: F64, E: Array
) -> dict[str, Any]:
    """Return the errors of radiance, response and offsets compared with the truth."""
    is_well_exposed = metrics.well_exposed(photographs.images, photographs.valid)
    errors = metrics.radiance_errors(E, truth.E, is_well_exposed)
    absolute_errors = np.abs(errors)[is_well_exposed]
    rmse = metrics.response_rmse(g, truth.g)
    channels = [name for name, *_ in plots.CHANNELS] if len(rmse) == 3 else ["gray"]
    offset_errors = metrics.offset_errors(offsets, truth.offsets)
    offset_rows = []
    for j, name in enumerate(photographs.names):
        offset_rows.append(
            {
                "name": name,
                "estimated": wording.offset(offsets[j]),
                "true": wording.offset(truth.offsets[j]),
                "error": wording.offset(offset_errors[j]),
            }
        )
    response_rows = []
    for channel, percent in zip(channels, rmse, strict=True):
        response_rows.append({"channel": channel, "error": f"{percent:.2f} %"})
    return {
        "median": f"{100 * np.nanmedian(absolute_errors):.2f} %",
        "percentile95": f"{100 * np.nanpercentile(absolute_errors, 95):.2f} %",
        "compared_pixels": wording.share(is_well_exposed),
        **error_map(truth, E, is_well_exposed),
        "response": response_rows,
        "offsets": offset_rows,
        "max_offset_error": int(np.abs(offset_errors).max()),
    }


def error_map(truth: metrics.Truth, E: Array, well: Mask) -> dict[str, Any]:
    """Return the errors of luminance in false color and their scale."""
    ratio = 1 + metrics.radiance_errors(colour.luminance(E), colour.luminance(truth.E), well)
    stops = np.where(well, np.log2(np.maximum(ratio, MIN_ERROR_RATIO)), np.nan)
    limit = figures.round_up(np.nanpercentile(np.abs(stops), 99))
    ends = f"from {wording.signed(-limit, 2)} to {wording.signed(limit, 2)} stops"
    alt = f"Errors of luminance in false color, {ends}"
    return _false_color_figure(stops, -limit, limit, alt, colours="PuOr_r", digits=2)
