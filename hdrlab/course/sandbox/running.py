"""A sandbox that runs: one process that has imported numpy, from which every check gets a process of its own.

control  the socket on which the parent orders checks, and hears that they are begun and cleared away
link     the socket of one check, on which its calls go out and its answers come back

A submission has a sandbox to itself. Between its checks nothing is kept: the process is forked
anew, what it started is ended, and there is no place for a file. Where a check does not end, the
whole sandbox is ended and started anew.
"""

import contextlib
import math
import socket
import subprocess
import time
import tomllib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course.sandbox.inside import channel

START = 60.0  # seconds in which a sandbox must have started, on a machine however busy
CLEAR = (
    10.0  # seconds in which a check must have been cleared away; else the sandbox is started anew
)
SETTLE = 1.0  # seconds for a process to end that has closed its control
SIGNALLED = 128  # and a signal's number: what a launcher ends with when a signal has ended its own
RULES: dict[str, Any] = tomllib.loads(Path(__file__).with_name("rules.toml").read_text("utf8"))
LIMITS, ENVIRONMENT = RULES["limits"], RULES["environment"]
ORDERED = (
    "credit",
    "program",
    "alone",
    "forks",
    "limits",
)  # what the supervisor is told of its sandbox
# no site-packages, no .pth, nothing from the folder it stands in
FLAGS = ("-s", "-P", "-S", "-B", "-X", "utf8")
PROGRAM = Path(channel.__file__).with_name("supervisor.py")  # beside the others that it needs


class Unavailable(RuntimeError):
    """A tier that this machine cannot give, and why."""


class SandboxProcess(NamedTuple):
    """A process that was started, what to do when it has ended, and a folder that it removes at its end."""

    process: subprocess.Popen[bytes]
    after: Callable[[], object]
    scratch: str = ""


class Sandbox(NamedTuple):
    """How a tier runs a student's functions.

    Attributes
    ----------
    tier : "strict", "container" or "practice"
    credit : whether what was scored in it may count
    launch : starts the supervisor, given its end of the control
    program : a seccomp filter for the checks, or nothing
    alone : whether the supervisor is the first process of a namespace of its own
    forks : whether the supervisor can fork a process for a check; else it is that process, one for
        each
    limits : of the process of a check, as in the module resource
    """

    tier: str
    credit: bool
    launch: Callable[[socket.socket], SandboxProcess]
    program: bytes = b""
    alone: bool = False
    forks: bool = True
    limits: dict[str, int] = LIMITS


class SandboxSession:
    """A sandbox that was started for one submission.

    Parameters
    ----------
    sandbox : of which tier
    modules : imported once, before the first check
    seconds : of a processor for one check, and for all; enforced where processes can fork
    """

    def __init__(
        self,
        sandbox: Sandbox,
        modules: Sequence[str] = (),
        seconds: tuple[float, float] = (60.0, math.inf),
    ) -> None:
        self.sandbox, self.modules = sandbox, list(modules)
        self._each, self.left = seconds  # of a processor
        self.granted = 0  # to the check that runs
        self._start()

    def _start(self) -> None:
        """Launch, and do not wait: it gets ready while the parent does other things."""
        self._control, theirs = socket.socketpair()
        with theirs, contextlib.ExitStack() as held:
            held.enter_context(self._control)
            self._launched = self.sandbox.launch(theirs)
            held.pop_all()
        self._ready, self._checks = False, 0  # how many checks it has begun
        self._busy = False  # with one that is not cleared away
        order = {name: getattr(self.sandbox, name) for name in ORDERED}
        order |= {"modules": self.modules, "scratch": self._launched.scratch}
        with contextlib.suppress(OSError):  # it has ended already: `wait` says why
            channel.send(self._control, "order", order)

    def wait(self) -> None:
        """Return when it is ready, or raise Unavailable with what it said."""
        if self._ready:
            return
        try:
            self._hear("ready", START)
            self._ready = True
        except (OSError, EOFError, ValueError) as error:
            said = self._last_words() or type(error).__name__
            self.close()
            raise Unavailable(f"the {self.sandbox.tier} sandbox did not start: {said}") from None

    def check(self) -> socket.socket:
        """Return the link to a new process, for one check; what the one before has left is cleared away."""
        for _ in range(2):
            self.wait()
            with contextlib.suppress(OSError, EOFError, ValueError):
                return self._begin()
            self.close()  # it was ended from outside, or cannot end what it began
            self._start()
        raise Unavailable(f"the {self.sandbox.tier} sandbox was ended from outside, twice")

    def _begin(self) -> socket.socket:
        """Clear the last check away, begin another, and return its link."""
        if not self.sandbox.forks:
            if self._checks:
                raise ConnectionError("one process serves one check")
            self._checks = 1
            return self._control.dup()
        self.clear()
        self.granted = max(1, math.ceil(min(self._each, self.left)))
        ours, theirs = socket.socketpair()
        with contextlib.ExitStack() as held:
            held.enter_context(ours)
            with theirs:
                self._checks += 1
                self._busy = True
                channel.send(self._control, "check", self.granted, self._checks)
                socket.send_fds(self._control, [b"c"], [theirs.fileno()])
            self._hear("begun", CLEAR)
            held.pop_all()
        return ours

    def clear(self, patience: float = 0.0) -> tuple[int, float]:
        """Clear the last check away; return the signal that ended it, or 0, and what it used of a processor.

        It may end by itself within `patience` seconds, and is ended then.
        """
        if not self._busy:
            return 0, 0.0
        channel.send(self._control, "end", patience, self._checks)
        ended, seconds = self._hear("clean", CLEAR)
        self._busy = False
        self.left -= seconds
        return ended, seconds

    def _hear(self, kind: str, seconds: float) -> Any:
        """Return the value of the next word from the supervisor, which must be of this kind."""
        came, call, value = channel.receive(self._control, time.monotonic() + seconds)
        if came != kind or call not in (0, self._checks):
            raise channel.ProtocolError(f"expected {kind!r}, got {came[:80]!r}")
        return value

    def _last_words(self) -> str:
        """Return the last line that the process wrote to stderr, or the signal that has ended it."""
        process = self._launched.process
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(SETTLE)
        ended = process.poll() or 0
        process.kill()
        _, said = process.communicate()
        lines = (said or b"").decode(errors="replace").strip().splitlines()
        if not lines and (ended < 0 or ended > SIGNALLED):
            return f"it was ended by signal {-ended if ended < 0 else ended - SIGNALLED}"
        return lines[-1][-500:] if lines else ""

    def close(self) -> None:
        """End it, and all that runs in it."""
        self._control.close()
        process = self._launched.process
        # a supervisor ends its check, then itself
        patience = CLEAR if self._ready and self.sandbox.forks else 0
        try:
            process.wait(patience)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        if process.stderr:
            process.stderr.close()
        self._launched.after()


def start(
    words: list[str],
    environment: dict[str, str],
    *inherited: int,
    folder: str = "/",
    stdin: int = subprocess.DEVNULL,
) -> subprocess.Popen[bytes]:
    """Return the process of a command: what it says is kept in case it fails."""
    streams: dict[str, Any] = {
        "stdin": stdin,
        "stdout": subprocess.DEVNULL,
        "stderr": subprocess.PIPE,
    }
    return subprocess.Popen(words, cwd=folder, env=environment, pass_fds=inherited, **streams)


def command(python: str, program: str, control: int, packages: Mapping[str, str]) -> list[str]:
    """Return the command that starts the supervisor, which knows these packages by their folders."""
    return [
        python,
        *FLAGS,
        program,
        str(control),
        *(f"{name}={at}" for name, at in packages.items()),
    ]


def packages() -> dict[str, str]:
    """Return the folders of numpy and of scipy: what a submission may import."""
    import numpy
    import scipy

    return {one.__name__: one.__path__[0] for one in (numpy, scipy)}
