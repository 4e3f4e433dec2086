"""A function in `fast` is a faster version of a lesson: the same name, signature and result."""

import inspect
import pkgutil
from importlib import import_module

import numpy as np
import pytest
from pairs import KINDS, MAKERS, compare

from hdrlab import fast

LESSONS = (
    "core",
    "core.filters",
    "align",
    "response",
    "calibration",
    "radiance",
    "tonemap",
    "enhance",
    "beyond",
    "capture",
)
MODULES = sorted(i.name for i in pkgutil.iter_modules(fast.__path__) if not i.name.startswith("_"))


def functions(module):
    """Return a module's own public functions by name."""
    own = vars(module).items()
    return {
        name: function
        for name, function in own
        if inspect.isfunction(function)
        and function.__module__ == module.__name__
        and not name.startswith("_")
    }


def lesson(module, name):
    """Return the lesson's function with this name, from the only chapter module called `module`."""
    for room in LESSONS:
        try:
            module_found = import_module(f"hdrlab.{room}.{module}")
        except ModuleNotFoundError:
            continue
        return getattr(module_found, name, None)
    return None


PAIRS = [
    (module, name)
    for module in MODULES
    for name in functions(import_module(f"hdrlab.fast.{module}"))
]
NAMES = [f"{module}.{name}" for module, name in PAIRS]


@pytest.mark.parametrize(("module", "name"), PAIRS, ids=NAMES)
def test_a_fast_function_has_a_lesson_with_the_same_parameters(module, name):
    slow = lesson(module, name)
    quick = getattr(import_module(f"hdrlab.fast.{module}"), name)
    assert slow is not None, f"fast.{module}.{name} has no lesson"
    ours = inspect.signature(quick).parameters
    theirs = inspect.signature(slow).parameters
    assert list(ours) == list(theirs)
    for parameter in ours:
        assert ours[parameter].kind == theirs[parameter].kind, parameter
        # a lesson takes the filter that is to be fast as an argument
        if not callable(ours[parameter].default):
            assert ours[parameter].default == theirs[parameter].default, parameter


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("module", "name"), PAIRS, ids=NAMES)
def test_a_fast_function_returns_the_same_as_its_lesson(module, name, kind):
    make, tolerance = MAKERS[f"{module}.{name}"]
    inputs = make(kind, np.random.default_rng(7))
    if inputs is None:  # the maker says why such input has no meaning here
        return
    args, named = inputs
    compare(
        lesson(module, name),
        getattr(import_module(f"hdrlab.fast.{module}"), name),
        args,
        named,
        tolerance,
    )


@pytest.mark.parametrize(("module", "name"), PAIRS, ids=NAMES)
def test_a_pair_is_tried_on_most_kinds_of_input(module, name):
    make, _ = MAKERS[f"{module}.{name}"]
    assert sum(make(kind, np.random.default_rng(7)) is not None for kind in KINDS) >= 4


def test_every_fast_function_has_an_input_maker():
    assert sorted(MAKERS) == sorted(NAMES)
