"""Write the report on a radiance map: one HTML page with figures, errors and warnings.

The template `report.html` calls the functions of `sections`. All images are embedded. The page
fetches nothing. Its one script explains the pixel that the reader presses, see `pressed_pixels`; the
page's content security policy allows no other script.
"""

import platform
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import scipy

import hdrlab
from hdrlab.core.arrays import ArrayLike, describe
from hdrlab.core.metrics import Truth
from hdrlab.errors import InputError
from hdrlab.io.files import write
from hdrlab.pipeline.assembly import Assembly
from hdrlab.pipeline.explanation import shorten
from hdrlab.radiance.merge import Quality
from hdrlab.show.pages import pressed_pixels, sections, templates, wording
from hdrlab.show.plots import figures

# The name of the template, and of the page.
REPORT_FILE_NAME = "report.html"
MAX_PICTURE_SIDE = 1600


def write_report(
    folder: str | Path,
    assembly: Assembly,
    picture: ArrayLike,
    *,
    recipe: str | Mapping[str, Any] = "",
    truth: Truth | None = None,
) -> Path:
    """Write `report.html` into a folder, which is created if needed, and return the page's path.

    Parameters
    ----------
    folder : path
        An existing report in it is replaced when the new one is complete.
    assembly : Assembly
        The result of `pipeline.assemble`.
    picture : (h, w) or (h, w, 3) uint8
        The tone-mapped map, as `pipeline.develop` returns it.
    recipe : str or mapping
        How the map was made: a sentence, or the methods and parameters by name.
    truth : Truth, optional
        With it, the report has a section on the errors of radiance, response and offsets.

    Raises
    ------
    InputError
        For an assembly that is unfinished or has no light, and for a picture or a truth of another
        size than the map.

    Examples
    --------
    >>> import tempfile
    >>> from hdrlab import pipeline, scenes
    >>> from hdrlab.capture import camera
    >>> assembly = pipeline.assemble(camera.shoot(scenes.room((48, 72)), [0.01, 0.04, 0.16], rng=1))
    >>> picture = pipeline.develop(assembly.E)
    >>> write_report(tempfile.mkdtemp(), assembly, picture, recipe={"tonemap": "reinhard"}).name
    'report.html'
    """
    picture = np.asarray(picture)
    quality = assembly.quality
    if quality is None or assembly.medians is None:
        raise InputError(f"expected a finished assembly, got one after stage {assembly.stage!r}")
    fits = picture.shape[:2] == quality.shape and picture.shape[2:] in ((), (3,))
    if picture.dtype != np.uint8 or not fits:
        raise InputError(
            f"expected a uint8 picture of {quality.shape} pixels, got {describe(picture)}"
        )
    if assembly.fallback:
        alt = "The picture: the photos, fused without a map"
    else:
        alt = "The picture: the radiance map, tone-mapped for a display"
    if recipe and isinstance(recipe, str):
        recipe = {"how": recipe}
    modules = {module.__name__: module for module in (hdrlab, np, scipy, platform)}
    script, script_hash = pressed_pixels.read_script()
    text = templates.render_page(
        Path(__file__).parent,
        REPORT_FILE_NAME,
        assembly=assembly,
        picture=picture,
        truth=truth,
        picture_illustration=figures.photograph(picture, MAX_PICTURE_SIDE, alt),
        pressed=pressed_pixels.describe_pixels(assembly),
        shorten=shorten,
        script=script,
        script_hash=script_hash,
        sections=sections,
        wording=wording,
        recipe=recipe,
        modules=modules,
        Quality=Quality,
    )
    page = Path(folder) / REPORT_FILE_NAME
    page.parent.mkdir(parents=True, exist_ok=True)
    return write(page, text)
