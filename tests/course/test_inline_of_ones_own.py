"""A user's own function with everything that it needs: what is copied, renamed and omitted."""

import pytest

from hdrlab.course.source_code import inline, library_source

OWN = '''\
"""A module."""

import os
from typing import Any, NamedTuple

import numpy as np
from scipy import ndimage

# a comment above
# on two lines
WIDTH = 3  # words
TABLE = {"é": WIDTH}
TABLE2 = 5


class State(NamedTuple):
    """A state.

    More of it.
    """

    s: int
    f: Any


# of a helper
def helper(x: float, k: int = WIDTH) -> float:
    """Return one.

    Parameters
    ----------
    x : y
    """
    if x < 0:
        raise ValueError(x)
    return State(x, k), "é" and TABLE, "é", helper


@np.vectorize
def again(x: int) -> int:
    """Return x."""

    y = x

    return again(y) if y else helper(y)


def main(x: Any, /, *more: int, k: float = 2, **rest: Any) -> str:
    """Return all."""
    return again(x) + helper(x) + ndimage.zoom(x) + np.pi + os.sep
'''
FIRST = '''\
import os
from typing import NamedTuple
import numpy as np
from scipy import ndimage

# a comment above
# on two lines
WIDTH = 3  # words

class State(NamedTuple):
    """A state."""

    s: int
    f: np.ndarray

TABLE = {"é": WIDTH}

# of a helper
def helper(x, k=WIDTH):
    """Return one."""
    return State(x, k), "é" and TABLE, "é", helper

@np.vectorize
def again2(x):
    """Return x."""

    y = x

    return again2(y) if y else helper(y)

def other(x, /, *more, k=2, **rest):
    """Return all."""
    return again2(x) + helper(x) + ndimage.zoom(x) + np.pi + os.sep
'''
SECOND = '''\
@np.vectorize
def again2(x):
    """Return x."""

    y = x

    return again2(y) if y else helper(y)
'''


@pytest.fixture
def inlined(tmp_path):
    """inlined({name: (file, text, function)}) -> the text of each function with everything that it
    needs.
    """

    def inlined(functions, given_places=()):
        for file, text, _ in functions.values():
            (tmp_path / file).write_text(text, encoding="utf8")
        inlined_functions = {
            name: f"{tmp_path / file}:{function}" for name, (file, _, function) in functions.items()
        }
        given_places = [f"{tmp_path / file}:{function}" for file, function in given_places]
        return {
            name: block.text + "\n"
            for name, block in inline.inlined(inlined_functions, given_places).items()
        }

    return inlined


def test_a_function_is_inlined_with_comments_but_without_types_guards_and_long_docstrings(
    inlined,
):
    cells = inlined({"other": ("own.py", OWN, "main"), "again2": ("own.py", OWN, "again")})
    assert cells == {"other": FIRST, "again2": SECOND}


def test_given_definitions_are_not_inlined(inlined):
    cells = inlined({"main": ("own.py", OWN, "main")}, [("own.py", "State"), ("own.py", "WIDTH")])[
        "main"
    ]
    assert "class State" not in cells and "WIDTH = 3" not in cells and "TABLE = " in cells
    assert "def again(x):" in cells and "def main(" in cells


def test_helpers_with_the_same_name_are_renamed_by_file_and_identical_ones_shared(inlined):
    texts = {
        k: f"def helper():\n    return {k}\n\n\ndef main():\n    return helper()\n" for k in (1, 2)
    }
    cells = inlined(
        {
            "a": ("a.py", texts[1], "main"),
            "b": ("b.py", texts[2], "main"),
            "c": ("c.py", texts[1], "main"),
        }
    )
    assert cells == {
        "a": "def helper():\n    return 1\n\ndef a():\n    return helper()\n",
        "b": "def helper_b():\n    return 2\n\ndef b():\n    return helper_b()\n",
        "c": "def c():\n    return helper()\n",
    }


def test_mutually_recursive_functions_are_inlined(inlined):
    text = "def main(n):\n    return other(n)\n\n\ndef other(n):\n    return n and main(n - 1)\n"
    parts = text.removesuffix("\n").split("\n\n\n")
    assert inlined({"main": ("a.py", text, "main")}) == {"main": f"{parts[1]}\n\n{parts[0]}\n"}


def test_a_comment_belongs_to_the_definition_below_it(inlined):
    above = "# above\ndef main():\n    return 1\n"
    assert inlined({"main": ("a.py", above, "main")})["main"] == above
    below = "def main():\n    return 1\n\n\n# below\n"
    assert inlined({"main": ("b.py", below, "main")})["main"] == "def main():\n    return 1\n"


def test_renaming_changes_only_references_to_the_definition(inlined):
    text = 'def main(x, main=1):\n    """Return a main."""\n    return " main"\n'
    assert inlined({"a": ("a.py", text, "main")})["a"] == text.replace("def main", "def a")
    texts = {k: f'A = " A{k}"\n\n\ndef main():\n    return A\n' for k in (1, 2)}
    cells = inlined({"a": ("c.py", texts[1], "main"), "b": ("d.py", texts[2], "main")})
    assert cells["b"] == 'A_d = " A2"\n\ndef b():\n    return A_d\n'


def test_nested_docstrings_keep_their_first_paragraph(inlined):
    def method(name, more):
        return f'    def {name}(self):\n        """Say {name}.{more}"""\n        return 1\n'

    more = "\n\n        More.\n        And more.\n        "
    whole = 'class main:\n    """Say main.{}"""\n\n{}\n{}'.format
    text = whole(more, method("a", more), method("b", more))
    text_found = inlined({"main": ("a.py", text, "main")})["main"]
    assert text_found == whole("", method("a", ""), method("b", ""))


def test_a_library_function_is_renamed_if_its_name_is_taken(
    inlined,
):
    text = "from hdrlab.core import weights\n\n\ndef main():\n    hat = weights.hat()\n    return hat\n"
    text_found = inlined({"main": ("a.py", text, "main")})["main"]
    assert "def hat_weights(" in text_found
    assert "    hat = hat_weights()\n    return hat\n" in text_found
    argument = text.replace("hat = weights.hat()", "f = lambda hat: hat + weights.hat()")
    assert "hat + hat_weights()" in inlined({"main": ("b.py", argument, "main")})["main"]
    other = text.replace("hat = ", "w = ").replace("return hat", "return w")
    assert "    w = hat()\n" in inlined({"main": ("c.py", other, "main")})["main"]
    with pytest.raises(ValueError, match="line 5: weights cannot be copied from hdrlab.core"):
        inlined({"main": ("d.py", text.replace("weights.hat()", "weights.none()"), "main")})


def test_copied_code_has_its_imports_first_and_empty_lines_around_functions(inlined):
    text = "import numpy as np\nimport os\nA = 1\nB = 2\ndef g(): return A + B\n"
    text += "def main(): return g(), np.pi, os.sep\n"
    assert inlined({"main": ("a.py", text, "main")})["main"] == (
        "import os\nimport numpy as np\n\nA = 1\nB = 2\n\ndef g(): return A + B\n\n"
        "def main(): return g(), np.pi, os.sep\n"
    )


LONG = ", ".join(f"a_long_name_{k}=1" for k in range(9))


@pytest.mark.parametrize(
    ("text", "board"),
    [
        ("def f(x: int, *, k: float = 2) -> int:\n    return x", "def f(x, *, k=2):\n    return x"),
        ("def f(x: int) -> int: return x", "def f(x: int) -> int: return x"),
        ("def f(\n    x: int,\n    k=1,\n) -> int:\n    return x", "def f(x, k=1):\n    return x"),
        (
            "def f():\n    check_it(1)\n    a.require_it(2)\n    checked(3)",
            "def f():\n    checked(3)",
        ),
        ("def f():\n    if x:\n        y = 1\n        raise E\n    z", "def f():\n    z"),
        ("def f():\n    if x:\n        raise E\n    else:\n        y", None),
        ("def f():\n    if x:\n        y", None),
        ("if x:\n    raise E", None),
        ("x: int = 3\ny: int\nz = 1", "x = 3\ny\nz = 1"),
        ("class A:\n    x: int = 3\n    y: dict[str, int]", None),
        ("class A:\n    z: Any", "class A:\n    z: np.ndarray"),
        (
            "x = 1  # noqa: E731\ny = 2  # type: ignore[a]\nz = 3  # why",
            "x = 1\ny = 2\nz = 3  # why",
        ),
        (
            'def f():\n    """Return x, or raise a ValueError where not."""',
            'def f():\n    """Return x."""',
        ),
        (f"def f({LONG}):\n    return 1", None),
    ],
)
def test_annotations_and_guards_are_stripped(text, board):
    text_found = library_source.strip_annotations(text)
    if text.startswith(f"def f({LONG}"):
        lines = text_found.splitlines()
        assert lines[0] == "def f(" and lines[-2:] == ["):", "    return 1"]
        assert " ".join(line.strip() for line in lines[1:-2]) == LONG
        assert max(map(len, lines)) <= 110
    else:
        assert text_found == (text if board is None else board) + "\n"


def test_a_signature_of_110_characters_stays_on_one_line():
    for letters, lines in ((110, 1), (111, 3)):
        name = "n" * (letters - len("def f():"))
        assert (
            len(library_source.strip_annotations(f"def f({name}):\n    return 1").splitlines())
            == lines + 1
        )
