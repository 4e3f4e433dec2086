"""The texts of a variant, and functions that run in this process."""

import numpy as np
import pytest

from hdrlab.course import plan
from hdrlab.course.checks import inprocess
from hdrlab.course.variants import rewording

SIZES = {"small": [], "large": [("five", "nine"), ("few", "many")]}
PAIRS = {"size": SIZES, "way": {"up": [], "down": [("up", "down")]}}


@pytest.fixture
def known(monkeypatch):
    """A task t with two parameters; all other tasks have none."""
    monkeypatch.setattr(rewording, "parameters", lambda task: PAIRS if task == "t" else {})


@pytest.mark.parametrize(
    ("variant", "text"),
    [
        ("", "five go up"),
        ("small/up", "five go up"),
        ("large/up", "nine go up"),
        ("large/down", "nine go down"),
    ],
)
def test_each_value_of_a_variant_changes_its_words(variant, text, known):
    assert rewording.reword("t", variant, "five go up") == text
    assert rewording.reword("t", variant, "nothing") == "nothing"
    assert rewording.reword("other", "", "five go up") == "five go up"


def test_a_variant_has_a_value_for_each_parameter(known):
    for variant in ("small", "small/up/more"):
        with pytest.raises(ValueError, match="zip"):
            rewording.reword("t", variant, "five")
    with pytest.raises(KeyError):
        rewording.reword("t", "huge/up", "five")


def test_an_assignment_must_contain_every_text_that_a_variant_changes(known):
    assert rewording.reword("t", "large/down", "five up", all_of_it=True) == "nine down"
    assert rewording.reword("t", "small/up", "words", all_of_it=True) == "words"
    assert rewording.reword("t", "large/up", "few", all_of_it=True) == "many"
    with pytest.raises(ValueError, match="sheet of t in hdrlab's words, to put 'down' there"):
        rewording.reword("t", "large/down", "five", all_of_it=True)


def test_every_variant_has_a_name_and_the_librarys_comes_first():
    tasks = {file.stem for file in rewording.FOLDER.glob("*.toml")}
    assert {"shift", "exclusion"} <= tasks and rewording.parameters("hat") == {}
    assert rewording.every("hat") == ("",)
    for task in tasks:
        every = rewording.every(task)
        values = rewording.parameters(task).values()
        assert len(every) == np.prod([len(value_list) for value_list in values]) == len(set(every))
        assert every[0] == "/".join(next(iter(value_list)) for value_list in values)


def test_a_library_function_is_called_like_a_students_and_its_calls_are_recorded():
    def f(x, *, k=1):
        x *= k
        return x, [1]

    subject = inprocess.Subject({"f": f, "_g": f, "h": lambda: 1 / 0})
    arguments = np.arange(3.0)
    answer = subject.f(arguments, k=2)
    assert answer[0].tolist() == [0, 2, 4] and answer[1] == [1]
    ((args, kwargs, kept_answer),) = subject.calls
    assert kwargs == {"k": 2} and kept_answer is answer
    arguments[:] = 9
    assert args[0].tolist() == [0, 2, 4]
    with pytest.raises(ZeroDivisionError):
        subject.h()
    assert subject.calls[1] == ((), {}, None)
    for name in ("_g", "g"):
        with pytest.raises(AttributeError, match=f"no function .*task {name}"):
            getattr(subject, name)


def test_the_library_has_a_function_for_each_task_of_a_plan():
    whole = plan.read()
    tasks = [task for homework in whole.homeworks.values() for task in homework.tasks]
    subject = inprocess.library()
    assert all(callable(getattr(subject, task.id)) for task in tasks)
    hw2 = {"hw2": whole.homeworks["hw2"]}
    own = inprocess.library(whole._replace(homeworks=hw2))
    (other,) = {task.id for task in whole.homeworks["hw1"].tasks} & {"shrink"}
    with pytest.raises(AttributeError):
        getattr(own, other)
