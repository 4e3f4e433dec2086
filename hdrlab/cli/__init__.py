"""The `hdrlab` command: the library's verbs with files around them.

Nothing is computed here. Chapters are imported inside the commands, so that `hdrlab --help` answers
at once. Bad input ends in one line on standard error and exit code 2, Ctrl-C in 130; files are
written whole or not at all.
"""

import ctypes
import os
import signal
import sys
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from io import TextIOWrapper
from pkgutil import iter_modules

import click

from hdrlab.cli.common import main
from hdrlab.cli.terminal import visible

for module in iter_modules(__path__):  # whose commands join the group when they are imported
    import_module(f"{__name__}.{module.name}")


def run(arguments: Sequence[str] | None = None) -> None:
    """Run the command and exit: 0 where all went well, 2 for bad input, 130 after Ctrl-C or SIGTERM."""
    if arguments is None:  # not from Python, whose own signals stay
        signal.signal(signal.SIGTERM, signal.default_int_handler)
    # the products here are small: threads only wait on them
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # glibc's M_ARENA_MAX: one pool of memory for all threads
    with suppress(AttributeError, OSError, TypeError):
        ctypes.CDLL(None).mallopt(-8, 1)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):  # a pipe of Windows has no sign such as ✗
            stream.reconfigure(errors="replace")
    try:
        sys.exit(main.main(arguments, prog_name="hdrlab", standalone_mode=False))
    except click.exceptions.Abort:
        said, code = "interrupted", 130
    except click.ClickException as error:
        said, code = error.format_message(), error.exit_code
    except OSError as error:
        said, code = f"{error.filename}: {error.strerror}" if error.filename else str(error), 2
    except (ValueError, MemoryError) as error:
        said, code = str(error) or type(error).__name__, 2
    except (
        RuntimeError,
        ImportError,
    ) as error:  # wrap what rises while a class, or a module of C, is made
        if not isinstance(error.__cause__, KeyboardInterrupt):
            raise
        said, code = "interrupted", 130
    click.echo(f"hdrlab: {visible(said)}", err=True)
    sys.exit(code)
