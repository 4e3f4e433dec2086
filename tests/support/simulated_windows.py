"""A Linux that lacks what Windows lacks: for tests of what a student and an instructor do there.

`hide` takes away modules, signals and calls that only POSIX has, and lends two methods of sockets
that only Windows has. `build` makes an interpreter that does so in every process, and that stands,
as the launcher of a virtual environment does there, between a process and the one it was started
by.
"""

import contextlib
import ctypes
import importlib.util
import os
import signal
import socket
import subprocess
import sys
import threading
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SYSTEM = ROOT / "hdrlab/course/sandbox/inside/system.py"
MODULES = ("fcntl", "resource", "pwd", "pyseccomp")
CALLS = (
    "fork",
    "forkpty",
    "killpg",
    "setpgid",
    "setsid",
    "getuid",
    "geteuid",
    "posix_fallocate",
    "mkfifo",
)
CALLS += ("waitid", "sched_getaffinity", "O_NOFOLLOW", "O_DIRECTORY")
LAUNCHER = """#!{python} -IS
import ctypes, subprocess, sys
die = lambda: ctypes.CDLL(None).prctl(1, 9, 0, 0, 0)
sys.exit(subprocess.call([{python!r}, *sys.argv[1:]], close_fds=False, preexec_fn=die))
"""
BASE = """#!/bin/sh
while [ "${{1#*supervisor.py}}" = "$1" ]; do flags="$flags $1"; shift; done
exec {python} $flags {this} "$@"
"""
CUSTOMIZE = """
import importlib.util, sys
spec = importlib.util.spec_from_file_location("windows", {this!r})
windows = importlib.util.module_from_spec(spec)
spec.loader.exec_module(windows)
windows.hide()
sys.executable, sys._base_executable = {launcher!r}, {base!r}
"""
recv_fds, send_fds = socket.recv_fds, socket.send_fds


def build(folder):
    """Return (launcher, environment): how a command is started that believes to be on Windows."""
    import matplotlib  # here: a supervisor has numpy and scipy alone

    launcher, base, this = folder / "launcher", folder / "base", os.path.abspath(__file__)
    python = getattr(sys, "_base_executable", sys.executable)
    launcher.write_text(LAUNCHER.format(python=sys.executable), encoding="utf8")
    base.write_text(BASE.format(python=python, this=this), encoding="utf8")
    customize = CUSTOMIZE.format(this=this, launcher=str(launcher), base=str(base))
    (folder / "sitecustomize.py").write_text(customize, encoding="utf8")
    for one in (launcher, base):
        one.chmod(0o755)
    paths = os.pathsep.join([str(folder), str(ROOT)])
    environment = {"PATH": os.defpath, "PYTHONPATH": paths, "OPENBLAS_NUM_THREADS": "1"}
    environment |= dict.fromkeys(("HOME", "TMPDIR"), str(folder)) | {
        "MPLCONFIGDIR": matplotlib.get_configdir()
    }
    return str(launcher), environment


def hide():
    """Take away what Windows has not, from this process."""
    share_sockets()
    with contextlib.suppress(ImportError):
        import filelock  # noqa: F401 it locks by fcntl here, as it does by msvcrt on Windows
    for name in MODULES:
        sys.modules[name] = None
    for name in set(CALLS) & set(dir(os)):
        delattr(os, name)
    del signal.SIGKILL, socket.send_fds, socket.recv_fds
    subprocess.Popen.kill = lambda process: process.send_signal(
        9
    )  # it is a call of its own on Windows
    started = subprocess.Popen.__init__

    def start(self, *words, **options):
        if options.get("pass_fds"):
            raise ValueError("pass_fds not supported on Windows.")
        started(self, *words, **options)

    subprocess.Popen.__init__ = start
    load_system()


def load_system():
    """Import the module that knows the system, while that pretends to be another."""
    spec = importlib.util.spec_from_file_location("system", SYSTEM)
    module = importlib.util.module_from_spec(spec)
    before, sys.platform = sys.platform, "win32"
    try:
        spec.loader.exec_module(module)
    finally:
        sys.platform = before
    sys.modules["system"] = sys.modules["hdrlab.course.sandbox.inside.system"] = module


def share_sockets():
    """Lend sockets the methods by which one process of Windows hands them to another."""

    def share(self, process):
        kept, listening = self.dup(), socket.socket(socket.AF_UNIX)
        listening.bind(f"\0hdrlab-{os.getpid()}-{process}")
        listening.listen()

        def give():
            with kept, listening, listening.accept()[0] as link:
                send_fds(link, [b"s"], [kept.fileno()])

        threading.Thread(target=give, daemon=True).start()
        return listening.getsockname()

    def fromshare(name):
        with socket.socket(socket.AF_UNIX) as link:
            link.connect(name)
            return socket.socket(fileno=recv_fds(link, 1, 1)[1][0])

    socket.socket.share, socket.fromshare = share, fromshare


if (
    __name__ == "__main__"
):  # in front of the supervisor, which starts without any site's customization
    import runpy

    hide()
    ctypes.CDLL(None).prctl(1, 9, 0, 0, 0)
    del sys.argv[0]
    runpy.run_path(sys.argv[0], run_name="__main__")
