"""Run a student's functions in the process of a check, and send their answers to the grader.

This file goes into the sandbox, where hdrlab is not: it needs the standard library and channel.py
alone. Nothing in it protects anything from the student's code, which can change all of it in its
own process. The sandbox around the process protects the grader, and so does the code that reads the
other end of the channel.
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

# of an iterator that a function returns
MAX_ITEMS = 4096
MAX_PRINTED_CHARACTERS = 2**16
MAX_MESSAGE_CHARACTERS = 2000
MAX_CLASS_NAME_CHARACTERS = 80
MAX_LINE_CHARACTERS = 200
FORBIDDEN_MESSAGE = "a function that is checked cannot {}"
MISSING_MODULE_HINT = "numpy, scipy and Python's own modules are here"

WRITING_FLAGS = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC
# what no tier for credit lets a function do, by Python's audit events
FORBIDDEN_ACTIONS = {
    # only with flags for writing
    "open": "write a file",
    "os.remove": "change a file",
    "os.rename": "change a file",
    "os.mkdir": "change a file",
    "os.rmdir": "change a file",
    "os.truncate": "change a file",
    "os.link": "change a file",
    "os.symlink": "change a file",
    "os.chmod": "change a file",
    "os.chown": "change a file",
    "os.utime": "change a file",
    "subprocess.Popen": "start a program",
    "os.system": "start a program",
    "os.exec": "start a program",
    "os.posix_spawn": "start a program",
    "os.fork": "start a process",
    "os.forkpty": "start a process",
    "socket.__new__": "use the network",
    "socket.connect": "use the network",
    "socket.bind": "use the network",
}


class PrintedText(io.TextIOBase):
    """A text stream that keeps the first MAX_PRINTED_CHARACTERS characters and discards the rest."""

    def __init__(self) -> None:
        self._parts: list[str] = []
        self._room = MAX_PRINTED_CHARACTERS

    def writable(self) -> bool:
        """Return True."""
        return True

    def write(self, text: str) -> int:
        """Keep as much of a text as there is room for."""
        if self._room > 0:
            self._parts.append(text[: self._room])
            self._room -= len(text)
        return len(text)

    def take(self) -> str:
        """Return what was written since the last call."""
        text = "".join(self._parts)
        self._parts = []
        return text


def forbid_actions(event: str, arguments: tuple[Any, ...]) -> None:
    """Raise PermissionError with a plain message for what a check may not do: an audit hook.

    This protects nothing. It is there so that the practice tier, which has no walls, fails for the
    same functions as the other tiers, and so that all tiers fail with a message that students
    understand.
    """
    if event not in FORBIDDEN_ACTIONS:
        return
    if event == "open":
        flags = arguments[2]
        opens_for_writing = isinstance(flags, int) and flags & WRITING_FLAGS != 0
        if not opens_for_writing:
            return
    if arguments[:1] == (os.devnull,):
        return
    raise PermissionError(FORBIDDEN_MESSAGE.format(FORBIDDEN_ACTIONS[event]))


def run_source(
    source: str, name: str, own_builtins: dict[str, Any] | None = None
) -> dict[str, Any]:
    """Run a submission's source as a module of this name, and return what it defines.

    Parameters
    ----------
    source : str
        The text of the module.
    name : str
        Its name.
    own_builtins : dict, optional
        What it has in place of Python's built-in functions.
    """
    module = types.ModuleType(name)
    if own_builtins is not None:
        module.__dict__["__builtins__"] = own_builtins
    # a dataclass looks its module up here
    sys.modules[name] = module
    file = f"<{name}>"
    # for tracebacks, which then show the lines of the source
    linecache.cache[file] = (len(source), None, source.splitlines(keepends=True), file)
    code = compile(source, file, "exec")
    exec(code, module.__dict__)
    return module.__dict__


def collect_items(value: Any) -> Any:
    """Return the first MAX_ITEMS items of an iterator as a list; return any other value as it is."""
    if isinstance(value, Iterator):
        return list(itertools.islice(value, MAX_ITEMS))
    return value


def describe_error(error: BaseException) -> dict[str, Any]:
    """Return an error's class, its message, and the last line of the submission that led to it."""
    message = str(error)
    if isinstance(error, ModuleNotFoundError):
        message = f"{message} ({MISSING_MODULE_HINT})"
    frames = traceback.extract_tb(error.__traceback__)
    # the submission's file has a name such as <gsolve>
    own_frames = [frame for frame in frames if frame.filename.startswith("<")]
    if own_frames:
        line = own_frames[-1].lineno
        text = own_frames[-1].line
    else:
        # a SyntaxError knows its place
        line = getattr(error, "lineno", None)
        text = getattr(error, "text", None)
    return {
        "error": type(error).__name__[:MAX_CLASS_NAME_CHARACTERS],
        "message": message[:MAX_MESSAGE_CHARACTERS],
        "line": line if isinstance(line, int) else None,
        "text": str(text or "").strip()[:MAX_LINE_CHARACTERS],
    }


def call_function(order: dict[str, Any], namespaces: dict[str, dict[str, Any]]) -> Any:
    """Call a student's function as an order says, and return its answer.

    Parameters
    ----------
    order : dict
        The task, the source, and the arguments.
    namespaces : dict
        What each source that was run defines; a new source is added.
    """
    source = order["source"]
    task = order["task"]
    if source not in namespaces:
        namespaces[source] = run_source(source, task)
    function = namespaces[source].get(task)
    if function is None:
        raise NameError(f"there is no function {task}")
    return collect_items(function(*order["args"], **order["kwargs"]))


def serve(link: socket.socket, channel: Any) -> None:
    """Answer the grader's calls until it closes the link.

    Parameters
    ----------
    link : socket
        The connection to the grader.
    channel : module
        The module channel.py, which has another name in the sandbox than outside.
    """
    namespaces: dict[str, dict[str, Any]] = {}
    printed = PrintedText()
    sys.stdout = printed
    sys.stderr = printed
    sys.addaudithook(forbid_actions)
    while True:
        try:
            _, call_number, order = channel.receive(link)
        except EOFError:
            return
        try:
            value = call_function(order, namespaces)
            kind = "answer"
        # also SystemExit and KeyboardInterrupt
        except BaseException as error:
            value = describe_error(error)
            kind = "raised"
        output = printed.take()
        try:
            channel.send(link, kind, (output, value), call_number)
        except channel.UnsupportedValue as error:
            reason = str(error)[:MAX_MESSAGE_CHARACTERS]
            channel.send(link, "refused", (output, reason), call_number)
