"""Run commands of hdrlab and interrupt them at a chosen change of a file.

`CommandServer` starts a process that has imported hdrlab, and forks it for each command, because the
import takes longer than most commands. A command counts its changes of files below its working folder:
files opened for writing, new folders, renames, removals, links. At the chosen change, it sends itself
a signal.
"""

import ctypes
import json
import os
import signal
import subprocess
import sys
import threading
import traceback
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

TIMEOUT_SECONDS = 300
PRELOADED = (
    "hdrlab.pipeline",
    "hdrlab.show.plots",
    "hdrlab.show.pages.report",
    "hdrlab.show.pages.sheet",
    "hdrlab.beyond.video",
    "hdrlab.course.authoring.handouts",
    "hdrlab.course.classroom.run",
    "hdrlab.course.projects.report",
    "hdrlab.course.projects.review",
    "hdrlab.demo",
    "hdrlab.io.sequence",
    "hdrlab.io.screens",
    "nbformat",
    "skimage.filters",
    "tifffile",
    "scipy.optimize",
    "matplotlib.backends.backend_agg",
)
CHANGE_EVENTS = {
    "os.mkdir",
    "os.rename",
    "os.remove",
    "os.rmdir",
    "os.link",
    "os.symlink",
    "os.truncate",
    "sqlite3.connect",
}
WRITE_FLAGS = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC
# Constants of Linux: the capabilities with which root ignores file modes, and how to drop them.
DAC_OVERRIDE = 1
DAC_READ_SEARCH = 2
CAPABILITY_VERSION = 0x20080522
PR_CAPBSET_DROP = 24


@dataclass(frozen=True)
class CommandRun:
    """How to run a command.

    Attributes
    ----------
    words : the words after `hdrlab`
    folder : the working folder
    signal, change : the signal, and the number of the change at which it is sent; 0 for no signal
    is_ordinary_user : whether root obeys file modes like other users
    """

    words: list[str]
    folder: str
    signal: int = 0
    change: int = 0
    is_ordinary_user: bool = False


@dataclass(frozen=True)
class CommandResult:
    """How a command ended.

    Attributes
    ----------
    code : its exit code, negative for a signal
    out, err : what it wrote to standard output and standard error
    changes : how often it changed a file
    """

    code: int
    out: str
    err: str
    changes: int

    @property
    def last_line(self):
        """The last line on standard error."""
        return (self.err.strip().splitlines() or [""])[-1]


class CommandServer:
    """A process that runs commands, one after the other."""

    def __init__(self, home):
        """Start the process; matplotlib keeps its cache in the folder `home`."""
        environment = os.environ | {"MPLCONFIGDIR": str(home), "OMP_NUM_THREADS": "1"}
        self.process = subprocess.Popen(
            [sys.executable, "-W", "ignore", __file__],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=environment,
            text=True,
        )

    def run(self, run):
        """Run a command to its end."""
        self.process.stdin.write(json.dumps(asdict(run)) + "\n")
        self.process.stdin.flush()
        return CommandResult(**json.loads(self.process.stdout.readline()))

    def close(self):
        """End the process."""
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()


def serve():
    """Read a CommandRun per line from standard input, run it, and print its CommandResult."""
    import importlib

    from hdrlab import cli

    for module in PRELOADED:
        importlib.import_module(module)
    requests = os.fdopen(os.dup(0))
    with open(os.devnull) as empty:
        os.dup2(empty.fileno(), 0)  # the commands have no standard input
    for line in requests:
        result = run_forked(cli.run, CommandRun(**json.loads(line)))
        sys.stdout.write(json.dumps(asdict(result)) + "\n")
        sys.stdout.flush()


def run_forked(command, run):
    """Run a command in a child process and return its CommandResult."""
    outputs = [os.memfd_create(name) for name in ("out", "err", "changes")]
    child = os.fork()
    if child == 0:
        os.setsid()
        code = 1
        try:
            code = run_here(command, run, outputs)
        except BaseException:
            traceback.print_exc()
        finally:
            for stream in (sys.stdout, sys.stderr):
                with suppress(OSError):
                    stream.flush()
            os._exit(code)
    timeout = threading.Timer(TIMEOUT_SECONDS, os.kill, (child, signal.SIGKILL))
    timeout.start()
    _, status = os.waitpid(child, 0)
    timeout.cancel()
    texts = []
    for descriptor in outputs:
        size = os.fstat(descriptor).st_size
        texts.append(os.pread(descriptor, size, 0).decode(errors="replace"))
        os.close(descriptor)
    return CommandResult(os.waitstatus_to_exitcode(status), texts[0], texts[1], len(texts[2]))


def run_here(command, run, outputs):
    """Run a command in this process and return its exit code."""
    os.dup2(outputs[0], 1)
    os.dup2(outputs[1], 2)
    os.chdir(run.folder)
    os.environ["TMPDIR"] = f"{run.folder}/tmp"
    sys.argv = ["hdrlab", *run.words]
    signal.signal(signal.SIGINT, signal.default_int_handler)
    if run.is_ordinary_user:
        drop_root_privileges()
    interrupt_at_change(run, outputs[2])
    try:
        command()
    except SystemExit as stop:
        return stop.code if isinstance(stop.code, int) else int(stop.code is not None)
    except KeyboardInterrupt:
        return -signal.SIGINT % 256
    return 0


def interrupt_at_change(run, count):
    """Send the signal at the chosen change, and write a byte to the file `count` at each change."""
    lock = threading.Lock()
    home = run.folder + os.sep
    number = 0

    def count_change(event, arguments):
        nonlocal number
        if event == "open":
            if not (isinstance(arguments[2], int) and arguments[2] & WRITE_FLAGS):
                return
        elif event not in CHANGE_EVENTS:
            return
        path = arguments[0]
        if isinstance(path, int):
            return
        if not os.path.abspath(os.fsdecode(path)).startswith(home):
            return
        with lock:
            number += 1
            os.write(count, b".")
            is_chosen = number == run.change
        if is_chosen:
            os.kill(os.getpid(), run.signal)

    sys.addaudithook(count_change)


def drop_root_privileges():
    """Make root obey file modes; do nothing for other users."""
    if os.geteuid() != 0:
        return
    libc = ctypes.CDLL(None)
    for capability in (DAC_OVERRIDE, DAC_READ_SEARCH):
        libc.prctl(PR_CAPBSET_DROP, capability, 0, 0, 0)
    header = (ctypes.c_uint32 * 2)(CAPABILITY_VERSION, 0)
    sets = (ctypes.c_uint32 * 6)()
    libc.capget(header, sets)
    for k in range(3):  # effective, permitted and inheritable capabilities
        sets[k] &= ~(1 << DAC_OVERRIDE | 1 << DAC_READ_SEARCH)
    libc.capset(header, sets)


def read_folder(folder):
    """Return the bytes of each file below a folder by its path, and None for each folder."""
    return {
        str(path.relative_to(folder)): path.read_bytes() if path.is_file() else None
        for path in sorted(Path(folder).rglob("*"))
    }


if __name__ == "__main__":
    serve()
