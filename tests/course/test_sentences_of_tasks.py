"""Each requirement that an assignment states is checked, and nothing else is."""

import warnings

import numpy as np
import pytest
import scoring
import sentences

from hdrlab.course import plan
from hdrlab.course.checks import inprocess
from hdrlab.course.checks.sentences import table

TABLE = table()
TEXTS = sentences.texts()
TASKS = [task.id for homework in plan.read().homeworks.values() for task in homework.tasks]


def demands(task):
    """Return (sentence, wrong answer, check) of each wrong answer to a task."""
    return [
        (entry["sentence"], wrong, check)
        for entry in TABLE[task]["demands"]
        for wrong, checks in entry["wrong"].items()
        for check in checks
    ]


@pytest.mark.parametrize("task", TASKS)
def test_every_sentence_of_an_assignment_is_in_the_table_and_every_entry_in_the_assignment(task):
    demanded = [entry["sentence"] for entry in TABLE[task]["demands"]]
    others = [*TABLE[task].get("advice", []), *TABLE[task].get("explains", [])]
    missing = [
        sentence
        for sentence in TEXTS[task]
        if sentence not in demanded and not sentence.startswith(tuple(others))
    ]
    assert not missing, "a sentence without an entry in hdrlab/course/checks/sentences"
    left = [entry for entry in demanded if entry not in TEXTS[task]]
    left += [entry for entry in others if not any(one.startswith(entry) for one in TEXTS[task])]
    assert not left, "an entry in hdrlab/course/checks/sentences that is not in the assignment"


@pytest.mark.parametrize("task", TASKS)
def test_every_check_belongs_to_a_sentence(task):
    checks = {name for name, *_ in scoring.checks(task)}
    assert checks == {check for _, _, check in demands(task)}


@pytest.mark.parametrize("task", TASKS)
def test_every_wrong_answer_of_the_table_exists(task):
    known = sentences.wrong_answers(task)
    assert all(wrong in known and wrong.startswith(f"{task}_") for _, wrong, _ in demands(task))


@pytest.mark.grading
@pytest.mark.parametrize("task", TASKS)
def test_a_wrong_answer_loses_points_at_the_check_of_the_sentence_that_it_breaks(task):
    known = sentences.wrong_answers(task)
    tests = {name: test for name, test, *_ in scoring.checks(task)}
    seed = plan.seed("secret", "ada", task)
    passed = []
    for _, wrong, check in demands(task):
        subject = inprocess.Subject({task: known[wrong]})
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")  # a wrong answer may divide by 0
            if scoring.ask(tests[check], subject, seed) is None:
                passed.append((wrong, check))
    assert not passed
