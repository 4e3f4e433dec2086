"""Start a sandbox for a submission, and start a process in it for each check.

Each submission has its own sandbox. A supervisor process in the sandbox (inside/supervisor.py)
imports numpy once, and then forks a new process for each check. Two kinds of sockets lead there:

control  one per sandbox: the grader orders checks, and the supervisor answers when a check has begun
         and when nothing of it is left
link     one per check: the grader calls the student's functions, and their answers come back

Nothing remains from one check to the next: each check has a new process, the supervisor ends
everything that the check started, and there is no place for a file. If the supervisor cannot end a
check, the session ends the whole sandbox and starts a new one.
"""

import contextlib
import dataclasses
import math
import socket
import subprocess
import time
import tomllib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from hdrlab.course.sandbox.inside import channel

# generous, because the machine may be busy
START_TIMEOUT_SECONDS = 60.0
# for a check to end with all that it started; after that the sandbox is replaced
CLEAR_TIMEOUT_SECONDS = 10.0
# for a process to end after it has closed its control socket
EXIT_TIMEOUT_SECONDS = 1.0
# a launcher whose child was ended by signal n exits with this number plus n
SIGNAL_EXIT_CODE = 128
MAX_ERROR_CHARACTERS = 500

RULES: dict[str, Any] = tomllib.loads(Path(__file__).with_name("rules.toml").read_text("utf8"))
LIMITS: dict[str, int] = RULES["limits"]
ENVIRONMENT: dict[str, str] = RULES["environment"]
# no site-packages, no .pth files, and no modules from the current folder or the script's folder
PYTHON_FLAGS = ("-s", "-P", "-S", "-B", "-X", "utf8")
# the modules that it imports lie in the same folder
SUPERVISOR_PATH = Path(channel.__file__).with_name("supervisor.py")


class Unavailable(RuntimeError):
    """Raised if this machine cannot run a sandbox tier; the message says why."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class SandboxProcess:
    """A supervisor process that was launched.

    Attributes
    ----------
    process : the process, or the launcher around it
    clean_up : called once, after the process has ended
    scratch : a folder that the supervisor removes at its end, or ""
    """

    process: subprocess.Popen[bytes]
    clean_up: Callable[[], object]
    scratch: str = ""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Sandbox:
    """How a tier runs a student's functions.

    Attributes
    ----------
    tier : "strict", "container", "practice" or "in-process"
    credit : whether scores from this tier may count
    launch : starts the supervisor; its argument is the supervisor's end of the control socket
    seccomp_program : the system call filter for the checks, or b""
    has_pid_namespace : whether the supervisor is the first process of a PID namespace of its own
    can_fork : whether the supervisor can fork a process for each check. If not, the supervisor
        becomes the process of the first check, and each further check gets a new sandbox.
    limits : limits for the process of a check, named as in the module `resource`
    """

    tier: str
    credit: bool
    launch: Callable[[socket.socket], SandboxProcess]
    seccomp_program: bytes = b""
    has_pid_namespace: bool = False
    can_fork: bool = True
    limits: dict[str, int] = dataclasses.field(default_factory=LIMITS.copy)


class SandboxSession:
    """A running sandbox for one submission.

    The constructor launches the sandbox and returns at once, so that it starts while the grader
    does other things.

    Parameters
    ----------
    sandbox : Sandbox
        The tier, from `hdrlab.course.sandbox.tiers.choose`.
    modules : sequence of str
        Modules to import once, before the first check.
    check_cpu_seconds, total_cpu_seconds : float
        Processor time for one check, and for all checks together. Both hold only where processes
        can fork.

    Attributes
    ----------
    granted_cpu_seconds : int
        Processor time that the current check may use.
    cpu_seconds_left : float
        Processor time that is left for all further checks.
    """

    def __init__(
        self,
        sandbox: Sandbox,
        modules: Sequence[str] = (),
        *,
        check_cpu_seconds: float = 60.0,
        total_cpu_seconds: float = math.inf,
    ) -> None:
        self.sandbox = sandbox
        self.granted_cpu_seconds = 0
        self.cpu_seconds_left = total_cpu_seconds
        self._modules = list(modules)
        self._check_cpu_seconds = check_cpu_seconds
        self._launch()

    def _launch(self) -> None:
        """Launch the sandbox without waiting for it, and send it its order."""
        self._control, supervisor_end = socket.socketpair()
        with supervisor_end:
            try:
                self._launched = self.sandbox.launch(supervisor_end)
            except BaseException:
                self._control.close()
                raise
        self._is_ready = False
        # how many checks have begun; also the number of the current check
        self._check_count = 0
        # whether a check has begun and was not cleared away yet
        self._is_busy = False
        order = {
            "credit": self.sandbox.credit,
            "seccomp_program": self.sandbox.seccomp_program,
            "has_pid_namespace": self.sandbox.has_pid_namespace,
            "can_fork": self.sandbox.can_fork,
            "limits": self.sandbox.limits,
            "modules": self._modules,
            "scratch": self._launched.scratch,
        }
        # if the sandbox has ended already, `wait_until_ready` raises the reason
        with contextlib.suppress(OSError):
            channel.send(self._control, "order", order)

    def wait_until_ready(self) -> None:
        """Wait until the sandbox is ready; raise Unavailable with its last words if it does not start."""
        if self._is_ready:
            return
        try:
            self._receive("ready", START_TIMEOUT_SECONDS)
        except (OSError, EOFError, channel.ProtocolError) as error:
            reason = self._last_words() or type(error).__name__
            self.close()
            message = f"the {self.sandbox.tier} sandbox did not start: {reason}"
            raise Unavailable(message) from None
        self._is_ready = True

    def start_check(self) -> socket.socket:
        """Clear the previous check away, start a process for the next one, and return the link to it.

        If the sandbox was ended from outside, or cannot clear the previous check away, it is
        started again once.
        """
        if not self.sandbox.can_fork and self._check_count > 0:
            # the supervisor has become the process of the previous check
            self._restart()
        for _ in range(2):
            self.wait_until_ready()
            with contextlib.suppress(OSError, EOFError, channel.ProtocolError):
                return self._begin_check()
            self._restart()
        raise Unavailable(f"the {self.sandbox.tier} sandbox was ended from outside, twice")

    def _restart(self) -> None:
        """End the sandbox and launch a new one."""
        self.close()
        self._launch()

    def _begin_check(self) -> socket.socket:
        """Clear the previous check away, start a process for the next one, and return the link to it."""
        if not self.sandbox.can_fork:
            self._check_count = 1
            return self._control.dup()
        self.clear_check()
        allowed = min(self._check_cpu_seconds, self.cpu_seconds_left)
        self.granted_cpu_seconds = max(1, math.ceil(allowed))
        link, check_end = socket.socketpair()
        try:
            with check_end:
                self._check_count += 1
                self._is_busy = True
                channel.send(self._control, "check", self.granted_cpu_seconds, self._check_count)
                # a descriptor needs a byte of data to travel with
                socket.send_fds(self._control, [b"c"], [check_end.fileno()])
            self._receive("begun", CLEAR_TIMEOUT_SECONDS)
        except BaseException:
            link.close()
            raise
        return link

    def clear_check(self, patience: float = 0.0) -> tuple[int, float]:
        """End the current check with all that it started.

        Parameters
        ----------
        patience : float
            Seconds that the check has to end by itself.

        Returns
        -------
        signal : int
            The signal that ended the check, 0 if there was none or no check is running.
        cpu_seconds : float
            Processor time that the check used.
        """
        if not self._is_busy:
            return 0, 0.0
        channel.send(self._control, "end", patience, self._check_count)
        match self._receive("clean", CLEAR_TIMEOUT_SECONDS):
            case (int(signal), float(cpu_seconds)):
                self._is_busy = False
                self.cpu_seconds_left -= cpu_seconds
                return signal, cpu_seconds
        raise channel.ProtocolError("expected the signal and the processor time of a check")

    def _receive(self, expected_kind: str, timeout: float) -> Any:
        """Return the value of the supervisor's next message, which must have the expected kind."""
        kind, check_number, value = channel.receive(self._control, time.monotonic() + timeout)
        if kind != expected_kind or check_number not in (0, self._check_count):
            raise channel.ProtocolError(f"expected {expected_kind!r}, got {kind[:80]!r}")
        return value

    def _last_words(self) -> str:
        """Return the last line that the process wrote to stderr, or the signal that ended it, or ""."""
        process = self._launched.process
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(EXIT_TIMEOUT_SECONDS)
        exit_code = process.poll() or 0
        process.kill()
        _, errors = process.communicate()
        lines = (errors or b"").decode(errors="replace").strip().splitlines()
        if lines:
            return lines[-1][-MAX_ERROR_CHARACTERS:]
        if exit_code < 0:
            return f"it was ended by signal {-exit_code}"
        if exit_code > SIGNAL_EXIT_CODE:
            return f"it was ended by signal {exit_code - SIGNAL_EXIT_CODE}"
        return ""

    def close(self) -> None:
        """End the sandbox and everything that runs in it."""
        self._control.close()
        process = self._launched.process
        # a supervisor that is ready ends its check first, then itself
        is_supervising = self._is_ready and self.sandbox.can_fork
        patience = CLEAR_TIMEOUT_SECONDS if is_supervising else 0
        try:
            process.wait(patience)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        if process.stderr:
            process.stderr.close()
        self._launched.clean_up()


def start_process(
    command: Sequence[str],
    environment: Mapping[str, str],
    *,
    pass_fds: Sequence[int] = (),
    folder: str = "/",
    stdin: int = subprocess.DEVNULL,
) -> subprocess.Popen[bytes]:
    """Start a command in a folder; its stderr is kept for the message in case it fails."""
    return subprocess.Popen(
        command,
        cwd=folder,
        env=environment,
        pass_fds=pass_fds,
        stdin=stdin,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
    )


def supervisor_command(
    python: str, program: str, control: int, packages: Mapping[str, str]
) -> list[str]:
    """Return the command that starts the supervisor.

    Parameters
    ----------
    python, program : str
        Paths of the interpreter and of supervisor.py, inside the sandbox.
    control : int
        The descriptor of the supervisor's end of the control socket.
    packages : mapping
        The folders of the packages that a submission may import, inside the sandbox, by name.
    """
    package_arguments = [f"{name}={folder}" for name, folder in packages.items()]
    return [python, *PYTHON_FLAGS, program, str(control), *package_arguments]


def package_folders() -> dict[str, str]:
    """Return the folders of numpy and scipy, the packages that a submission may import, by name."""
    import numpy
    import scipy

    return {"numpy": numpy.__path__[0], "scipy": scipy.__path__[0]}
