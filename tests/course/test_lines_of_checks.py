"""The lines that checks write become a Result: its fields, points and outcomes."""

import base64
import hashlib
import json
from fractions import Fraction

import numpy as np
import pytest

from hdrlab.course import plan
from hdrlab.course.checks import SPECIFICATION
from hdrlab.course.grading import grader
from hdrlab.course.grading.results import Drawing
from hdrlab.course.plan import GradingOptions
from hdrlab.course.sandbox import tiers
from hdrlab.course.sandbox.session import Unavailable
from hdrlab.course.submissions.reader import SubmittedCode

HW2 = plan.read().homeworks["hw2"]
HOMEWORK = HW2._replace(
    tasks=tuple(task for task in HW2.tasks if task.id in ("hat", "gsolve")), at_most=None
)
READ = SubmittedCode({"hat": "def hat(): ..."}, ("a problem",), "digest", ("numpy",))


def check(name, task="hat", *, points="1", needs="", case="", hidden=False, hints=("h",)):
    """Return the line that announces a check."""
    line = {
        "check": f"test_{task}.py::{name}{case}",
        "task": task,
        "name": name,
        "promise": f"It {name}s",
    }
    return line | {"points": points, "needs": needs, "hints": list(hints), "hidden": hidden}


def ending(name, outcome="holds", task="hat", *, case="", message="", printed="", **more):
    """Return the line of a check that has run."""
    line = {
        "ended": f"test_{task}.py::{name}{case}",
        "outcome": outcome,
        "message": message,
        "printed": printed,
    }
    return line | more


@pytest.fixture
def run_checks(monkeypatch):
    """run_checks(lines) -> each Result of a run that writes these lines; `jobs` holds the jobs of the
    runs.
    """
    jobs = []
    chosen = []

    def run_checks(*lines, conditions=grader.FOR_CREDIT, homework=HOMEWORK, read=READ):
        def run(folder, job, files, *, timeout):
            job_fields = json.loads(job.read_text("utf8"))
            texts = {file: file.read_text("utf8") for file in files}
            jobs.append(
                (folder, job, files, timeout, job_fields, texts, (folder / "lines").read_bytes())
            )
            yield from lines

        monkeypatch.setattr(grader, "run_pytest", run)
        monkeypatch.setattr(tiers, "choose", chosen.append)
        return list(grader.check_steps(read, homework, conditions))

    run_checks.jobs = jobs
    run_checks.chosen = chosen
    return run_checks


def test_a_result_names_the_student_the_checks_and_the_tier(run_checks):
    conditions = GradingOptions("container", "ada", "secret")
    (result,) = run_checks(
        check("hold"), conditions=conditions, homework=HOMEWORK._replace(at_most=7.0)
    )
    assert (result.student, result.homework) == ("ada", "hw2")
    assert (result.title, result.tier) == (HOMEWORK.title, "container")
    assert (result.problems, result.submission, result.at_most) == (("a problem",), "digest", 7.0)
    files = [SPECIFICATION / f"test_{task.id}.py" for task in HOMEWORK.tasks]
    whole = b"".join(file.name.encode() + b"\0" + file.read_bytes() for file in files)
    assert result.specification == hashlib.sha256(whole).hexdigest()
    assert set(result.versions) == {"hdrlab", "numpy", "scipy", "python"}
    seeds = {task.id: str(plan.seed("secret", "ada", task.id)) for task in HOMEWORK.tasks}
    assert result.seed == hashlib.sha256(json.dumps(seeds).encode()).hexdigest()[:16]


def test_the_job_holds_all_that_the_checks_are_to_know(run_checks):
    run_checks(conditions=GradingOptions("strict", "ada", "secret", None, 3.0, False))
    ((folder, job, files, patience, job_fields, _, lines),) = run_checks.jobs
    assert (job, patience, lines, run_checks.chosen) == (folder / "job.json", 240, b"", ["strict"])
    assert files == [SPECIFICATION / f"test_{task.id}.py" for task in HOMEWORK.tasks]
    assert job_fields.pop("grader") > 1 and job_fields.pop("tasks")[0][0] == HOMEWORK.tasks[0].id
    assert job_fields == {
        "sources": READ.sources,
        "modules": ["numpy"],
        "tier": "strict",
        "seeds": {task.id: str(plan.seed("secret", "ada", task.id)) for task in HOMEWORK.tasks},
        "timeout": 3.0,
        "draw": False,
        "hidden": "",
        "out": str(folder / "lines"),
        "by": "hdrlab.course.checks.plugin:GradingPlugin",
    }
    assert not folder.exists()


@pytest.mark.parametrize(
    ("student", "secret", "seeded"), [("", "", 0), ("", "s", 0), ("ada", "", 1), ("ada", "s", 2)]
)
def test_inputs_are_the_public_ones_without_a_student_and_drawn_with_a_secret(
    student, secret, seeded, run_checks
):
    (result,) = run_checks(conditions=GradingOptions("strict", student, secret))
    seeds = run_checks.jobs[0][4]["seeds"]
    assert (set(seeds.values()) == {"0"}) is (seeded == 0)
    assert len(result.seed) == (16 if seeded == 2 else 0)


def test_extra_fields_of_a_job_are_added_to_the_others(run_checks, monkeypatch):
    run_checks()
    list(grader.iter_events(READ, HOMEWORK, GradingOptions(), by="other", asked=[1]))
    assert run_checks.jobs[1][4]["by"] == "other" and run_checks.jobs[1][4]["asked"] == [1]


def test_hidden_checks_come_after_the_checks_of_the_task(run_checks, tmp_path):
    for name in ("test_hat.py", "test_other.py"):
        (tmp_path / name).write_text("", encoding="utf8")
    run_checks(conditions=GradingOptions(hidden=tmp_path))
    _, _, files, _, job_fields, *_ = run_checks.jobs[0]
    own = {task.id: [SPECIFICATION / f"test_{task.id}.py"] for task in HOMEWORK.tasks}
    own["hat"].append(tmp_path / "test_hat.py")
    assert files == [file for task in HOMEWORK.tasks for file in own[task.id]]
    assert job_fields["hidden"] == str(tmp_path)
    for missing in (tmp_path / "none", tmp_path / "test_hat.py"):
        with pytest.raises(ValueError, match="folder with hidden checks"):
            run_checks(conditions=GradingOptions(hidden=missing))


def test_checks_are_adapted_to_the_variant_except_for_hidden_ones(run_checks, tmp_path):
    hw1 = plan.read().homeworks["hw1"]
    (task,) = [task for task in hw1.tasks if task.id == "exclusion"]
    homework = hw1._replace(tasks=(task._replace(variant="compared/above/six"), *HOMEWORK.tasks))
    (tmp_path / "test_exclusion.py").write_text("hidden", encoding="utf8")
    run_checks(homework=homework, conditions=GradingOptions(hidden=tmp_path))
    folder, _, files, *_, texts, _ = run_checks.jobs[0]
    assert files[:2] == [folder / "test_exclusion.py", tmp_path / "test_exclusion.py"]
    assert files[2:] == [SPECIFICATION / f"test_{task.id}.py" for task in HOMEWORK.tasks]
    plain = (SPECIFICATION / "test_exclusion.py").read_text("utf8")
    assert texts[files[0]] != plain and len(texts[files[0]]) > len(plain) / 2
    assert texts[files[1]] == "hidden"


def test_an_unavailable_tier_ends_the_grading(run_checks):
    with pytest.raises(Unavailable, match="no walls"):
        run_checks(check("hold"), {"unavailable": "no walls"}, ending("hold"))


def test_a_result_is_yielded_after_each_check_and_at_the_end(run_checks):
    lines = [check("hold"), check("fail"), ending("hold"), ending("fail", "fails")]
    result = run_checks(
        *lines, {"recognised": "hat", "sentence": "S", "explains_all": True, "once": True}
    )
    outcomes = [
        [check_result.outcome for check_result in result_so_far.checks] for result_so_far in result
    ]
    assert outcomes == [["holds", "no answer"], ["holds", "fails"], ["holds", "fails"]]
    assert [result_so_far.misconceptions for result_so_far in result] == [{}, {}, {"hat": "S"}]


def test_the_outcome_of_a_check_is_the_one_that_was_written(run_checks):
    line = ending("fail", "no answer", message="m" * 2001, printed="s\x07" * 4001, kind="late")
    (*_, result) = run_checks(check("fail", hints=("a", "b")), line)
    (check_result,) = result.checks
    assert (check_result.task, check_result.name, check_result.promise) == (
        "hat",
        "fail",
        "It fails",
    )
    assert check_result.hints == (
        "a",
        "b",
    )
    assert (check_result.outcome, check_result.kind, check_result.hidden, check_result.drawing) == (
        "no answer",
        "late",
        False,
        Drawing(),
    )
    assert check_result.message == "m" * 2000 and check_result.printed == "s" * 2000


def test_a_check_that_never_ran_has_no_answer(run_checks):
    (result,) = run_checks(check("hold"))
    (check_result,) = result.checks
    assert (check_result.outcome, check_result.printed) == (
        "no answer",
        "",
    ) and check_result.message
    assert (check_result.points, check_result.kind) == (0, "")


def test_a_check_with_several_cases_shows_the_first_failing_case(run_checks):
    cases = [check("hold", case=case) for case in ("[a]", "[b]", "[c]")]
    ends = [
        ending("hold", case="[a]", message="note a"),
        ending("hold", "fails", case="[b]", message="b fails"),
        ending("hold", "no answer", case="[c]", message="c"),
    ]
    *_, result = run_checks(*cases, *ends)
    assert [(check_result.outcome, check_result.message) for check_result in result.checks] == [
        ("fails", "b fails")
    ]
    *_, result = run_checks(
        *cases, ends[0], *(check_result | {"outcome": "holds"} for check_result in ends[1:])
    )
    assert [(check_result.outcome, check_result.message) for check_result in result.checks] == [
        ("holds", "note a")
    ]


def test_a_check_that_ended_twice_fails_if_it_failed_once(run_checks):
    ends = [ending("hold"), ending("hold", "fails", message="at its end")]
    for order in (ends, ends[::-1]):
        *_, result = run_checks(check("hold"), *order)
        assert [(check_result.outcome, check_result.message) for check_result in result.checks] == [
            ("fails", "at its end")
        ]


def test_the_points_of_a_task_are_split_by_the_weights_of_its_checks(run_checks):
    gsolve = next(check_result for check_result in HOMEWORK.tasks if check_result.id == "gsolve")
    hat = next(check_result for check_result in HOMEWORK.tasks if check_result.id == "hat")
    tasks = (gsolve._replace(points=7.5), hat._replace(points=4.0))
    lines = [
        check("hold", "gsolve", points="2"),
        check("fail", "gsolve", points="1/2"),
        check("hold", points="3", case="[a]"),
        check("hold", points="3", case="[b]"),
        check("hold", points="1", hidden=True),
    ]
    ends = [ending("hold", task="gsolve"), ending("hold", case="[a]"), ending("hold", case="[b]")]
    *_, result = run_checks(*lines, *ends, homework=HOMEWORK._replace(tasks=tasks))
    weights = [
        (check_result.task, check_result.hidden, check_result.max_points, check_result.points)
        for check_result in result.checks
    ]
    assert weights == [
        ("gsolve", False, 6, 6),
        ("gsolve", False, Fraction(3, 2), 0),
        ("hat", False, 3, 3),
        ("hat", True, 1, 0),
    ]


@pytest.mark.parametrize(("once", "earned"), [(False, [2, 0, 0]), (True, [2, 0, 2])])
def test_a_recognized_mistake_is_named_as_the_cause_of_its_tasks_failures(once, earned, run_checks):
    lines = [check("hold", points="2"), check("fail", points="3"), check("err", points="3")]
    ends = [ending("hold"), ending("fail", "fails"), ending("err", "fails")]
    homework = HOMEWORK._replace(
        tasks=tuple(check_result._replace(points=8.0) for check_result in HOMEWORK.tasks)
    )
    recognized = {"sentence": "S", "explains_all": True, "once": once}
    *_, result = run_checks(*lines, *ends, {"recognised": "hat", **recognized}, homework=homework)
    assert [check_result.follows for check_result in result.checks] == ["", "", "It fails"]
    assert [check_result.points for check_result in result.checks] == earned
    *_, result = run_checks(
        *lines, *ends, {"recognised": "gsolve", **recognized}, homework=homework
    )
    assert [check_result.points for check_result in result.checks] == [2, 0, 0]
    assert [check_result.follows for check_result in result.checks] == ["", "", ""]


def test_a_mistake_that_explains_only_some_checks_is_named_but_is_not_the_cause_of_all(run_checks):
    lines = [check("hold", points="2"), check("fail", points="3"), check("err", points="3")]
    ends = [ending("hold"), ending("fail", "fails"), ending("err", "fails")]
    partial = {"recognised": "hat", "sentence": "S", "explains_all": False, "once": False}
    *_, result = run_checks(*lines, *ends, partial)
    assert [check_result.follows for check_result in result.checks] == ["", "", ""]
    assert result.misconceptions == {"hat": "S"}


def test_a_check_that_needs_another_one_is_passed_on_to_the_scoring(run_checks):
    lines = [check("fail"), check("hold", needs="fail")]
    *_, result = run_checks(*lines, ending("fail", "fails"), ending("hold"))
    assert [check_result.points for check_result in result.checks] == [
        0,
        0,
    ]
    assert "It fails" in result.checks[1].message
    *_, result = run_checks(*lines, ending("fail"), ending("hold"))
    assert result.score == result.max_score > 0


def drawn(kind, shape, wrong):
    truth = np.linspace(0, 1, int(np.prod(shape))).reshape(shape)
    answer = truth.copy()
    answer.flat[wrong] += 0.5
    texts = [base64.b64encode(array.astype("<f8").tobytes()).decode() for array in (truth, answer)]
    return {"kind": kind, "shape": shape, "expected": texts[0], "answer": texts[1]}


@pytest.mark.parametrize(
    ("kind", "shape", "frames"), [("curve", (30,), 1), ("image", (12, 9), 3), ("image", (4,), 0)]
)
def test_a_difference_is_drawn_at_its_own_check_if_it_can_be_drawn(kind, shape, frames, run_checks):
    line = ending("fail", "fails", differs=drawn(kind, shape, 3))
    for end in (line, line | {"ended": "/tmp/a/test_hat.py::fail"}):
        begun = check("fail") | {"check": end["ended"]}
        *_, result = run_checks(begun, end)
        drawing = result.checks[0].drawing
        assert len(drawing.frames) == len(drawing.alts) == len(drawing.captions) == frames
        assert all("hat" in alt for alt in drawing.alts[:1])
