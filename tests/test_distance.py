"""The slide is the code: how far each task and each whole verb is from its code, and how large rooms are."""

import distance
import pytest

A = """
from toy import b
from toy.c import half

TWO = 2


def f(x):
    '''A line.'''
    # another
    return b.double(half(x)) * TWO


def unused():
    return g()
"""
B = """
from toy.c import half as h


def double(x):
    return 2 * x


def g():
    return h(1)
"""
C = """
def half(
    x,
):
    return x / 2
"""
TOY = distance.Library({"toy": "", "toy.a": A, "toy.b": B, "toy.c": C})


def test_lines_are_those_of_what_a_function_calls_without_docstrings_and_comments():
    assert TOY.needs("toy.a.f") == {
        ("toy.a", "f"),
        ("toy.a", "TWO"),
        ("toy.b", "double"),
        ("toy.c", "half"),
    }
    assert TOY.distance("toy.a.f") == (3, 2 + 1 + 2 + 4)
    assert TOY.distance("toy.b.g") == (2, 2 + 4)
    assert TOY.rooms() == {"(top)": 0, "a": 7, "b": 5, "c": 4}


@pytest.mark.parametrize("function", distance.tasks().values(), ids=distance.tasks())
def test_a_task_needs_at_most_60_lines_of_3_files(function):
    files, lines = distance.read().distance(function)
    assert files <= 3 and lines <= 60


@pytest.mark.parametrize("verb", distance.VERBS)
def test_a_whole_verb_needs_at_most_120_lines_of_5_files(verb):
    files, lines = distance.read().distance(f"hdrlab.{verb}")
    assert files <= 5 and lines <= 120


def test_tasks_and_rooms_stay_below_their_ceilings():
    assert not list(distance.excesses(distance.read()))
