"""The first process in a sandbox: it imports numpy once, forks a process per check, and clears up.

control  the socket to the grader; see `serve_checks` for the messages
link     the socket of one check, which the grader sends over the control socket

When a check ends, its memory, its processes and its files end with it. The student's code never
runs in this process. This file goes into the sandbox with channel.py, system.py and worker.py, and
hdrlab is not there: it needs the standard library and numpy alone.
"""

import contextlib
import gc
import importlib
import importlib.util
import os
import shutil
import signal
import socket
import sys
from functools import partial
from typing import Any

OWN_MODULES = ("channel", "system", "worker")
ENDING_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP")
STDERR = 2


class PackageFinder:
    """Find the packages that a submission may import and the modules of this folder, nothing else.

    No folder is put on sys.path, because a folder that holds numpy holds much else.

    Parameters
    ----------
    files : dict
        The files of the top-level modules, by name.
    """

    def __init__(self, files: dict[str, str]) -> None:
        self.files = files

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> Any:
        """Return the spec of a top-level module, or None; submodules are found as usual."""
        if path is not None or name not in self.files:
            return None
        file = self.files[name]
        is_package = file.endswith("__init__.py")
        return importlib.util.spec_from_file_location(
            name, file, submodule_search_locations=[os.path.dirname(file)] if is_package else None
        )


def become_check(link: socket.socket, order: dict[str, Any]) -> None:
    """Limit and filter this process, and run a student's functions in it until the link closes."""
    system = importlib.import_module("system")
    system.set_limits(order["limits"], required=order["credit"])
    if order["seccomp_program"]:
        system.install_seccomp_filter(order["seccomp_program"])
    worker = importlib.import_module("worker")
    worker.serve(link, importlib.import_module("channel"))


def serve_checks(control: socket.socket, order: dict[str, Any]) -> None:
    """Fork a process for each check that the grader orders, until the grader closes the socket.

    A "check" message brings the seconds of processor time that the check may use, and a descriptor:
    the link of the new process. The answer is "begun".

    An "end" message brings the seconds that the check has to end by itself. The answer comes when
    nothing of the check is left: "clean", with the signal that ended it, or 0, and the seconds of
    processor time that it used.
    """
    system = importlib.import_module("system")
    channel = importlib.import_module("channel")
    pid = 0
    cpu_seconds_before = 0.0
    try:
        while True:
            kind, check_number, seconds = channel.receive(control)
            if kind == "check":
                cpu_seconds_before = system.children_cpu_seconds()
                check_order = order | {"limits": limit_cpu_seconds(order["limits"], seconds)}
                pid = system.fork_check(control, partial(become_check, order=check_order))
                channel.send(control, "begun", call=check_number)
            else:
                ending_signal = system.wait_for_signal(pid, seconds)
                system.end_check(pid, order["has_pid_namespace"])
                cpu_seconds = system.children_cpu_seconds() - cpu_seconds_before
                channel.send(control, "clean", (ending_signal, cpu_seconds), check_number)
                pid = 0
    except EOFError:
        if pid:
            system.end_check(pid, order["has_pid_namespace"])


def limit_cpu_seconds(limits: dict[str, int], seconds: int) -> dict[str, int]:
    """Return the limits of a process, with at most this processor time."""
    return limits | {"CPU": min(seconds, limits["CPU"])}


def import_modules(modules: list[str]) -> None:
    """Import what the checks will need, and seed numpy's global random generator."""
    for name in ("numpy.random", "worker", *modules):
        # if a module is missing, the submission fails where it imports it
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    sys.modules["numpy.random"].seed(0)
    gc.collect()
    # the collector then leaves these objects alone, and forked processes share their memory
    gc.freeze()


def install_finder(packages: tuple[str, ...]) -> None:
    """Make the modules of this folder importable, and packages that are given as "name=folder"."""
    here = os.path.dirname(os.path.abspath(__file__))
    files = {name: f"{here}/{name}.py" for name in OWN_MODULES}
    for package in packages:
        name, _, folder = package.partition("=")
        files[name] = f"{folder}/__init__.py"
    sys.meta_path.append(PackageFinder(files))


def reset_signals() -> None:
    """Give the signals that end a process their default action, so that no check can send them.

    Python handles SIGINT. If a signal has its default action instead, Linux does not deliver it
    from inside a PID namespace to the namespace's first process.
    """
    for name in ENDING_SIGNALS:
        # Windows lacks some of them
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_DFL)


def silence_stderr() -> None:
    """Discard what this process and its libraries write to stderr from now on."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, STDERR)
    os.close(nowhere)


def main(control_number: str, *packages: str) -> None:
    """Receive the order, get ready, and serve checks; without fork, become the only check.

    Parameters
    ----------
    control_number : str
        The descriptor of the control socket.
    packages : str
        Packages that may be imported, each as "name=folder".
    """
    install_finder(packages)
    system = importlib.import_module("system")
    channel = importlib.import_module("channel")
    control = system.inherit_control(control_number)
    _, _, order = channel.receive(control)
    reset_signals()
    system.adopt_orphans()
    import_modules(order["modules"])
    silence_stderr()
    channel.send(control, "ready")
    if order["can_fork"]:
        serve_checks(control, order)
    else:
        become_check(control, order)
    if order["scratch"]:
        # the grader cannot remove it if it was killed
        shutil.rmtree(order["scratch"], ignore_errors=True)
    # at once: nothing is left that needs an orderly end
    os._exit(0)


if __name__ == "__main__":
    main(*sys.argv[1:])
