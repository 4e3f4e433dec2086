"""The sections of a report, a function each: rounded numbers, and figures with alt texts.

The letters are those of `pipeline.Assembly`; the template `report.html` calls these functions.
"""

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
from hdrlab.show.plots import figures


def bracket(photographs: Bracket, offsets: Array) -> list[dict[str, Any]]:
    """Return a thumbnail, the name, the exposure time and the offset of each photo."""
    frames = []
    for image, seconds, name, moved in zip(
        photographs.images, photographs.times, photographs.names, offsets, strict=True
    ):
        time = plots.seconds(seconds)
        small = to_256(figures.fit(image, 400))
        if photographs.linear:  # its numbers are light, and a screen wants them encoded
            small = colour.to_8bit(small / np.float32(255))
        shown = figures.photograph(small, 400, f"Photograph {name}, exposed for {time}")
        frames.append(
            {"name": name, "time": time, "offset": wording.offset(moved), "picture": shown}
        )
    return frames


def response(g: F64, truth: metrics.Truth | None) -> dict[str, Any]:
    """Return the plot of the response, over the true one where that is known, and its reach."""
    ax = plots.axes(4.6, 3.4)
    if truth is not None:
        plots.response(truth.g, label="true", ax=ax)
    plots.response(g, label="found" if truth is not None else "", ax=ax)
    curves = g.reshape(len(g), -1)
    low, high = (
        curves[round(z / 255 * (len(g) - 1))] for z in (metrics.LOW_LEVEL, metrics.HIGH_LEVEL)
    )
    reach = ", ".join(f"{stops:.1f}" for stops in (high - low) / np.log(2))
    alt = f"Response, pixel level over ln exposure: from level 10 to level 250 it rises over {reach} stops"
    return {"plot": figures.plot(ax, alt), "reach": reach, "coloured": curves.shape[1] == 3}


def radiance(E: Array) -> dict[str, Any]:
    """Return the map in false colour, its scale, and how many stops lie between its ends."""
    ev = figures.stops(E)
    low, high = figures.limits(ev)
    ends = f"from {wording.signed(low)} to {wording.signed(high)} stops around the median luminance"
    stops = np.ptp(np.nanpercentile(ev, [0.1, 99.9]))
    return {**_coloured(ev, low, high, f"The radiance map in false colour, {ends}"), "stops": stops}


def _coloured(
    values: Array, low: float, high: float, alt: str, colours: str = "viridis", digits: int = 0
) -> dict[str, Any]:
    """Return values in false colour and their scale."""
    image = figures.false_colour(figures.fit(values, 1000), low, high, colours=colours)
    scale = figures.scale(low, high, colours, digits=digits)
    return {"picture": figures.photograph(image, 1000, alt), "scale": scale}


def known(quality: Flags, picture: Image) -> dict[str, Any]:
    """Return the pixels of each quality flag, and a figure of the pixels that were not measured."""
    masks = {flag: quality == flag for flag in (Quality.MEASURED, *figures.KNOWN)}
    met = {flag: mask for flag, mask in masks.items() if flag == Quality.MEASURED or mask.any()}
    alt = "The picture in pale gray, with dots where a pixel was not measured"
    shown = figures.photograph(figures.known(picture, quality), 1000, alt) if len(met) > 1 else None
    return {"masks": met, "colours": figures.KNOWN, "picture": shown}


def certainty(E: F32, s: F32 | None) -> dict[str, Any] | None:
    """Return the standard deviation of the pixels as text and in false color, or None without one."""
    if s is None:
        return None
    stops = wording.deviation(E, s)
    said = wording.certainty(E, s)
    stops = np.where(np.isfinite(stops), stops, np.nan)
    if not np.isfinite(stops).any():
        return {"said": said, "picture": None}
    low, high = np.nanpercentile(stops, [1, 99]).tolist()
    low = min(low, 0.9 * high)  # a nearly uniform map must not look uneven
    ends = f"from ± {low:.2g} to ± {high:.2g} stops; gray where it is not known"
    shown = _coloured(
        stops, low, high, f"How sure each pixel is, in false colour, {ends}", digits=3
    )
    ticks = [(at, label.removeprefix("+")) for at, label in shown["scale"].ticks]
    return {**shown, "said": said, "scale": shown["scale"]._replace(ticks=ticks)}


def moving(labels: Labels | None, picture: Image) -> dict[str, Any] | None:
    """Return the regions that moved and a figure of them, or None if nothing moved."""
    if labels is None or not labels.any():
        return None
    count = int(labels.max())
    part = wording.share(labels > 0)
    regions = "one region" if count == 1 else f"{count} regions"
    alt = f"The picture in pale gray; what moved lies in {regions}, in orange with dark outlines"
    shown = figures.photograph(figures.regions(picture, labels), 1000, alt)
    return {"regions": regions, "share": part, "picture": shown}


def agreement(photographs: Bracket, medians: F64) -> dict[str, Any]:
    """Return how far each frame deviates from the consensus of all frames, as numbers and bars."""
    shared = np.isfinite(medians[..., consistency.LEVELS])
    shared &= shared.sum(axis=0) >= 2
    spread = consistency.measure_spread(medians)
    found = consistency.measure_deviations(medians)
    counts = shared.any(axis=1).sum(axis=1).tolist()
    # none, for a frame of which nothing is known
    known = np.isfinite(found)
    bars = np.nan_to_num(found)
    columns = (photographs.names, map(plots.seconds, photographs.times), counts, known, bars)
    widest = max(np.abs(bars).max(), wording.CLOSE)
    return {"spread": spread, "widest": widest, "rows": list(zip(*columns, strict=True))}


def against(
    truth: metrics.Truth, photographs: Bracket, offsets: Array, g: F64, E: Array
) -> dict[str, Any]:
    """Return the errors of radiance, response and offsets against the truth."""
    well = metrics.well_exposed(photographs.images, photographs.valid)
    apart = np.abs(metrics.radiance_errors(E, truth.E, well))[well]
    rmse = metrics.response_rmse(g, truth.g)
    off = metrics.offset_errors(offsets, truth.offsets)
    channels = [name for name, *_ in plots.CHANNELS] if len(rmse) == 3 else ["gray"]
    columns = zip(photographs.names, offsets, truth.offsets, off, strict=True)
    return {
        "median": f"{100 * np.nanmedian(apart):.2f} %",
        "most": f"{100 * np.nanpercentile(apart, 95):.2f} %",
        "well": wording.share(well),
        **error_map(truth, E, well),
        "rmse": [
            (channel, f"{percent:.2f} %") for channel, percent in zip(channels, rmse, strict=True)
        ],
        "offsets": [(name, *map(wording.offset, three)) for name, *three in columns],
        "furthest": int(np.abs(off).max()),
    }


def error_map(truth: metrics.Truth, E: Array, well: Mask) -> dict[str, Any]:
    """Return the errors of luminance in false colour and their scale."""
    ratio = 1 + metrics.radiance_errors(colour.luminance(E), colour.luminance(truth.E), well)
    stops = np.where(well, np.log2(np.maximum(ratio, 2.0**-10)), np.nan)
    reach = figures.round_up(np.nanpercentile(np.abs(stops), 99))
    ends = f"from {wording.signed(-reach, 2)} to {wording.signed(reach, 2)} stops"
    return _coloured(
        stops, -reach, reach, f"Errors of luminance in false colour, {ends}", "PuOr_r", 2
    )
