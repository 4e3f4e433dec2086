"""Draw the bits of floating-point numbers and RGBE pixels, and the bytes of a scanline.

field   a part of a number       its name, its bits as "0101", and their meaning
half    16 bits                  sign 1, exponent 5, mantissa 10
float   32 bits                  sign 1, exponent 8, mantissa 23
RGBE    4 bytes                  three mantissas, one exponent
planes  of a scanline            (4, W) uint8: all red mantissas, then green, blue, exponents

Each kind of field has its own color, and its name is written beside it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from hdrlab.core.arrays import ArrayLike, describe
from hdrlab.errors import InputError
from hdrlab.show.plots import BLACK, picture_axes
from hdrlab.show.plots.lectures.offsets import WIDTH_INCHES

# Lengths are in inches.
ROW_HEIGHT = 0.36
BOX_SIDE = 0.21
NAME_WIDTH = 1.3
LONG_ROW_LEFT = 0.38
TITLE_HEIGHT = 0.35
NO_TITLE_HEIGHT = 0.08
# The bits of a longer field have a row of their own.
MAX_SHORT_FIELD_BITS = 20
CHANNEL_COLORS = {"red": "#F6CDBB", "green": "#BFE5D8", "blue": "#C0DAEE"}
FIELD_COLORS = {
    "sign": "#E6E6E6",
    "exponent": "#F3D9A4",
    "mantissa": "#C6E2F5",
    **CHANNEL_COLORS,
}
RGBE_BIAS = 128


@dataclass(frozen=True)
class FloatFormat:
    """A binary floating-point format: numpy's types, the bits of its exponent, and their bias."""

    float_type: Any
    integer_type: Any
    exponent_bits: int
    bias: int


FLOAT_FORMATS = {
    16: FloatFormat(np.float16, np.uint16, exponent_bits=5, bias=15),
    32: FloatFormat(np.float32, np.uint32, exponent_bits=8, bias=127),
}


class Field(NamedTuple):
    """A part of a number: its name, whose first word selects the color, its bits, their meaning."""

    name: str
    bits: str
    meaning: str


def rgbe(pixel: ArrayLike) -> Axes:
    """Draw the four bytes of an RGBE pixel (4,) uint8, a row each: bits, number and radiance."""
    pixel = np.asarray(pixel)
    if pixel.shape != (4,) or pixel.dtype != np.uint8:
        raise InputError(f"expected a pixel (4,) uint8, got {describe(pixel)}")
    *mantissas, e = pixel.tolist()
    fields = []
    for name, m in zip(CHANNEL_COLORS, mantissas, strict=True):
        value = np.ldexp(m / 256, e - RGBE_BIAS) if e else 0.0
        fields.append(Field(f"{name} mantissa", f"{m:08b}", f"{m}, so {value:.4g}"))
    meaning = "0: black"
    if e:
        unit = np.ldexp(1.0, e - RGBE_BIAS - 8)
        meaning = f"{e}: 2^{e - RGBE_BIAS} / 256 = {unit:.3g}"
    fields.append(Field("exponent", f"{e:08b}", meaning))
    return rows(fields)


def number(value: float, *, bits: int = 16) -> Axes:
    """Draw the fields of a half (16 bits) or a float (32 bits), a row each, with their meaning."""
    if bits not in FLOAT_FORMATS:
        raise InputError(f"expected 16 or 32 bits, got {bits}")
    layout = FLOAT_FORMATS[bits]
    with np.errstate(over="ignore"):
        stored = layout.float_type(value)
    text = f"{int(stored.view(layout.integer_type)):0{bits}b}"
    sign = text[0]
    exponent = text[1 : 1 + layout.exponent_bits]
    mantissa = text[1 + layout.exponent_bits :]
    e = int(exponent, 2)
    fraction = int(mantissa, 2) / 2 ** len(mantissa)
    leading_digit = 1 if e > 0 else 0
    factor = f"times {leading_digit + fraction:.8g}" if np.isfinite(stored) else ""
    fields = [
        Field("sign", sign, "-" if sign == "1" else "+"),
        Field("exponent", exponent, _describe_exponent(e, layout)),
        Field("mantissa", mantissa, factor),
    ]
    return rows(fields, title=f"{value:.7g} is stored as {float(stored):.10g}")


def rows(fields: Sequence[Field], *, title: str = "") -> Axes:
    """Draw each field as a row: its name, a box for each bit, and its meaning.

    The bits of a long field are in a second row below its name.
    """
    is_long = [len(field.bits) > MAX_SHORT_FIELD_BITS for field in fields]
    heights = [2 * ROW_HEIGHT if long else ROW_HEIGHT for long in is_long]
    title_height = TITLE_HEIGHT if title else NO_TITLE_HEIGHT
    height = sum(heights) + title_height
    ax = picture_axes(WIDTH_INCHES, height, (0.01, 0, 0.98, 1 - title_height / height))
    digit_places: dict[str, list[tuple[float, float]]] = {"0": [], "1": []}
    boxes = []
    colors = []
    tops = np.cumsum([0, *heights])[:-1]
    for field, y, long in zip(fields, tops, is_long, strict=True):
        count = len(field.bits)
        if long:
            left = LONG_ROW_LEFT
            top = y + ROW_HEIGHT - 0.05
            meaning_left = NAME_WIDTH
        else:
            left = NAME_WIDTH
            top = y
            meaning_left = 1.4 + BOX_SIDE * count
        for x, bit in zip(left + BOX_SIDE * np.arange(count), field.bits, strict=True):
            boxes.append(Rectangle((x, top), BOX_SIDE, BOX_SIDE))
            digit_places[bit].append((x + BOX_SIDE / 2, top + BOX_SIDE / 2))
        kind = field.name.split()[0]
        colors += [FIELD_COLORS.get(kind, FIELD_COLORS["mantissa"])] * count
        ax.text(0, y + BOX_SIDE / 2, field.name, fontsize=10, va="center")
        ax.text(meaning_left, y + BOX_SIDE / 2, field.meaning, fontsize=10, va="center")
    ax.add_collection(PatchCollection(boxes, facecolors=colors, edgecolors="#808080"))
    # Digits are markers, because a text for each bit would take longer than all the rest.
    for digit, places in digit_places.items():
        ax.plot(
            *np.reshape(places, (-1, 2)).T,
            marker=f"${digit}$",
            color=BLACK,
            markersize=7,
            markeredgewidth=0,
            linestyle="none",
        )
    ax.set(xlim=(0, WIDTH_INCHES * 0.98), ylim=(sum(heights), -0.03))
    ax.text(
        0.012, 1 - 0.2 / height, title, fontsize=11, va="center", transform=ax.figure.transFigure
    )
    return ax


def scanline(planes: ArrayLike, done: int, *, title: str = "") -> Figure:
    """Draw the planes of a scanline (4, W) while it is decoded: `done` of its 4 W bytes are known."""
    planes = np.asarray(planes)
    if planes.ndim != 2 or len(planes) != 4 or not 0 <= done <= planes.size:
        raise InputError(
            f"expected planes (4, W) and 0 to 4 W bytes, got {describe(planes)} and {done}"
        )
    width = planes.shape[1]
    figure = Figure(figsize=(WIDTH_INCHES, 2.6), dpi=100)
    names = (*CHANNEL_COLORS, "exponent")
    for k, (name, plane) in enumerate(zip(names, planes, strict=True)):
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


def _describe_exponent(e: int, layout: FloatFormat) -> str:
    """Return the meaning of an exponent field; 0 has the power of 1, for subnormal numbers."""
    largest = 2**layout.exponent_bits - 1
    if e == largest:
        return f"{e}: infinity, or no number"
    return f"{e}: 2^{max(e, 1) - layout.bias}"
