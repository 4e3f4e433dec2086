"""Find the definition of a name in the library's source, which is read and not imported.

The source is simplified to what a student writes: without types, and without guards, the statements
that only raise. What remains is the algorithm.
"""

import ast
import builtins
import re
import textwrap
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from hdrlab.course.source_code.names import FreeName, bound_names, free_names
from hdrlab.errors import InputError

PACKAGE = "hdrlab"
MAX_LINE_CHARACTERS = 110
# comments for checkers, and what a docstring says about guards
CHECKER_TEXT = re.compile(
    r"  # (?:noqa|type: ignore).*$|, or raise a ValueError[^.\"]*", re.MULTILINE
)
# the beginning of the name of a function that only raises
GUARD_PREFIXES = ("require_", "check_")
# the decorator of a known mistake, see `hdrlab.course.checks.mistakes`
REGISTRATION = "mistake"


class SymbolRef(NamedTuple):
    """The place of a definition: a dotted module, or the path of a file, and a name in it."""

    module: str
    name: str


class Import(NamedTuple):
    """What an imported name stands for: a module, a name in it ("" for the module), and the statement."""

    module: str
    name: str
    text: str


@dataclass(frozen=True, kw_only=True)
class Module:
    """The simplified source of a module.

    Attributes
    ----------
    lines : its lines
    definitions : the statements that define each name
    imported : what each imported name stands for
    returns : the return annotation of each function that has one
    """

    lines: list[str]
    definitions: dict[str, list[ast.stmt]]
    imported: dict[str, Import]
    returns: dict[str, ast.expr]


def parse_reference(function: str) -> SymbolRef:
    """Return the place of a function that is given as a dotted path under hdrlab, or as FILE.py:NAME."""
    if ":" in function:
        file, _, name = function.rpartition(":")
        return SymbolRef(file, name)
    home, _, name = function.rpartition(".")
    return SymbolRef(f"{PACKAGE}.{home}", name)


def format_reference(symbol: SymbolRef) -> str:
    """Return the place of a definition in the form that `parse_reference` reads."""
    if symbol.module.endswith(".py"):
        return f"{symbol.module}:{symbol.name}"
    return f"{symbol.module}.{symbol.name}".partition(".")[2]


@cache
def module(dotted: str) -> Module:
    """Return the simplified source of a module, given by its dotted name or a file's path."""
    origin: str | None = dotted
    if not dotted.endswith(".py"):
        spec = find_spec(dotted)
        origin = spec.origin if spec is not None else dotted
    if origin is None or not origin.endswith(".py"):
        raise InputError(f"expected a module of the library, got {dotted!r}")
    typed = with_builtin_errors(Path(origin).read_text(encoding="utf8"))
    text = strip_annotations(typed)
    definitions: dict[str, list[ast.stmt]] = {}
    imported: dict[str, Import] = {}
    for node in ast.parse(text).body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            imported |= _imports(node)
            continue
        for name in bound_names(node):
            definitions.setdefault(name, []).append(node)
    returns = {
        node.name: node.returns
        for node in ast.parse(typed).body
        if isinstance(node, ast.FunctionDef) and node.returns
    }
    return Module(
        lines=text.splitlines(), definitions=definitions, imported=imported, returns=returns
    )


def with_builtin_errors(text: str) -> str:
    """Return a module's text with `ValueError` in place of hdrlab's own errors, as students write it."""
    without_import = re.sub(r"^from hdrlab\.errors import .*\n", "", text, flags=re.MULTILINE)
    return re.sub(
        r"\b(?:InputError|FileFormatError|CalibrationError)\b", "ValueError", without_import
    )


def strip_annotations(text: str) -> str:
    r"""Return a module's text without types and guards; a field that is no plain number is an array.

    Examples
    --------
    >>> lines = ("def gain(E: F32, *, k: float = 2) -> F32:", "    if k < 0:", "        raise InputError(k)")
    >>> print(strip_annotations("\n".join([*lines, "    n: int = 3", "    return k * n * E"])))
    def gain(E, *, k=2):
        n = 3
        return k * n * E
    """
    lines = CHECKER_TEXT.sub("", text).splitlines()
    nodes = list(ast.walk(ast.parse(text)))
    functions = [node for node in nodes if isinstance(node, ast.FunctionDef)]
    annotated = [node for node in nodes if isinstance(node, ast.AnnAssign)]
    fields = {child for node in nodes if isinstance(node, ast.ClassDef) for child in node.body}
    removed: set[ast.stmt | ast.expr] = set()
    for function in functions:
        removed.update(child for child in function.body if _is_guard(child))
        removed.update(child for child in function.decorator_list if _is_registration(child))
    edited = [*functions, *removed, *annotated]
    # from the last line to the first, so that an edit does not move what is still to be edited
    for node in sorted(edited, key=lambda node: node.lineno, reverse=True):
        start = node.lineno - 1
        if node in removed:
            del lines[start : node.end_lineno]
        elif isinstance(node, ast.FunctionDef):
            body = node.body[0]
            body_has_own_line = not lines[body.lineno - 1][: body.col_offset].strip()
            if body_has_own_line:
                lines[start : body.lineno - 1] = _signature(node)
        elif isinstance(node, ast.AnnAssign):
            name = lines[start][: node.target.end_col_offset]
            after = lines[start][node.annotation.end_col_offset :]
            field_type = f": {_plain_type(node.annotation)}" if node in fields else ""
            lines[start] = name + field_type + after
    return "\n".join(lines) + "\n"


def _is_guard(node: ast.stmt) -> bool:
    """Return whether a statement only raises: an `if` that ends so, or a call of a guard function."""
    if isinstance(node, ast.If):
        return isinstance(node.body[-1], ast.Raise) and not node.orelse
    if not isinstance(node, ast.Expr) or not isinstance(node.value, ast.Call):
        return False
    name = ast.unparse(node.value.func).rpartition(".")[2]
    return name.startswith(GUARD_PREFIXES)


def _is_registration(decorator: ast.expr) -> bool:
    return isinstance(decorator, ast.Call) and ast.unparse(decorator.func) == REGISTRATION


def _signature(node: ast.FunctionDef) -> list[str]:
    """Return the lines of a function's signature, with names and defaults alone."""
    for part in ast.walk(node.args):
        if isinstance(part, ast.arg):
            part.annotation = None
    indent = " " * node.col_offset
    arguments = ast.unparse(node.args)
    line = f"{indent}def {node.name}({arguments}):"
    if len(line) <= MAX_LINE_CHARACTERS:
        return [line]
    deeper = f"{indent}    "
    wrapped = textwrap.wrap(
        arguments, MAX_LINE_CHARACTERS, initial_indent=deeper, subsequent_indent=deeper
    )
    return [f"{indent}def {node.name}(", *wrapped, f"{indent}):"]


def _plain_type(annotation: ast.expr) -> str:
    """Return a field's type if it consists of builtin types, and np.ndarray otherwise."""
    used = {node.id for node in ast.walk(annotation) if isinstance(node, ast.Name)}
    return ast.unparse(annotation) if used <= set(dir(builtins)) else "np.ndarray"


def _imports(node: ast.Import | ast.ImportFrom) -> dict[str, Import]:
    """Return what each name that a statement imports stands for."""
    imports = {}
    for alias in node.names:
        name = alias.asname or alias.name
        if isinstance(node, ast.Import):
            statement = ast.unparse(ast.Import([alias]))
            imports[name.split(".")[0]] = Import(alias.name, "", statement)
        else:
            statement = ast.unparse(ast.ImportFrom(node.module, [alias], 0))
            imports[name] = Import(str(node.module), alias.name, statement)
    return imports


class Resolved(NamedTuple):
    """What a used name stands for: a definition, or an import as text; `node` is where it is used."""

    target: SymbolRef | str
    node: ast.expr


def _resolve(at: str, use: FreeName) -> Resolved | None:
    """Return what a name that the module `at` uses stands for; None for a builtin."""
    here = module(at)
    name = use.node.id
    if name in here.definitions:
        return Resolved(SymbolRef(at, name), use.node)
    if name not in here.imported:
        return None
    found = here.imported[name]
    # a module of the library may import the name from another one
    while _is_library(found.module) and found.name in module(found.module).imported:
        found = module(found.module).imported[found.name]
    if not _is_library(found.module):
        return Resolved(found.text, use.node)
    if found.name in module(found.module).definitions:
        return Resolved(SymbolRef(found.module, found.name), use.node)
    inner = f"{found.module}.{found.name}"
    if find_spec(inner) and use.attribute in module(inner).definitions:
        return Resolved(SymbolRef(inner, use.attribute), use.whole)
    raise InputError(f"{at}, line {use.node.lineno}: {name} cannot be copied from {found.module}")


def _is_library(dotted: str) -> bool:
    return dotted.split(".")[0] == PACKAGE


def statements(symbol: SymbolRef) -> list[ast.stmt]:
    """Return the statements that define a name of a module, or raise an InputError."""
    try:
        return module(symbol.module).definitions[symbol.name]
    except KeyError:
        raise InputError(
            f"expected a function of the library, got {symbol.module}.{symbol.name}"
        ) from None


def definitions_in(at: str, node: ast.AST) -> list[SymbolRef]:
    """Return the definitions of the library that a part of the module `at` uses."""
    resolved = [_resolve(at, use) for use in free_names(node)]
    targets = [found.target for found in resolved if found is not None]
    return [target for target in targets if isinstance(target, SymbolRef)]


@cache
def targets(symbol: SymbolRef) -> tuple[Resolved, ...]:
    """Return what a definition uses from outside itself, in the order of reading."""
    uses = [use for node in statements(symbol) for use in free_names(node)]
    resolved = [_resolve(symbol.module, use) for use in uses]
    return tuple(found for found in resolved if found is not None and found.target != symbol)
