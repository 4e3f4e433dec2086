"""Fold the cells of the notebooks that only draw, so that a figure comes right after its question.

    python -m tools.fold_cells

The script writes the metadata that JupyterLab and the site read into every notebook. Folded cells:

- a cell that draws with `hdrlab.show`, uses nothing else of hdrlab, and defines no function that
  computes;
- a cell that only imports;
- a cell that asks for a prediction, because its code contains the answer;
- a cell that shows the images of a slider side by side, unless it also plays or tunes.
"""

import ast
import json
from pathlib import Path

NOTEBOOKS = Path(__file__).parents[1] / "notebooks"
DRAWING_MODULES = ("hdrlab.show",)
FOLDED_METADATA = {"jupyter": {"source_hidden": True}}


def imported_names(source):
    """Return the names that a cell imports from hdrlab, each with whether it belongs to hdrlab.show."""
    names = {}
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.ImportFrom):
            continue
        module = node.module or ""
        if module.startswith("hdrlab"):
            for alias in node.names:
                name = alias.asname or alias.name
                names[name] = f"{module}.{alias.name}".startswith(DRAWING_MODULES)
    return names


def used_names(node):
    """Return the names that occur below a node of a syntax tree."""
    return {child.id for child in ast.walk(node) if isinstance(child, ast.Name)}


def is_folded(source, known_names):
    """Return whether to fold a cell.

    Parameters
    ----------
    source : the code of the cell
    known_names : what this cell and the cells above it import, see `imported_names`
    """
    tree = ast.parse(source)
    if all(isinstance(node, ast.Import | ast.ImportFrom) for node in tree.body):
        return True
    used = used_names(tree) & set(known_names)
    if not all(imported_names(source).values()):
        return False
    if "predict" in used:
        return True
    attributes = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    if "side_by_side" in attributes and not attributes & {"play", "tune"}:
        return True
    only_draws = bool(used) and all(known_names[name] for name in used)
    return only_draws and not defines_computing_function(tree, used)


def defines_computing_function(tree, library_names):
    """Return whether a cell defines a function that uses nothing of hdrlab and returns a new value."""
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    return any(
        not used_names(function) & library_names and not returns_existing_value(function)
        for function in functions
    )


def returns_existing_value(function):
    """Return whether a function only looks up a value: `return part` or `return shown[k]`."""
    statement = function.body[0]
    return isinstance(statement, ast.Return) and isinstance(
        statement.value, ast.Name | ast.Subscript
    )


def code_cells(notebook):
    """Return the code cells of a notebook."""
    return [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]


def choose_folded_cells(notebook):
    """Return for each code cell of a notebook whether to fold it."""
    known_names = {}
    choices = []
    for cell in code_cells(notebook):
        source = "".join(cell["source"])
        known_names |= imported_names(source)
        choices.append(is_folded(source, known_names))
    return choices


def main():
    """Fold the cells of all notebooks and print how many are folded in each."""
    for path in sorted(NOTEBOOKS.glob("*.ipynb")):
        notebook = json.loads(path.read_text(encoding="utf8"))
        choices = choose_folded_cells(notebook)
        for cell, fold in zip(code_cells(notebook), choices, strict=True):
            cell["metadata"] = FOLDED_METADATA if fold else {}
        text = json.dumps(notebook, indent=1, ensure_ascii=False) + "\n"
        path.write_text(text, encoding="utf8")
        print(f"{path.stem:40} {sum(choices):2} of {len(choices)}")


if __name__ == "__main__":
    main()
