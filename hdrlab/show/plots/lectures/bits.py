"""Numbers as they stand in a file, drawn: every bit, what its field says, and a scanline, code by code.

field   a part of a number       its name, its bits as "0101", and what they stand for, in words
half    16 bits                  sign 1, exponent 5, mantissa 10
float   32 bits                  sign 1, exponent 8, mantissa 23
RGBE    4 bytes                  three mantissas, one exponent
planes  of a scanline            (4, W) uint8: all red mantissas, then green, blue, exponents

Each kind of field has its colour; the names stand beside them, so none is told by its colour alone.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from hdrlab.core.arrays import ArrayLike, describe
from hdrlab.errors import InputError
from hdrlab.show.plots import picture_axes

WIDTH = 5.4  # inches, as the other plots have
# inches from row to row, and of a box; bits beyond which a row is long
ROW = 0.36
SIDE = 0.21
LONG = 20
CHANNELS = {"red": "#F6CDBB", "green": "#BFE5D8", "blue": "#C0DAEE"}
COLOURS = {"sign": "#E6E6E6", "exponent": "#F3D9A4", "mantissa": "#C6E2F5", **CHANNELS}
FORMATS: dict[int, Any] = {16: (np.float16, np.uint16, 5, 15), 32: (np.float32, np.uint32, 8, 127)}


class Field(NamedTuple):
    """A part of a number: its name, whose first word gives the colour, its bits, and what they say."""

    name: str
    bits: str
    said: str


def rgbe(pixel: ArrayLike) -> Axes:
    """Draw the four bytes of a pixel (4,) uint8, a row each: bits, number, and what a channel comes to."""
    given = np.asarray(pixel)
    if given.shape != (4,) or given.dtype != np.uint8:
        raise InputError(f"expected a pixel (4,) uint8, got {describe(given)}")
    *mantissas, e = given.tolist()
    fields = []
    for name, m in zip(CHANNELS, mantissas, strict=True):
        value = np.ldexp(m / 256, e - 128) if e else 0.0
        fields.append(Field(f"{name} mantissa", f"{m:08b}", f"{m}, so {value:.4g}"))
    unit = f"{e}: 2^{e - 128} / 256 = {np.ldexp(1.0, e - 136):.3g}" if e else "0: black"
    return rows([*fields, Field("exponent", f"{e:08b}", unit)])


def number(value: float, *, bits: int = 16) -> Axes:
    """Draw the fields of a half (16 bits) or a float (32), a row each, with what they say."""
    if bits not in FORMATS:
        raise InputError(f"expected 16 or 32 bits, got {bits}")
    kind, as_word, wide, bias = FORMATS[bits]
    with np.errstate(over="ignore"):
        stored = kind(value)
    text = f"{int(stored.view(as_word)):0{bits}b}"
    sign = text[0]
    exponent = text[1 : 1 + wide]
    mantissa = text[1 + wide :]
    e = int(exponent, 2)
    m = int(mantissa, 2) / 2 ** len(mantissa)
    fields = [
        Field("sign", sign, "-" if sign == "1" else "+"),
        Field("exponent", exponent, _power(e, bias, 2**wide - 1)),
        Field("mantissa", mantissa, f"times {m + (e > 0):.8g}" if np.isfinite(stored) else ""),
    ]
    return rows(fields, title=f"{value:.7g} is stored as {float(stored):.10g}")


def rows(fields: Sequence[Field], *, title: str = "") -> Axes:
    """Draw fields as rows of boxes, a bit in each, between name and meaning; long rows stand below."""
    tall = [2 * ROW if len(field.bits) > LONG else ROW for field in fields]
    above = 0.35 if title else 0.08
    height = sum(tall) + above
    ax = picture_axes(WIDTH, height, (0.01, 0, 0.98, 1 - above / height))
    digits: dict[str, list[tuple[float, float]]] = {"0": [], "1": []}
    boxes = []
    colours = []
    for (name, bits, said), y in zip(fields, np.cumsum([0, *tall]), strict=False):
        long = len(bits) > LONG
        left, top = (0.38, y + ROW - 0.05) if long else (1.3, y)
        for x, bit in zip(left + SIDE * np.arange(len(bits)), bits, strict=True):
            boxes.append(Rectangle((x, top), SIDE, SIDE))
            digits[bit].append((x + SIDE / 2, top + SIDE / 2))
        colours += [COLOURS.get(name.split()[0], COLOURS["mantissa"])] * len(bits)
        ax.text(0, y + SIDE / 2, name, fontsize=10, va="center")
        ax.text(
            1.3 if long else 1.4 + SIDE * len(bits), y + SIDE / 2, said, fontsize=10, va="center"
        )
    ax.add_collection(PatchCollection(boxes, facecolors=colours, edgecolors="#808080"))
    look: dict[str, Any] = dict(color="#1A1A1A", markersize=7, markeredgewidth=0, linestyle="none")
    for (
        digit,
        at,
    ) in digits.items():  # as markers: a text for each bit takes longer than all the rest
        ax.plot(*np.reshape(at, (-1, 2)).T, marker=f"${digit}$", **look)
    ax.set(xlim=(0, WIDTH * 0.98), ylim=(sum(tall), -0.03))
    ax.text(
        0.012, 1 - 0.2 / height, title, fontsize=11, va="center", transform=ax.figure.transFigure
    )
    return ax


def scanline(planes: ArrayLike, done: int, *, title: str = "") -> Figure:
    """Return the four planes of a scanline (4, W), of whose 4 W bytes `done` are known; the rest is pale."""
    given = np.asarray(planes)
    if given.ndim != 2 or len(given) != 4 or not 0 <= done <= given.size:
        raise InputError(
            f"expected planes (4, W) and 0 to 4 W bytes, got {describe(given)} and {done}"
        )
    width = given.shape[1]
    figure = Figure(figsize=(WIDTH, 2.6), dpi=100)
    for k, (name, plane) in enumerate(zip((*CHANNELS, "exponent"), given, strict=True)):
        ax = figure.add_axes((0.15, 0.72 - 0.18 * k, 0.83, 0.15))
        known = min(max(done - k * width, 0), width)
        ax.stairs(plane[:known], np.arange(known + 1) - 0.5, fill=True, color="#404040")
        ax.axvspan(known - 0.5, width - 0.5, color="#DCE6EE")
        ax.set(xlim=(-0.5, width - 0.5), ylim=(0, 255), yticks=())
        ax.set_ylabel(name, rotation=0, ha="right", va="center", fontsize=10)
        if k < 3:
            ax.set_xticks(())
    ax.set_xlabel("pixel of the scanline; bars are bytes, 0 to 255", labelpad=1)
    figure.text(0.15, 0.92, title, fontsize=11, va="center")
    return figure


def _power(e: int, bias: int, top: int) -> str:
    """Return what an exponent field of e says; in the lowest one the mantissa has no 1 before its point."""
    return f"{e}: infinity, or no number" if e == top else f"{e}: 2^{max(e, 1) - bias}"
