"""The practice tier: a process of its own and limits. It keeps mistakes apart from the grader, and no attack.

It serves a student's own computer, where a function that loops, crashes or fills the memory must
not take the notebook with it. What it finds is never for credit, for it does not stop what
DOES_NOT_STOP tells.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from contextlib import ExitStack
from socket import socket

from hdrlab.course.sandbox import running

DOES_NOT_STOP: list[str] = running.RULES["practice"]["does_not_stop"]
# processes are not counted, for all of yours would be
OWN_LIMITS = {name: most for name, most in running.LIMITS.items() if name != "NPROC"}


def sandbox() -> running.Sandbox:
    """Return the practice tier; where processes cannot fork, each check starts a process of its own."""
    return running.Sandbox("practice", False, launch, forks=hasattr(os, "fork"), limits=OWN_LIMITS)


def launch(control: socket) -> running.SandboxProcess:
    """Start the supervisor with this interpreter, in an empty folder, without this process's environment."""
    scratch = tempfile.mkdtemp(prefix="hdrlab-check-")
    python = getattr(
        sys, "_base_executable", sys.executable
    )  # not the environment's, with all its packages
    words = running.command(python, str(running.PROGRAM), control.fileno(), running.packages())
    environment = running.ENVIRONMENT | {"HOME": scratch, "TMPDIR": scratch}
    environment |= {
        name: os.environ[name] for name in ("SYSTEMROOT",) if name in os.environ
    }  # for Windows
    with ExitStack() as held:
        held.callback(shutil.rmtree, scratch, ignore_errors=True)
        if hasattr(control, "share"):  # on Windows
            return running.SandboxProcess(
                _shared(words, environment, control, scratch), held.pop_all().close
            )
        process = running.start(words, environment, control.fileno(), folder=scratch)
        return running.SandboxProcess(process, held.pop_all().close, scratch)


def _shared(
    words: list[str], environment: dict[str, str], control: socket, folder: str
) -> subprocess.Popen[bytes]:
    """Return the process of a command that is told its control on the standard input, as Windows does."""
    process = running.start(words, environment, folder=folder, stdin=subprocess.PIPE)
    if process.stdin:
        process.stdin.write(control.share(process.pid))  # type: ignore[attr-defined,unused-ignore]
        process.stdin.close()
    return process
