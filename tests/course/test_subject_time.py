"""The subject of a check: time limits of its calls, and the reason for a missing answer."""

from functools import partial

import pytest
from support import fake_student_process
from support.fake_student_process import answer_with, missing_answer

from hdrlab.course.sandbox.inside import channel

KILL = 9


@pytest.fixture
def opened(monkeypatch):
    """opened(answers...) -> a Subject with one task, f, and its FakeSession."""
    return partial(fake_student_process.open_subject, monkeypatch)


def is_late(subject, limit):
    """Return whether the next call fails because this time limit is reached, which its message names."""
    kind, message = missing_answer(subject)
    return kind == "late" and message.startswith("f") and limit in message


def test_the_time_of_a_call_is_limited_by_its_check_and_its_submission(
    opened,
):
    subject, session = opened(*[answer_with(1, seconds=9.0)] * 3, answer_with(1, seconds=3.0))
    with subject:
        for left in (191, 182, 173, 170):
            subject.f()
            assert subject.seconds_left == left
        assert session.waits == [(10, 10), (10, 10), (10, 10), (3, 3)]
        assert is_late(subject, "30 s")
        subject.fresh()
        session.answers += [answer_with(1, seconds=1.0), (10.5, TimeoutError())]
        subject.f()
        assert is_late(subject, "10 s") and subject.seconds_left == 158.5


def test_a_submission_without_time_left_fails_each_check_with_that_reason(opened):
    subject, session = opened(
        *[answer_with(1, seconds=30.0)] * 6,
        answer_with(1, seconds=15.0),
        answer_with(1, seconds=5.0),
    )
    with subject:
        for _ in range(8):
            subject.f()
            subject.fresh()
        assert session.waits[-2:] == [(10, 10), (5, 5)] and subject.seconds_left == 0
        assert is_late(subject, "200 s")
        assert len(session.requests) == 8


@pytest.mark.parametrize(("left", "answered"), [(0.001, True), (0.0, False), (-1.0, False)])
def test_the_processor_time_of_a_submission_is_that_of_four_calls(left, answered, opened):
    subject, session = opened(answer_with(1), (1, TimeoutError()))
    with subject:
        session.cpu_seconds_left = left
        if answered:
            subject.f()
            session.cpu_seconds_left = 0.0001
            assert is_late(subject, "10 s")
        else:
            assert is_late(subject, "40 s") and not session.requests


@pytest.mark.parametrize(
    ("error", "ended", "used", "forks", "kind", "text"),
    [
        (EOFError(), KILL, 1.5, True, "late", "2 s of processor time"),
        (EOFError(), KILL, 1.499, True, "killed", "ended"),
        (EOFError(), KILL, 9.0, False, "killed", "ended"),
        (OSError(), 11, 9.0, True, "died", "ended"),
        (OSError(), 0, 0.0, True, "died", "ended"),
        (
            channel.ProtocolError("half"),
            KILL,
            2.0,
            True,
            "late",
            "2 s of processor time",
        ),
        (
            channel.ProtocolError("half"),
            KILL,
            1.0,
            True,
            "killed",
            "half",
        ),
        (channel.ProtocolError("half"), 0, 9.0, True, "damaged", "half"),
    ],
)
def test_a_missing_answer_is_explained_by_how_the_process_ended(
    error, ended, used, forks, kind, text, opened
):
    subject, session = opened((4.0, error), answer_with(1), ended=ended, used=used, forks=forks)
    with subject:
        answer, message = missing_answer(subject)
        assert answer == kind and message.startswith("f ") and text in message
        assert session.links[0].closed and session.cleared == [1.0] and subject.seconds_left == 196
        subject.f()
        assert len(session.links) == 2


def test_a_lost_supervisor_counts_as_a_killed_process(opened):
    subject, session = opened((0, EOFError()))

    def gone(seconds):
        raise OSError

    session.clear_check = gone
    with subject:
        assert missing_answer(subject)[0] == "killed"
