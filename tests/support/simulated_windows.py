"""Simulate on Linux what Windows lacks, for tests of what students and instructors do on Windows.

`hide_posix` removes the modules, signals and functions that only POSIX has, and adds two methods of
sockets that only Windows has. `build_interpreter` makes a Python that does so in every process. Like
the launcher of a virtual environment on Windows, it is a process between the caller and Python.

The interpreter also runs this file as a script: the supervisor of the sandbox starts Python without
`sitecustomize`, so this file runs first and then runs the supervisor.
"""

import contextlib
import ctypes
import importlib.util
import os
import runpy
import signal
import socket
import subprocess
import sys
import threading
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SYSTEM_MODULE = ROOT / "hdrlab/course/sandbox/inside/system.py"
POSIX_MODULES = ("fcntl", "resource", "pwd", "pyseccomp")
POSIX_NAMES_OF_OS = {
    "fork",
    "forkpty",
    "killpg",
    "setpgid",
    "setsid",
    "getuid",
    "geteuid",
    "posix_fallocate",
    "mkfifo",
    "waitid",
    "sched_getaffinity",
    "O_NOFOLLOW",
    "O_DIRECTORY",
}
PR_SET_PDEATHSIG = 1  # of Linux, see prctl(2): the signal that a process gets when its parent ends
# In place of python.exe: Python is its child and ends with it.
LAUNCHER = """#!{python} -IS
import ctypes, subprocess, sys
die_with_parent = lambda: ctypes.CDLL(None).prctl(1, 9, 0, 0, 0)
command = [{python!r}, *sys.argv[1:]]
sys.exit(subprocess.call(command, close_fds=False, preexec_fn=die_with_parent))
"""
# In place of the base interpreter, which starts the supervisor: this file runs before it.
BASE_INTERPRETER = """#!/bin/sh
while [ "${{1#*supervisor.py}}" = "$1" ]; do flags="$flags $1"; shift; done
exec {python} $flags {this} "$@"
"""
SITE_CUSTOMIZATION = """
import importlib.util, sys
spec = importlib.util.spec_from_file_location("simulated_windows", {this!r})
simulated_windows = importlib.util.module_from_spec(spec)
spec.loader.exec_module(simulated_windows)
simulated_windows.hide_posix()
sys.executable = {launcher!r}
sys._base_executable = {base!r}
"""
# hide_posix removes these functions from the module `socket`
recv_fds = socket.recv_fds
send_fds = socket.send_fds


def build_interpreter(folder):
    """Make a Python that behaves as if it ran on Windows.

    Returns
    -------
    launcher : the path of the interpreter
    environment : the environment variables that it needs
    """
    import matplotlib  # here, because a supervisor cannot import it

    launcher = folder / "launcher"
    base = folder / "base"
    this = os.path.abspath(__file__)
    base_python = getattr(sys, "_base_executable", sys.executable)
    launcher.write_text(LAUNCHER.format(python=sys.executable), encoding="utf8")
    base.write_text(BASE_INTERPRETER.format(python=base_python, this=this), encoding="utf8")
    customization = SITE_CUSTOMIZATION.format(this=this, launcher=str(launcher), base=str(base))
    (folder / "sitecustomize.py").write_text(customization, encoding="utf8")
    launcher.chmod(0o755)
    base.chmod(0o755)
    environment = {
        "PATH": os.defpath,
        "PYTHONPATH": os.pathsep.join([str(folder), str(ROOT)]),
        "OPENBLAS_NUM_THREADS": "1",
        "HOME": str(folder),
        "TMPDIR": str(folder),
        "MPLCONFIGDIR": matplotlib.get_configdir(),
    }
    return str(launcher), environment


def hide_posix():
    """Remove from this process what Windows lacks."""
    add_socket_sharing()
    with contextlib.suppress(ImportError):
        import filelock  # noqa: F401 before fcntl is hidden: on Windows it locks with msvcrt
    for name in POSIX_MODULES:
        sys.modules[name] = None
    for name in POSIX_NAMES_OF_OS & set(dir(os)):
        delattr(os, name)
    del signal.SIGKILL
    del socket.send_fds
    del socket.recv_fds
    # on Windows, kill() is a call of its own and needs no SIGKILL
    subprocess.Popen.kill = lambda process: process.send_signal(9)
    original_init = subprocess.Popen.__init__

    def init_without_pass_fds(self, *arguments, **options):
        if options.get("pass_fds"):
            raise ValueError("pass_fds not supported on Windows.")
        original_init(self, *arguments, **options)

    subprocess.Popen.__init__ = init_without_pass_fds
    load_system_module()


def load_system_module():
    """Import hdrlab's module `system` while sys.platform says that this is Windows."""
    spec = importlib.util.spec_from_file_location("system", SYSTEM_MODULE)
    module = importlib.util.module_from_spec(spec)
    platform = sys.platform
    sys.platform = "win32"
    try:
        spec.loader.exec_module(module)
    finally:
        sys.platform = platform
    sys.modules["system"] = module
    sys.modules["hdrlab.course.sandbox.inside.system"] = module


def add_socket_sharing():
    """Add the methods by which a process on Windows hands a socket to another process."""

    def share(self, process):
        copy = self.dup()
        listening = socket.socket(socket.AF_UNIX)
        listening.bind(f"\0hdrlab-{os.getpid()}-{process}")
        listening.listen()

        def send_copy():
            with copy, listening, listening.accept()[0] as link:
                send_fds(link, [b"s"], [copy.fileno()])

        threading.Thread(target=send_copy, daemon=True).start()
        return listening.getsockname()

    def fromshare(name):
        with socket.socket(socket.AF_UNIX) as link:
            link.connect(name)
            _, descriptors, _, _ = recv_fds(link, 1, 1)
            return socket.socket(fileno=descriptors[0])

    socket.socket.share = share
    socket.fromshare = fromshare


if __name__ == "__main__":
    hide_posix()
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, 9, 0, 0, 0)
    del sys.argv[0]
    runpy.run_path(sys.argv[0], run_name="__main__")
