"""The library's own source: which definition a name in it stands for. It is read, and not imported."""

import ast
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from hdrlab.course.code.names import Use, bound, free

HOUSE = "hdrlab"


class Key(NamedTuple):
    """A definition's place: the dotted module, and the name in it."""

    module: str
    name: str


class Module(NamedTuple):
    """A module's source: its lines, its definitions by name, and what each imported name stands for."""

    lines: list[str]
    definitions: dict[str, list[ast.stmt]]
    imported: dict[str, tuple[str, str, str]]  # name -> (module, name in it or "", the import as text)


def key_of(function: str) -> Key:
    """Return the place of a function that is given dotted under hdrlab."""
    home, _, name = function.rpartition(".")
    return Key(f"{HOUSE}.{home}", name)


@cache
def module(dotted: str) -> Module:
    """Return the Module of a dotted name, read and not imported."""
    spec = find_spec(dotted)
    if spec is None or spec.origin is None:
        raise ValueError(f"expected a module of the library, got {dotted!r}")
    text = Path(spec.origin).read_text(encoding="utf8")
    definitions: dict[str, list[ast.stmt]] = {}
    imported: dict[str, tuple[str, str, str]] = {}
    for node in ast.parse(text).body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            imported |= _imported(node)
            continue
        for name in bound(node):
            definitions.setdefault(name, []).append(node)
    return Module(text.splitlines(), definitions, imported)


def _imported(node: ast.Import | ast.ImportFrom) -> dict[str, tuple[str, str, str]]:
    found = {}
    for alias in node.names:
        name = alias.asname or alias.name
        renamed = f" as {alias.asname}" if alias.asname else ""
        if isinstance(node, ast.Import):
            found[name.split(".")[0]] = (alias.name, "", f"import {alias.name}{renamed}")
        else:
            said = f"from {node.module} import {alias.name}{renamed}"
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
    if source.split(".")[0] != HOUSE:
        return Found(text, use.node)
    while original in module(source).imported:  # it is imported there, too
        source, original, _ = module(source).imported[original]
    if original in module(source).definitions:
        return Found(Key(source, original), use.node)
    inner = f"{source}.{original}"
    if _is_module(inner) and use.attribute in module(inner).definitions:  # a module's function
        return Found(Key(inner, use.attribute), use.whole)
    raise ValueError(f"{at}, line {use.node.lineno}: {name} cannot be copied from {source}")


@cache
def _is_module(dotted: str) -> bool:
    return find_spec(dotted) is not None


def statements(key: Key) -> list[ast.stmt]:
    """Return what defines a name of a module, or raise a ValueError."""
    try:
        return module(key.module).definitions[key.name]
    except KeyError:
        raise ValueError(f"expected a function of the library, got {key.module}.{key.name}") from None


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
