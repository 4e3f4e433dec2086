"""Default pictures of hdrlab beside those of Luminance HDR and pfstools, to look at.

`python -m benchmarks pictures OUT [MAP ...]` writes OUT/pictures.png with a row for each radiance
map, and prints the mean and the black and white parts of each picture. Without MAP, the maps are
those of ../shared/data and the embedded scenes. To compare brackets, assemble them first: a map that
`hdrlab assemble` wrote states how bright the scene was. A program that is not installed has an
empty column.
"""

import argparse
import os
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from hdrlab import pipeline, scenes
from hdrlab.core.arrays import F32, Array
from hdrlab.io import radiance
from hdrlab.show.plots import figures

DATA = Path(__file__).resolve().parents[2] / "shared/data"
MAPS = ("hdri_cc0/*.hdr", "memorial/memorial.hdr", "openexr/*.exr")
# pixels of the longer side of a picture
SIDE = 360
LABEL_HEIGHT = 16
SECONDS_PER_PICTURE = 120
# pixel values that count as black and as white
BLACK_LEVEL = 4
WHITE_LEVEL = 252

Program = Callable[[Path, Path], None]


def luminance_hdr(operator: str) -> Program:
    """Return the program that tone-maps a map by an operator of Luminance HDR."""

    def run(source: Path, target: Path) -> None:
        environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "HOME": str(target.parent)}
        _run(
            ["luminance-hdr-cli", "-l", source, "--tmo", operator, "-o", target],
            env=environment,
        )

    return run


def pfstools(operator: str) -> Program:
    """Return the program that tone-maps a map by an operator of pfstools, with a gamma of 2.2."""

    def run(source: Path, target: Path) -> None:
        steps = f"pfsin '{source}' | pfstmo_{operator} | pfsgamma -g 2.2 | pfsout '{target}'"
        _run(["bash", "-o", "pipefail", "-c", steps])

    return run


PROGRAMS: dict[str, Program] = {
    "luminance mantiuk06": luminance_hdr("mantiuk06"),
    "luminance fattal": luminance_hdr("fattal"),
    "pfstmo_mantiuk06": pfstools("mantiuk06"),
    "pfstmo_reinhard02": pfstools("reinhard02"),
}


def _run(command: list[str | Path], env: dict[str, str] | None = None) -> None:
    """Run a program without its output."""
    subprocess.run(command, env=env, check=True, capture_output=True, timeout=SECONDS_PER_PICTURE)


def read_maps(paths: list[Path]) -> Iterator[tuple[str, F32, float | None]]:
    """Yield name, radiance, and cd/m^2 of a unit of each map: of these paths, or of all there are."""
    if not paths:
        for name, make in {
            "chapel": scenes.chapel,
            "workshop": scenes.workshop,
            "street": scenes.street,
            "room": scenes.room,
        }.items():
            yield name, make(), None
        paths = [path for pattern in MAPS for path in sorted(DATA.glob(pattern))]
    for path in paths:
        E = radiance.read_radiance(path, clean=True)
        yield path.name, E, radiance.read_luminance_of_unit(path)


def make_pictures(E: F32, luminance_of_unit: float | None, folder: Path) -> Iterator[Array | None]:
    """Yield the picture of hdrlab and of each program, or None if a program fails or is missing."""
    yield pipeline.develop(E, luminance_of_unit=luminance_of_unit)
    source = folder / "map.hdr"
    radiance.write_radiance(source, E)
    for number, program in enumerate(PROGRAMS.values()):
        target = folder / f"{number}.png"
        target.unlink(missing_ok=True)
        try:
            program(source, target)
            yield np.asarray(Image.open(target).convert("RGB"))
        except (OSError, subprocess.SubprocessError):
            yield None


def describe(picture: Array) -> str:
    """Return the mean of a picture, and the percentages of its pixels that are black and white."""
    gray = picture if picture.ndim == 2 else picture.max(axis=-1)
    black = 100 * np.mean(gray <= BLACK_LEVEL)
    white = 100 * np.mean(gray >= WHITE_LEVEL)
    return f"{picture.mean():4.0f} {black:3.0f} {white:3.0f}"


def main(arguments: list[str]) -> int:
    """Write the pictures, print the table, and return the exit code."""
    parser = argparse.ArgumentParser("python -m benchmarks pictures")
    parser.add_argument("out", type=Path)
    parser.add_argument("maps", type=Path, nargs="*")
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    names = ["hdrlab", *PROGRAMS]
    print("mean, black %, white %:", ", ".join(names))
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        for name, E, luminance_of_unit in read_maps(options.maps):
            small = figures.fit(E, SIDE)
            pictures = list(make_pictures(small, luminance_of_unit, Path(scratch)))
            cells = ["failed     " if shown is None else describe(shown) for shown in pictures]
            print(f"{name:24}", " | ".join(cells), flush=True)
            rows.append((name, pictures))
    draw_table(rows, names).save(options.out / "pictures.png")
    return 0


def draw_table(rows: list[tuple[str, list[Array | None]]], names: list[str]) -> Image.Image:
    """Return one image of all pictures, a row for each map and a column for each program."""
    heights = []
    for _, pictures in rows:
        heights.append(max(shown.shape[0] for shown in pictures if shown is not None))
    height = sum(heights) + LABEL_HEIGHT * len(rows)
    sheet = Image.new("RGB", (SIDE * len(names), height), "white")
    draw = ImageDraw.Draw(sheet)
    top = 0
    for (row_name, pictures), row_height in zip(rows, heights, strict=True):
        for column, (name, shown) in enumerate(zip(names, pictures, strict=True)):
            left = SIDE * column
            draw.text((left + 2, top + 2), f"{row_name}: {name}", fill="black")
            if shown is not None:
                sheet.paste(Image.fromarray(shown), (left, top + LABEL_HEIGHT))
        top += row_height + LABEL_HEIGHT
    return sheet
