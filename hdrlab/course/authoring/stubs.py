"""Make stubs of library functions: signature and docstring, and the classes that they return."""

import ast
import re
from functools import cache

from hdrlab.course.plan import Task
from hdrlab.course.source_code import library_source
from hdrlab.errors import InputError

SECTION_HEADING = re.compile(r"\n\n(?=[A-Z][a-z]+\n-{3,}\n)")  # of a docstring


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
    return tuple(
        library_source.format_reference(returned)
        for returned in keys
        if isinstance(library_source.statements(returned)[-1], ast.ClassDef)
    )


def definition(function: str) -> ast.FunctionDef:
    """Return the library's definition of a function; raise an InputError if it has none."""
    node = library_source.statements(library_source.parse_reference(function))[-1]
    if not isinstance(node, ast.FunctionDef):
        raise InputError(f"expected a function of the library, got {function}")
    return node


def stub(task: Task, opening: str = "") -> str:
    """Return a function's signature and docstring, with a body that raises NotImplementedError.

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
    for default in (*node.args.defaults, *node.args.kw_defaults):
        if not isinstance(default, ast.Name):
            continue
        definition_of_default = home[default.id][-1]
        if isinstance(definition_of_default, ast.Assign):  # students do not have this constant
            value = ast.unparse(definition_of_default.value)
            arguments = arguments.replace(f"={default.id}", f"={value}")
    beginning, *sections = SECTION_HEADING.split(ast.get_docstring(node) or "")
    kept = [section for section in sections if not section.startswith("Examples")]
    text = "\n\n".join([opening or beginning, *kept]).rstrip()
    lines = text.splitlines()
    body = "\n".join(f"    {line}".rstrip() for line in lines[1:])
    doc = f'    """{lines[0]}"""' if len(lines) == 1 else f'    """{lines[0]}\n{body}\n    """'
    return f'def {task.id}({arguments}):\n{doc}\n    raise NotImplementedError("{task.id} is yours to write")'


def bare_class(dotted: str) -> str:
    """Return a class of the library as a student gets it, with its fields but without methods.

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
    fields = [part for part in node.body if isinstance(part, ast.AnnAssign)]
    lines = (ast.get_docstring(node) or "").splitlines()
    body = [f'"""{lines[0]}"""'] if len(lines) == 1 else [f'"""{lines[0]}', *lines[1:], '"""']
    typed = [ast.unparse(field) for field in fields]
    inside = "\n".join(f"    {line}".rstrip() for line in [*body, "", *typed])
    return f"from typing import NamedTuple\n\n\nclass {node.name}(NamedTuple):\n{inside}"
