"""How one submission of a class is graded: its limits, its attempts, and the files that are sent along."""

from types import SimpleNamespace

import pytest
from support.small_class import HOMEWORK, make_result

from hdrlab.course.classroom import run
from hdrlab.course.classroom.jobs import GradingJob
from hdrlab.course.classroom.run import Grader
from hdrlab.course.grading import results
from hdrlab.course.plan import GradingOptions
from hdrlab.course.sandbox.session import Unavailable


def grader(monkeypatch, *results, **knobs):
    """Return a Grader whose attempts give these results, and the list of its calls."""
    left = list(results)
    calls = []

    def grade(path, homework, conditions):
        files = (
            {}
            if conditions.hidden is None
            else {
                path.relative_to(conditions.hidden).as_posix(): path.read_bytes()
                for path in conditions.hidden.rglob("*")
                if path.is_file()
            }
        )
        calls.append((path, conditions.student, files))
        return left.pop(0)

    monkeypatch.setattr(run.grader, "grade", grade)
    return Grader(HOMEWORK, GradingOptions(**knobs.pop("conditions", {})), **knobs), calls


JOB = GradingJob("t", "file", "key")


@pytest.mark.parametrize(
    ("tries", "tried", "counts"),
    [
        ([("",)], 1, 0),
        ([("", "raised")], 1, 0),
        ([("killed", ""), ("", "")], 2, 1),
        ([("", "killed"), ("killed", ""), ("raised", "")], 3, 2),
        ([("killed", ""), ("killed", ""), ("killed", "")], 3, 0),
        ([("killed", ""), ("", "killed"), ("killed", "")], 3, None),
        ([("killed", ""), ("killed", ""), ("", "killed")], 3, None),
    ],
)
def test_a_killed_submission_is_graded_again_until_the_result_repeats(
    tries, tried, counts, monkeypatch
):
    made, calls = grader(monkeypatch, *(make_result("x", *kinds) for kinds in tries))
    if counts is None:
        with pytest.raises(ValueError, match="ended .*answer, each time at another check"):
            made.grade(JOB)
    else:
        assert made.grade(JOB) == results.to_json(make_result("t", *tries[counts]))
    assert len(calls) == tried


@pytest.mark.parametrize(("secret", "student"), [("", ""), ("s", "t")])
def test_a_secret_gives_each_student_their_own_inputs_and_hidden_checks_are_included(
    secret, student, monkeypatch
):
    files = [("test_a.py", b"1"), ("data/b/x.npy", b"2"), ("data/b/y.npy", b"3")]
    made, calls = grader(monkeypatch, make_result("x"), conditions={"secret": secret}, hidden=files)
    made.grade(JOB)
    assert calls == [("file", student, dict(files))]
    made, calls = grader(monkeypatch, make_result("x"))
    made.grade(JOB)
    assert calls == [("file", "", {})]


def test_the_tier_of_a_machine_is_checked_once(monkeypatch):
    calls = []
    monkeypatch.setattr(
        run.doctor,
        "examine",
        lambda tier: (
            calls.append(tier) or SimpleNamespace(works=tier != "none", details="no walls")
        ),
    )
    run._check_tier_available.cache_clear()
    for tier in ("some", "some", "none"):
        made = Grader(HOMEWORK, GradingOptions(tier))
        if tier == "none":
            with pytest.raises(Unavailable, match="no walls"):
                made.check_available()
        else:
            made.check_available()
    run._check_tier_available.cache_clear()
    assert calls == ["some", "none"]


def test_hidden_checks_are_read_up_to_the_size_limit(tmp_path, monkeypatch):
    assert run.read_hidden_checks(None) == []
    for name in ("b.py", "a/c.npy", "a/__pycache__/c.pyc"):
        (tmp_path / "h" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "h" / name).write_bytes(name.encode())
    whole = [("a/c.npy", b"a/c.npy"), ("b.py", b"b.py")]
    monkeypatch.setattr(run, "MAX_HIDDEN_CHECKS_BYTES", 11)
    assert run.read_hidden_checks(tmp_path / "h") == whole
    monkeypatch.setattr(run, "MAX_HIDDEN_CHECKS_BYTES", 10)
    with pytest.raises(ValueError, match="hidden checks of at most 10 bytes.*11"):
        run.read_hidden_checks(tmp_path / "h")
    with pytest.raises(ValueError, match="folder with hidden checks"):
        run.read_hidden_checks(tmp_path / "h" / "b.py")
