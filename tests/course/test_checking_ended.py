"""The grader's pytest plugin: what it writes when a check has ended."""

import base64
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from support import fake_grading_plugin
from support.fake_grading_plugin import CalledSubject, make_item

from hdrlab.course.checks import compare, misconceptions, plugin
from hdrlab.course.checks.compare import AnswerMismatch
from hdrlab.course.checks.mistakes import KnownMistake
from hdrlab.course.checks.subject import NoAnswer
from hdrlab.course.sandbox.session import Unavailable


@pytest.fixture
def checking(tmp_path):
    """A GradingPlugin whose method `lines` reads its output; no check has any notes yet."""
    compare.notes.clear()
    yield fake_grading_plugin.make_plugin(tmp_path)
    compare.notes.clear()


def end_check(checking, check, raised):
    """Let pytest report that a check has ended, with what it raised or None."""
    call = SimpleNamespace(when="call", excinfo=raised and SimpleNamespace(value=raised))
    report = checking.pytest_runtest_makereport(check, call)
    next(report)
    with pytest.raises(StopIteration):
        report.send("report")


@pytest.mark.parametrize(
    ("when", "raised", "written"),
    [
        ("call", None, "holds"),
        ("call", ValueError(), "fails"),
        ("setup", ValueError(), "fails"),
        ("setup", None, None),
    ],
)
def test_a_check_is_reported_after_its_call_or_a_failed_setup(when, raised, written, checking):
    call = SimpleNamespace(when=when, excinfo=raised and SimpleNamespace(value=raised))
    report = checking.pytest_runtest_makereport(make_item(), call)
    assert next(report) is None
    with pytest.raises(StopIteration) as stopped:
        report.send("report")
    assert stopped.value.value == "report"
    assert [line["outcome"] for line in checking.lines()] == ([written] if written else [])


def test_a_passed_check_is_reported_with_its_distinct_notes_and_printed_output(checking):
    compare.notes += ["b", "a", "b", "n" * 2000]
    end_check(
        checking, make_item(subject=CalledSubject(printed="<f at 0x7fab> " + "s" * 4000)), None
    )
    (line,) = checking.lines()
    assert line == {
        "ended": "/checks/test_hat.py::test_a_promise",
        "outcome": "holds",
        "message": "b\na\n" + "n" * 1496,
        "printed": "<f> " + "s" * (4000 - 14),
    }
    assert not checking.failed


@pytest.mark.parametrize(
    ("raised", "outcome", "kind", "message"),
    [
        (NoAnswer("hat raised E", "raised"), "no answer", "raised", "hat raised E"),
        (NoAnswer("", "missing"), "no answer", "missing", ""),
        (NoAnswer("too long", "late"), "no answer", "late", "too long"),
        (AnswerMismatch("n" * 1501), "fails", "", "n" * 1500),
        (AssertionError(), "fails", "", "The check failed"),
        (AssertionError("a\n +  where b"), "fails", "", "a"),
        (
            ValueError("of <f at 0x7f>"),
            "fails",
            "",
            "The answer could not be compared: ValueError: of <f>",
        ),
        (
            ValueError("n" * 1600),
            "fails",
            "",
            ("The answer could not be compared: ValueError: " + "n" * 1600)[:1500],
        ),
    ],
)
def test_a_failed_check_is_reported_with_its_message(raised, outcome, kind, message, checking):
    end_check(checking, make_item(), raised)
    (line,) = checking.lines()
    assert (line["outcome"], line["kind"], line["message"], line["differs"]) == (
        outcome,
        kind,
        message,
        None,
    )
    assert checking.failed == {"hat"} and checking.late == ({"hat"} if kind == "late" else set())


@pytest.mark.parametrize(
    ("words", "answer", "message"),
    [
        ("w: no", np.ones(3), "w: no\nYours: shape (3,)"),
        ("n" * 1600, np.ones(3), "n" * 1500 + "\nYours"),
        ("w: no", np.array(1.0), "w: no"),
    ],
)
def test_a_mismatch_message_describes_the_array_that_the_student_returned(
    words, answer, message, checking
):
    end_check(checking, make_item(), AnswerMismatch(words, answer=answer))
    (line,) = checking.lines()
    assert line["message"].startswith(message)
    assert ("Yours" in line["message"]) is (answer.ndim > 0)


@pytest.mark.parametrize(
    ("kind", "shape", "drawn"),
    [
        ("curve", (3,), True),
        ("image", (2, 2), True),
        ("values", (3,), False),
        ("image", (4, 1), True),
        ("image", (5, 1), False),
    ],
)
def test_a_mismatch_that_can_be_drawn_includes_both_arrays_as_base64(
    kind, shape, drawn, checking, monkeypatch
):
    monkeypatch.setattr(plugin, "MAX_DRAWN_VALUES", 4)
    truth = np.zeros(shape)
    answer = np.ones(shape, np.float32)
    error = AnswerMismatch("no", expected=truth, answer=answer, kind=kind)
    end_check(checking, make_item(), error)
    checking.job["draw"] = False
    end_check(checking, make_item(), error)
    first, second = [line["differs"] for line in checking.lines()]
    assert second is None and (first is not None) is drawn
    if drawn:
        texts = [
            base64.b64encode(array.astype("<f8").tobytes()).decode() for array in (truth, answer)
        ]
        assert first == {
            "kind": kind,
            "shape": list(shape),
            "expected": texts[0],
            "answer": texts[1],
        }


@pytest.mark.parametrize("answers", ["expected", "answer"])
def test_nothing_is_drawn_unless_both_answers_are_known(answers, checking):
    end_check(checking, make_item(), AnswerMismatch("no", kind="curve", **{answers: np.zeros(3)}))
    (line,) = checking.lines()
    assert line["differs"] is None


def test_hidden_checks_are_not_used_to_recognize_a_mistake(checking):
    hidden = make_item(folder=Path("/hidden"), subject=CalledSubject(1))
    end_check(checking, hidden, AssertionError())
    assert not checking.failed and not checking.calls
    end_check(checking, make_item(subject=CalledSubject(*range(15))), None)
    end_check(checking, make_item(subject=CalledSubject(*range(15))), None)
    kept = checking.calls["hat"]
    assert [[answer for *_, answer in check.calls] for check in kept] == [[*range(15)], [*range(5)]]
    assert all(check.holds for check in kept)
    assert kept[0].calls[1] == ((1,), {}, 1)


def test_an_unavailable_sandbox_is_reported_without_failing_a_check(checking):
    end_check(checking, make_item(subject=CalledSubject(1)), Unavailable("no walls"))
    assert checking.lines() == [{"unavailable": "no walls"}] and not checking.failed


def test_mistakes_of_failed_tasks_are_recognized_and_an_error_affects_one_task_only(
    checking, monkeypatch
):
    def diagnose(task, checks):
        if task.id == "gsolve":
            raise ValueError
        calls = [misconceptions.CheckedCalls(calls=[((0,), {}, 5)], holds=False)]
        assert (task.function, task.points, checks) == ("core.weights.hat", 1.0, calls)
        mistake = KnownMistake(
            name="hat_x", task="hat", sentence="A sentence.", function=len, misses_method=True
        )
        return misconceptions.Diagnosis(mistakes=(mistake,), explains_all=True)

    monkeypatch.setattr(misconceptions, "diagnose", diagnose)
    end_check(checking, make_item(subject=CalledSubject(5)), AssertionError())
    checking.failed |= {"gsolve", "unknown"}
    checking.pytest_sessionfinish(None)
    recognised = {"recognised": "hat", "sentence": "A sentence.", "explains_all": True}
    assert checking.lines()[1:] == [{**recognised, "once": False}]
    nothing = misconceptions.Diagnosis()
    monkeypatch.setattr(misconceptions, "diagnose", lambda task, checks: nothing)
    checking.pytest_sessionfinish(None)
    assert len(checking.lines()) == 2
