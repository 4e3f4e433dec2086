"""Reading a portable float map: from_bytes(data) -> E."""

import numpy as np

from hdrlab.course.checks.compare import points, same


def drawn(rng, channels=()):
    # of few bits: no byte at either end of the values is a white space
    return (10.0 ** rng.uniform(-3, 3, (4, 6, *channels))).astype(np.float16).astype(np.float32)


def file(E, scale="-1.0", order="<f4", gap=b"\n"):
    """Return the bytes of a PFM file, written here by hand."""
    head = gap.join([b"PF" if E.ndim == 3 else b"Pf", b"%d %d" % E.shape[1::-1], scale.encode()])
    return head + b"\n" + E[::-1].astype(order).tobytes()


@points(4)
def test_the_first_row_of_the_file_is_the_lowest(subject, rng):
    """Is your picture upside down?

    The first row of the file is the lowest of the picture.

    Turn the rows round: E[::-1].
    """
    E = drawn(rng)
    same(subject.from_bytes(file(E)), E, 1e-6 * E.max(), what="E", picture=True)


@points(2)
def test_a_map_in_colour_has_three_channels(subject, rng):
    """PF has three values for each pixel.

    The second line is width, then height.

    Reshape to (height, width, 3).
    """
    E = drawn(rng, (3,))
    same(subject.from_bytes(file(E)), E, 1e-6 * E.max(), what="E")


@points(3)
def test_a_positive_scale_is_big_endian(subject, rng):
    """What does a positive scale say?

    Its sign is the order of the bytes: positive is big endian.

    np.frombuffer with '>f4' where the scale is positive.
    """
    E = drawn(rng)
    same(subject.from_bytes(file(E, "1.0", ">f4")), E, 1e-6 * E.max(), what="E", picture=True)


def test_a_first_value_that_looks_like_white_space_is_a_value(subject):
    """Where does the header end, and where do the values begin?

    The first value's bytes may look like a new line.

    One white space, and no more, follows the scale: do not strip.
    """
    E = np.array([0x20200A0A, 0x0A0A2020], "<u4").view("<f4").reshape(1, 2)
    same(np.asarray(subject.from_bytes(file(E)), np.float64) / E.max(), E / E.max(), 1e-6, what="E")
