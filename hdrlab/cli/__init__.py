"""The `hdrlab` command line.

Every command is a thin layer over the library: it reads files, calls hdrlab and writes files. The
library is imported inside the commands, so that `hdrlab --help` stays fast. Output files appear
whole or not at all.

Exit codes: 0 for success, 2 for bad input (one line on standard error), 130 after Ctrl-C, and 1
with a traceback for a bug in hdrlab.
"""

import ctypes
import os
import signal
import sys
import traceback
from collections.abc import Sequence
from contextlib import suppress
from io import TextIOWrapper

import click

from hdrlab import __version__
from hdrlab.cli import (
    capture,
    course,
    gallery,
    grading,
    lessons,
    maps,
    noise,
    photos,
    projects,
    video,
    viva,
)
from hdrlab.cli.common import Group, Settings, debug_option
from hdrlab.cli.terminal import visible
from hdrlab.errors import HdrlabError

COMMANDS = (
    capture.correct,
    capture.meter,
    capture.plan,
    capture.shoot,
    course.course,
    gallery.gallery,
    grading.check,
    grading.doctor,
    grading.grade,
    grading.receipt,
    grading.regrade,
    lessons.demo,
    lessons.lab,
    lessons.site,
    maps.compare,
    maps.convert,
    maps.info,
    maps.score,
    maps.tonemap,
    maps.why,
    noise.noise,
    photos.assemble,
    photos.calibrate,
    projects.report,
    projects.submit,
    video.video,
    viva.viva,
)

# the headings of `hdrlab --help`, and the commands below each of them
SECTIONS = {
    "Photographs": (
        "assemble",
        "tonemap",
        "compare",
        "score",
        "info",
        "why",
        "convert",
        "calibrate",
        "correct",
        "meter",
        "noise",
        "plan",
        "shoot",
        "video",
    ),
    "Learn": ("demo", "lab", "check", "site"),
    "Teach": ("course", "grade", "regrade", "receipt", "viva", "doctor", "gallery"),
    "Project": ("report", "submit"),
}

EXIT_BUG = 1
EXIT_BAD_INPUT = 2
EXIT_INTERRUPTED = 130

# columns before and between the two columns of a list of commands
HELP_INDENT = 6

# the number of glibc's option M_ARENA_MAX, the number of memory pools
MALLOPT_ARENA_MAX = -8


class SectionedGroup(Group):
    """The group of all commands, whose help lists them by what they are for."""

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands of each section, one line each."""
        width = max(len(name) for name in self.commands)
        for heading, names in SECTIONS.items():
            limit = formatter.width - width - HELP_INDENT
            rows = [(name, self.commands[name].get_short_help_str(limit)) for name in names]
            with formatter.section(heading):
                formatter.write_dl([(name.ljust(width), text) for name, text in rows])


@click.group(
    cls=SectionedGroup,
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"], "show_default": True},
)
@click.version_option(__version__, prog_name="hdrlab")
@click.pass_context
def main(ctx: click.Context) -> None:
    """Make radiance maps and tone-mapped images from photos, and teach HDR imaging."""
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help())


main.params.append(debug_option(hidden=False))
for command in COMMANDS:
    main.add_command(command)


def run(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit.

    Parameters
    ----------
    arguments : the words after `hdrlab`; by default those of this process
    """
    if arguments is None:
        # called from Python, the caller's signal handlers stay
        _stop_like_ctrl_c()
    _limit_threads_and_memory()
    _replace_unprintable_characters()
    settings = Settings()
    try:
        sys.exit(main.main(arguments, prog_name="hdrlab", standalone_mode=False, obj=settings))
    except Exception as error:
        if settings.debug:
            traceback.print_exc()
        message, exit_code = _describe(error)
        if _is_bug(error) and not settings.debug:
            traceback.print_exc()
        click.echo(f"hdrlab: {visible(message)}", err=True)
    sys.exit(exit_code)


def _stop_like_ctrl_c() -> None:
    """Let SIGTERM and the end of the terminal stop the command as Ctrl-C does.

    A command that was started with nohup goes on without its terminal.
    """
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) != signal.SIG_IGN:
        signal.signal(signal.SIGHUP, signal.default_int_handler)


def _is_bug(error: Exception) -> bool:
    """Return whether an error is none of those that hdrlab, click or the system raise on purpose."""
    on_purpose = (click.exceptions.Abort, click.ClickException, HdrlabError, OSError, MemoryError)
    return not isinstance(error, on_purpose) and not _is_interrupt(error)


def _describe(error: Exception) -> tuple[str, int]:
    """Return the line that tells the user about an error, and the exit code."""
    if isinstance(error, click.exceptions.Abort) or _is_interrupt(error):
        return "interrupted", EXIT_INTERRUPTED
    if isinstance(error, click.ClickException):
        return error.format_message(), error.exit_code
    if isinstance(error, HdrlabError):
        return str(error), EXIT_BAD_INPUT
    if isinstance(error, OSError):
        if error.filename is None:
            return str(error), EXIT_BAD_INPUT
        return f"{_file_names(error)}: {error.strerror}", EXIT_BAD_INPUT
    if isinstance(error, MemoryError):
        return str(error) or "not enough memory", EXIT_BAD_INPUT
    return (
        f"this is a bug in hdrlab ({type(error).__name__}); please report it with the lines above",
        EXIT_BUG,
    )


def _file_names(error: OSError) -> str:
    """Return the name of the file of an error, or both of a rename that failed."""
    if error.filename2 is None:
        return os.fsdecode(error.filename)
    return f"{os.fsdecode(error.filename)} -> {os.fsdecode(error.filename2)}"


def _is_interrupt(error: Exception) -> bool:
    """Tell whether Ctrl-C caused an error.

    Python and pybind11 wrap a KeyboardInterrupt in a RuntimeError or an ImportError when it
    arrives while a class is created or a C extension is loaded.
    """
    return isinstance(error, RuntimeError | ImportError) and isinstance(
        error.__cause__, KeyboardInterrupt
    )


def _limit_threads_and_memory() -> None:
    """Use one BLAS thread and one memory pool: for small matrices, more threads only wait."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    with suppress(AttributeError, OSError, TypeError):
        ctypes.CDLL(None).mallopt(MALLOPT_ARENA_MAX, 1)


def _replace_unprintable_characters() -> None:
    """Print `?` for what an output stream cannot encode, such as ✗ on a pipe of Windows."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")
