"""A fake sandbox session in place of a student's process, with answers and a clock that a test controls."""

from types import SimpleNamespace

import pytest

from hdrlab.course.checks import subject as module
from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.sandbox.inside import channel


class FakeLink:
    """The socket of a check; `unexpected` is what the student's process has sent without a request."""

    def __init__(self, unexpected=None):
        self.unexpected = unexpected
        self.closed = False
        self.timeout_seconds = None

    def setblocking(self, whether):
        assert whether is False

    def recv(self, count):
        assert count == 1
        if self.unexpected is None:
            raise BlockingIOError
        return self.unexpected

    def settimeout(self, seconds):
        self.timeout_seconds = seconds

    def close(self):
        self.closed = True


class FakeSession:
    """A SandboxSession that records what is sent to it, and its clock.

    Parameters
    ----------
    answers : (seconds, answer) of each call; an answer that is an Exception is raised
    forks : whether the sandbox can fork
    ended : how the process of a check ended
    used : the processor time that the check used, s
    left : the processor time that is left for all checks, s

    Attributes
    ----------
    now : the time, s
    start_arguments : what the session was started with
    requests : (kind, order, call number) of each request
    waits : the seconds until the deadline and the timeout of the link, for each answer
    links : the FakeLink of each check
    """

    def __init__(self, *answers, forks=True, ended=0, used=0.0, left=1e9):
        self.answers = list(answers)
        self.now = 100.0
        self.start_arguments = None
        self.requests = []
        self.waits = []
        self.links = []
        self.unexpected = None
        self.cleared = []
        self.closed = False
        self.sandbox = SimpleNamespace(can_fork=forks)
        self.granted_cpu_seconds = 2
        self.ended = ended
        self.used = used
        self.cpu_seconds_left = left

    def __call__(self, sandbox, modules, *, check_cpu_seconds, total_cpu_seconds):
        self.start_arguments = (sandbox, modules, check_cpu_seconds, total_cpu_seconds)
        return self

    def start_check(self):
        self.links.append(FakeLink(self.unexpected))
        return self.links[-1]

    def clear_check(self, seconds):
        self.cleared.append(seconds)
        return self.ended, self.used

    def close(self):
        self.closed = True

    def send(self, link, kind, order, call):
        self.requests.append((kind, order, call))

    def receive(self, link, until):
        self.waits.append((until - self.now, link.timeout_seconds))
        seconds, answer = self.answers.pop(0)
        self.now += seconds
        if isinstance(answer, Exception):
            raise answer
        kind, value, *echoed_call = answer
        if echoed_call:
            return kind, echoed_call[0], value
        return kind, self.requests[-1][2], value


def open_subject(monkeypatch, *answers, timeout=10.0, **session_options):
    """Return a Subject with one task, f, and its FakeSession."""
    session = FakeSession(*answers, **session_options)
    fake_channel = SimpleNamespace(
        send=session.send, receive=session.receive, ProtocolError=channel.ProtocolError
    )
    monkeypatch.setattr(module, "SandboxSession", session)
    monkeypatch.setattr(module, "time", SimpleNamespace(monotonic=lambda: session.now))
    monkeypatch.setattr(module, "secrets", SimpleNamespace(randbits=lambda count: count))
    monkeypatch.setattr(module, "channel", fake_channel)
    return Subject({"f": "def f(): return 1"}, "a sandbox", timeout, ["numpy"]), session


def answer_with(value, output="", seconds=0.0):
    """Return an answer for a FakeSession: the value and the printed output, after some seconds."""
    return seconds, ("answer", (output, value))


def missing_answer(subject):
    """Call f, and return the kind and the message of the NoAnswer that it raises."""
    with pytest.raises(NoAnswer) as raised:
        subject.f()
    return raised.value.kind, str(raised.value)
