"""Which cells of a notebook only draw: their code is folded, and the picture comes right after the words.

    python tests/folds.py     # writes it into the notebooks' cells, as JupyterLab and the site read it

A cell draws where it makes a picture or asks a prediction, whose code has the answer. It only draws
where it calls nothing of the library but what shows, and defines no function that computes. A cell
that shows a widget's pictures side by side is folded in any case.
"""

import ast
import json
import sys
from pathlib import Path

NOTEBOOKS = Path(__file__).parents[1] / "notebooks"
SHOWS = ("hdrlab.show",)
FOLDED = {"jupyter": {"source_hidden": True}}


def imported(source):
    """Return the names that a cell imports from the library: whether each is of what shows."""
    names = {}
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("hdrlab"):
            for each in node.names:
                names[each.asname or each.name] = f"{node.module}.{each.name}".startswith(SHOWS)
    return names


def names_in(node):
    return {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}


def only_draws(source, known):
    """Return whether a cell makes a picture, or asks, and shows nothing of a lesson's code."""
    tree = ast.parse(source)
    used = names_in(tree) & set(known)
    if not all(imported(source).values()):
        return False
    if "predict" in used:
        return True
    called = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    if "side_by_side" in called and not called & {"play", "tune"}:
        return True
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    computes = [one for one in functions if not names_in(one) & used and not passes_on(one)]
    return bool(used) and all(known[name] for name in used) and not computes


def passes_on(function):
    """Return whether a function only gives back what it has: `return part`, `return shown[k]`."""
    last = function.body[0]
    return isinstance(last, ast.Return) and isinstance(last.value, ast.Name | ast.Subscript)


def folded(notebook):
    """Return for each cell of code of a notebook whether it is to be folded."""
    known, found = {}, []
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            source = "".join(cell["source"])
            known |= imported(source)
            found.append(only_draws(source, known))
    return found


def main():
    for path in sorted(NOTEBOOKS.glob("*.ipynb")):
        text = path.read_text(encoding="utf8")
        notebook = json.loads(text)
        code = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
        for cell, fold in zip(code, folded(notebook), strict=True):
            cell["metadata"] = FOLDED if fold else {}
        path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n", encoding="utf8")
        sys.stdout.write(f"{path.stem:40} {sum(folded(notebook)):2} of {len(code)}\n")


if __name__ == "__main__":
    main()
