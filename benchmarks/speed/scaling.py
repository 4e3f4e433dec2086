"""From 2 to 12 megapixels: time that grows with the pixels and not faster, and what merging takes."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

from benchmarks import data
from benchmarks.rows import Case, Row, Run, grows, within
from hdrlab import pipeline
from hdrlab.radiance.merge import merge

SIZES = {"2 MP": data.SMALL, "12 MP": data.LARGE}


def case(make: Callable[[Path, data.Size, bool], Run], folder: Path, one: bool) -> Case:
    """Return the same work at both sizes."""
    return Case({name: make(folder, size, one) for name, size in SIZES.items()}, {})


def merging(folder: Path, size: data.Size, one: bool) -> Run:
    """Return the merge of seven photographs."""
    bracket, g = data.photographs(folder, size), data.response()
    return lambda: merge(bracket.images, bracket.times, g, threads=1 if one else None)


def developing(folder: Path, size: data.Size, one: bool) -> Run:
    """Return Reinhard's global operator to 8 bits."""
    E = data.scene(folder, size)
    return lambda: pipeline.develop(E, "reinhard")


POWER = grows("2 MP", "12 MP", data.PIXELS, 1.15)
ROWS = (
    Row(
        "merge-12", "radiance map, 2 and 12 megapixels", partial(case, merging), (POWER, within("12 MP", 200))
    ),
    Row(
        "reinhard-12", "Reinhard's global operator, 2 and 12 megapixels", partial(case, developing), (POWER,)
    ),
)
