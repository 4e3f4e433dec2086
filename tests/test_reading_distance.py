"""`tools.reading_distance` counts the files and lines of code that a reader needs for a function."""

from tools.reading_distance import Distance, Library

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
TOY = Library({"toy": "", "toy.a": A, "toy.b": B, "toy.c": C})


def test_lines_are_those_of_what_a_function_calls_without_docstrings_and_comments():
    assert TOY.needed_definitions("toy.a.f") == {
        ("toy.a", "f"),
        ("toy.a", "TWO"),
        ("toy.b", "double"),
        ("toy.c", "half"),
    }
    assert TOY.distance("toy.a.f") == Distance(file_count=3, line_count=2 + 1 + 2 + 4)
    assert TOY.distance("toy.b.g") == Distance(file_count=2, line_count=2 + 4)
    assert TOY.folder_line_counts() == {"(top)": 0, "a": 7, "b": 5, "c": 4}
