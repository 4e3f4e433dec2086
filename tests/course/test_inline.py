"""Source code of hdrlab's functions together with all that they need."""

import ast
import re

import numpy as np
import pytest

from hdrlab.core import weights
from hdrlab.course import plan
from hdrlab.course.authoring import stubs
from hdrlab.course.source_code import inline, library_source, names
from hdrlab.response import debevec
from hdrlab.response.debevec import gsolve

TASKS = [task for homework in plan.read().homeworks.values() for task in homework.tasks]


@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.id)
def test_every_inlined_task_needs_only_numpy_and_scipy(task):
    block = inline.inlined({task.id: task.function})[task.id]
    scope = {}
    exec(block.text, scope)
    assert callable(scope[task.id])
    roots = set()
    for node in ast.walk(ast.parse(block.text)):
        if isinstance(node, ast.Import):
            roots |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            roots.add(node.module.split(".")[0])
    assert not roots & {"hdrlab", "skimage", "matplotlib", "PIL"}
    defined = {name for name in scope if not name.startswith("__")}
    unknown = [use.node.id for node in ast.parse(block.text).body for use in names.free_names(node)]
    assert not set(unknown) - defined - set(dir(__builtins__)) - set(__builtins__)


def test_inlined_code_computes_the_same_as_the_library():
    scope = {}
    exec(inline.inlined({"gsolve": "response.debevec.gsolve"})["gsolve"].text, scope)
    Z = np.random.default_rng(0).integers(0, 256, (80, 4))
    B = np.log([1, 2, 4, 8])
    for ours, copied in zip(
        debevec.gsolve(Z, B, 10, weights.hat()),
        scope["gsolve"](Z, B, 10, weights.hat()),
        strict=True,
    ):
        assert np.array_equal(ours, copied)


def test_shared_helpers_are_inlined_once():
    both = inline.inlined({"hat": "core.weights.hat", "gsolve": "response.debevec.gsolve"})
    assert not set(both["hat"].imports) & set(both["gsolve"].imports)
    alone = inline.inlined({"gsolve": "response.debevec.gsolve"})["gsolve"]
    assert len(both["gsolve"].text) < len(alone.text)


def test_definitions_with_the_same_name_are_kept_apart_by_module():
    """Both operators are called tonemap, and each needs its own types."""
    both = inline.inlined({"photo": "tonemap.reinhard.tonemap", "slow": "tonemap.chiu.tonemap"})
    scope = {}
    exec("\n\n".join(block.text for block in both.values()), scope)
    L = np.geomspace(0.01, 100, 3000).reshape(50, 60).astype(np.float32)
    assert not np.allclose(scope["photo"](L), scope["slow"](L))


def test_a_renamed_function_keeps_its_docstring():
    block = inline.inlined({"tent": "core.weights.hat"})["tent"]
    assert "def tent(" in block.source and "[Debevec97 eq. 4]" in block.source


def test_only_the_first_paragraph_of_a_docstring_is_inlined():
    text = inline.inlined({"gsolve": "response.debevec.gsolve"})["gsolve"].text
    first_line = (gsolve.__doc__ or "").splitlines()[0]
    assert first_line in text and "Parameters" not in text and ">>>" not in text
    assert text.count('"""') % 2 == 0


@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.id)
def test_a_solution_has_the_signature_of_its_assignment_without_types_and_guards(task):
    text = inline.inlined({task.id: task.function})[task.id].text
    by_value = text
    # as the sheet has constants
    for name, value in re.findall(r"^([A-Z_]+) = (.+)$", text, re.MULTILINE):
        by_value = by_value.replace(f"={name}", f"={value}")
    assert stubs.stub(task).splitlines()[0] in by_value
    functions = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)]
    for function in functions:
        assert not function.returns
        for node in ast.walk(function.args):
            assert not (isinstance(node, ast.arg) and node.annotation)
        for statement in function.body:
            is_guard = isinstance(statement, ast.If) and isinstance(statement.body[-1], ast.Raise)
            assert not is_guard
    assert "require_" not in text and "# noqa" not in text and "hdrlab" not in text


def test_only_statements_that_just_raise_are_removed():
    kept = ["    if x > 9:", "        raise ValueError(x)", "    else:", "        x = 1"]
    kept += ["    if x > 5:", "        x = 2", "    return x"]
    guard = ["    if x < 0:", "        raise ValueError(x)", "    require_finite(x)"]
    text = library_source.strip_annotations("\n".join(["def f(x: float) -> float:", *guard, *kept]))
    assert text.splitlines() == ["def f(x):", *kept]


def test_a_class_that_the_notebook_gives_is_not_inlined():
    functions = {"gsolve": "response.debevec.gsolve"}
    given_classes = stubs.classes("response.debevec.gsolve")
    assert "class Solution" in inline.inlined(functions)["gsolve"].text
    assert "class Solution" not in inline.inlined(functions, given_classes)["gsolve"].text


def test_imports_from_one_module_are_merged_into_one_line():
    text = inline.inlined({"align": "align.mtb.align"})["align"].text
    modules = [
        line.partition(" import ")[0] for line in text.splitlines() if line.startswith("from ")
    ]
    assert len(modules) == len(set(modules))


def test_inlining_a_missing_function_is_an_error():
    with pytest.raises(ValueError, match="function .*library"):
        inline.inlined({"x": "response.debevec.nothing"})
    with pytest.raises(ValueError, match="module .*library"):
        inline.inlined({"x": "response.nothing.x"})
