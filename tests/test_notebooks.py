"""Rules for every notebook, checked without running it; test_notebooks_run runs them."""

import ast
import re
import symtable
from pathlib import Path

import nbformat
import pytest

from hdrlab.course.site import pages
from tools import fold_cells

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))
PICTURES = {f"pictures.{name}" for name in ("picture", "radiance", "strip", "side_by_side")}
PICTURES |= {f"widgets.{name}" for name in ("play", "tune", "wipe", "blink", "brush", "pixel_mean")}
PICTURES |= {"widgets.exposure_window"}
PICTURES |= {"widgets.bitmap_difference"}
PICTURES |= {"widgets.zone_scale", "widgets.gain_screen", "widgets.screen_match"}
PICTURES |= {"widgets.gsolve_by_hand", "widgets.bilateral_kernel", "widgets.gradient_line"}
# a cell is read at a glance; the limits leave room for one statement a line
MAX_CELL_LINES = 14
MAX_FUNCTION_LINES = 8
LONGEST = 100  # letters: what JupyterLab shows at 1280 px without scrolling

pytestmark = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def cells_of(path, kind):
    return [cell for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == kind]


def calls_of(cell):
    """Return the calls that make a picture: pictures.picture(...), widgets.play(...)."""
    calls = [node for node in ast.walk(ast.parse(cell.source)) if isinstance(node, ast.Call)]
    return [call for call in calls if ".".join(ast.unparse(call.func).split(".")[-2:]) in PICTURES]


def bound(table):
    return {
        name.get_name() for name in table.get_symbols() if name.is_assigned() or name.is_imported()
    }


def globals_read(table):
    """Return the globals that the functions of a cell read; a comprehension runs at once, and is none."""
    inner = [
        inner_table
        for inner_table in table.get_children()
        if not inner_table.get_name().endswith(("comp", "genexpr"))
    ]
    names = {
        name.get_name()
        for inner_table in inner
        for name in inner_table.get_symbols()
        if name.is_global()
    }
    return names.union(*map(globals_read, inner))


def kinds_of(cell):
    return {call.func.attr for call in calls_of(cell)}


def test_a_notebook_is_valid_and_its_cells_have_ids_that_last(path):
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    ids = [cell.id for cell in notebook.cells]
    assert len(set(ids)) == len(ids) and all(name.replace("-", "").isalnum() for name in ids)
    assert notebook.metadata.kernelspec.name == "python3"


def test_a_notebook_carries_no_outputs(path):
    for cell in cells_of(path, "code"):
        assert cell.outputs == [] and cell.execution_count is None, cell.id
    assert set(nbformat.read(path, as_version=4).metadata) <= {"kernelspec", "language_info"}


def test_a_function_of_a_notebook_is_short(path):
    """Students read it between two figures; longer ones belong in the library."""
    for cell in cells_of(path, "code"):
        for node in ast.walk(ast.parse(cell.source)):
            if isinstance(node, ast.FunctionDef):
                lines = node.end_lineno - node.lineno + 1
                assert lines <= MAX_FUNCTION_LINES, f"{cell.id}: {node.name}"


def test_a_statement_of_a_notebook_assigns_one_thing(path):
    """Values of one tuple are assigned one by one, unless the statement changes names together."""
    for cell in cells_of(path, "code"):
        for node in ast.walk(ast.parse(cell.source)):
            if not isinstance(node, ast.Assign) or not isinstance(node.value, ast.Tuple):
                continue
            target = node.targets[0]
            if isinstance(target, ast.Tuple):
                assigned = {name.id for name in ast.walk(target) if isinstance(name, ast.Name)}
                used = {name.id for name in ast.walk(node.value) if isinstance(name, ast.Name)}
                assert assigned & used, f"{cell.id}: {ast.unparse(node)}"


def test_a_cell_of_code_fits_the_page(path):
    for cell in cells_of(path, "code"):
        lines = cell.source.splitlines()
        assert max(map(len, lines)) <= LONGEST, cell.id
        imports_only = all(
            isinstance(node, ast.Import | ast.ImportFrom) for node in ast.parse(cell.source).body
        )
        assert len(lines) <= MAX_CELL_LINES or imports_only, cell.id


def test_a_cell_is_folded_where_it_only_draws_and_open_where_its_code_is_the_lesson(path):
    cells = cells_of(path, "code")
    should = fold_cells.choose_folded_cells({"cells": cells})
    for cell, fold in zip(cells, should, strict=True):
        assert cell.metadata == (fold_cells.FOLDED_METADATA if fold else {}), (
            f"{cell.id}: python -m tools.fold_cells"
        )


def test_every_picture_has_alt_text(path):
    for cell in cells_of(path, "code"):
        for call in calls_of(cell):
            texts = [word.value for word in call.keywords if word.arg == "alt"]
            assert len(texts) == 1, f"{cell.id}: {call.func.attr}"
            assert not isinstance(texts[0], ast.Constant) or len(texts[0].value) > 10, cell.id
    for cell in cells_of(path, "markdown"):
        assert "![](" not in cell.source and ("<img" not in cell.source or "alt=" in cell.source), (
            cell.id
        )


def test_a_prediction_binds_no_name_that_a_function_reads_from_another_cell(path):
    """A slider calls its function late: what it reads must not have become something else by then."""
    cells = cells_of(path, "code")
    tables = [symtable.symtable(cell.source, cell.id, "exec") for cell in cells]
    binds = [bound(table) for table in tables]
    asks = [k for k, cell in enumerate(cells) if re.search(r"^predict\.", cell.source, re.M)]
    for k, table in enumerate(tables):
        for name in globals_read(table) & set().union(*binds[: k + 1]):
            expected = max(j for j in range(k + 1) if name in binds[j])
            assert [cells[j].id for j in asks if name in binds[j] and j != expected] == [], (
                f"{cells[k].id}: {name}"
            )


def test_a_notebook_says_how_long_it_takes_and_what_one_can_do_afterwards(path):
    lesson = pages.describe_lesson(nbformat.read(path, 4))
    assert 10 <= lesson.minutes <= 90 and lesson.goal.endswith(".")
    assert not re.search(r"[$`\[]", lesson.goal), (
        "the first page of the site shows it as plain text"
    )


def test_a_question_stands_before_each_picture(path):
    """Each picture follows a text that asks; a strip may also follow the slider it stands in for."""
    has_question = False
    for cell in nbformat.read(path, as_version=4).cells:
        if cell.cell_type == "markdown":
            has_question = "?" in cell.source or (has_question and not cell.source.startswith("#"))
        else:
            assert has_question or not calls_of(cell), cell.id


def test_a_question_that_begins_with_predict_takes_an_answer_and_no_other_does(path):
    """Between two questions or headings there is at most one that begins so, and then a widget."""
    waiting = []
    for cell in nbformat.read(path, as_version=4).cells:
        if cell.cell_type == "markdown":
            kinds = re.findall(r"\*\*(Predict|Think)\.\*\*", cell.source)
            if kinds:
                assert "Predict" not in [*waiting, *kinds[:-1]], cell.id
                waiting = kinds[-1:]
        elif re.search(r"^predict\.", cell.source, re.M):
            assert waiting != ["Think"], cell.id
            waiting = []
    assert waiting != ["Predict"]


def test_still_pictures_stand_beside_each_widget(path):
    """Nothing but text comes between a widget and its pictures for paper."""
    code = cells_of(path, "code")
    for cell, following in zip(code, [*code[1:], None], strict=True):
        if kinds_of(cell) & {"play", "tune"}:
            assert following is not None, cell.id
            stills = {"side_by_side", "strip"} & (kinds_of(cell) | kinds_of(following))
            assert stills, cell.id


def test_no_strip_shows_on_screen_what_the_widget_above_it_shows(path):
    drawn_by_widgets = ""
    for cell in nbformat.read(path, as_version=4).cells:
        if cell.cell_type == "markdown":
            if re.search(r"^## |\*\*(?:Predict|Think)\.\*\*", cell.source, re.M):
                drawn_by_widgets = ""
            continue
        for call in calls_of(cell):
            if call.func.attr in ("play", "tune"):
                drawn_by_widgets += ast.unparse(call.args[1]) + "\n"
            elif call.func.attr == "strip":
                draw = ast.unparse(call.args[1])
                assert not re.search(rf"\b{re.escape(draw)}\b", drawn_by_widgets), (
                    f"{cell.id}: use pictures.side_by_side"
                )


def test_answers_that_unfold_are_closed_again(path):
    text = "\n".join(cell.source for cell in cells_of(path, "markdown"))
    assert text.count("<details><summary>") == text.count("<details") == text.count("</details>")


def test_a_notebook_with_exercises_takes_the_readers_photos_and_leads_to_an_assignment(path):
    text = "\n".join(cell.source for cell in cells_of(path, "markdown"))
    _, heading, exercises = text.partition("## Exercises")
    if not heading:
        pytest.skip("this notebook has no exercises")
    assert any('FOLDER = ""' in cell.source for cell in cells_of(path, "code"))
    links = re.findall(r"\]\((\S+assignments/\S+)\)", exercises)
    assert links and all((path.parent / link).is_file() for link in links)
