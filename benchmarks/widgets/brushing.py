"""Frames a second of the Detail Brush while the pointer goes round over the whole map."""

from pathlib import Path

from benchmarks.widgets import browsers
from hdrlab import scenes
from hdrlab.show import widgets

SHAPE = (768, 1024)
SIZE = 512
MAGNIFICATIONS = (1, 2, 4)
FIGURE = "frames a second, magnified 1, 2, 4 times"
SECONDS = 4

# A frame counts when the brush was painted in it. 60 a second is the clock of the display.
ROUND = """async ([magnification, seconds]) => {
    window.model.set("magnification", magnification);
    const frame = document.querySelector(".hdrlab-stage"), canvas = frame.querySelector("canvas");
    const box = canvas.getBoundingClientRect(), next = () => new Promise(requestAnimationFrame);
    let [painted, said] = [0, ""];
    await next();
    const start = performance.now();
    while (performance.now() - start < 1000 * seconds) {
        const angle = (performance.now() - start) / 200;
        const at = { clientX: box.left + box.width * (0.5 + 0.4 * Math.sin(angle)),
                     clientY: box.top + box.height * (0.5 + 0.4 * Math.cos(0.7 * angle)) };
        frame.dispatchEvent(new PointerEvent("pointermove", { ...at, pointerId: 1, bubbles: true }));
        await next();
        painted += said !== (said = canvas.getAttribute("aria-label"));
    }
    return painted / ((performance.now() - start) / 1000);
}"""


def brushed(_: Path) -> dict[str, list[float]]:
    """Return the frames a second at each magnification, after a round to warm up."""
    room = scenes.room((SHAPE[0] // 2, SHAPE[1] // 2)).repeat(2, axis=0).repeat(2, axis=1)
    brush = widgets.brush(room, alt="The room", size=SIZE)
    with browsers.page() as (page, tools):
        tools.open_widget(page, brush)
        page.evaluate(ROUND, [1, 1])
        return {
            FIGURE: [
                page.evaluate(ROUND, [magnification, SECONDS]) for magnification in MAGNIFICATIONS
            ]
        }
