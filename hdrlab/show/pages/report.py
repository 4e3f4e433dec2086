"""The report on a radiance map: one page that travels alone, with what was found and how far to trust it.

The template `report.html` asks `sections` for what it says; its pictures travel in it.
Nothing on the page is fetched, and nothing on it runs.
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
from hdrlab.radiance.merge import Quality
from hdrlab.show.pages import sections, templates, wording
from hdrlab.show.plots import figures

PAGE = "report.html"


def write_report(
    folder: str | Path,
    assembly: Assembly,
    picture: ArrayLike,
    *,
    recipe: str | Mapping[str, Any] = "",
    truth: Truth | None = None,
) -> Path:
    """Write `report.html` into a folder, which is made where it is missing, and return the page's path.

    Parameters
    ----------
    folder : path
        A page that stands there is replaced when the new one is complete.
    assembly : Assembly
        All that `pipeline.assemble` found.
    picture : (h, w) or (h, w, 3) uint8
        The tone-mapped map, as `pipeline.develop` returns it.
    recipe : str or mapping
        How it was made, beyond what the assembly knows: methods and knobs, by name.
    truth : Truth, optional
        Adds the errors of radiance, response and offsets.

    Raises
    ------
    ValueError
        For an assembly that is not finished or without light, a picture or a truth that does not
        fit it.

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
        raise InputError(
            f"expected a finished assembly, got one after the stage {assembly.stage!r}"
        )
    if (
        picture.dtype != np.uint8
        or picture.shape[:2] != quality.shape
        or picture.shape[2:] not in ((), (3,))
    ):
        raise InputError(
            f"expected a uint8 picture of {quality.shape} pixels, got {describe(picture)}"
        )
    seen = "fused without a map" if assembly.fallback else "tone-mapped for a display"
    seen = f"The picture: the {'photographs' if assembly.fallback else 'radiance map'}, {seen}"
    words: dict[str, Any] = {"assembly": assembly, "picture": picture, "truth": truth}
    words |= {
        "shown": figures.photograph(picture, 1600, seen),
        "sections": sections,
        "wording": wording,
    }
    words |= {"recipe": {"how": recipe} if recipe and isinstance(recipe, str) else recipe}
    words |= {
        "modules": {one.__name__: one for one in (hdrlab, np, scipy, platform)},
        "Quality": Quality,
    }
    text = templates.render_page(Path(__file__).parent, PAGE, **words)
    page = Path(folder) / PAGE
    page.parent.mkdir(parents=True, exist_ok=True)
    return write(page, text)
