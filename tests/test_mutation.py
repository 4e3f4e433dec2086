"""`python -m benchmarks mutation`: the changes that it makes, and how it finds out whether a test fails."""

import ast

import numpy as np
import pytest

from benchmarks import mutation
from benchmarks.measure import ROOT
from benchmarks.mutation.mutants import mutants

pytestmark = pytest.mark.papers

SOURCE = '''"""Sums of 3 numbers."""


def total(x: int, *, most: float = 2.5) -> int:
    """Return x + 1, at most 2.5."""
    if x < 0 and not most:
        raise ValueError(f"expected at least {0 + 0}, got {x}")
    print(x)
    return -x if x is None else x * 2
'''
TURNED_ROUND = "-x if x is None else x * 2 -> (x * 2 if x is None else -x)"
CHANGES = {
    "2.5 -> 5.0",
    "x < 0 and not most -> (x < 0 or not most)",
    "x < 0 -> (x <= 0)",
    "x < 0 -> (x >= 0)",
    "0 -> 1",
    "not most -> (most)",
    "print(x) -> pass",
    TURNED_ROUND,
    "-x -> (x)",
    "x is None -> (x is not None)",
    "x * 2 -> (x / 2)",
    "2 -> 3",
}
TEST = """import toy


def test_it_doubles():
    assert toy.total(4) == 8
"""


def test_every_operator_number_and_condition_is_changed_but_words_types_and_refusals_are_not():
    changes = {mutant.said.partition(": ")[2] for mutant in mutants("toy.py", SOURCE)}
    assert changes == CHANGES


def test_the_length_that_a_reshape_finds_becomes_another_but_no_other_number_below_0():
    assert [mutant.new for mutant in mutants("toy.py", "a.reshape(3, -1)")] == ["pass", "4", "(1)"]
    assert [mutant.new for mutant in mutants("toy.py", "a[-1]")] == ["(1)", "2"]
    a = np.arange(6)
    assert a.reshape(3, -1).tolist() == a.reshape(3, -2).tolist()


@pytest.mark.parametrize(
    "file", ["hdrlab/radiance/merge.py", "hdrlab/course/submissions/reader.py"]
)
def test_a_mutant_is_python_and_differs_in_one_place(file):
    text = (ROOT / file).read_text(encoding="utf8")
    all_mutants = mutants(file, text)
    whole = ast.dump(ast.parse(text))
    assert len(all_mutants) > 20
    for mutant in all_mutants:
        changed = mutant.applied(text)
        assert ast.dump(ast.parse(changed)) != whole
        assert changed.replace(mutant.new, "", 1) != changed
        assert len(changed) - len(text) == len(mutant.new) - len(mutant.old)


@pytest.fixture
def forked(tmp_path):
    """The process that runs tests, in a tree of one module and its test."""
    tree = tmp_path / "tree"
    tree.mkdir()
    (tree / "toy.py").write_text(SOURCE)
    (tree / "test_toy.py").write_text(TEST)
    started = mutation.Forked(tree)
    yield started
    started.end()


def test_a_mutant_is_killed_by_a_test_that_fails_or_hangs_and_survives_one_that_does_not_see_it(
    forked,
):
    tests = ["test_toy.py::test_it_doubles"]
    assert forked.run(tests, 60) == 0
    codes = {}
    for mutant in mutants("toy.py", SOURCE)[3:]:
        with forked.changed(mutant):
            codes[mutant.said.partition(": ")[2]] = forked.run(tests, 60)
    seen = {message for message, code in codes.items() if code}
    assert seen == {"x * 2 -> (x / 2)", "2 -> 3", "x is None -> (x is not None)", TURNED_ROUND}
    assert (forked.tree / "toy.py").read_text() == SOURCE
    (forked.tree / "toy.py").write_text("while True:\n    pass\n")
    assert forked.run(tests, 1) != 0
