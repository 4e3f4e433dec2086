"""The library's own source: which definition a name in it stands for. It is read, and not imported.

It is read as one writes it on the board: without types, which are for checkers, and without guards,
the statements that only raise. Both stand in the library; what is left is the equation.
"""

import ast
import builtins
import re
import textwrap
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from hdrlab.course.code.names import Use, bound, free
from hdrlab.errors import InputError

HOUSE = "hdrlab"
# letters of a line
WIDTH = 110
# what is for checkers, and what a docstring says of guards
UNSAID = re.compile(r"  # (?:noqa|type: ignore).*$|, or raise a ValueError[^.\"]*", re.MULTILINE)
GUARDS = ("require_", "check_")


class Key(NamedTuple):
    """A definition's place: the dotted module, or the path of a file, and the name in it."""

    module: str
    name: str


class Module(NamedTuple):
    """A module's source: lines and definitions, as on the board, and what each imported name stands for."""

    lines: list[str]
    definitions: dict[str, list[ast.stmt]]
    imported: dict[
        str, tuple[str, str, str]
    ]  # name -> (module, name in it or "", the import as text)
    returns: dict[str, ast.expr]  # of each function that says it, the type of its answer


def key_of(function: str) -> Key:
    """Return the place of a function that is given dotted under hdrlab, or as FILE.py:NAME."""
    file, _, name = function.rpartition(":")
    home, _, name = ("", "", name) if file else function.rpartition(".")
    return Key(file or f"{HOUSE}.{home}", name)


def written(key: Key) -> str:
    """Return the place of a definition in the form that `key_of` takes."""
    home = key.module
    return f"{home}:{key.name}" if home.endswith(".py") else f"{home}.{key.name}".partition(".")[2]


@cache
def module(dotted: str) -> Module:
    """Return the Module of a dotted name, or of a file's path, read and not imported."""
    spec = None if dotted.endswith(".py") else find_spec(dotted)
    origin = dotted if spec is None else spec.origin
    if origin is None or not origin.endswith(".py"):
        raise InputError(f"expected a module of the library, got {dotted!r}")
    typed = with_builtin_errors(Path(origin).read_text(encoding="utf8"))
    functions = [one for one in ast.parse(typed).body if isinstance(one, ast.FunctionDef)]
    returns, text = {one.name: one.returns for one in functions if one.returns}, on_the_board(typed)
    definitions: dict[str, list[ast.stmt]] = {}
    imported: dict[str, tuple[str, str, str]] = {}
    for node in ast.parse(text).body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            imported |= _imported(node)
            continue
        for name in bound(node):
            definitions.setdefault(name, []).append(node)
    return Module(text.splitlines(), definitions, imported, returns)


def with_builtin_errors(text: str) -> str:
    """Return a module's text with `ValueError` in place of hdrlab's own errors, as students write it."""
    without_import = re.sub(r"^from hdrlab\.errors import .*\n", "", text, flags=re.MULTILINE)
    return re.sub(
        r"\b(?:InputError|FileFormatError|CalibrationError)\b", "ValueError", without_import
    )


def on_the_board(text: str) -> str:
    r"""Return a module's text without types and guards; a field that is no plain number is an array.

    Examples
    --------
    >>> lines = ("def gain(E: F32, *, k: float = 2) -> F32:", "    if k < 0:", "        raise InputError(k)")
    >>> print(on_the_board("\n".join([*lines, "    n: int = 3", "    return k * n * E"])))
    def gain(E, *, k=2):
        n = 3
        return k * n * E
    """
    lines, tree = UNSAID.sub("", text).splitlines(), ast.parse(text)
    functions = [one for one in ast.walk(tree) if isinstance(one, ast.FunctionDef)]
    guards = {one for node in functions for one in node.body if _is_guard(one)}
    fields = {one for node in ast.walk(tree) if isinstance(node, ast.ClassDef) for one in node.body}
    typed = [one for one in ast.walk(tree) if isinstance(one, ast.AnnAssign)]
    registrations = {
        decorator
        for node in functions
        for decorator in node.decorator_list
        if isinstance(decorator, ast.Call) and ast.unparse(decorator.func) == "mistake"
    }
    parts = [*functions, *guards, *typed, *registrations]
    for node in sorted(parts, key=lambda one: one.lineno, reverse=True):
        line, start = lines[node.lineno - 1], node.lineno - 1
        if node in guards or node in registrations:
            del lines[start : node.end_lineno]
        elif isinstance(node, ast.FunctionDef):
            body = node.body[0]
            if not lines[body.lineno - 1][
                : body.col_offset
            ].strip():  # else it shares the signature's line
                lines[start : body.lineno - 1] = _signature(node)
        elif isinstance(node, ast.AnnAssign):
            name, after = line[: node.target.end_col_offset], line[node.annotation.end_col_offset :]
            lines[start] = (
                f"{name}: {_plain(node.annotation)}{after}" if node in fields else name + after
            )
    return "\n".join(lines) + "\n"


def _is_guard(node: ast.stmt) -> bool:
    """Return whether a statement only raises: an `if` that ends so, or a call of a function that is one."""
    if isinstance(node, ast.If):
        return isinstance(node.body[-1], ast.Raise) and not node.orelse
    call = node.value if isinstance(node, ast.Expr) else None
    return isinstance(call, ast.Call) and ast.unparse(call.func).rpartition(".")[2].startswith(
        GUARDS
    )


def _signature(node: ast.FunctionDef) -> list[str]:
    """Return a function's first lines, with names and defaults alone."""
    for one in ast.walk(node.args):
        if isinstance(one, ast.arg):
            one.annotation = None
    indent, arguments = " " * node.col_offset, ast.unparse(node.args)
    whole = f"{indent}def {node.name}({arguments}):"
    if len(whole) <= WIDTH:
        return [whole]
    inner = textwrap.wrap(
        arguments, WIDTH, initial_indent=f"{indent}    ", subsequent_indent=f"{indent}    "
    )
    return [f"{indent}def {node.name}(", *inner, f"{indent}):"]


def _plain(annotation: ast.expr) -> str:
    """Return the type of a field, np.ndarray unless it is of builtin types alone."""
    used = {one.id for one in ast.walk(annotation) if isinstance(one, ast.Name)}
    return ast.unparse(annotation) if used <= set(dir(builtins)) else "np.ndarray"


def _imported(node: ast.Import | ast.ImportFrom) -> dict[str, tuple[str, str, str]]:
    found = {}
    for alias in node.names:
        name = alias.asname or alias.name
        if isinstance(node, ast.Import):
            found[name.split(".")[0]] = (alias.name, "", ast.unparse(ast.Import([alias])))
        else:
            said = ast.unparse(ast.ImportFrom(node.module, [alias], 0))
            found[name] = (str(node.module), alias.name, said)
    return found


class Found(NamedTuple):
    """What a use stands for: a definition, or an import as text; and what its copy's name replaces."""

    target: Key | str
    node: ast.expr


def _resolved(at: str, use: Use) -> Found | None:
    """Return what a use in the module `at` stands for; None for a builtin."""
    here, name = module(at), use.node.id
    if name in here.definitions:
        return Found(Key(at, name), use.node)
    if name not in here.imported:
        return None
    source, original, text = here.imported[name]
    while (
        source.split(".")[0] == HOUSE and original in module(source).imported
    ):  # it is imported there, too
        source, original, text = module(source).imported[original]
    if source.split(".")[0] != HOUSE:
        return Found(text, use.node)
    if original in module(source).definitions:
        return Found(Key(source, original), use.node)
    inner = f"{source}.{original}"
    if find_spec(inner) and use.attribute in module(inner).definitions:  # a module's function
        return Found(Key(inner, use.attribute), use.whole)
    raise InputError(f"{at}, line {use.node.lineno}: {name} cannot be copied from {source}")


def statements(key: Key) -> list[ast.stmt]:
    """Return what defines a name of a module, or raise a ValueError."""
    try:
        return module(key.module).definitions[key.name]
    except KeyError:
        raise InputError(
            f"expected a function of the library, got {key.module}.{key.name}"
        ) from None


def definitions_in(at: str, node: ast.AST) -> list[Key]:
    """Return the definitions of the library that a part of the module `at` uses."""
    found = [one.target for use in free(node) if (one := _resolved(at, use))]
    return [one for one in found if isinstance(one, Key)]


@cache
def targets(key: Key) -> tuple[Found, ...]:
    """Return what a definition uses from outside itself, in the order of reading."""
    uses = [use for node in statements(key) for use in free(node)]
    found = [one for use in uses if (one := _resolved(key.module, use))]
    return tuple(one for one in found if one.target != key)
