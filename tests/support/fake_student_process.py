"""A student's process that answers by the book, and a made clock: what stands behind a Subject in tests."""

from types import SimpleNamespace

import pytest

from hdrlab.course.checks import subject as module
from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.sandbox.inside import channel


class Link:
    """The link of a check, on which nothing comes unasked unless told."""

    def __init__(self, spoken=None):
        self.spoken, self.closed, self.patience = spoken, False, None

    def setblocking(self, whether):
        assert whether is False

    def recv(self, count):
        assert count == 1
        if self.spoken is None:
            raise BlockingIOError
        return self.spoken

    def settimeout(self, seconds):
        self.patience = seconds

    def close(self):
        self.closed = True


class Process:
    """All that stands behind a Subject: its sandbox, its clock, and what it answers to each call."""

    def __init__(self, *answers, forks=True, ended=0, used=0.0, left=1e9):
        self.answers, self.now, self.asked, self.links = list(answers), 100.0, [], []
        self.until, self.cleared, self.closed, self.granted_cpu_seconds = [], [], False, 2
        self.sandbox, self.ended, self.used, self.cpu_seconds_left = (
            SimpleNamespace(can_fork=forks),
            ended,
            used,
            left,
        )
        self.spoken, self.begun = None, None

    def __call__(self, sandbox, modules, *, check_cpu_seconds, total_cpu_seconds):
        self.begun = sandbox, modules, check_cpu_seconds, total_cpu_seconds
        return self

    def start_check(self):
        self.links.append(Link(self.spoken))
        return self.links[-1]

    def clear_check(self, seconds):
        self.cleared.append(seconds)
        return self.ended, self.used

    def close(self):
        self.closed = True

    def send(self, link, kind, order, call):
        self.asked.append((kind, order, call))

    def receive(self, link, until):
        self.until.append((until - self.now, link.patience))
        seconds, answer = self.answers.pop(0)
        self.now += seconds
        if isinstance(answer, Exception):
            raise answer
        kind, value, *echo = answer
        return kind, echo[0] if echo else self.asked[-1][2], value


def opened(monkeypatch, *answers, timeout=10.0, **knobs):
    """Return a Subject with one task, f, and the Process behind it."""
    process = Process(*answers, **knobs)
    bits = SimpleNamespace(randbits=lambda count: count)
    monkeypatch.setattr(module, "SandboxSession", process)
    monkeypatch.setattr(module, "time", SimpleNamespace(monotonic=lambda: process.now))
    monkeypatch.setattr(module, "secrets", bits)
    sent = SimpleNamespace(
        send=process.send, receive=process.receive, ProtocolError=channel.ProtocolError
    )
    monkeypatch.setattr(module, "channel", sent)
    return Subject({"f": "def f(): return 1"}, "a sandbox", timeout, ["numpy"]), process


def right(value, output="", seconds=0.0):
    return seconds, ("answer", (output, value))


def silence(subject):
    with pytest.raises(NoAnswer) as raised:
        subject.f()
    return raised.value.kind, str(raised.value)
