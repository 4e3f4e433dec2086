"""A notebook in JupyterLab: the time to its first picture, and the latency of every slider."""

from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from benchmarks.widgets import browsers

FIRST = "first picture, s"
WORST = {kind: f"slowest slider of {kind}, 95 %, ms" for kind in ("play", "tune")}
PRESSES = 24  # of the arrow keys, for each slider
LOST = 5000.0  # ms, after which a picture counts as one that does not come
Figures = dict[str, Any]

FIRST_PICTURE = """async () => {
    const images = document.getElementsByTagName("img"), canvas = ".hdrlab canvas:not([aria-label=''])";
    const seen = () => document.querySelector(canvas)
        || [...images].some((one) => one.naturalWidth && one.closest(".jp-OutputArea-output"));
    const start = performance.now();
    window.jupyterapp.commands.execute("notebook:run-all-cells");
    while (!seen() && performance.now() - start < 60_000) await new Promise(requestAnimationFrame);
    return (performance.now() - start) / 1000;
}"""

# The alt text names the position, and is set in the moment in which the pixels are there. To look
# for it on each frame of the display would keep the page drawing, and the kernel waiting for a
# processor.
WATCH = """([el, lost]) => {
    const canvas = el.querySelector("canvas"), text = canvas.getAttribute("aria-label");
    window.latency = new Promise((resolve) => {
        addEventListener("keydown", (event) => {
            const passed = () => performance.now() - event.timeStamp;
            const timer = setTimeout(() => resolve(passed()), lost);
            const observer = new MutationObserver(() => {
                if (canvas.getAttribute("aria-label") === text) return;
                observer.disconnect();
                clearTimeout(timer);
                requestAnimationFrame(() => resolve(passed()));
            });
            observer.observe(canvas, { attributeFilter: ["aria-label"] });
        }, { capture: true, once: true });
    });
}"""


def opened(_folder: Path, name: str) -> Figures:
    """Return what a notebook takes: first picture, the worst of each kind, then each slider's p50 and p95."""
    with TemporaryDirectory() as home, browsers.lab(Path(home)) as (page, _, server):
        server.open(page, name)
        figures: Figures = {FIRST: page.evaluate(FIRST_PICTURE)}
        server.until_done(page)
        figures_of_kind = {kind: sliders(page, kind) for kind in WORST}
    figures |= {
        WORST[kind]: max(p95 for _, p95 in seconds.values())
        for kind, seconds in figures_of_kind.items()
        if seconds
    }
    return figures | figures_of_kind["play"] | figures_of_kind["tune"]


def sliders(page: Any, kind: str) -> Figures:
    """Return the latency of every slider of one kind of widget, median and 95 %, in ms."""
    figures: Figures = {}
    for number, widget in enumerate(page.locator(f".hdrlab[data-kind={kind}]").all(), 1):
        widget.scroll_into_view_if_needed()
        names = widget.locator(".hdrlab-slider span:first-child").all_inner_texts()
        for name, slider in zip(names, widget.get_by_role("slider").all(), strict=True):
            latencies = moved(page, widget, slider)
            figures[f"{kind} {number}, {name}: 50, 95 %, ms"] = np.quantile(
                latencies, (0.5, 0.95)
            ).tolist()
    return figures


def moved(page: Any, widget: Any, slider: Any) -> list[float]:
    """Return the latency of each press of an arrow key, there and back again, after two that warm up."""
    slider.focus()
    top = int(slider.get_attribute("max"))
    at = int(slider.input_value())
    places = bouncing(at, top, PRESSES + 3)
    latencies = []
    for here, there in pairwise(places):
        page.wait_for_timeout(50)  # a reader looks before the next press
        page.evaluate(WATCH, [widget.element_handle(), LOST])
        page.keyboard.press("ArrowRight" if there > here else "ArrowLeft")
        latencies.append(float(page.evaluate("window.latency")))
    return latencies[2:]


def bouncing(at: int, top: int, count: int) -> list[int]:
    """Return places 0 ... top, one step at a time, turned back at the ends.

    Examples
    --------
    >>> bouncing(1, 2, 6)
    [1, 2, 1, 0, 1, 2]
    """
    places = [at]
    step = 1
    while len(places) < count:
        step = -step if not 0 <= places[-1] + step <= top else step
        places.append(places[-1] + step)
    return places
