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
    tasks=tuple(one for one in HW2.tasks if one.id in ("hat", "gsolve")), at_most=None
)
READ = SubmittedCode({"hat": "def hat(): ..."}, ("a problem",), "digest", ("numpy",))


def check(name, task="hat", *, points="1", needs="", case="", hidden=False, hints=("h",)):
    """The line of a check before it is run."""
    line = {
        "check": f"test_{task}.py::{name}{case}",
        "task": task,
        "name": name,
        "promise": f"It {name}s",
    }
    return line | {"points": points, "needs": needs, "hints": list(hints), "hidden": hidden}


def ending(name, outcome="holds", task="hat", *, case="", message="", said="", **more):
    """The line of a check that has run."""
    line = {
        "ended": f"test_{task}.py::{name}{case}",
        "outcome": outcome,
        "message": message,
        "said": said,
    }
    return line | more


@pytest.fixture
def heard(monkeypatch):
    """heard(lines) -> each Result of a run that writes these lines; `jobs` are the jobs of those runs."""
    jobs, chosen = [], []

    def heard(*lines, conditions=grader.FOR_CREDIT, homework=HOMEWORK, read=READ):
        def run(folder, job, files, *, timeout):
            told = json.loads(job.read_text("utf8"))
            texts = {file: file.read_text("utf8") for file in files}
            jobs.append((folder, job, files, timeout, told, texts, (folder / "lines").read_bytes()))
            yield from lines

        monkeypatch.setattr(grader, "run_pytest", run)
        monkeypatch.setattr(tiers, "choose", chosen.append)
        return list(grader.check_steps(read, homework, conditions))

    heard.jobs, heard.chosen = jobs, chosen
    return heard


def test_a_result_names_the_student_the_checks_and_the_tier(heard):
    conditions = GradingOptions("container", "ada", "secret")
    (found,) = heard(check("hold"), conditions=conditions, homework=HOMEWORK._replace(at_most=7.0))
    assert (found.student, found.homework) == ("ada", "hw2")
    assert (found.title, found.tier) == (HOMEWORK.title, "container")
    assert (found.problems, found.submission, found.at_most) == (("a problem",), "digest", 7.0)
    files = [SPECIFICATION / f"test_{one.id}.py" for one in HOMEWORK.tasks]
    whole = b"".join(file.name.encode() + b"\0" + file.read_bytes() for file in files)
    assert found.specification == hashlib.sha256(whole).hexdigest()
    assert set(found.versions) == {"hdrlab", "numpy", "scipy", "python"}
    seeds = {one.id: str(plan.seed("secret", "ada", one.id)) for one in HOMEWORK.tasks}
    assert found.seed == hashlib.sha256(json.dumps(seeds).encode()).hexdigest()[:16]


def test_the_job_holds_all_that_the_checks_are_to_know(heard):
    heard(conditions=GradingOptions("strict", "ada", "secret", None, 3.0, False))
    ((folder, job, files, patience, told, _, lines),) = heard.jobs
    assert (job, patience, lines, heard.chosen) == (folder / "job.json", 240, b"", ["strict"])
    assert files == [SPECIFICATION / f"test_{one.id}.py" for one in HOMEWORK.tasks]
    assert told.pop("grader") > 1 and told.pop("tasks")[0][0] == HOMEWORK.tasks[0].id
    assert told == {
        "sources": READ.sources,
        "modules": ["numpy"],
        "tier": "strict",
        "seeds": {one.id: str(plan.seed("secret", "ada", one.id)) for one in HOMEWORK.tasks},
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
    student, secret, seeded, heard
):
    (found,) = heard(conditions=GradingOptions("strict", student, secret))
    seeds = heard.jobs[0][4]["seeds"]
    assert (set(seeds.values()) == {"0"}) is (seeded == 0)
    assert len(found.seed) == (16 if seeded == 2 else 0)


def test_extra_fields_of_a_job_are_added_to_the_others(heard, monkeypatch):
    heard()
    list(grader.iter_events(READ, HOMEWORK, GradingOptions(), by="other", asked=[1]))
    assert heard.jobs[1][4]["by"] == "other" and heard.jobs[1][4]["asked"] == [1]


def test_hidden_checks_come_after_the_checks_of_the_task(heard, tmp_path):
    for name in ("test_hat.py", "test_other.py"):
        (tmp_path / name).write_text("", encoding="utf8")
    heard(conditions=GradingOptions(hidden=tmp_path))
    _, _, files, _, told, *_ = heard.jobs[0]
    own = {one.id: [SPECIFICATION / f"test_{one.id}.py"] for one in HOMEWORK.tasks}
    own["hat"].append(tmp_path / "test_hat.py")
    assert files == [file for one in HOMEWORK.tasks for file in own[one.id]]
    assert told["hidden"] == str(tmp_path)
    for missing in (tmp_path / "none", tmp_path / "test_hat.py"):
        with pytest.raises(ValueError, match="folder with hidden checks"):
            heard(conditions=GradingOptions(hidden=missing))


def test_checks_are_adapted_to_the_variant_except_for_hidden_ones(heard, tmp_path):
    hw1 = plan.read().homeworks["hw1"]
    (task,) = [one for one in hw1.tasks if one.id == "exclusion"]
    homework = hw1._replace(tasks=(task._replace(variant="compared/above/six"), *HOMEWORK.tasks))
    (tmp_path / "test_exclusion.py").write_text("hidden", encoding="utf8")
    heard(homework=homework, conditions=GradingOptions(hidden=tmp_path))
    folder, _, files, *_, texts, _ = heard.jobs[0]
    assert files[:2] == [folder / "test_exclusion.py", tmp_path / "test_exclusion.py"]
    assert files[2:] == [SPECIFICATION / f"test_{one.id}.py" for one in HOMEWORK.tasks]
    plain = (SPECIFICATION / "test_exclusion.py").read_text("utf8")
    assert texts[files[0]] != plain and len(texts[files[0]]) > len(plain) / 2
    assert texts[files[1]] == "hidden"


def test_an_unavailable_tier_ends_the_grading(heard):
    with pytest.raises(Unavailable, match="no walls"):
        heard(check("hold"), {"unavailable": "no walls"}, ending("hold"))


def test_a_result_is_yielded_after_each_check_and_at_the_end(heard):
    lines = [check("hold"), check("fail"), ending("hold"), ending("fail", "fails")]
    found = heard(
        *lines, {"recognised": "hat", "sentence": "S", "explains_all": True, "once": True}
    )
    outcomes = [[one.outcome for one in each.checks] for each in found]
    assert outcomes == [["holds", "no answer"], ["holds", "fails"], ["holds", "fails"]]
    assert [each.misconceptions for each in found] == [{}, {}, {"hat": "S"}]


def test_the_outcome_of_a_check_is_the_one_that_was_written(heard):
    line = ending("fail", "no answer", message="m" * 2001, said="s\x07" * 4001, kind="late")
    (*_, found) = heard(check("fail", hints=("a", "b")), line)
    (one,) = found.checks
    assert (one.task, one.name, one.promise) == ("hat", "fail", "It fails") and one.hints == (
        "a",
        "b",
    )
    assert (one.outcome, one.kind, one.hidden, one.drawing) == (
        "no answer",
        "late",
        False,
        Drawing(),
    )
    assert one.message == "m" * 2000 and one.said == "s" * 2000


def test_a_check_that_never_ran_has_no_answer(heard):
    (found,) = heard(check("hold"))
    (one,) = found.checks
    assert (one.outcome, one.said) == ("no answer", "") and one.message
    assert (one.points, one.kind) == (0, "")


def test_a_check_with_several_cases_shows_the_first_failing_case(heard):
    cases = [check("hold", case=case) for case in ("[a]", "[b]", "[c]")]
    ends = [
        ending("hold", case="[a]", message="note a"),
        ending("hold", "fails", case="[b]", message="b fails"),
        ending("hold", "no answer", case="[c]", message="c"),
    ]
    *_, found = heard(*cases, *ends)
    assert [(one.outcome, one.message) for one in found.checks] == [("fails", "b fails")]
    *_, found = heard(*cases, ends[0], *(one | {"outcome": "holds"} for one in ends[1:]))
    assert [(one.outcome, one.message) for one in found.checks] == [("holds", "note a")]


def test_a_check_that_ended_twice_fails_if_it_failed_once(heard):
    ends = [ending("hold"), ending("hold", "fails", message="at its end")]
    for order in (ends, ends[::-1]):
        *_, found = heard(check("hold"), *order)
        assert [(one.outcome, one.message) for one in found.checks] == [("fails", "at its end")]


def test_the_points_of_a_task_are_split_by_the_weights_of_its_checks(heard):
    gsolve, hat = (next(one for one in HOMEWORK.tasks if one.id == id) for id in ("gsolve", "hat"))
    tasks = (gsolve._replace(points=7.5), hat._replace(points=4.0))
    lines = [
        check("hold", "gsolve", points="2"),
        check("fail", "gsolve", points="1/2"),
        check("hold", points="3", case="[a]"),
        check("hold", points="3", case="[b]"),
        check("hold", points="1", hidden=True),
    ]
    ends = [ending("hold", task="gsolve"), ending("hold", case="[a]"), ending("hold", case="[b]")]
    *_, found = heard(*lines, *ends, homework=HOMEWORK._replace(tasks=tasks))
    told = [(one.task, one.hidden, one.max_points, one.points) for one in found.checks]
    assert told == [
        ("gsolve", False, 6, 6),
        ("gsolve", False, Fraction(3, 2), 0),
        ("hat", False, 3, 3),
        ("hat", True, 1, 0),
    ]


@pytest.mark.parametrize(("once", "earned"), [(False, [2, 0, 0]), (True, [2, 0, 2])])
def test_a_recognized_mistake_is_named_as_the_cause_of_its_tasks_failures(once, earned, heard):
    lines = [check("hold", points="2"), check("fail", points="3"), check("err", points="3")]
    ends = [ending("hold"), ending("fail", "fails"), ending("err", "fails")]
    homework = HOMEWORK._replace(tasks=tuple(one._replace(points=8.0) for one in HOMEWORK.tasks))
    recognized = {"sentence": "S", "explains_all": True, "once": once}
    *_, found = heard(*lines, *ends, {"recognised": "hat", **recognized}, homework=homework)
    assert [one.follows for one in found.checks] == ["", "", "It fails"]
    assert [one.points for one in found.checks] == earned
    *_, found = heard(*lines, *ends, {"recognised": "gsolve", **recognized}, homework=homework)
    assert [one.points for one in found.checks] == [2, 0, 0]
    assert [one.follows for one in found.checks] == ["", "", ""]


def test_a_mistake_that_explains_only_some_checks_is_named_but_is_not_the_cause_of_all(heard):
    lines = [check("hold", points="2"), check("fail", points="3"), check("err", points="3")]
    ends = [ending("hold"), ending("fail", "fails"), ending("err", "fails")]
    partial = {"recognised": "hat", "sentence": "S", "explains_all": False, "once": False}
    *_, found = heard(*lines, *ends, partial)
    assert [one.follows for one in found.checks] == ["", "", ""]
    assert found.misconceptions == {"hat": "S"}


def test_a_check_that_needs_another_one_is_passed_on_to_the_scoring(heard):
    lines = [check("fail"), check("hold", needs="fail")]
    *_, found = heard(*lines, ending("fail", "fails"), ending("hold"))
    assert [one.points for one in found.checks] == [0, 0] and "It fails" in found.checks[1].message
    *_, found = heard(*lines, ending("fail"), ending("hold"))
    assert found.score == found.max_score > 0


def drawn(kind, shape, wrong):
    truth = np.linspace(0, 1, int(np.prod(shape))).reshape(shape)
    came = truth.copy()
    came.flat[wrong] += 0.5
    texts = [base64.b64encode(one.astype("<f8").tobytes()).decode() for one in (truth, came)]
    return {"kind": kind, "shape": shape, "expected": texts[0], "came": texts[1]}


@pytest.mark.parametrize(
    ("kind", "shape", "frames"), [("curve", (30,), 1), ("image", (12, 9), 3), ("image", (4,), 0)]
)
def test_a_difference_is_drawn_at_its_own_check_if_it_can_be_drawn(kind, shape, frames, heard):
    line = ending("fail", "fails", differs=drawn(kind, shape, 3))
    for end in (line, line | {"ended": "/tmp/a/test_hat.py::fail"}):
        begun = check("fail") | {"check": end["ended"]}
        *_, found = heard(begun, end)
        drawing = found.checks[0].drawing
        assert len(drawing.frames) == len(drawing.alts) == len(drawing.captions) == frames
        assert all("hat" in alt for alt in drawing.alts[:1])
