"""Suppress what libraries print past Python's streams, and warnings that do not matter to users.

Both change a state of the whole process for a moment: there is one stream 2 and one list of warning
filters for all threads. OpenEXR and its codecs offer no handler for their messages, so the stream
is the only place where they can be held back.
"""

import contextlib
import os
import threading
import warnings
from collections.abc import Iterator

# whose warnings about odd EXIF, large sizes and odd tags hdrlab judges itself
LIBRARY_MODULES = r"(PIL|tifffile|pillow_heif)(\.|$)"
# what NumPy warns of where there is nothing to average
EMPTY_MEAN = "Mean of empty slice|Degrees of freedom|All-NaN"

_lock = threading.Lock()
_open_blocks = 0
_filters = contextlib.ExitStack()


@contextlib.contextmanager
def ignore_library_warnings() -> Iterator[None]:
    """Ignore warnings of the libraries that read photos, and of NumPy about empty means.

    Blocks of several threads may overlap: the first that begins changes the filters, and the last
    that ends restores them. `warnings.catch_warnings` in each thread would restore them in any
    order, which can leave warnings off for good. Other warnings are shown meanwhile.

    Examples
    --------
    >>> import numpy as np
    >>> with ignore_library_warnings():
    ...     mean = np.nanmean(np.array([np.nan]))
    >>> bool(np.isnan(mean))
    True
    """
    global _open_blocks
    with _lock:
        if not _open_blocks:
            _filters.enter_context(warnings.catch_warnings())
            warnings.filterwarnings("ignore", module=LIBRARY_MODULES)
            warnings.filterwarnings("ignore", EMPTY_MEAN, RuntimeWarning)
        _open_blocks += 1
    try:
        yield
    finally:
        with _lock:
            _open_blocks -= 1
            if not _open_blocks:
                _filters.close()


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
