"""The names that Python code binds, and those that it needs from outside."""

import ast

import pytest

from hdrlab.course.source_code import library_source, names
from hdrlab.course.source_code.library_source import SymbolRef


@pytest.mark.parametrize(
    ("text", "bound", "free"),
    [
        ("x = y", ["x"], ["y"]),
        ("x += y", ["x"], ["y"]),
        ("import a.b, c as d", ["a", "d"], []),
        ("from a import b as c, d", ["c", "d"], []),
        ("def f(x=a, *y, **z): return x, y, z, b", ["f"], ["a", "b"]),
        ("async def f(x): return x, b", ["f"], ["b"]),
        ("class A(B): x = y", ["A"], ["B", "y"]),
        ("z = [x for x in xs if x < n]", ["z"], ["xs", "n"]),
        ("z = {k: v for k, v in items}", ["z"], ["items"]),
        ("if (n := f(x)): y = n", ["n", "y"], ["f", "x", "n"]),
        ("z = [m := x for x in xs]", ["z", "m"], ["xs", "m"][:1]),
        ("f = lambda x: x + y", ["f"], ["y"]),
        ("try:\n    a\nexcept E as e:\n    b = e", ["e", "b"], ["a", "E", "e"]),
        ("match x:\n    case [a, *b]:\n        pass", ["a", "b"], ["x"]),
        ("with a as b: c.d(b)", ["b"], ["a", "c", "b"]),
        ("def f():\n    global g\n    g = 1\n    return g", ["f"], ["g"]),
    ],
)
def test_names_that_a_statement_binds_and_uses(text, bound, free):
    (node,) = ast.parse(text).body
    assert names.bound_names(node) == bound
    assert [use.node.id for use in names.free_names(node)] == free


def test_imported_parts_of_numpy_and_scipy_are_named_once():
    texts = [
        "import numpy.fft, os\nfrom scipy import ndimage as n",
        "from . import a\nfrom scipy import ndimage",
        "x =",
    ]
    assert names.imported_numpy_modules(texts) == ["numpy.fft", "scipy", "scipy.ndimage"]
    assert names.modules("from .numpy import a\nimport a.b") == {"a.b"}


def test_places_are_written_as_they_are_read():
    for text, key in (
        ("response.debevec.gsolve", SymbolRef("hdrlab.response.debevec", "gsolve")),
        ("/a/v.py:vignette", SymbolRef("/a/v.py", "vignette")),
    ):
        assert library_source.parse_reference(text) == key
        assert library_source.format_reference(key) == text
