"""Checks of from_bytes(data), reading a portable float map: E."""

import numpy as np

from hdrlab.course.checks.compare import points, same


def draw_inputs(rng, channels=()):
    # float16 values: no byte at either end of the data is white space
    return (10.0 ** rng.uniform(-3, 3, (4, 6, *channels))).astype(np.float16).astype(np.float32)


def file(E, scale="-1.0", order="<f4", gap=b"\n"):
    """Return the bytes of a PFM file."""
    head = gap.join([b"PF" if E.ndim == 3 else b"Pf", b"%d %d" % E.shape[1::-1], scale.encode()])
    return head + b"\n" + E[::-1].astype(order).tobytes()


SMALL_INPUTS = [
    (file(np.array([[1]], np.float32)),),
    (file(np.array([[1], [2]], np.float32)),),
    (file(np.array([[1, 2, 3]], np.float32)),),
    (file(np.array([[[1, 2, 3], [4, 5, 6]]], np.float32)),),
    (file(np.array([[1]]), "1.0", ">f4"),),
    (file(np.array([[1]], np.float32), gap=b" "),),
    (file(np.array([[1]], np.float32), gap=b"\t"),),
    (file(np.array([[1]], np.float32), gap=b" \n"),),
    (file(np.array([0x0A0A2020], "<u4").view("<f4").reshape(1, 1)),),
]


@points(4)
def test_the_first_row_of_the_file_is_the_bottom_row(subject, rng):
    """Is your image upside down?

    The first row of the file is the bottom row of the image.

    Reverse the rows: E[::-1].
    """
    E = draw_inputs(rng)
    same(subject.from_bytes(file(E)), E, 1e-6 * E.max(), what="E", picture=True)


@points(2)
def test_a_color_map_has_three_channels(subject, rng):
    """A PF file has three values for each pixel.

    The second line has the width first, then the height.

    Reshape to (height, width, 3).
    """
    E = draw_inputs(rng, (3,))
    same(subject.from_bytes(file(E)), E, 1e-6 * E.max(), what="E")


@points(3)
def test_a_positive_scale_is_big_endian(subject, rng):
    """What does a positive scale mean?

    The sign of the scale is the byte order: positive means big-endian.

    Use np.frombuffer with '>f4' if the scale is positive.
    """
    E = draw_inputs(rng)
    same(subject.from_bytes(file(E, "1.0", ">f4")), E, 1e-6 * E.max(), what="E", picture=True)


def test_a_value_that_looks_like_white_space_is_kept(subject):
    """Where does the header end, and where do the values start?

    The first bytes of the values can look like line breaks.

    Exactly one white-space character follows the scale. Do not use strip.
    """
    E = np.array([0x20200A0A, 0x0A0A2020], "<u4").view("<f4").reshape(1, 2)
    same(np.asarray(subject.from_bytes(file(E)), np.float64) / E.max(), E / E.max(), 1e-6, what="E")


@points(2)
def test_any_white_space_separates_the_header(subject, rng):
    """Another program writes the header into one line. Can you read it?

    Any white space may separate its parts: spaces, tabs or several lines.

    Search for the parts, not for lines. A regular expression is one way: rb"(P[Ff])\\s+(\\d+)\\s+...".
    """
    E = draw_inputs(rng)
    for gap in (b" ", b"\t", b" \n"):
        what = f"E of a file with {gap!r} in the header"
        same(subject.from_bytes(file(E, gap=gap)), E, 1e-6 * E.max(), what=what)
