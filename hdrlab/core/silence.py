"""Suppress output that compiled libraries write past Python's sys.stdout and sys.stderr."""

import contextlib
import os
from collections.abc import Iterator


@contextlib.contextmanager
def silence(descriptor: int) -> Iterator[None]:
    """Discard everything that is written to file descriptor 1 (output) or 2 (errors).

    Examples
    --------
    >>> with silence(1):
    ...     written = os.write(1, b"not to be seen")
    >>> written
    14
    """
    with open(os.devnull, "wb") as nowhere, contextlib.ExitStack() as after:
        with contextlib.suppress(OSError):  # a program without a terminal may have closed it
            kept = after.enter_context(open(os.dup(descriptor), "wb"))
            after.callback(os.dup2, kept.fileno(), descriptor)
            os.dup2(nowhere.fileno(), descriptor)
        yield
