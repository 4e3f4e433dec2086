"""The process of a check: it runs a student's functions on what the channel brings, and sends their answers.

It stands alone, on the standard library and on channel.py: it goes into the sandbox, where hdrlab
is not. Nothing in it guards anything against the student's code, which may rewrite all of it in its
own process. The sandbox around it does, and the reader at the other end of the channel.
"""

import io
import itertools
import linecache
import os
import socket
import sys
import traceback
import types
from collections.abc import Iterator
from typing import Any

STATES = 4096  # of a generator, at most
OUTPUT = 1 << 16  # characters of what was printed, at most
MESSAGE = 2000  # characters of an error's message, at most
HERE = "numpy, scipy and Python's own modules are here"
CHANGES = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC
REFUSED = {  # what no tier for credit lets a function do, by the names of Python's audit events
    "open": "write a file",
    **dict.fromkeys(
        ("os.remove", "os.rename", "os.mkdir", "os.rmdir", "os.truncate"), "change a file"
    ),
    **dict.fromkeys(("os.link", "os.symlink", "os.chmod", "os.chown", "os.utime"), "change a file"),
    **dict.fromkeys(
        ("subprocess.Popen", "os.system", "os.exec", "os.posix_spawn"), "start a program"
    ),
    **dict.fromkeys(("os.fork", "os.forkpty"), "start a process"),
    **dict.fromkeys(("socket.__new__", "socket.connect", "socket.bind"), "use the network"),
}


class Output(io.TextIOBase):
    """What is printed: the first OUTPUT characters, the rest goes nowhere."""

    def __init__(self) -> None:
        self.text: list[str] = []
        self.left = OUTPUT

    def writable(self) -> bool:
        """Return True."""
        return True

    def write(self, text: str) -> int:
        """Keep what there is room for."""
        if self.left > 0:
            self.text.append(text[: self.left])
            self.left -= len(text)
        return len(text)

    def take(self) -> str:
        """Return what came since the last time."""
        text, self.text = "".join(self.text), []
        return text


def refuse(event: str, arguments: tuple[Any, ...]) -> None:
    """Say in plain words what the walls of the stricter tiers would say in the system's: an audit hook.

    It is a courtesy, that a function which is checked at home is checked alike later; it keeps
    nobody in.
    """
    if event in REFUSED:
        reads = event == "open" and not (isinstance(arguments[2], int) and arguments[2] & CHANGES)
        if not reads and arguments[:1] != (os.devnull,):
            raise PermissionError(f"a function that is checked cannot {REFUSED[event]}")


def run(source: str, name: str) -> dict[str, Any]:
    """Run a submission's source as a module of this name, and return what it defines."""
    module, file = types.ModuleType(name), f"<{name}>"
    sys.modules[name] = module  # a dataclass looks its module up
    linecache.cache[file] = (len(source), None, source.splitlines(keepends=True), file)
    exec(compile(source, file, "exec"), module.__dict__)
    return module.__dict__


def drained(value: Any) -> Any:
    """Return an iterator's items as a list, of STATES at most, and anything else as it is."""
    return list(itertools.islice(value, STATES)) if isinstance(value, Iterator) else value


def complaint(error: BaseException) -> dict[str, Any]:
    """Return what an error says: its class, its message, and the last line of the submission on its way."""
    message = str(error)
    if isinstance(error, ModuleNotFoundError):
        message = f"{message} ({HERE})"
    frames = [
        one for one in traceback.extract_tb(error.__traceback__) if one.filename.startswith("<")
    ]
    line = frames[-1].lineno if frames else getattr(error, "lineno", None)
    text = frames[-1].line if frames else getattr(error, "text", None)
    return {
        "error": type(error).__name__[:80],
        "message": message[:MESSAGE],
        "line": line if isinstance(line, int) else None,
        "text": str(text or "").strip()[:200],
    }


def answer(order: dict[str, Any], known: dict[str, dict[str, Any]]) -> Any:
    """Return what the student's function answers to the arguments of an order."""
    if order["source"] not in known:
        known[order["source"]] = run(order["source"], order["task"])
    function = known[order["source"]].get(order["task"])
    if function is None:
        raise NameError(f"there is no function {order['task']}")
    return drained(function(*order["args"], **order["kwargs"]))


def serve(link: socket.socket, channel: Any) -> None:
    """Answer calls until the other end closes."""
    known: dict[str, dict[str, Any]] = {}
    output = sys.stdout = sys.stderr = Output()
    sys.addaudithook(refuse)
    while True:
        try:
            _, call, order = channel.receive(link)
        except EOFError:
            return
        try:
            kind, value = "answer", answer(order, known)
        except BaseException as error:  # sys.exit and the interrupt as well: they are no answer
            kind, value = "raised", complaint(error)
        try:
            channel.send(link, kind, (output.take(), value), call)
        except channel.UnsupportedValue as error:
            channel.send(link, "refused", (output.take(), str(error)[:MESSAGE]), call)
