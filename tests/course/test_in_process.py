"""The in-process tier: the checks that run in a browser, tested here without one."""

import sys
import time
import warnings
from pathlib import Path

import numpy as np
import pytest
from IPython.testing.globalipapp import start_ipython

from hdrlab.core.steps import last
from hdrlab.course import notebook, plan
from hdrlab.course.checks import misconceptions
from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.grading import grader
from hdrlab.course.plan import GradingOptions
from hdrlab.course.reports import feedback
from hdrlab.course.sandbox import in_process, tiers
from hdrlab.course.source_code import closure, names
from hdrlab.course.submissions import reader
from hdrlab.errors import InputError

FAIRNESS = Path(__file__).parents[2] / "benchmarks" / "fairness"
HOMEWORKS = plan.read().homeworks
TASKS = {task.id: (homework, task) for homework in HOMEWORKS.values() for task in homework.tasks}
MISTAKES = {mistake.name: mistake.task for mistake in misconceptions.known()}


def right_answers(id):
    """Return the texts of the benchmark's right answers to a task."""
    return [path.read_text("utf8") for path in sorted((FAIRNESS / "right" / id).glob("*.py"))]


def wrong_answers(id):
    """Return the texts of the benchmark's wrong answers to a task, and of its known mistakes."""
    _, task = TASKS[id]
    texts = [path.read_text("utf8") for path in sorted((FAIRNESS / "wrong" / id).glob("*.py"))]
    names_of_task = [name for name, of_task in MISTAKES.items() if of_task == id]
    return texts + [misconceptions.solutions([task], [name])[id] for name in names_of_task]


def outcomes_of(id, text, tier):
    """Return the outcomes of the checks of a task's function in a tier."""
    homework, task = TASKS[id]
    sources, problems = closure.extract_sources([closure.Cell(text)], [id])
    modules = tuple(names.imported_numpy_modules(sources.values()))
    code = reader.SubmittedCode(sources, tuple(problems), "", modules)
    options = GradingOptions(tier=tier, draw=False)
    result = last(grader.check_steps(code, homework._replace(tasks=(task,)), options))
    assert not result.for_credit
    return result.misconceptions, result.checks


def subject_of(source, *, timeout=10.0):
    """Return a Subject of one function f, which runs in this process."""
    return Subject({"f": source}, tiers.choose(in_process.TIER), timeout)


@pytest.mark.grading
def test_an_answer_gets_the_outcomes_of_the_practice_tier():
    for text in (right_answers("hat")[0], wrong_answers("hat")[0]):
        assert outcomes_of("hat", text, in_process.TIER) == outcomes_of("hat", text, "practice")


@pytest.mark.grading
@pytest.mark.parametrize("id", sorted(TASKS)[::4])
def test_a_right_and_a_wrong_answer_to_every_fourth_task_get_the_outcomes_of_the_practice_tier(id):
    for text in [*right_answers(id)[:1], *wrong_answers(id)[:1]]:
        assert outcomes_of(id, text, in_process.TIER) == outcomes_of(id, text, "practice"), text


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("open('x', 'w')", "cannot write a file"),
        ("import subprocess; subprocess.run(['ls'])", "cannot start a program"),
        ("import socket; socket.socket()", "cannot use the network"),
        ("import hdrlab", "No module named 'hdrlab'"),
        ("raise SystemExit(3)", "raised SystemExit: 3"),
        ("return len", "not an array"),
    ],
)
def test_what_a_function_may_not_do_is_refused_in_the_words_of_the_practice_tier(body, words):
    source = f"def f():\n    {body}\n"
    messages = []
    for tier in (in_process.TIER, "practice"):
        with Subject({"f": source}, tiers.choose(tier)) as subject:
            with pytest.raises(NoAnswer, match=words) as raised:
                subject.f()
            messages.append((str(raised.value), raised.value.kind))
    assert messages[0] == messages[1]


@pytest.mark.parametrize(
    "body",
    [
        "while True: pass",
        "for _ in iter(int, 1):\n        try:\n            raise KeyError\n        except Exception: pass",
        "return f()",
        "return [0 for _ in iter(int, 1)]",
    ],
)
def test_an_endless_loop_ends_and_the_interpreter_goes_on(body):
    started = time.monotonic()
    tracer = sys.gettrace()
    source = f"def f(n=2):\n    {body}\n"
    with subject_of(source, timeout=0.3) as subject, pytest.raises(NoAnswer) as raised:
        subject.f()
    assert raised.value.kind in ("late", "raised")
    assert time.monotonic() - started < 5
    assert sys.gettrace() == tracer


def test_a_check_leaves_nothing_to_the_next_one_and_nothing_in_the_interpreter():
    source = (
        "import sys, warnings\nimport numpy as np\ncalls = []\n"
        "def f(x):\n    calls.append(x)\n    x[0] = 9\n    np.seterr(all='raise')\n"
        "    warnings.simplefilter('error')\n"
        "    return len(calls), np.random.random(), x\n"
    )
    modules = set(sys.modules)
    state = np.random.get_state()[1].copy()  # noqa: NPY002
    x = np.zeros(3)
    answers = []
    with warnings.catch_warnings(), subject_of(source) as subject:
        filters = list(warnings.filters)
        for _ in range(2):
            subject.fresh()
            answers.append([subject.f(x), subject.f(x)])
        assert warnings.filters == filters
    assert repr(answers[0]) == repr(answers[1])
    assert [int(count) for count, _, _ in answers[0]] == [1, 2] and not x.any()
    assert "f" not in set(sys.modules) - modules
    assert np.array_equal(np.random.get_state()[1], state) and np.geterr()["over"] == "warn"  # noqa: NPY002


def test_a_function_prints_into_the_feedback_and_warns_there():
    source = "import numpy as np\ndef f():\n    print('hi')\n    return np.array([1.0]) / 0\n"
    with subject_of(source) as subject:
        subject.f()
        assert "hi" in subject.printed and "divide by zero" in subject.printed


@pytest.mark.grading
def test_check_in_a_notebook_runs_without_processes_where_there_are_none(monkeypatch):
    shell = start_ipython() or sys.modules["IPython"].get_ipython()
    right = right_answers("hat")[0]
    monkeypatch.setattr(notebook, "PRACTICE", GradingOptions(tier=in_process.TIER))
    monkeypatch.setattr("subprocess.Popen", None)
    monkeypatch.setattr(shell.history_manager, "input_hist_raw", ["", right])
    report = notebook.check("hat")
    assert report.points == report.result.max_score
    assert "not for credit" in report.result.why_practice


def test_grading_a_file_without_processes_gives_a_clear_message(tmp_path, monkeypatch):
    monkeypatch.setattr(in_process, "IS_BROWSER", True)
    path = tmp_path / "hw2.py"
    path.write_text(right_answers("hat")[0])
    with pytest.raises(InputError, match="processes.*check"):
        grader.grade(path, HOMEWORKS["hw2"], GradingOptions(tier=in_process.TIER))
    with pytest.raises(tiers.Unavailable, match="processes"):
        tiers.choose("practice")


BROKEN_CHECK = """import numpy as np
from hdrlab.course.checks.compare import points, same


@points(1)
def test_it_is_a_hat(subject):
    same(subject.hat(256)[128], 1.0, 1e-9)


@points(1)
def test_nobody_can_pass_this(subject):
    subject.hat(256)
    raise TypeError("Cannot cast array data")
"""


@pytest.mark.grading
@pytest.mark.parametrize("tier", ["practice", in_process.TIER])
def test_checks_that_cannot_be_imported_are_an_error_and_no_key_press(tier, tmp_path, monkeypatch):
    monkeypatch.setattr(grader, "SPECIFICATION", tmp_path)
    (tmp_path / "test_hat.py").write_text("import a_module_that_nobody_has\n")
    homework, task = TASKS["hat"]
    code = reader.SubmittedCode({"hat": "def hat(n=256):\n    return [0.0] * n\n"}, (), "")
    with pytest.raises(InputError, match="a_module_that_nobody_has"):
        last(grader.check_steps(code, homework._replace(tasks=(task,)), GradingOptions(tier=tier)))


@pytest.mark.grading
def test_a_key_press_ends_checks_in_the_same_interpreter(tmp_path, monkeypatch):
    monkeypatch.setattr(grader, "SPECIFICATION", tmp_path)
    pressed = BROKEN_CHECK.replace('TypeError("Cannot cast array data")', "KeyboardInterrupt")
    (tmp_path / "test_hat.py").write_text(pressed)
    homework, task = TASKS["hat"]
    code = reader.SubmittedCode({"hat": "def hat(n=256):\n    return [0.0] * n\n"}, (), "")
    options = GradingOptions(tier=in_process.TIER)
    with pytest.raises(KeyboardInterrupt):
        last(grader.check_steps(code, homework._replace(tasks=(task,)), options))


@pytest.mark.grading
@pytest.mark.parametrize("tier", ["practice", in_process.TIER])
def test_a_check_that_breaks_for_the_solution_too_costs_no_points(tier, tmp_path, monkeypatch):
    monkeypatch.setattr(grader, "SPECIFICATION", tmp_path)
    (tmp_path / "test_hat.py").write_text(BROKEN_CHECK)
    homework, task = TASKS["hat"]
    source = "def hat(n=256):\n    return [0.0] * n\n"
    code = reader.SubmittedCode({"hat": source}, (), "")
    options = GradingOptions(tier=tier)
    result = last(grader.check_steps(code, homework._replace(tasks=(task,)), options))
    outcomes = [check.outcome for check in result.checks]
    assert outcomes == ["fails", "broken"] and result.score == result.max_score / 2
    assert "Cannot cast" in result.checks[1].message
    assert "check broke" in feedback.fragment(result)
    missing = reader.SubmittedCode({}, (), "")
    result = last(grader.check_steps(missing, homework._replace(tasks=(task,)), options))
    assert result.score == 0
