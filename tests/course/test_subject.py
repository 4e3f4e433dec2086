"""The subject of a check: its calls, its records, and which answers count as missing."""

import math
from functools import partial

import numpy as np
import pytest
from support import fake_student_process
from support.fake_student_process import answer_with, missing_answer

from hdrlab.course.checks import subject as module


@pytest.fixture
def opened(monkeypatch):
    """opened(answers...) -> a Subject with one task, f, and its FakeSession."""
    return partial(fake_student_process.open_subject, monkeypatch)


@pytest.mark.parametrize("timeout", [2.0, 10.0])
def test_a_sandbox_is_given_the_processors_time_of_a_check_and_of_all(timeout, opened):
    subject, session = opened(timeout=timeout)
    assert subject.seconds_left == 20 * timeout
    with subject:
        assert session.start_arguments == ("a sandbox", ["numpy"], 3 * timeout, 4 * timeout)
        session.cpu_seconds_left = 0.5
        assert subject.seconds_left == 0.5
    assert session.closed and subject.seconds_left == 20 * timeout
    with pytest.raises(RuntimeError, match="with statement"):
        subject.f()


def test_a_call_is_sent_with_its_source_and_recorded_with_its_answer(opened):
    subject, session = opened(
        answer_with(np.arange(3)), answer_with((1, [2])), (0, ("refused", ("", "a set")))
    )
    with subject:
        assert subject.f(1, k=2).tolist() == [0, 1, 2]
        assert subject.f() == (1, [2]) and len(session.links) == 1
        missing_answer(subject)
        order = {"task": "f", "source": "def f(): return 1", "args": (1,), "kwargs": {"k": 2}}
        assert session.requests[0] == ("call", order, 60)
        first, second, third = subject.calls
        assert first[:3] == ("f", (1,), {"k": 2}) and first.answer.tolist() == [0, 1, 2]
        assert second.answer == (1, [2]) and third == ("f", (), {}, None)
        subject.fresh(f="def f(): return 2", g="g")
        assert subject.calls == [] and session.links[0].closed
        session.answers.append(answer_with(4))
        subject.g()
        assert session.requests[-1][1]["source"] == "g" and len(session.links) == 2
    assert session.links[1].closed


def test_a_subject_has_only_the_submitted_tasks(opened):
    subject, _ = opened()
    assert subject.f.__name__ == "f"
    subject._sources["_g"] = ""
    for name in ("g", "_g"):
        with pytest.raises(AttributeError, match=f"submission has no task {name}"):
            getattr(subject, name)


def test_recorded_answers_have_a_limited_total_size(opened, monkeypatch):
    monkeypatch.setattr(module, "MAX_KEPT_ANSWER_BYTES", 100)
    sizes = [40, 61, 60, 1, 0]
    subject, _ = opened(
        *(answer_with(np.zeros(size, np.uint8)) for size in sizes),
        answer_with((np.zeros(60, np.uint8), "a")),
    )
    with subject:
        for _ in sizes:
            subject.f()
        assert [None if call.answer is None else call.answer.size for call in subject.calls] == [
            40,
            None,
            60,
            None,
            0,
        ]
        subject.fresh()
        subject.f()
        assert subject.calls[0].answer is not None


def test_printed_text_is_cut_to_its_first_characters(opened, monkeypatch):
    monkeypatch.setattr(module, "MAX_PRINTED_CHARACTERS", 10)
    subject, _ = opened(
        answer_with(1, "abcd"),
        answer_with(1, "efgh\x07"),
        answer_with(1, "ijkl"),
        answer_with(1, "mn"),
    )
    with subject:
        printed = []
        for _ in range(4):
            subject.f()
            printed.append(subject.printed)
        assert printed == ["abcd", "abcdefgh", "abcdefghij", "abcdefghij"]
        subject.fresh()
        assert subject.printed == ""


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        (("answer", ("", 1), 61), "another call"),
        (("answer", 1), "without its output"),
        (("answer", ("", 1, 2)), "without its output"),
        (("answer", ["", 1]), "without its output"),
        (("answer", (1, "")), "without its output"),
        (("refused", ("", 1)), "wrong form"),
        (("raised", ("", "a")), "wrong form"),
        (("of no kind", ("", "a")), "wrong form"),
        (
            ("raised", ("", {"error": "E", "message": "", "text": "", "line": "1"})),
            "wrong form",
        ),
        (
            ("raised", ("", {"error": "E", "message": "", "text": "", "line": 1, "more": 1})),
            "wrong form",
        ),
        (
            ("refused", ("", {"error": "E", "message": "", "text": "", "line": 1})),
            "wrong form",
        ),
    ],
)
def test_a_malformed_message_is_not_accepted_as_an_answer(answer, why, opened):
    subject, _ = opened((0, answer))
    with subject:
        kind, message = missing_answer(subject)
        assert kind == "damaged" and message.startswith("f ") and why in message


def test_an_answer_sent_before_the_call_is_refused(opened):
    for spoken, is_refused in ((b"x", True), (b"", False)):
        subject, session = opened(answer_with(7))
        session.unexpected = spoken
        with subject:
            if is_refused:
                kind, message = missing_answer(subject)
                assert kind == "damaged" and message.startswith("f ") and not session.requests
            else:
                assert subject.f() == 7


@pytest.mark.parametrize(
    ("raised", "message"),
    [
        (
            {"error": "ValueError", "message": "no", "text": "x = 1", "line": 3},
            "ValueError: no (line 3: x = 1)",
        ),
        ({"error": "ValueError", "message": "", "text": "", "line": None}, "ValueError"),
        ({"error": "E", "message": "a\x07b", "text": "", "line": 0}, "E: ab (line 0: )"),
        ({"error": "E", "message": "n" * 2001, "text": "", "line": None}, f"E: {'n' * 2000}"),
        ({"error": "E", "message": "m", "text": "", "line": None}, "E: m"),
    ],
)
def test_an_exception_is_reported_with_its_line(raised, message, opened):
    subject, _ = opened((0, ("raised", ("", raised))))
    with subject:
        assert missing_answer(subject) == ("raised", f"f raised {message}")


def test_an_unsupported_value_is_reported_by_its_type(opened):
    subject, _ = opened((0, ("refused", ("", "a set" + "n" * 400))))
    with subject:
        kind, message = missing_answer(subject)
        assert kind == "refused" and message.startswith("f ") and "a setnnn" in message
        assert len(message) < 400 and subject.calls[0].answer is None


def test_without_a_sandbox_the_time_has_no_bound_but_its_own(opened):
    assert min(opened(timeout=math.inf)[0].seconds_left, 1) == 1
