"""Correct solutions that are written differently pass all checks."""

import ast
import json
import sys
import warnings
from functools import wraps
from pathlib import Path

import pytest
import scoring

from hdrlab.course import plan
from hdrlab.course.checks import compare, inprocess
from hdrlab.course.submissions import reader

HERE = Path(__file__).parents[1] / "equivalent"
FILES = sorted(HERE.glob("*.py"))
RIGHT = Path(__file__).parents[2] / "benchmarks/fairness/right"
HOMEWORKS = plan.read().homeworks
pytestmark = [
    pytest.mark.grading,
    pytest.mark.skipif(not FILES, reason="no model solution is part of the source distribution"),
]


def aside(function):
    """Return a function whose warnings are ignored, as in grading, where they appear in another
    process.
    """

    @wraps(function)
    def wrapper(*arguments, **named):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return compare.plain(function(*arguments, **named))

    return wrapper


def tasks_of(path):
    """Return the tasks of the homework that a file's name begins with."""
    return [task.id for task in HOMEWORKS[path.stem.partition("_")[0]].tasks]


def keeps_every_promise(functions, tasks, student):
    subject = inprocess.Subject({task: aside(functions[task]) for task in tasks})
    for task in tasks:
        share, outcomes = scoring.score(task, subject, plan.seed("secret", student, task))
        assert share == 1, (task, {name: str(error) for name, error in outcomes.items() if error})


@pytest.mark.parametrize("student", ["ada", "grace"])
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_an_equivalent_solution_passes_every_check(path, student):
    keeps_every_promise(scoring.functions(path), tasks_of(path), student)


# The same code in another notebook


def reversed_order(cells):
    """The cells in reverse order: helpers are below the functions that use them."""
    return cells[::-1], "hw.ipynb"


def helpers_apart(cells):
    """Every statement in its own cell, with unrelated cells between them; the file is renamed."""
    split = [ast.unparse(statement) for cell in cells for statement in ast.parse(cell).body]
    between = [
        "unused = [n**2 for n in range(9)]",
        "def plot_it(x):\n    return x",
        "%matplotlib inline\n",
    ]
    return [*between, *split, "!ls", "results = {}"], "Final version (2) of Ada.ipynb"


def printing(cells):
    """Functions that print, warn, and write to stderr."""

    class Talk(ast.NodeTransformer):
        def visit_FunctionDef(self, node):
            errors = (
                f"import sys, warnings\nprint('in {node.name}')\n"
                f"print('to stderr', file=sys.stderr)\nwarnings.warn('{node.name} is slow', stacklevel=2)"
            )
            first = 1 if ast.get_docstring(node) else 0
            node.body[first:first] = ast.parse(errors).body
            return node

    return [ast.unparse(Talk().visit(ast.parse(cell))) for cell in cells], "hw.ipynb"


def as_one_script(cells):
    """A Python file without cells."""
    return ["\n\n".join(cells)], "solution.py"


WAYS = (reversed_order, helpers_apart, printing, as_one_script)


@pytest.mark.parametrize("way", WAYS, ids=lambda way: way.__name__)
@pytest.mark.parametrize(
    "path", [path for path in FILES if path.stem.endswith("_float32")], ids=lambda path: path.stem
)
def test_the_same_code_in_another_notebook_layout_passes_every_check(path, way, tmp_path, capsys):
    cells, name = way([cell.text for cell in reader.cells_of(path.read_bytes(), path.name)[0]])
    handed_in = tmp_path / name
    handed_in.write_text(notebook(cells) if name.endswith(".ipynb") else cells[0], encoding="utf8")
    sources = reader.tasks_of(handed_in, tasks_of(path))
    assert set(sources.sources) == set(tasks_of(path)), sources.problems
    functions = {}
    for task, source in sources.sources.items():
        names = {"__name__": "a student's module"}
        exec(source, names)
        functions[task] = names[task]
    keeps_every_promise(functions, sources.sources, "ada")
    assert ("to stderr" in capsys.readouterr().err) == (way is printing)


def notebook(cells):
    """Return a notebook of code cells, as JSON."""
    made = [{"cell_type": "code", "metadata": {}, "outputs": [], "source": cell} for cell in cells]
    return json.dumps({"cells": made, "metadata": {}, "nbformat": 4, "nbformat_minor": 5})


@pytest.mark.parametrize("homework", HOMEWORKS)
def test_every_homework_has_more_than_five_equivalents(homework):
    """They solve a whole homework, or a single task of it, as in `test_fairness`."""
    wholes = [path for path in FILES if path.stem.startswith(f"{homework}_")]
    answers = [len(list(RIGHT.glob(f"{task.id}/*.py"))) for task in HOMEWORKS[homework].tasks]
    assert max(len(wholes) + len(WAYS), min(answers)) > 5


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_the_equivalents_import_only_numpy_scipy_and_the_standard_library(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf8"))):
        names = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [node.module]
        for name in names:
            assert name.split(".")[0] in {"numpy", "scipy"} | set(sys.stdlib_module_names)
