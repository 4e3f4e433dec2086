"""The session of a sandbox: its orders to the supervisor, and how it ends and restarts."""

import math
import os
import socket
import subprocess
from types import SimpleNamespace

import pytest

from hdrlab.course.sandbox.inside import channel
from hdrlab.course.sandbox.session import (
    Sandbox,
    SandboxProcess,
    SandboxSession,
    Unavailable,
    package_folders,
)


class Process:
    """A fake process that ends on request, or has ended already, and records its calls."""

    def __init__(self, code=None, errors=b"", stubborn=False):
        self.code = code
        self.errors = errors
        self.stubborn = stubborn
        self.killed = False
        self.stderr = SimpleNamespace(close=lambda: None)

    def wait(self, seconds=None):
        if self.stubborn and not self.killed:
            raise subprocess.TimeoutExpired("", seconds)
        return self.code

    def poll(self):
        return self.code

    def kill(self):
        self.killed = True

    def communicate(self):
        return b"", self.errors


class Supervisor:
    """The other ends of a sandbox: each launch immediately sends the messages of the next script."""

    def __init__(self, *scripts, process=Process, **options):
        self.scripts = list(scripts)
        self.process = process
        self.ends = []
        self.processes = []
        self.cleaned_up = []
        self.sandbox = Sandbox(tier="practice", credit=False, launch=self.launch, **options)

    def launch(self, control):
        end = control.dup()
        self.ends.append(end)
        for kind, value, call in self.scripts.pop(0) if self.scripts else ():
            channel.send(end, kind, value, call)
        self.processes.append(self.process())
        number = len(self.ends)
        return SandboxProcess(
            process=self.processes[-1],
            clean_up=lambda: self.cleaned_up.append(number),
            scratch=f"scratch {number}",
        )

    def next_message(self, launch=0):
        """Return the next message that the session has sent to a launched supervisor."""
        self.ends[launch].setblocking(False)
        return channel.receive(self.ends[launch], None)


READY = ("ready", None, 0)


@pytest.fixture
def begin():
    """begin(scripts..., options) -> a SandboxSession and its Supervisor, closed at the end."""
    begun = []

    def begin(*scripts, times=None, modules=("scipy",), **options):
        supervisor = Supervisor(*scripts, **options)
        session = SandboxSession(supervisor.sandbox, modules, **(times or {}))
        begun.append((session, supervisor))
        return session, supervisor

    yield begin
    for session, supervisor in begun:
        session._control.close()
        for end in supervisor.ends:
            end.close()


def cpu_seconds(check, total):
    return {"check_cpu_seconds": check, "total_cpu_seconds": total}


def test_a_submission_may_import_numpy_and_scipy():
    folders = package_folders()
    assert set(folders) == {"numpy", "scipy"}
    assert all(os.path.isfile(f"{folder}/__init__.py") for folder in folders.values())


def test_a_supervisor_gets_its_order_first_and_is_waited_for_when_it_is_needed(begin):
    session, supervisor = begin(
        [READY], has_pid_namespace=True, seccomp_program=b"rules", limits={"CPU": 1}
    )
    kind, _, order = supervisor.next_message()
    assert kind == "order"
    assert order == {
        "credit": False,
        "seccomp_program": b"rules",
        "has_pid_namespace": True,
        "can_fork": True,
        "limits": {"CPU": 1},
        "modules": ["scipy"],
        "scratch": "scratch 1",
    }
    assert session.cpu_seconds_left == math.inf
    session.wait_until_ready()
    session.wait_until_ready()


def test_a_check_gets_a_link_and_the_processor_time_that_is_left(begin):
    answers = [("begun", None, 1), ("clean", (9, 2.5), 1), ("begun", None, 2)]
    session, supervisor = begin([READY, *answers], times=cpu_seconds(3.2, 6.0))
    link = session.start_check()
    assert session.granted_cpu_seconds == 4
    supervisor.next_message()
    assert supervisor.next_message() == ("check", 1, 4)
    _, (descriptor,), *_ = socket.recv_fds(supervisor.ends[0], 1, 1)
    with link, socket.socket(fileno=descriptor) as check_end:
        check_end.sendall(b"x")
        assert link.recv(1) == b"x"
    with session.start_check():
        assert session.cpu_seconds_left == 3.5
        assert session.granted_cpu_seconds == 4
    assert supervisor.next_message() == ("end", 1, 0.0)
    assert supervisor.next_message() == ("check", 2, 4)


@pytest.mark.parametrize(
    ("check", "left", "granted"), [(60.0, 0.2, 1), (0.5, 9.0, 1), (1.5, 9.0, 2), (5.0, 2.0, 2)]
)
def test_whole_seconds_are_granted_and_one_at_least(check, left, granted, begin):
    session, _ = begin([READY, ("begun", None, 1)], times=cpu_seconds(check, left))
    session.start_check().close()
    assert session.granted_cpu_seconds == granted


def test_a_message_that_belongs_to_no_check_is_accepted(begin):
    session, supervisor = begin([READY, ("begun", None, 0)])
    session.start_check().close()
    assert len(supervisor.ends) == 1


def test_only_a_running_check_is_cleared_away_and_it_may_end_by_itself_first(begin):
    session, supervisor = begin(
        [READY, ("begun", None, 1), ("clean", (11, 0.25), 1)], times=cpu_seconds(9.0, 5.0)
    )
    assert session.clear_check() == (0, 0.0)
    session.start_check().close()
    assert session.clear_check(1.5) == (11, 0.25)
    assert session.cpu_seconds_left == 4.75
    assert session.clear_check(2.0) == (0, 0.0)
    supervisor.next_message()
    supervisor.next_message()
    os.close(socket.recv_fds(supervisor.ends[0], 1, 1)[1][0])
    assert supervisor.next_message() == ("end", 1, 1.5)


@pytest.mark.parametrize("value", [None, (9,), (9, "1"), ("9", 1.0), (9, 1.0, 2)])
def test_a_check_whose_end_is_reported_in_another_form_is_a_protocol_error(value, begin):
    session, _ = begin([READY, ("begun", None, 1), ("clean", value, 1)])
    session.start_check().close()
    with pytest.raises(channel.ProtocolError):
        session.clear_check()


def test_where_processes_cannot_fork_each_check_has_a_supervisor_of_its_own(begin):
    session, supervisor = begin([READY], [READY], can_fork=False)
    first = session.start_check()
    channel.send(supervisor.ends[0], "printed", 7)
    first.setblocking(False)
    assert channel.receive(first, None) == ("printed", 0, 7)
    second = session.start_check()
    assert len(supervisor.ends) == 2 and supervisor.cleaned_up == [1]
    first.close()
    second.close()


@pytest.mark.parametrize("message", [("begun", None, 2), ("clean", None, 1), ("began", None, 0)])
def test_a_message_that_is_not_the_expected_one_restarts_the_sandbox(message, begin):
    session, supervisor = begin([READY, message], [READY, ("begun", None, 1)])
    session.start_check().close()
    assert supervisor.cleaned_up == [1] and len(supervisor.ends) == 2


def test_a_sandbox_that_is_ended_twice_is_unavailable(begin):
    session, supervisor = begin(
        [READY, ("no", None, 0)], [READY, ("no", None, 0)], [READY, ("begun", None, 1)]
    )
    with pytest.raises(Unavailable, match="practice sandbox was ended from outside"):
        session.start_check()
    assert supervisor.cleaned_up == [1, 2]


@pytest.mark.parametrize(
    ("code", "errors", "reason"),
    [
        (1, b"one\nbwrap: no  \n", "bwrap: no"),
        (1, b"n" * 501, "n" * 500),
        (-9, b"", "it was ended by signal 9"),
        (137, b"\n", "it was ended by signal 9"),
        (129, b"", "it was ended by signal 1"),
        (128, b"", "ProtocolError"),
        (0, b"", "ProtocolError"),
        (None, b"", "ProtocolError"),
        (-9, b"last", "last"),
    ],
)
def test_a_sandbox_that_does_not_start_reports_its_last_words_or_its_signal(
    code, errors, reason, begin
):
    session, supervisor = begin([("no", None, 0)], process=lambda: Process(code, errors))
    with pytest.raises(Unavailable, match=f"^the practice sandbox did not start: {reason}$"):
        session.wait_until_ready()
    assert supervisor.processes[0].killed
    assert supervisor.cleaned_up == [1]


@pytest.mark.parametrize("stubborn", [False, True])
@pytest.mark.parametrize("can_fork", [False, True])
def test_a_closed_session_leaves_no_process_and_cleans_up(can_fork, stubborn, begin):
    session, supervisor = begin(
        [READY], can_fork=can_fork, process=lambda: Process(0, b"", stubborn)
    )
    session.wait_until_ready()
    session.close()
    assert supervisor.processes[0].killed == stubborn
    assert supervisor.cleaned_up == [1]
    assert session._control.fileno() == -1


def test_a_launch_that_fails_leaves_no_socket():
    controls = []

    def launch(control):
        controls.append(control)
        raise OSError("no room")

    with pytest.raises(OSError, match="no room"):
        SandboxSession(Sandbox(tier="practice", credit=False, launch=launch))
    assert controls[0].fileno() == -1
