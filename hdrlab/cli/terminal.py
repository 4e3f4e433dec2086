"""Show on a terminal that a command is still working, and make text from files safe to print."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event, Thread
from time import monotonic
from typing import TextIO

# messages may quote the content of a file, which may be of any length
MAX_MESSAGE_LENGTH = 2000


def visible(text: object) -> str:
    r"""Return text with its control characters escaped, and shortened to a length for a message.

    Examples
    --------
    >>> print(visible("a \x1b[2J of a title"))
    a \x1b[2J of a title
    """
    characters = str(text)
    shown = "".join(map(_escape, characters[:MAX_MESSAGE_LENGTH]))
    if len(characters) > MAX_MESSAGE_LENGTH:
        return f"{shown[:MAX_MESSAGE_LENGTH]} ..."
    return shown


def _escape(character: str) -> str:
    r"""Return a character as it is, or as \x1b if a terminal would obey it."""
    if character.isprintable() or character in "\n\t":
        return character
    return ascii(character)[1:-1]


@contextmanager
def elapsed(what: str, *, stream: TextIO | None = None, delay: float = 1.0) -> Iterator[None]:
    """Show `what` and the elapsed seconds while the block runs. Only a terminal shows them.

    This is for work whose progress is unknown. The line is removed when the block ends.

    Parameters
    ----------
    what : description of the work
    stream : where to show it; standard error by default
    delay : seconds before the line appears, and between its updates

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
    clock = Thread(target=_update_line, args=(what, stream, delay, done), daemon=True)
    clock.start()
    try:
        yield
    finally:
        # also after an error or Ctrl-C, whose message needs a clean line
        done.set()
        clock.join()


def _update_line(what: str, stream: TextIO, delay: float, done: Event) -> None:
    """Write the elapsed seconds every `delay` seconds until `done`, then erase the line."""
    start = monotonic()
    line = ""
    while not done.wait(delay):
        line = f"{what}: {monotonic() - start:.0f} s"
        stream.write("\r" + line)
        stream.flush()
    if line:
        stream.write("\r" + " " * len(line) + "\r")
        stream.flush()
