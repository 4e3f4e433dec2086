"""What a student gets of a function of the library: its signature, its docstring, its answers' classes."""

import ast
import re
from functools import cache

from hdrlab.course.plan import Task
from hdrlab.course.source_code import library_source
from hdrlab.errors import InputError

SECTION = re.compile(r"\n\n(?=[A-Z][a-z]+\n-{3,}\n)")  # of a docstring


@cache
def classes(function: str) -> tuple[str, ...]:
    """Return the classes of the library that a function says it returns or yields, dotted under hdrlab.

    Examples
    --------
    >>> classes("response.debevec.gsolve")
    ('response.debevec.Solution',)
    """
    key = library_source.parse_reference(function)
    returns = library_source.module(key.module).returns.get(key.name)
    keys = library_source.definitions_in(key.module, returns) if returns is not None else []
    found = [one for one in keys if isinstance(library_source.statements(one)[-1], ast.ClassDef)]
    return tuple(map(library_source.format_reference, found))


def definition(function: str) -> ast.FunctionDef:
    """Return the library's definition of a function, or raise a ValueError."""
    node = library_source.statements(library_source.parse_reference(function))[-1]
    if not isinstance(node, ast.FunctionDef):
        raise InputError(f"expected a function of the library, got {function}")
    return node


def stub(task: Task, opening: str = "") -> str:
    """Return a function's signature and docstring, and a body that says that it is not written yet.

    Examples
    --------
    >>> print(stub(Task("tent", "core.weights.hat", 10), "Return the hat weight."))
    def tent(n=256):
        \"\"\"Return the hat weight.\"\"\"
        raise NotImplementedError("tent is yours to write")
    """
    node = definition(task.function)
    arguments = ast.unparse(node.args)
    home = library_source.module(library_source.parse_reference(task.function).module).definitions
    for one in (*node.args.defaults, *node.args.kw_defaults):
        if not isinstance(one, ast.Name):
            continue
        given = home[one.id][-1]
        if isinstance(given, ast.Assign):  # a constant, which a student has not: its value
            arguments = arguments.replace(f"={one.id}", f"={ast.unparse(given.value)}")
    beginning, *sections = SECTION.split(ast.get_docstring(node) or "")
    kept = [one for one in sections if not one.startswith("Examples")]
    text = "\n\n".join([opening or beginning, *kept]).rstrip()
    lines = text.splitlines()
    body = "\n".join(f"    {line}".rstrip() for line in lines[1:])
    doc = f'    """{lines[0]}"""' if len(lines) == 1 else f'    """{lines[0]}\n{body}\n    """'
    return f'def {task.id}({arguments}):\n{doc}\n    raise NotImplementedError("{task.id} is yours to write")'


def bare_class(dotted: str) -> str:
    """Return a class of states as a student meets it: its fields are arrays, or plain numbers.

    Examples
    --------
    >>> print(bare_class("tonemap.durand.Layers"))
    from typing import NamedTuple
    <BLANKLINE>
    <BLANKLINE>
    class Layers(NamedTuple):
        \"\"\"The two layers of lL = base + detail, each (H, W), decades.\"\"\"
    <BLANKLINE>
        base: np.ndarray
        detail: np.ndarray
    """
    node = library_source.statements(library_source.parse_reference(dotted))[-1]
    assert isinstance(node, ast.ClassDef)
    fields = [one for one in node.body if isinstance(one, ast.AnnAssign)]
    lines = (ast.get_docstring(node) or "").splitlines()
    body = [f'"""{lines[0]}"""'] if len(lines) == 1 else [f'"""{lines[0]}', *lines[1:], '"""']
    typed = [ast.unparse(one) for one in fields]
    inside = "\n".join(f"    {line}".rstrip() for line in [*body, "", *typed])
    return f"from typing import NamedTuple\n\n\nclass {node.name}(NamedTuple):\n{inside}"
