"""The pipeline finds a method because its module has the function of its chapter."""

import inspect
from importlib import import_module
from importlib.util import find_spec

import pytest

from hdrlab.cli.maps import check_settings
from hdrlab.pipeline import catalogue


@pytest.mark.parametrize(
    ("chapter", "some"),
    [("align", {"mtb"}), ("response", {"debevec", "linear"}), ("tonemap", {"curves", "reinhard"})],
)
def test_a_chapter_lists_its_methods_and_nothing_else(chapter, some):
    names = catalogue.names(chapter)
    assert some <= set(names) and names == sorted(names)
    assert all(callable(catalogue.method(chapter, name)) for name in names)
    assert "shift" not in names and "__init__" not in names


def test_a_method_is_the_verb_of_its_module():
    from hdrlab.response import linear

    assert catalogue.method("response", "linear") is linear.recover


@pytest.mark.parametrize("chapter", catalogue.VERBS)
def test_the_fast_function_is_used_if_there_is_one(chapter):
    for name in catalogue.names(chapter):
        fast = find_spec(f"hdrlab.fast.{name}") and import_module(f"hdrlab.fast.{name}")
        own = import_module(f"hdrlab.{chapter}.{name}")
        verb = catalogue.VERBS[chapter]
        assert catalogue.method(chapter, name) is getattr(fast or own, verb, getattr(own, verb))


def test_a_callable_is_returned_unchanged():
    assert catalogue.method("response", len) is len


@pytest.mark.parametrize("name", ["nobody", "", "__init__", "shift", "../core/arrays"])
def test_an_unknown_method_raises_an_error_that_lists_the_methods(name):
    with pytest.raises(ValueError, match="align .*mtb"):
        catalogue.method("align", name)


@pytest.mark.parametrize("chapter", catalogue.VERBS)
def test_every_method_documents_every_keyword(chapter):
    for name in catalogue.names(chapter):
        verb = getattr(import_module(f"hdrlab.{chapter}.{name}"), catalogue.VERBS[chapter])
        for knob in inspect.signature(verb).parameters.values():
            if knob.kind is knob.KEYWORD_ONLY:
                assert f"{knob.name} :" in verb.__doc__ or f"{knob.name}," in verb.__doc__, (
                    name,
                    knob,
                )


def test_an_unknown_setting_raises_an_error_that_lists_the_settings():
    check_settings("align", "mtb", {"bits": 5})
    with pytest.raises(ValueError, match="setting of mtb out of .*bits.*'bytes'"):
        check_settings("align", "mtb", {"bytes": 5})
