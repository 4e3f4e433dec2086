"""Count, room by room, the forms that make code dense: joined assignments, packed constants and their like.

    python tests/density.py [FOLDER ...]     # prints a table; it sets no limits

nodes    expressions and statements per line of code
joined   tuple assignments from a tuple of values: `a, b = f(), g()`
packed   the same for constants: `MOST, FEW = 8, 2`
gen      names unpacked from a generator: `a, b = (f(x) for x in pair)`
chained  assignments with several targets of which one is a tuple: `a, b = c = f()`
walrus   assignment expressions
nested   conditional expressions inside conditional expressions
one/each loops over a variable called one, each, given, said, told or found
word     constants of a single word
tuple    NamedTuple classes
data     dataclasses
"""

import ast
import sys
import tokenize
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
COLUMNS = ("lines", "nodes", "joined", "packed", "gen", "chained", "walrus", "nested")
COLUMNS += ("one/each", "word", "tuple", "data")
LOOP_WORDS = {"one", "each", "given", "said", "told", "found"}
LAYOUT_TOKENS = (
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENCODING,
    tokenize.ENDMARKER,
)


def docstring_lines(tree):
    """Return the line numbers of all docstrings."""
    lines = set()
    for node in ast.walk(tree):
        is_documented = isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef)
        if is_documented and ast.get_docstring(node) is not None:
            lines.update(range(node.body[0].lineno, node.body[0].end_lineno + 1))
    return lines


def code_lines(path, tree):
    """Return the number of lines that hold code: no comments, docstrings or empty lines."""
    lines = set()
    with open(path, "rb") as file:
        for token in tokenize.tokenize(file.readline):
            if token.type not in LAYOUT_TOKENS:
                lines.update(range(token.start[0], token.end[0] + 1))
    return len(lines - docstring_lines(tree))


def is_joined(node):
    """Return whether an assignment gives several values to several names at once."""
    target = node.targets[0]
    return isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple)


def is_packed(node):
    """Return whether an assignment defines several constants at once."""
    names = [item.id for item in node.targets[0].elts if isinstance(item, ast.Name)]
    return bool(names) and all(name.isupper() for name in names)


def count_assignment(node, counts):
    """Count one assignment statement."""
    has_tuple = any(isinstance(target, ast.Tuple) for target in node.targets)
    if len(node.targets) > 1:
        counts["chained"] += has_tuple
    elif is_joined(node):
        counts["packed" if is_packed(node) else "joined"] += 1
    elif has_tuple and isinstance(node.value, ast.GeneratorExp):
        counts["gen"] += 1
    target = node.targets[0]
    if isinstance(target, ast.Name) and target.id.isupper() and node.col_offset == 0:
        counts["word"] += "_" not in target.id.strip("_")


def count_file(path):
    """Return the counts of one file."""
    tree = ast.parse(path.read_text(encoding="utf8"))
    documentation = docstring_lines(tree)
    counts = Counter(lines=code_lines(path, tree))
    for node in ast.walk(tree):
        if getattr(node, "lineno", None) in documentation:
            continue
        counts["syntax"] += isinstance(node, ast.expr | ast.stmt)
        match node:
            case ast.Assign():
                count_assignment(node, counts)
            case ast.NamedExpr():
                counts["walrus"] += 1
            case ast.IfExp():
                inner = [child for child in ast.walk(node) if isinstance(child, ast.IfExp)]
                counts["nested"] += len(inner) > 1
            case ast.For(target=ast.Name(id=name)) | ast.comprehension(target=ast.Name(id=name)):
                counts["one/each"] += name in LOOP_WORDS
            case ast.ClassDef():
                counts["tuple"] += any("NamedTuple" in ast.unparse(base) for base in node.bases)
                counts["data"] += any(
                    "dataclass" in ast.unparse(one) for one in node.decorator_list
                )
    return counts


def main(folders):
    """Print a line of counts for each folder, and one for all."""
    folders = [Path(folder) for folder in folders] or sorted((ROOT / "hdrlab").iterdir())
    total = Counter()
    print(f"{'':28}" + "".join(f"{column:>9}" for column in COLUMNS))
    rows = []
    for folder in folders:
        files = sorted(folder.rglob("*.py")) if folder.is_dir() else [folder]
        counts = Counter()
        for path in files:
            if path.suffix == ".py":
                counts.update(count_file(path))
        if counts["lines"]:
            rows.append((str(folder.name), counts))
            total.update(counts)
    for name, counts in [*rows, ("all", total)]:
        nodes = counts["syntax"] / counts["lines"]
        values = [
            f"{nodes:.1f}" if column == "nodes" else str(counts[column]) for column in COLUMNS
        ]
        print(f"{name:28}" + "".join(f"{value:>9}" for value in values))


if __name__ == "__main__":
    main(sys.argv[1:])
