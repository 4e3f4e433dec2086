"""From 2 to 12 megapixels: time that grows with the pixels and not faster, and memory."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks import data
from benchmarks.rows import Case, Row, Run, grows, within
from hdrlab import pipeline
from hdrlab.core.colour import luminance
from hdrlab.fast import merge, mertens
from hdrlab.pipeline import catalogue

SIZES = {"2 MP": data.SMALL, "12 MP": data.LARGE}


Work = tuple[Run, int]  # and the bytes of its input


def case(make: Callable[[Path, data.Size, bool], Work], folder: Path, one_thread: bool) -> Case:
    """Return the same work at both sizes."""
    made = {name: make(folder, size, one_thread) for name, size in SIZES.items()}
    reads = {name: read for name, (_, read) in made.items()}
    return Case({name: run for name, (run, _) in made.items()}, {}, reads=reads)


def merging(folder: Path, size: data.Size, one_thread: bool) -> Work:
    """Return the merge of seven photographs."""
    bracket = data.photographs(folder, size)
    g = data.response()

    def work() -> Any:
        return merge.merge_with_quality(bracket.images, bracket.times, g)

    return work, bracket.images.nbytes


def developing(folder: Path, size: data.Size, one_thread: bool) -> Work:
    """Return Reinhard's global operator to 8 bits."""
    E = data.scene(folder, size)
    return lambda: pipeline.develop(E, "reinhard"), E.nbytes


def tonemapping(name: str, folder: Path, size: data.Size, one_thread: bool) -> Work:
    """Return an operator, luminance to luminance."""
    L = luminance(data.scene(folder, size))
    tonemap = catalogue.method("tonemap", name)
    return lambda: tonemap(L), L.nbytes


def fusing(folder: Path, size: data.Size, one_thread: bool) -> Work:
    """Return the fusion of seven photographs."""
    images = data.photographs(folder, size).images
    return lambda: mertens.fuse(images), images.nbytes


def operator(name: str) -> Row:
    """Return the row of an operator of tone mapping; a new one has its row by existing."""
    holds = (POWER, within("12 MP", MAX_MEGABYTES.get(name, DEFAULT_MAX_MEGABYTES)))
    return Row(
        f"{name}-12",
        f"{name}, 2 and 12 megapixels",
        partial(case, partial(tonemapping, name)),
        holds,
    )


POWER = grows("2 MP", "12 MP", data.PIXELS, 1.15)
MAX_MEGABYTES = {"fattal": 400, "local_laplacian": 450}
DEFAULT_MAX_MEGABYTES = 300
ROWS = (
    Row(
        "merge-12",
        "radiance map, 2 and 12 megapixels",
        partial(case, merging),
        (POWER, within("12 MP", 200)),
    ),
    Row(
        "picture-12",
        "Reinhard's operator to 8 bits, 2 and 12 megapixels",
        partial(case, developing),
        (POWER,),
    ),
    Row("mertens-12", "exposure fusion, 2 and 12 megapixels", partial(case, fusing), (POWER,)),
    *map(operator, catalogue.names("tonemap")),
)
