"""Writing a portable float map: to_bytes(E) -> the file's bytes."""

import numpy as np

from hdrlab.course.checks.compare import AnswerMismatch, points, require, same
from hdrlab.io.maps import pfm


def drawn(rng, channels=()):
    return (10.0 ** rng.uniform(-3, 3, (5, 7, *channels))).astype(np.float32)


def asked(subject, E):
    """Return the bytes that came."""
    data = subject.to_bytes(E)
    require(isinstance(data, bytes), "expected the bytes of a file, got something else")
    return data


def as_read(data):
    """Return what hdrlab reads out of the bytes, or raise AnswerMismatch with the reader's words."""
    try:
        return pfm.from_bytes(data)
    except ValueError as error:
        raise AnswerMismatch(f"the file cannot be read: {error}") from None


def test_the_file_begins_with_the_kind_of_map(subject, rng):
    """Two letters say what follows.

    Pf for gray, PF for colour.

    The bytes begin with b'Pf'.
    """
    for E, kind in ((drawn(rng), b"Pf"), (drawn(rng, (3,)), b"PF")):
        require(asked(subject, E)[:2] == kind, f"expected a file that begins with {kind.decode()}")


@points(6)
def test_what_is_written_is_read_again_and_stands_upright(subject, rng):
    """Look at the file with another program: where is the sky?

    The rows of a PFM file run from the bottom to the top.

    Write E[::-1].
    """
    E = drawn(rng)
    same(as_read(asked(subject, E)), E, 1e-6 * E.max(), what="the picture read again", picture=True)


@points(4)
def test_a_map_in_colour_is_read_again(subject, rng):
    """A gray map is Pf, a map in colour is PF.

    The three values of a pixel follow each other.

    The second line is width and height, in this order.
    """
    E = drawn(rng, (3,))
    same(as_read(asked(subject, E)), E, 1e-6 * E.max(), what="the map read again")


@points(3)
def test_the_file_holds_four_bytes_a_value_and_no_more(subject, rng):
    """The values are float32: 4 bytes each, no more.

    A file of n values is the header and 4 n bytes.

    E.astype('<f4').tobytes(): float64 would take twice as many.
    """
    E = drawn(rng)
    data = asked(subject, E)
    start = data.find(b"\n", data.find(b"\n", data.find(b"\n") + 1) + 1) + 1
    same(len(data) - start, 4 * E.size, 0, what="bytes after the header's three lines")


@points(2)
def test_the_sign_of_the_scale_is_the_order_of_the_bytes(subject, rng):
    """Which byte of a number comes first? The third line says so.

    A negative scale means little endian, a positive one big endian.

    Write -1.0, and '<f4'.
    """
    E = drawn(rng)
    data = asked(subject, E)
    scale = float(data.split(b"\n")[2])
    values = np.frombuffer(data[-4 * E.size :], "<f4" if scale < 0 else ">f4").reshape(E.shape)
    same(
        values[::-1],
        E,
        1e-6 * E.max(),
        what="the values, in the order of bytes that the scale tells",
    )
