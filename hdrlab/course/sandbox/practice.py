"""The practice tier: a process with limits. It protects the grader from mistakes, not from attacks.

It is for a student's own computer, where a function that loops, crashes or fills the memory must
not end the notebook with it. Scores from this tier never count, because it does not stop what
DOES_NOT_STOP lists.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from socket import socket

from hdrlab.course.sandbox import session

DOES_NOT_STOP: list[str] = session.RULES["practice"]["does_not_stop"]
# without NPROC, which would count all processes of the student, also those outside of the sandbox
LIMITS = {name: limit for name, limit in session.LIMITS.items() if name != "NPROC"}
# Python does not start on Windows without it
WINDOWS_VARIABLE = "SYSTEMROOT"


def sandbox() -> session.Sandbox:
    """Return the practice tier. Where processes cannot fork, each check starts a new interpreter."""
    return session.Sandbox(
        tier="practice",
        credit=False,
        launch=launch,
        can_fork=hasattr(os, "fork"),
        limits=LIMITS,
    )


def launch(control: socket) -> session.SandboxProcess:
    """Start the supervisor with this interpreter, in an empty folder and with few variables."""
    # the interpreter of a virtual environment would bring all its packages
    python = getattr(sys, "_base_executable", sys.executable)
    command = session.supervisor_command(
        python, str(session.SUPERVISOR_PATH), control.fileno(), session.package_folders()
    )
    scratch = tempfile.mkdtemp(prefix="hdrlab-check-")

    def remove_scratch() -> None:
        shutil.rmtree(scratch, ignore_errors=True)

    environment = session.ENVIRONMENT | {"HOME": scratch, "TMPDIR": scratch}
    if WINDOWS_VARIABLE in os.environ:
        environment[WINDOWS_VARIABLE] = os.environ[WINDOWS_VARIABLE]
    try:
        # on Windows alone
        if hasattr(control, "share"):
            process = _start_and_share(command, environment, scratch, control)
            return session.SandboxProcess(process=process, clean_up=remove_scratch)
        process = session.start_process(
            command, environment, pass_fds=[control.fileno()], folder=scratch
        )
    except BaseException:
        remove_scratch()
        raise
    return session.SandboxProcess(process=process, clean_up=remove_scratch, scratch=scratch)


def _start_and_share(
    command: list[str], environment: dict[str, str], folder: str, control: socket
) -> subprocess.Popen[bytes]:
    """Start a command, and describe the control socket to it on its standard input, as on Windows."""
    process = session.start_process(command, environment, folder=folder, stdin=subprocess.PIPE)
    if process.stdin:
        process.stdin.write(control.share(process.pid))  # type: ignore[attr-defined,unused-ignore]
        process.stdin.close()
    return process
