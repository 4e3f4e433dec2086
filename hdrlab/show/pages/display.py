"""A display's part in a calibration: the pictures of one exposure, as files and as a page that plays them.

pictures  (T, H, W) uint8   of `calibration.display.draw_schedule`
frames    of the display    that each picture stands: refresh rate x exposure time / T, an even number

Even, since liquid crystals are driven by a voltage whose sign changes every frame: brightness may differ
between the two, and a picture should hold as many of either.

The page fills the screen, draws a picture's pixel on a pixel of the display, changes only where a new frame
begins, and counts the frames that the browser missed: a calibration with a missed one is not to be trusted.
It repeats the sequence without a pause, so that an exposure as long as the sequence holds all of it, wherever
it begins.
"""

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from hdrlab.core.arrays import describe
from hdrlab.io import web
from hdrlab.io.files import replacing
from hdrlab.io.photos import write_picture
from hdrlab.show.pages.templates import templates

PAGE = "display.html"


def write_display(folder: str | Path, pictures: ArrayLike, *, frames: int = 4) -> Path:
    """Write `step-01.png` ... and `display.html`, which plays them, into a folder; return the page's path.

    Parameters
    ----------
    folder : path
        Made where it is missing; what stands there under these names is replaced.
    pictures : (T, H, W) uint8
        In the order of the sequence.
    frames : int
        Frames of the display that each picture stands, an even number.

    Raises
    ------
    ValueError
        For pictures that are none, or an odd number of frames.

    Examples
    --------
    >>> import tempfile
    >>> page = write_display(tempfile.mkdtemp(), np.zeros((2, 4, 6), np.uint8))
    >>> sorted(file.name for file in page.parent.iterdir())
    ['display.html', 'step-01.png', 'step-02.png']
    """
    shown = np.asarray(pictures)
    if shown.ndim != 3 or shown.dtype != np.uint8 or shown.size == 0:
        raise ValueError(f"expected pictures (T, H, W) of uint8, got {describe(shown)}")
    if frames < 2 or frames % 2:
        raise ValueError(f"expected an even number of frames per picture, got {frames}")
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for number, picture in enumerate(shown, 1):
        write_picture(folder / f"step-{number:02d}.png", picture)
    template = templates(Path(__file__).parent).get_template(PAGE)
    height, width = shown.shape[1:]
    pages = [web.data_uri(web.encode_webp(picture, lossless=True)) for picture in shown]
    with replacing(folder / PAGE) as temporary:
        temporary.write_text(
            template.render(pictures=pages, frames=frames, width=width, height=height), encoding="utf8"
        )
    return folder / PAGE
