"""Drawings of the bits of numbers and of RGBE pixels, and of the bytes of a scanline."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.io.maps import rgbe
from hdrlab.show import pictures
from hdrlab.show.plots.lectures import bits


def texts(ax):
    return [text.get_text() for text in ax.texts]


def drawn(ax):
    """Return the bits in the boxes, line by line."""
    placed = [
        (y, x, line.get_marker().strip("$")) for line in ax.lines for x, y in line.get_xydata()
    ]
    return "".join(bit for _, _, bit in sorted(placed))


def test_rgbe_shows_the_four_bytes_of_the_slides_pixel_and_their_values():
    ax = bits.rgbe(np.array([145, 215, 87, 149], np.uint8))
    assert drawn(ax) == "10010001" + "11010111" + "01010111" + "10010101"
    labels = texts(ax)
    assert "145, so 1.188e+06" in labels and "149: 2^21 / 256 = 8.19e+03" in labels


@given(st.tuples(*[st.integers(0, 255)] * 4))
def test_values_beside_the_mantissas_are_those_that_rgbe_decodes(pixel):
    given_ = np.array(pixel, np.uint8)
    E = rgbe.to_radiance(given_[None, None])[0, 0]
    labels = [text.split("so ")[1] for text in texts(bits.rgbe(given_)) if "so " in text]
    assert [float(label) for label in labels] == pytest.approx(E.tolist(), rel=1e-3, abs=0)


@pytest.mark.parametrize("pixel", [np.zeros(3, np.uint8), np.zeros(4), [1, 2, 3, 4]])
def test_rgbe_rejects_anything_but_four_bytes(pixel):
    with pytest.raises(ValueError, match="pixel"):
        bits.rgbe(pixel)


@pytest.mark.parametrize(
    ("size", "kind", "word"), [(16, np.float16, np.uint16), (32, np.float32, np.uint32)]
)
@pytest.mark.parametrize("value", [0.7, -3.0, 1e-6, 0.0, 12345.0])
def test_number_shows_the_bits_of_numpys_format(size, kind, word, value):
    expected = f"{int(kind(value).view(word)):0{size}b}"
    assert drawn(bits.number(value, bits=size)) == expected


@pytest.mark.parametrize("value", [0.7, 1e-6, 3e-5, 1000.0])
def test_power_of_two_times_mantissa_is_the_number(value):
    labels = texts(bits.number(value))
    power = next(text.split("^")[1] for text in labels if "2^" in text)
    times = next(text.split()[1] for text in labels if text.startswith("times"))
    assert 2.0 ** int(power) * float(times) == pytest.approx(float(np.float16(value)), rel=1e-6)


def test_number_beyond_the_largest_half_is_infinity():
    labels = texts(bits.number(1e5))
    assert any("infinity" in text for text in labels)
    assert not any("times" in text for text in labels)
    assert "100000" in labels[-1] and "inf" in labels[-1]


def test_number_rejects_other_sizes():
    with pytest.raises(ValueError, match="16 or 32 bits.*64"):
        bits.number(1.0, bits=64)


def test_scanline_shows_as_many_bytes_as_are_decoded():
    planes = np.arange(40, dtype=np.uint8).reshape(4, 10)
    figure = bits.scanline(planes, 23)
    shown = [ax.patches[0].get_data().values.tolist() for ax in figure.axes]
    assert shown == [planes[0].tolist(), planes[1].tolist(), planes[2, :3].tolist(), []]


@pytest.mark.parametrize(
    ("planes", "done"), [(np.zeros((3, 5)), 0), (np.zeros((4, 5)), 21), (np.zeros(20), 0)]
)
def test_scanline_rejects_other_shapes_and_too_many_bytes(planes, done):
    with pytest.raises(ValueError, match="planes"):
        bits.scanline(planes, done)


def test_all_drawings_of_bits_have_the_same_width():
    made = [
        bits.rgbe(np.zeros(4, np.uint8)),
        bits.number(1.0),
        bits.number(1.0, bits=32),
        bits.scanline(np.zeros((4, 8), np.uint8), 32),
    ]
    assert {pictures.render(figure).shape[1] for figure in made} == {540}
