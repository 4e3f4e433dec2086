"""One small change in a file: another operator or number, a condition turned round, a call left out."""

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

OPERATORS: dict[type[ast.AST], tuple[Any, ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
    ast.Add: (ast.Sub,),
    ast.Sub: (ast.Add,),
    ast.Mult: (ast.Div,),
    ast.Div: (ast.Mult,),
    ast.FloorDiv: (ast.Div,),
    ast.Mod: (ast.FloorDiv,),
    ast.Pow: (ast.Mult,),
    ast.BitAnd: (ast.BitOr,),
    ast.BitOr: (ast.BitAnd,),
    ast.LShift: (ast.RShift,),
    ast.RShift: (ast.LShift,),
    ast.And: (ast.Or,),
    ast.Or: (ast.And,),
}
# what is said, promised or asserted is no result
SILENT = (ast.Raise, ast.Assert, ast.JoinedStr, ast.Import, ast.ImportFrom)


class Mutant(NamedTuple):
    """A file in which `old`, from `start` to `end` of its bytes, has become `new`.

    `line` counts from 1 and `column` from 0; `text` is what stands in that line.
    """

    file: str
    line: int
    column: int
    text: str
    start: int
    end: int
    old: str
    new: str

    @property
    def said(self) -> str:
        """Return the change in a line."""
        old = " ".join(self.old.split())
        new = " ".join(self.new.split())
        return f"{self.file}:{self.line}:{self.column}: {old} -> {new}"

    def applied(self, text: str) -> str:
        """Return the file's text with the change."""
        raw = text.encode()
        return (raw[: self.start] + self.new.encode() + raw[self.end :]).decode()


def mutants(file: str, text: str) -> list[Mutant]:
    """Return all mutants of a file that Python can compile, in the order of their places."""
    words = text.splitlines(keepends=True)
    lines = [len(line.encode()) for line in words]
    begin = [0, *(sum(lines[:k]) for k in range(1, len(lines) + 1))]
    raw = text.encode()
    found_mutants = []
    for top in ast.parse(text).body:
        first = begin[top.lineno - 1]
        last = begin[top.end_lineno or 0]
        for node, new in changes(top):
            start = begin[node.lineno - 1] + node.col_offset
            end = begin[(node.end_lineno or 0) - 1] + (node.end_col_offset or 0)
            old = raw[start:end].decode()
            line = words[node.lineno - 1].strip()
            if old != new and compiles((raw[first:start] + new.encode() + raw[end:last]).decode()):
                found_mutants.append(
                    Mutant(file, node.lineno, node.col_offset, line, start, end, old, new)
                )
    return sorted(set(found_mutants), key=lambda mutant: (mutant.start, mutant.end, mutant.new))


def compiles(text: str) -> bool:
    """Return whether this is Python."""
    try:
        ast.parse(text)
    except SyntaxError:
        return False
    return True


def changes(tree: ast.AST) -> Iterator[tuple[ast.expr | ast.stmt, str]]:
    """Yield (node, what stands in its place): of everything but words, types and refusals."""
    if isinstance(tree, SILENT):
        return
    if isinstance(tree, ast.expr | ast.stmt):
        for new in instead(tree):
            yield tree, new
    left_out = {"annotation", "returns", "decorator_list"}
    for name, value in ast.iter_fields(tree):
        if name not in left_out:
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.expr) and left_open(tree, child):
                    yield from ((child, new) for new in instead(child))
                elif isinstance(child, ast.AST):
                    yield from changes(child)


def left_open(tree: ast.AST, child: ast.expr) -> bool:
    """Return whether this is the -1 of a reshape, which is the same with any other number below 0."""
    match tree:
        case ast.Call(ast.Attribute(attr="reshape")):
            return ast.unparse(child) == "-1"
    return False


def instead(node: ast.expr | ast.stmt) -> Iterator[str]:
    """Yield what may stand in a node's place."""
    match node:
        case ast.BinOp(left, op, right):
            for other in OPERATORS.get(type(op), ()):
                yield f"({ast.unparse(ast.BinOp(left, other(), right))})"
        case ast.AugAssign(target, op, value):
            for other in OPERATORS.get(type(op), ()):
                yield ast.unparse(ast.AugAssign(target, other(), value))
        case ast.BoolOp(joined, values):
            yield f"({ast.unparse(ast.BoolOp(OPERATORS[type(joined)][0](), values))})"
        case ast.Compare(left, ops, comparators):
            for k, compared in enumerate(ops):
                for other in OPERATORS[type(compared)]:
                    every = [*ops[:k], other(), *ops[k + 1 :]]
                    yield f"({ast.unparse(ast.Compare(left, every, comparators))})"
        case ast.UnaryOp(ast.USub() | ast.Not() | ast.Invert(), operand):
            yield f"({ast.unparse(operand)})"
        case ast.Constant(bool(value)):
            yield str(not value)
        case ast.Constant(int(value)):
            yield str(value + 1)
        case ast.Constant(float(value)):
            yield str(2 * value or 1.0)
        case ast.IfExp(test, body, orelse):
            yield f"({ast.unparse(ast.IfExp(test, orelse, body))})"
        case ast.Expr(ast.Call()):
            yield "pass"


def of(root: Path, files: list[str]) -> list[Mutant]:
    """Return the mutants of files of a repository."""
    return [
        mutant
        for file in files
        for mutant in mutants(file, (root / file).read_text(encoding="utf8"))
    ]
