"""What the library says of itself: examples run, every public name is explained, and a file fits the head."""

import ast
import doctest
import importlib
import importlib.util
import pkgutil
from pathlib import Path

import numpy as np
import pytest

import hdrlab

MODULES = sorted(
    module.name
    for module in pkgutil.walk_packages(hdrlab.__path__, "hdrlab.")
    if not module.name.endswith("__main__")
    and ".checks.specification" not in module.name
    and ".checks.mistakes" not in module.name
)
LONGEST = 260  # lines


def source(name):
    """Return the text of a module."""
    return Path(importlib.util.find_spec(name).origin).read_text(encoding="utf8")


@pytest.mark.parametrize("name", MODULES)
def test_examples_run(name, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    module = importlib.import_module(name)
    flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    failed, _ = doctest.testmod(module, extraglobs={"np": np}, optionflags=flags)
    assert failed == 0


ALGORITHMS = ("align", "beyond", "capture", "core", "enhance", "radiance", "response", "tonemap")
PARTS = {  # of something with examples
    "hdrlab.core.filters",
    "hdrlab.core.types",
    "hdrlab.radiance.deghosting",
}


@pytest.mark.parametrize("name", [name for name in MODULES if name.split(".")[1] in ALGORITHMS])
def test_every_module_with_an_algorithm_has_an_example(name):
    if name.count(".") > 1 and name not in PARTS:
        assert "    >>> " in source(name)


@pytest.mark.parametrize("name", [name for name in MODULES if name.split(".")[1] in (*ALGORITHMS, "io")])
def test_a_function_whose_parameters_are_listed_shows_an_example(name):
    for node in ast.parse(source(name)).body:
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            said = ast.get_docstring(node)
            assert ("Parameters\n---" in said) <= (">>> " in said), f"{name}.{node.name} has no example"


@pytest.mark.parametrize("name", MODULES)
def test_every_module_and_public_function_is_explained(name):
    tree = ast.parse(source(name))
    assert ast.get_docstring(tree), f"{name} has no docstring"
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef)]
    for node in [*tree.body, *(method for one in classes for method in one.body)]:
        if isinstance(node, ast.ClassDef | ast.FunctionDef) and not node.name.startswith("_"):
            assert ast.get_docstring(node), f"{name}.{node.name} has no docstring"


@pytest.mark.parametrize("name", MODULES)
def test_a_module_is_short_enough_to_be_read(name):
    assert source(name).count("\n") <= LONGEST


VERBS = ["align", "recover", "merge_with_quality", "tonemap", "shoot", "assemble"]
IO_VERBS = ["read", "write"]


@pytest.mark.parametrize("name", MODULES)
def test_a_verb_names_its_parameters_results_and_errors(name):
    if name.startswith(("hdrlab.cli", "hdrlab.fast")):
        return  # commands, whose words are for the shell; and fast forms, whose lessons say it
    verbs = VERBS + IO_VERBS * name.startswith("hdrlab.io.")
    for node in ast.parse(source(name)).body:
        if isinstance(node, ast.FunctionDef) and node.name in verbs:
            said = ast.get_docstring(node)
            sections = ["Parameters", "Raises"] + (["Returns"] if node.name != "write" else [])
            missing = [section for section in sections if f"{section}\n---" not in said]
            assert not missing, f"{name}.{node.name} says nothing of {missing}"
