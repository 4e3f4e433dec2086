"""A sign of life on a terminal, for work that does not know how far it is."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event, Thread
from time import monotonic
from typing import TextIO

# letters: what a file holds may be quoted in a message, and may be of any length
LONGEST_MESSAGE = 2000


def visible(text: object) -> str:
    r"""Return text of any origin as a terminal may show it: controls are written out, and it is not too long.

    Examples
    --------
    >>> print(visible("a \x1b[2J of a title"))
    a \x1b[2J of a title
    """
    letters = str(text)[: LONGEST_MESSAGE + 1]
    shown = "".join(
        one if one.isprintable() or one in "\n\t" else ascii(one)[1:-1] for one in letters
    )
    return shown if len(letters) <= LONGEST_MESSAGE else f"{shown[:LONGEST_MESSAGE]} ..."


@contextmanager
def elapsed(what: str, *, stream: TextIO | None = None, delay: float = 1.0) -> Iterator[None]:
    """Show `what` and the seconds gone by while the block runs, after `delay` and on a terminal alone.

    A bar would be a guess where the work is one piece. The line is removed when the block ends.

    Parameters
    ----------
    what : the work
    stream : standard error by default
    delay : seconds before the first sign, and between two of them

    Examples
    --------
    >>> with elapsed("adding"):
    ...     sum(range(10))
    45
    """
    stream = stream or sys.stderr
    if not stream.isatty():
        yield
        return
    done = Event()
    clock = Thread(target=_tick, args=(what, stream, delay, done), daemon=True)
    clock.start()
    try:
        yield
    finally:  # after an error or Ctrl-C too: its message belongs on a clean line
        done.set()
        clock.join()


def _tick(what: str, stream: TextIO, delay: float, done: Event) -> None:
    start, line = monotonic(), ""
    while not done.wait(delay):
        line = f"{what}: {monotonic() - start:.0f} s"
        stream.write("\r" + line)
        stream.flush()
    if line:
        stream.write("\r" + " " * len(line) + "\r")
        stream.flush()
