"""A sandbox that runs, word by word: what its supervisor is told and must answer, and how it is ended."""

import math
import os
import socket
import subprocess
from types import SimpleNamespace

import pytest

from hdrlab.course.sandbox import running
from hdrlab.course.sandbox.inside import channel
from hdrlab.course.sandbox.running import Sandbox, SandboxProcess, SandboxSession, Unavailable


class Process:
    """A process that ends when it is told to, or has already; what is done to it is written down."""

    def __init__(self, code=None, said=b"", stubborn=False):
        self.code, self.said, self.stubborn, self.done = code, said, stubborn, []
        self.stderr = SimpleNamespace(close=lambda: self.done.append("closed"))

    def wait(self, seconds=None):
        self.done.append(("wait", seconds))
        if self.stubborn and seconds is not None:
            raise subprocess.TimeoutExpired("", seconds)
        return self.code

    def poll(self):
        return self.code

    def kill(self):
        self.done.append("kill")

    def communicate(self):
        return b"", self.said


class Supervisor:
    """The other ends of a sandbox: each launch takes the next list of words, which lie there at once."""

    def __init__(self, *scripts, process=Process, **knobs):
        self.scripts, self.process, self.ends, self.processes, self.ended = (
            list(scripts),
            process,
            [],
            [],
            [],
        )
        self.sandbox = Sandbox("practice", False, self.launch, **knobs)

    def launch(self, control):
        end = control.dup()
        self.ends.append(end)
        for kind, value, call in self.scripts.pop(0) if self.scripts else ():
            channel.send(end, kind, value, call)
        self.processes.append(self.process())
        number = len(self.ends)
        return SandboxProcess(
            self.processes[-1], lambda: self.ended.append(number), f"scratch {number}"
        )

    def told(self, which=0):
        """Return the next word that a supervisor was told."""
        self.ends[which].setblocking(False)  # it lies there already
        return channel.receive(self.ends[which], None)


READY = ("ready", None, 0)


@pytest.fixture
def begun():
    """begun(scripts..., seconds=...) -> a SandboxSession and its Supervisor, which are closed at the end."""
    held = []

    def begun(*scripts, seconds=None, modules=("scipy",), **knobs):
        behind = Supervisor(*scripts, **knobs)
        made = (
            SandboxSession(behind.sandbox, modules, seconds)
            if seconds
            else SandboxSession(behind.sandbox, modules)
        )
        held.append((made, behind))
        return made, behind

    yield begun
    for made, behind in held:
        made._control.close()
        for one in behind.ends:
            one.close()


def test_the_seconds_and_defaults_of_a_sandbox():
    assert (running.START, running.CLEAR, running.SETTLE, running.SIGNALLED) == (60, 10, 1, 128)
    assert Sandbox("a", True, print) == ("a", True, print, b"", False, True, running.LIMITS)
    assert set(running.packages()) == {"numpy", "scipy"}
    assert all(os.path.isfile(f"{folder}/__init__.py") for folder in running.packages().values())


def test_a_supervisor_is_told_its_sandbox_first_and_waited_for_when_it_is_needed(begun):
    made, behind = begun([READY], alone=True, program=b"rules", limits={"CPU": 1})
    order = {
        "credit": False,
        "program": b"rules",
        "alone": True,
        "forks": True,
        "limits": {"CPU": 1},
    }
    kind, call, value = behind.told()
    assert (kind, call) == ("order", 0) and value == order | {
        "modules": ["scipy"],
        "scratch": "scratch 1",
    }
    assert (made.left, made.granted, made._ready, made.modules) == (math.inf, 0, False, ["scipy"])
    made.wait()
    made.wait()
    assert made._ready


def test_a_check_gets_a_link_and_the_seconds_of_a_processor_that_are_left(begun):
    answers = [("begun", None, 1), ("clean", (9, 2.5), 1), ("begun", None, 2)]
    made, behind = begun([READY, *answers], seconds=(3.2, 6.0))
    link = made.check()
    assert made.granted == 4 and isinstance(link, socket.socket)
    behind.told()
    assert behind.told() == ("check", 1, 4)
    _, (number,), *_ = socket.recv_fds(behind.ends[0], 1, 1)
    with link, socket.socket(fileno=number) as theirs:
        theirs.sendall(b"x")
        assert link.recv(1) == b"x"
    with made.check():
        assert made.left == 3.5 and made.granted == 4
    assert behind.told() == ("end", 1, 0.0) and behind.told() == ("check", 2, 4)


@pytest.mark.parametrize(
    ("each", "left", "granted"), [(60.0, 0.2, 1), (0.5, 9.0, 1), (1.5, 9.0, 2), (5.0, 2.0, 2)]
)
def test_whole_seconds_are_granted_and_one_at_least(each, left, granted, begun):
    made, _ = begun([READY, ("begun", None, 1)], seconds=(each, left))
    made.check().close()
    assert made.granted == granted


def test_a_word_that_is_of_no_check_is_heard_too(begun):
    made, behind = begun([READY, ("begun", None, 0)])
    made.check().close()
    assert len(behind.ends) == 1


def test_unless_told_a_check_has_a_minute_of_a_processor(begun):
    made, _ = begun([READY, ("begun", None, 1)])
    made.check().close()
    assert made.granted == 60


def test_what_is_cleared_away_is_what_runs_and_it_may_end_by_itself_first(begun):
    made, behind = begun([READY, ("begun", None, 1), ("clean", (11, 0.25), 1)], seconds=(9.0, 5.0))
    assert made.clear() == (0, 0.0)
    made.check().close()
    assert made.clear(1.5) == (11, 0.25) and made.left == 4.75 and made.clear(2.0) == (0, 0.0)
    behind.told()
    behind.told()
    os.close(socket.recv_fds(behind.ends[0], 1, 1)[1][0])
    assert behind.told() == ("end", 1, 1.5)


def test_where_processes_cannot_fork_the_supervisor_is_the_check_and_the_next_has_another(begun):
    made, behind = begun([READY], [READY], forks=False)
    first = made.check()
    channel.send(behind.ends[0], "said", 7)
    first.setblocking(False)
    assert channel.receive(first, None) == ("said", 0, 7)
    second = made.check()
    assert len(behind.ends) == 2 and behind.ended == [1]
    first.close()
    second.close()


@pytest.mark.parametrize(
    "word",
    [("begun", None, 2), ("clean", None, 1), ("began", None, 0)],
)
def test_a_word_that_is_not_the_one_awaited_ends_the_sandbox_and_another_is_started(word, begun):
    made, behind = begun([READY, word], [READY, ("begun", None, 1)])
    made._checks = 0
    link = made.check()
    link.close()
    assert behind.ended == [1] and len(behind.ends) == 2 and made._checks == 1


def test_a_sandbox_that_is_ended_twice_cannot_be_had(begun):
    made, behind = begun(
        [READY, ("no", None, 0)], [READY, ("no", None, 0)], [READY, ("begun", None, 1)]
    )
    with pytest.raises(Unavailable, match="^the practice sandbox was ended from outside, twice$"):
        made.check()
    assert behind.ended == [1, 2] and len(behind.ends) == 3


@pytest.mark.parametrize(
    ("code", "said", "why"),
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
def test_a_sandbox_that_does_not_start_says_its_last_words_or_its_signal(code, said, why, begun):
    made, behind = begun([("no", None, 0)], process=lambda: Process(code, said))
    with pytest.raises(Unavailable, match=f"^the practice sandbox did not start: {why}$"):
        made.wait()
    assert behind.processes[0].done[:2] == [("wait", 1.0), "kill"] and behind.ended == [1]


@pytest.mark.parametrize(
    ("ready", "forks", "patience"),
    [(True, True, 10), (False, True, 0), (True, False, 0), (False, False, 0)],
)
def test_a_supervisor_that_is_ready_has_time_to_end_its_check(ready, forks, patience, begun):
    for stubborn in (False, True):
        made, behind = begun(
            [READY], forks=forks, process=lambda stubborn=stubborn: Process(0, b"", stubborn)
        )
        if ready:
            made.wait()
        made.close()
        killed = ["kill", ("wait", None)] if stubborn else []
        assert behind.processes[0].done == [("wait", patience), *killed, "closed"]
        assert behind.ended == [1] and made._control.fileno() == -1


def test_what_was_launched_in_vain_leaves_no_socket():
    made = []

    def launch(control):
        made.append(control)
        raise OSError("no room")

    with pytest.raises(OSError, match="no room"):
        SandboxSession(Sandbox("practice", False, launch))
    assert made[0].fileno() == -1
