"""Change one token of a function, or make one of its lines superfluous.

The student's own text is changed, so names, comments and lines stay as they are. The text is parsed
and never run here. A change that does not compile is left out.

source    text of a task's function with everything that it needs, see `code.closure`
"""

import ast
import inspect
import io
import re
import tokenize
import tomllib
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from itertools import accumulate
from pathlib import Path

from hdrlab.course.source_code import names

# token -> what may replace it
REPLACEMENTS: dict[str, list[str]] = tomllib.loads(
    Path(__file__).with_name("tokens.toml").read_text("utf8")
)
# a longer source gets no questions
MAX_SOURCE_CHARACTERS = 20_000
# a longer function is not shown
MAX_FUNCTION_LINES = 80
# uses of a name that may be replaced by its value
MAX_INLINED_USES = 3
# what `numpy.empty` returns when a version runs again
FILL_VALUE = 113


@dataclass(frozen=True)
class Version:
    """A changed source.

    Attributes
    ----------
    source : the whole text, with the change
    function : the function that was changed
    line : the changed line in the function, from 1 on; 0 if no single line was changed
    change : the old and the new token
    was : the old line
    """

    source: str
    function: str
    line: int = 0
    change: str = ""
    was: str = ""


@cache
def fill_empty_arrays() -> str:
    """Return code that makes `numpy.empty` return other numbers; append it to a source.

    Fresh memory often holds zeros. With other numbers, an answer that depends on it changes.
    """
    definition = inspect.getsource(_replace_numpy_empty)
    return f"\n\n\n{definition}\n\n_replace_numpy_empty({FILL_VALUE})\n"


def _replace_numpy_empty(value):  # type: ignore[no-untyped-def]  # its text runs with a student's
    import numpy

    def empty(shape, dtype=float, *_, **__):  # type: ignore[no-untyped-def]
        return numpy.full(shape, value, dtype)

    def empty_like(array, dtype=None, *_, **__):  # type: ignore[no-untyped-def]
        return numpy.full_like(array, value, dtype)

    numpy.empty = empty  # type: ignore[misc]
    numpy.empty_like = empty_like


def versions(source: str) -> list[Version]:
    r"""Return every version of a source with one token changed, in the order of the text.

    Examples
    --------
    >>> [version.change for version in versions("def twice(x):\n    return 2 * x  # not 3\n")]
    ['2 → 3', '2 → 1', '* → /', '* → +']
    """
    changed = []
    for start, function in functions(source):
        before = source[:start]
        after = source[start + len(function) :]
        for token in tokenize.generate_tokens(io.StringIO(function).readline):
            if token.start[0] == 1:  # the signature
                continue
            for new in replacements(token):
                lines = function.split("\n")
                row = token.start[0] - 1
                old_line = lines[row]
                lines[row] = old_line[: token.start[1]] + new + old_line[token.end[1] :]
                text = "\n".join(lines)
                if not compiles(text):
                    continue
                version = Version(
                    source=before + text + after,
                    function=text,
                    line=row + 1,
                    change=f"{token.string} → {new}",
                    was=old_line,
                )
                changed.append(version)
    return changed


def compiles(text: str) -> bool:
    """Return whether a text is valid Python."""
    with suppress(*names.PARSE_ERRORS):
        compile(text, "", "exec", dont_inherit=True)
        return True
    return False


def functions(source: str) -> Iterator[tuple[int, str]]:
    """Yield the start and the text of each function of a source that is short enough to be shown."""
    if len(source) > MAX_SOURCE_CHARACTERS or "\f" in source:
        return
    starts = [0, *accumulate(len(line) + 1 for line in source.split("\n"))]
    for node in ast.parse(source).body:
        last = node.end_lineno or 0
        if isinstance(node, ast.FunctionDef) and last - node.lineno < MAX_FUNCTION_LINES:
            start = starts[node.lineno - 1]
            yield start, source[start : starts[last]].rstrip("\n")


def parameters(source: str, task: str) -> list[str]:
    r"""Return the names of a function's positional parameters.

    Examples
    --------
    >>> parameters("def scale(x, by=2, *, offset=0):\n    return by * x + offset\n", "scale")
    ['x', 'by']
    """
    definitions = {
        node.name: node.args for node in ast.parse(source).body if isinstance(node, ast.FunctionDef)
    }
    arguments = definitions[task]
    return [argument.arg for argument in arguments.posonlyargs + arguments.args]


def replacements(token: tokenize.TokenInfo) -> list[str]:
    """Return what may replace a token: other operators and functions, and nearby numbers."""
    if token.type in (tokenize.OP, tokenize.NAME):
        return REPLACEMENTS.get(token.string, [])
    if token.type != tokenize.NUMBER:
        return []
    value = ast.literal_eval(token.string)
    if isinstance(value, int):
        return [str(value + 1), str(value - 1)] if value else ["1"]
    if isinstance(value, float):
        return [repr(2 * value or 1.0), repr(value / 2)]
    return []


def unused(text: str) -> dict[int, str]:
    r"""Return, for each line that only names a value, the text in which this line is superfluous.

    The value is written out where the name was used. Only a run shows whether that changes an
    answer.

    Examples
    --------
    >>> unused("def f(x):\n    y = x + 1\n    return 2 * y\n")
    {2: 'def f(x):\n    y = x + 1\n    return 2 * (x + 1)\n'}
    """
    lines = text.split("\n")
    if len(lines) > MAX_FUNCTION_LINES:
        return {}
    texts: dict[int, str] = {}
    for function in ast.parse(text).body:
        if not isinstance(function, ast.FunctionDef):
            continue
        nodes = list(ast.walk(function))
        loads = [
            node for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)
        ]
        # the last use comes first, so that replacing one does not move the others
        loads.sort(key=lambda node: (node.lineno, node.col_offset), reverse=True)
        for node in nodes:
            match node:
                case ast.Assign([ast.Name(name)], value) if node.lineno == node.end_lineno:
                    uses = [use for use in loads if use.id == name and use.lineno > node.lineno]
                    if 0 < len(uses) <= MAX_INLINED_USES and ";" not in lines[node.lineno - 1]:
                        segment = ast.get_source_segment(text, value)
                        texts[node.lineno] = _write_out(lines, uses, segment)
    return dict(sorted(texts.items()))


def _write_out(lines: Sequence[str], uses: Sequence[ast.Name], value: str | None) -> str:
    """Return a text in which the value replaces its name; `uses` begin with the last one."""
    written = [line.encode() for line in lines]  # the parser counts columns in bytes
    for use in uses:
        line = written[use.lineno - 1]
        before = line[: use.col_offset]
        after = line[use.end_col_offset :]
        written[use.lineno - 1] = before + f"({value})".encode() + after
    return b"\n".join(written).decode()


def without(text: str, line: int) -> str:
    """Return a text without one of its lines; the other lines keep their numbers."""
    lines = text.split("\n")
    lines[line - 1] = re.sub(r"\S.*", "pass", lines[line - 1])
    return "\n".join(lines)
