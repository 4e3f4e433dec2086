"""What stands in `fast` is a lesson, faster: the same name, the same signature, the same result."""

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
        name: one
        for name, one in own
        if inspect.isfunction(one)
        and one.__module__ == module.__name__
        and not name.startswith("_")
    }


def lesson(module, name):
    """Return the lesson's function of a name, from the one module of the chapters that is called `module`."""
    for room in LESSONS:
        try:
            found = import_module(f"hdrlab.{room}.{module}")
        except ModuleNotFoundError:
            continue
        return getattr(found, name, None)
    return None


PAIRS = [
    (module, name)
    for module in MODULES
    for name in functions(import_module(f"hdrlab.fast.{module}"))
]
NAMES = [f"{module}.{name}" for module, name in PAIRS]


@pytest.mark.parametrize(("module", "name"), PAIRS, ids=NAMES)
def test_a_fast_function_has_a_lesson_with_the_same_parameters(module, name):
    slow, quick = lesson(module, name), getattr(import_module(f"hdrlab.fast.{module}"), name)
    assert slow is not None, f"fast.{module}.{name} has no lesson"
    ours, theirs = inspect.signature(quick).parameters, inspect.signature(slow).parameters
    assert list(ours) == list(theirs)
    for one in ours:
        assert ours[one].kind == theirs[one].kind, one
        if not callable(
            ours[one].default
        ):  # a lesson takes the filter that is to be fast as an argument
            assert ours[one].default == theirs[one].default, one


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("module", "name"), PAIRS, ids=NAMES)
def test_a_fast_function_returns_the_same_as_its_lesson(module, name, kind):
    make, tolerance = MAKERS[f"{module}.{name}"]
    given = make(kind, np.random.default_rng(7))
    if given is None:  # the maker says why such input has no meaning here
        return
    args, named = given
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
