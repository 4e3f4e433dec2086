"""Docstrings: examples run, and every public name is documented."""

import ast
import doctest
import importlib
import importlib.util
import pkgutil
import tempfile
from functools import cache
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


@cache
def source(name):
    """Return the text of a module."""
    return Path(importlib.util.find_spec(name).origin).read_text(encoding="utf8")


def functions_of(name):
    """Return the functions of a module, those of its classes aside."""
    return [node for node in ast.parse(source(name)).body if isinstance(node, ast.FunctionDef)]


def in_rooms(rooms):
    """Return the modules of some rooms of the house."""
    return [name for name in MODULES if name.split(".")[1] in rooms]


def test_every_module_can_be_imported():
    assert all(importlib.import_module(name).__name__ == name for name in MODULES)


@pytest.mark.parametrize("name", [name for name in MODULES if ">>> " in source(name)])
def test_examples_run(name, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    module = importlib.import_module(name)
    flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    with np.printoptions(legacy=False):  # whoever imports colour-science prints as NumPy 1.13 did
        failed, _ = doctest.testmod(module, extraglobs={"np": np}, optionflags=flags)
    assert failed == 0


ALGORITHMS = ("align", "beyond", "capture", "core", "enhance", "radiance", "response", "tonemap")
PARTS = {  # of something with examples
    "hdrlab.beyond.burst",
    "hdrlab.core.filters",
    "hdrlab.radiance.deghosting",
}


def test_every_module_with_an_algorithm_has_an_example():
    modules = [name for name in in_rooms(ALGORITHMS) if name.count(".") > 1 and name not in PARTS]
    assert len(modules) > 50
    assert [name for name in modules if "    >>> " not in source(name)] == []


def unexplained(name):
    """Return what of a module has no docstring: itself, a public class, function or method."""
    tree = ast.parse(source(name))
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef)]
    nodes = [*tree.body, *(method for class_node in classes for method in class_node.body)]
    public = [
        node
        for node in nodes
        if isinstance(node, ast.ClassDef | ast.FunctionDef) and not node.name.startswith("_")
    ]
    names = [f"{name}.{node.name}" for node in public if not ast.get_docstring(node)]
    return names if ast.get_docstring(tree) else [name, *names]


def test_every_module_and_public_function_is_explained():
    assert [entry for name in MODULES for entry in unexplained(name)] == []


VERBS = ["align", "recover", "merge_with_quality", "tonemap", "shoot", "assemble"]
IO_VERBS = ["read", "write"]


def unsaid(name):
    """Return the sections that are missing in the docstrings of a module's verbs."""
    verbs = VERBS
    if name.startswith("hdrlab.io."):
        verbs = VERBS + IO_VERBS
    missing = []
    for node in functions_of(name):
        if node.name not in verbs:
            continue
        sections = ["Parameters", "Raises"]
        if node.name != "write":
            sections.append("Returns")
        docstring = ast.get_docstring(node)
        missing += [
            f"{name}.{node.name} has no section {section}"
            for section in sections
            if f"{section}\n---" not in docstring
        ]
    return missing


def test_a_verb_names_its_parameters_results_and_errors():
    # commands are documented for the shell, fast forms by their lessons, attacks are data
    others = ("hdrlab.cli", "hdrlab.fast", "hdrlab.course.authoring.toy_attacks")
    modules = [name for name in MODULES if not name.startswith(others)]
    assert [entry for name in modules for entry in unsaid(name)] == []
