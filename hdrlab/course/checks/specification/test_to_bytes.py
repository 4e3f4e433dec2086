"""Checks of to_bytes(E), writing a portable float map: the bytes of the file."""

import numpy as np

from hdrlab.course.checks.compare import AnswerMismatch, points, require, same
from hdrlab.io.maps import pfm


def draw_inputs(rng, channels=()):
    return (10.0 ** rng.uniform(-3, 3, (5, 7, *channels))).astype(np.float32)


def get_answer(subject, E):
    """Return the bytes of the student's file."""
    data = subject.to_bytes(E)
    require(
        isinstance(data, bytes), "expected bytes, got another type: return the bytes of the file"
    )
    return data


def as_read(data):
    """Return what hdrlab reads from the bytes, or raise AnswerMismatch with the reader's
    message.
    """
    try:
        return pfm.from_bytes(data)
    except ValueError as error:
        raise AnswerMismatch(f"the file cannot be read: {error}") from None


def check_one_input(subject, E):
    """Read the student's file, because a header may be written in several ways."""
    same(as_read(get_answer(subject, E)), E, 1e-6 * E.max(), what="the map read back")


def test_the_file_starts_with_the_type_of_map(subject, rng):
    """The first two letters say which type of map follows.

    Pf means gray, and PF means color.

    Start the bytes of a gray map with b'Pf'.
    """
    for E, kind in ((draw_inputs(rng), b"Pf"), (draw_inputs(rng, (3,)), b"PF")):
        require(
            get_answer(subject, E)[:2] == kind, f"expected a file that starts with {kind.decode()}"
        )


@points(6)
def test_a_gray_map_is_read_back_the_right_way_up(subject, rng):
    """Open your file in another program: is the sky at the top?

    The rows of a PFM file run from bottom to top.

    Write E[::-1].
    """
    E = draw_inputs(rng)
    same(
        as_read(get_answer(subject, E)),
        E,
        1e-6 * E.max(),
        what="the gray map read back",
        picture=True,
    )


@points(4)
def test_a_color_map_is_read_back(subject, rng):
    """A gray map is Pf, and a color map is PF.

    The three values of a pixel follow each other.

    The second line has the width first, then the height.
    """
    E = draw_inputs(rng, (3,))
    same(as_read(get_answer(subject, E)), E, 1e-6 * E.max(), what="the color map read back")


@points(3)
def test_the_file_has_four_bytes_per_value(subject, rng):
    """The values are float32, with 4 bytes each.

    A file with n values has the header and 4 n bytes.

    Use E.astype('<f4').tobytes(). float64 takes twice as many bytes.
    """
    E = draw_inputs(rng)
    data = get_answer(subject, E)
    start = data.find(b"\n", data.find(b"\n", data.find(b"\n") + 1) + 1) + 1
    same(
        len(data) - start,
        4 * E.size,
        0,
        what="the number of bytes after the three lines of the header",
    )


@points(2)
def test_the_sign_of_the_scale_is_the_byte_order(subject, rng):
    """In which order are the bytes of a number? The third line says it.

    A negative scale means little-endian, and a positive one means big-endian.

    Write -1.0 as the scale, and the values as '<f4'.
    """
    E = draw_inputs(rng)
    data = get_answer(subject, E)
    scale = float(data.split(b"\n")[2])
    values = np.frombuffer(data[-4 * E.size :], "<f4" if scale < 0 else ">f4").reshape(E.shape)
    same(
        values[::-1],
        E,
        1e-6 * E.max(),
        what="the values, read in the byte order of the scale",
    )
