"""Functions that use up time or memory, and texts that break pages and terminals, in the strict tier."""

import json
import re
import socket
import unicodedata
from fractions import Fraction
from xml.etree import ElementTree

import pytest
from support import hostile_submissions

from hdrlab.course import plan
from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.classroom import run as classroom
from hdrlab.course.classroom.jobs import GradingJob, JobResult
from hdrlab.course.grading import grader, results
from hdrlab.course.grading.results import Check, Result
from hdrlab.course.reports import feedback, gradebook
from hdrlab.course.sandbox import tiers
from hdrlab.course.sandbox.inside import channel
from hdrlab.course.sanitize import sanitize_line, sanitize_text

pytestmark = pytest.mark.grading

KINDS = {  # of no answer; the others answer with something that is compared
    "computes in each call": ("late",),
    "computes in threads": ("late",),
    "computes at import": ("late",),
    "a list of 340,000 integers": ("refused",),
    "a dictionary of 100,000": ("refused",),
    "lists of lists": ("refused", "damaged"),
    "a frame that lies": ("damaged", "raised", "late", "died"),
    "a number of many digits": ("refused",),
    "ends by itself": ("died",),
    "ends otherwise each time": ("died",),
    "kills itself": ("died", "raised"),
    "closes its link": ("died",),
    "fills the memory": ("raised",),
    "crashes": ("died", "raised"),
    "calls itself": ("died", "late", "raised"),
    "prints without end": ("late",),
}


@pytest.fixture(scope="module")
def strict():
    """The strict tier; skip the test if this machine cannot run it."""
    try:
        with Subject({"hat": hostile_submissions.CORRECT_CODE}, tiers.choose("strict")) as subject:
            subject.hat(3)
        return tiers.choose("strict")
    except tiers.Unavailable as reason:
        pytest.skip(str(reason))


@pytest.mark.parametrize("name", hostile_submissions.HOSTILE_CODE)
def test_a_hostile_function_fails_only_its_own_call(name, strict):
    kinds = KINDS.get(name, ())
    late = kinds == ("late",)
    patience = 20.0
    if late:
        patience = 0.3
    elif "late" in kinds:
        patience = 3.0
    with Subject({"hat": hostile_submissions.HOSTILE_CODE[name]}, strict, patience) as subject:
        try:
            kind = bool(subject.hat(8) is None)
        except NoAnswer as error:
            kind = error.kind
        subject.fresh()
        assert (
            subject._session.clear_check()[1] <= 20
            and subject._session.cpu_seconds_left > 0
            or late
        )
    assert kind in KINDS.get(name, (False, True))


def test_time_limits_of_a_check_and_of_a_submission_are_reported(strict):
    source = "import time\ndef hat(n):\n    time.sleep(0.08)\n    return n\n"
    messages = []
    with Subject({"hat": source}, strict, 0.1) as subject:
        for _ in range(12):
            subject.fresh()
            for _ in range(6):
                try:
                    subject.hat(8)
                except NoAnswer as error:
                    messages.append(str(error))
    assert any("0.3 s" in message and "check" in message for message in messages)
    assert "hat" in messages[-1] and "2 s" in messages[-1]


def test_the_processor_time_of_a_submission_is_limited_and_reported(strict):
    with Subject(
        {"hat": hostile_submissions.HOSTILE_CODE["computes in each call"]}, strict, 0.3
    ) as subject:
        subject._session.cpu_seconds_left = 0.1
        messages = []
        for _ in range(2):
            subject.fresh()
            with pytest.raises(NoAnswer) as raised:
                subject.hat(8)
            messages.append(str(raised.value))
            subject._close_link()
            subject._session.clear_check()
            # a busy machine may not have used it
            subject._session.cpu_seconds_left = min(subject._session.cpu_seconds_left, 0.0)
    assert "hat" in messages[0] and "0.3 s" in messages[0]
    assert "1.2 s" in messages[1] and "processor time" in messages[1]


def test_a_process_at_its_processor_limit_counts_as_late(strict):
    with Subject(
        {"hat": hostile_submissions.HOSTILE_CODE["computes in each call"]}, strict, 20.0
    ) as subject:
        subject._session.cpu_seconds_left = 0.5
        with pytest.raises(NoAnswer, match="hat took longer than 1 s of processor time") as raised:
            subject.hat(8)
        assert raised.value.kind == "late"


def test_a_killed_process_is_distinguished_from_one_that_exits(strict):
    with Subject(
        {"hat": hostile_submissions.HOSTILE_CODE["ends by itself"]}, strict, 5.0
    ) as subject:
        with pytest.raises(NoAnswer) as raised:
            subject.hat(8)
        assert raised.value.kind == "died"
    source = "import time\ndef hat(n):\n    time.sleep(30)\n"
    with Subject({"hat": source}, strict, 20.0) as subject:
        subject._session.wait_until_ready()
        subject._session._launched.process.kill()  # as a system that is out of memory does
        subject._session._launched.process.wait()
        subject._session.start_check = _silent(subject._session)
        subject._session._is_busy = True
        with pytest.raises(NoAnswer) as raised:
            subject.hat(8)
        assert raised.value.kind == "killed"


def _silent(running):
    """Return a function that returns a connection whose other end is closed."""

    def check():
        ours, theirs = socket.socketpair()
        theirs.close()
        return ours

    return check


def test_an_exception_that_imitates_the_grader_gets_no_second_try(tmp_path, monkeypatch):
    tries = []

    def graded(path, homework, conditions):
        tries.append(path)
        message = f"hat raised ValueError: hat ended its process, and gave no answer {len(tries)}"
        return result(message=message, kind="raised" if len(tries) < 9 else "")

    monkeypatch.setattr(grader, "grade", graded)
    class_grader = classroom.Grader(None, plan.GradingOptions("practice"))
    class_grader.grade(GradingJob("b1", tmp_path / "b1.py", "key"))
    assert len(tries) == 1


def result(**fields):
    """Return a Result with one failed check."""
    check = Check("hat", "test_a", "A promise", Fraction(), Fraction(1), "no answer", **fields)
    return Result("b1", "hw2", "T", "strict", (check,), {}, (), "", "", "", {})


def shown(text):
    """Return whether a text contains nothing that breaks a page, a terminal or a table."""
    categories = [unicodedata.category(character) for character in text if character not in "\n\t"]
    stacked = re.search("(?:[\u0300-\u036f\u20d0-\u20ff]){5}", unicodedata.normalize("NFD", text))
    return not stacked and not {"Cc", "Cf", "Cs", "Co"} & set(categories)


@pytest.mark.parametrize("name", hostile_submissions.CODE_WITH_NASTY_TEXTS)
def test_printed_text_is_escaped_in_every_format(name, strict, tmp_path):
    with Subject({"hat": hostile_submissions.CODE_WITH_NASTY_TEXTS[name]}, strict, 10.0) as subject:
        message = ""
        try:
            subject.hat()
        except NoAnswer as error:
            message = str(error)
        assert shown(message) and shown(subject.printed)
        paths = gradebook.write_results(
            tmp_path, result(message=message, printed=subject.printed, kind="raised")
        )
    texts = {path.name: path.read_bytes().decode() for path in paths}
    assert "<script>alert" not in texts["feedback.html"]
    assert "<svg onload" not in texts["feedback.html"]
    assert shown(texts["feedback.html"]) and json.loads(texts["gradescope.json"])
    ElementTree.fromstring(texts["junit.xml"])


@pytest.mark.parametrize("name", hostile_submissions.NASTY_TEXTS)
def test_sanitizing_removes_what_escaping_cannot(name):
    text = hostile_submissions.NASTY_TEXTS[name]
    for once in (
        sanitize_text(text, 4000),
        sanitize_line(text, 80),
        sanitize_line("a" + text + "b", 80),
    ):
        assert shown(once) and once.encode().decode() == once
        assert sanitize_text(once, 4000) == once
    assert len(sanitize_line(text * 100, 80)) <= 80


def test_an_error_while_writing_feedback_is_a_note_of_that_student(tmp_path, monkeypatch):
    monkeypatch.setattr(feedback, "page", lambda _, **options: "\ud800")
    (tmp_path / "b1.json").write_bytes(results.to_json(result()))
    done = classroom.write_feedback(
        tmp_path, JobResult(GradingJob("b1", tmp_path, "key"), tmp_path / "b1.json")
    )
    assert done.path
    assert done.problem.startswith("its feedback could not be written: UnicodeEncodeError")
    (tmp_path / "b1.json").write_text("half a res")
    done = classroom.write_feedback(
        tmp_path, JobResult(GradingJob("b1", tmp_path, "key"), tmp_path / "b1.json")
    )
    assert "its feedback could not be written" in done.problem


def test_the_channel_limits_values_outside_arrays_on_both_sides():
    ours, theirs = socket.socketpair()
    with ours, theirs:
        with pytest.raises(
            channel.UnsupportedValue, match="more than 16384 values outside of arrays"
        ):
            channel.send(ours, "answer", [0] * 20_000)
        channel.send(ours, "answer", [0] * 16_000)
        assert len(channel.receive(theirs)[2]) == 16_000
