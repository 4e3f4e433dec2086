"""Ways of damaging a file, each of what a reader believes: lengths, numbers, order, text."""

import random
import re
import struct
from collections.abc import Callable, Sequence

# bytes of a mutated file
LARGEST = 400_000
MOST_CHANGES = 5
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
NUMBERS: tuple[bytes, ...] = (
    b"0",
    b"-1",
    b"1",
    b"65536",
    b"2147483648",
    b"-9223372036854775809",
    b"1e400",
    b"nan",
    b"1e-320",
)
NUMBERS += (
    b"9" * 30,
    b"9" * 5000,
    b"0x7f",
    b"",
    b"1_0",
    b"\xd9\xa3",
    b"inf",
    b"-0",
    b"1/0",
    b"4294967295",
)
WORDS: tuple[bytes, ...] = (
    b"\0",
    b"\xed\xa0\x80",
    b"\\ud800",
    b"\x1b[2J",
    b"\x1b]0;x\x07",
    b"\xff",
    b"\xef\xbb\xbf",
    b"\xe2\x80\xae",
)
WORDS += (
    b"\r",
    b"\n",
    b'"',
    b",",
    b"\t",
    b"[" * 3000,
    b'{"a":' * 2000,
    b"../",
    b"null",
    b"true",
    b"=1+1",
)
WORDS += (
    b"\xff\xd9",
    b"x" * 140_000,
    b"#",
    b"\\",
    b"'",
    b"-",
    b"]",
    b"}",
    b"%s{0}",
    b"\xe2\x80\xa8",
    b"\x85",
)
# how numbers stand in binary headers
FORMS = ("B", "<H", ">H", "<I", ">I", "<Q", ">Q")
EDGES = (0, 1, 2, 3, 7, 255, 256, 65535, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 1 << 20, 1 << 27)
# bytes: most of what is believed stands before them
HEAD = 512


def generator(seed: int, reader: str, number: int) -> random.Random:
    """Return what draws one file, whichever files were drawn before."""
    return random.Random(f"{seed} {reader} {number}")


def mutated(seeds: Sequence[bytes], rng: random.Random) -> bytes:
    """Return one of the seeds with a few changes, or two of them spliced."""
    data = bytearray(rng.choice(seeds))
    if rng.random() < 0.1:
        splice(data, rng.choice(seeds), rng)
    for _ in range(min(1 + int(rng.expovariate(1)), MOST_CHANGES)):
        rng.choice(CHANGES)(data, rng)
    return bytes(data[:LARGEST])


def splice(data: bytearray, other: bytes, rng: random.Random) -> None:
    """Put the end of another file behind a beginning."""
    data[place(data, rng) :] = other[place(other, rng) :]


def place(data: bytes | bytearray, rng: random.Random) -> int:
    """Return a place in a file, half of the time in its head, where sizes stand."""
    return rng.randrange(min(len(data), HEAD if rng.random() < 0.5 else len(data)) + 1)


def flip(data: bytearray, rng: random.Random) -> None:
    """Flip a bit."""
    if data:
        data[place(data, rng) % len(data)] ^= 1 << rng.randrange(8)


def cut(data: bytearray, rng: random.Random) -> None:
    """Cut the end off."""
    del data[place(data, rng) :]


def remove(data: bytearray, rng: random.Random) -> None:
    """Take a block out."""
    at = place(data, rng)
    del data[at : at + rng.choice((1, 2, 4, 12, 64, 500))]


def repeat(data: bytearray, rng: random.Random) -> None:
    """Have a block twice, or many times."""
    at = place(data, rng)
    size = rng.choice((1, 4, 12, 64, 500))
    data[at:at] = data[at : at + size] * rng.choice((1, 1, 2, 50))


def edge(data: bytearray, rng: random.Random) -> None:
    """Write a number at the edge of its range over what stands there, as a header has it."""
    form = rng.choice(FORMS)
    value = rng.choice(EDGES)
    packed = struct.pack(form, value & ((1 << 8 * struct.calcsize(form)) - 1))
    at = place(data, rng)
    data[at : at + len(packed)] = packed


def number(data: bytearray, rng: random.Random) -> None:
    """Replace a number that is written in digits."""
    matches = list(NUMBER.finditer(bytes(data[:20_000])))
    if matches:
        match = rng.choice(matches)
        data[match.start() : match.end()] = rng.choice(NUMBERS)


def insert(data: bytearray, rng: random.Random) -> None:
    """Insert what a parser, a terminal or UTF-8 stumbles over."""
    at = place(data, rng)
    data[at:at] = rng.choice(WORDS)


def line(data: bytearray, rng: random.Random) -> None:
    """Move, double or drop a line, such as a field of a header."""
    lines = bytes(data).split(b"\n")
    line_taken = lines.pop(rng.randrange(len(lines)))
    for _ in range(rng.randrange(3)):
        lines.insert(rng.randrange(len(lines) + 1), line_taken)
    data[:] = b"\n".join(lines)


def swap(data: bytearray, rng: random.Random) -> None:
    """Exchange two blocks."""
    size = rng.choice((1, 2, 4, 12, 64))
    a = place(data, rng)
    b = place(data, rng)
    first = bytes(data[a : a + size])
    second = bytes(data[b : b + size])
    if len(first) == len(second) and abs(a - b) >= size:
        data[a : a + size] = second
        data[b : b + size] = first


Change = Callable[[bytearray, random.Random], None]
CHANGES: tuple[Change, ...] = (
    flip,
    flip,
    cut,
    remove,
    repeat,
    edge,
    edge,
    number,
    number,
    insert,
    line,
    swap,
)
