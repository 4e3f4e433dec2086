"""The first process in a sandbox: it imports numpy once, forks a process per check, and clears up behind it.

control  the socket to the parent, on which orders come and answers go: see `tend`
link     the socket of one check, which the parent sends over the control

What a check has left behind ends with it: its memory, its processes, its files. The student's code
never runs in this process. Like channel.py, system.py and worker.py, which stand beside it in the
sandbox, it needs the standard library and numpy alone.
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


class PackageFinder:
    """Finds the packages that a submission may import, and what stands beside this file, and nothing else.

    No folder is put on sys.path: one that holds numpy holds much else.
    """

    def __init__(self, files: dict[str, str]) -> None:
        self.files = files

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> Any:
        """Return where a top-level module is, or None; what lies inside of it is found as ever."""
        if path is not None or name not in self.files:
            return None
        file = self.files[name]
        inside = [os.path.dirname(file)] if file.endswith("__init__.py") else None
        return importlib.util.spec_from_file_location(name, file, submodule_search_locations=inside)


def begin(link: socket.socket, order: dict[str, Any]) -> None:
    """Become the process of a check: limited, filtered, and with nothing but its link."""
    system, channel = importlib.import_module("system"), importlib.import_module("channel")
    system.limit(order["limits"], order["credit"])
    if order["program"]:
        system.restrict(order["program"])
    importlib.import_module("worker").serve(link, channel)


def tend(control: socket.socket, order: dict[str, Any]) -> None:
    """Fork a process for each check that is ordered, until the other end closes.

    "check" comes with the seconds of a processor that it may use and a descriptor, the new
    process's link, and is answered by "begun". "end" comes with the seconds in which it is expected
    to end by itself, and is answered, when nothing of the check is left, by "clean" with the signal
    that has ended it, or 0, and the seconds it has used.
    """
    system, channel = importlib.import_module("system"), importlib.import_module("channel")
    pid, before = 0, 0.0
    try:
        while True:
            kind, call, seconds = channel.receive(control)
            if kind == "check":
                before = system.used()
                limits = order["limits"] | {"CPU": min(seconds, order["limits"]["CPU"])}
                pid = system.fork(control, partial(begin, order=order | {"limits": limits}))
                channel.send(control, "begun", call=call)
            else:
                ended = system.signal_of(pid, seconds)
                system.sweep(pid, order["alone"])
                channel.send(control, "clean", (ended, system.used() - before), call)
                pid = 0
    except EOFError:
        if pid:
            system.sweep(pid, order["alone"])


def prepare(modules: list[str]) -> None:
    """Import what the checks will need, once, and begin numpy's old random numbers at one place."""
    for name in ("numpy.random", "worker", *modules):
        with contextlib.suppress(
            ImportError
        ):  # the submission will say so itself, where it asks for it
            importlib.import_module(name)
    sys.modules["numpy.random"].seed(0)
    gc.collect()
    gc.freeze()  # a fork then shares these pages


def main(number: str, *packages: str) -> None:
    """Read the first order from the control, make ready, and tend the checks, or be the only one there is."""
    here = os.path.dirname(os.path.abspath(__file__))
    shelf = {name: f"{here}/{name}.py" for name in ("channel", "system", "worker")}
    for package in packages:
        name, _, folder = package.partition("=")
        shelf[name] = f"{folder}/__init__.py"
    sys.meta_path.append(PackageFinder(shelf))
    system, channel = importlib.import_module("system"), importlib.import_module("channel")
    control = system.inherit_control(number)
    _, _, order = channel.receive(control)
    for one in ("SIGINT", "SIGTERM", "SIGHUP"):
        if hasattr(
            signal, one
        ):  # the first process of a namespace does not feel its default from inside
            signal.signal(getattr(signal, one), signal.SIG_DFL)
    system.prctl(system.ADOPT, 1)
    prepare(order["modules"])
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)  # what a library might still write there is for nobody
    os.close(nowhere)
    channel.send(control, "ready")
    if order["forks"]:
        tend(control, order)
    else:
        begin(control, order)
    if order["scratch"]:  # the parent may have been killed, and cannot
        shutil.rmtree(order["scratch"], ignore_errors=True)
    os._exit(0)  # nothing is left that would need an orderly end


if __name__ == "__main__":
    main(*sys.argv[1:])
