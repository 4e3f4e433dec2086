"""The grader's pytest plugin: the fixtures that it gives to a check, and what it writes before the check."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from support import fake_grading_plugin
from support.fake_grading_plugin import CalledSubject, make_item

from hdrlab.course.checks import compare, plugin
from hdrlab.course.checks.plugin import Missing
from hdrlab.course.checks.subject import NoAnswer


@pytest.fixture
def checking(tmp_path):
    """A GradingPlugin whose method `lines` reads its output; no check has any notes yet."""
    compare.notes.clear()
    yield fake_grading_plugin.make_plugin(tmp_path)
    compare.notes.clear()


def request(task="hat"):
    return SimpleNamespace(node=make_item(task=task))


def fixture(checking, name):
    """Return the function of a fixture."""
    fixture_function = getattr(type(checking), name)
    return getattr(fixture_function, "__wrapped__", None) or fixture_function.__pytest_wrapped__.obj


def test_the_job_is_read_and_its_worker_registered(tmp_path):
    (tmp_path / "job.json").write_text('{"by": "json:dumps", "more": 1}', encoding="utf8")
    messages = []
    options = []
    config = SimpleNamespace(
        addinivalue_line=lambda *words: messages.append(words),
        getoption=lambda name: str(tmp_path / "job.json") if name == "--job" else None,
        pluginmanager=SimpleNamespace(register=lambda *words: messages.append(words)),
    )
    plugin.pytest_configure(config)
    assert messages == [
        ("markers", plugin.POINTS_MARKER),
        ('{"by": "json:dumps", "more": 1}', "hdrlab-checking"),
    ]
    plugin.pytest_addoption(SimpleNamespace(addoption=lambda name, **_: options.append(name)))
    assert options == ["--job"]


@pytest.mark.parametrize("alive", [True, False])
def test_a_sandbox_is_opened_with_the_jobs_sources_unless_the_grader_has_ended(
    alive, checking, monkeypatch
):
    begun = []

    class Made:
        def __init__(self, *arguments):
            begun.append(arguments)

        def __enter__(self):
            return self

        def __exit__(self, *error):
            begun.append("closed")

    monkeypatch.setattr(plugin.system, "die_with_parent", lambda grader: alive and grader == 1)
    monkeypatch.setattr(plugin.tiers, "choose", lambda tier: f"{tier} sandbox")
    monkeypatch.setattr(plugin, "Subject", Made)
    if not alive:
        with pytest.raises(pytest.exit.Exception, match="grader has ended"):
            checking.pytest_sessionstart()
        assert not begun
        return
    checking.pytest_sessionstart()
    assert begun == [({"hat": "def hat(): ..."}, "practice sandbox", 3.0, ["numpy"])]
    assert isinstance(checking.submission, Made)
    checking.pytest_unconfigure()
    assert begun[1:] == ["closed"]


def test_each_check_gets_a_fresh_subject_or_no_answer_for_a_missing_or_late_task(checking):
    checking.submission = CalledSubject()
    subject = fixture(checking, "subject")
    compare.notes.append("of the check before")
    assert subject(checking, request()) is checking.submission
    assert checking.submission.fresh_count == 1 and not compare.notes
    for late, task, kind in ((False, "gsolve", "missing"), (True, "hat", "late")):
        if late:
            checking.late.add("hat")
        with pytest.raises(NoAnswer) as raised:
            subject(checking, request(task)).hat()
        assert raised.value.kind == kind and str(raised.value) == ""
    assert checking.submission.fresh_count == 1 and Missing().printed == ""


def test_inputs_are_drawn_from_the_seed_of_the_task_or_from_seed_zero(checking):
    rng = fixture(checking, "rng")
    for task, seed in (("hat", 7), ("gsolve", 0)):
        assert rng(checking, request(task)).random() == np.random.default_rng(seed).random()


def test_all_checks_are_listed_before_the_first_one_runs(checking):
    def check():
        """Look at
        the ends.

        Then count.
        """

    def mark(*args, **kwargs):
        return SimpleNamespace(args=args, kwargs=kwargs)

    items = [
        make_item("test_it_is_white[a]", mark=mark(2.5, needs="test_b"), check=check),
        make_item("test_b", mark=mark(3)),
        make_item("test_c", "gsolve", folder=Path("/hidden")),
    ]
    checking.pytest_collection_finish(SimpleNamespace(items=items))
    first, second, third = checking.lines()
    assert first == {
        "check": "/checks/test_hat.py::test_it_is_white[a]",
        "task": "hat",
        "name": "test_it_is_white[a]",
        "promise": "It is white[a]",
        "points": "5/2",
        "needs": "test_b",
        "hints": ["Look at the ends.", "Then count."],
        "hidden": False,
    }
    assert (second["points"], second["needs"], second["hints"]) == ("3", "", [])
    assert (third["points"], third["needs"], third["hidden"], third["task"]) == (
        "1",
        "",
        True,
        "gsolve",
    )


def test_hints_are_the_paragraphs_of_a_docstring():
    assert plugin.hints(None) == [] and plugin.hints(SimpleNamespace()) != [""]
    assert plugin.promise_of(make_item("test_a")) == "A"
    assert plugin.promise_of(make_item("test_")) == ""
