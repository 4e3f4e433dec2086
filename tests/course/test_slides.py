"""The rule that makes slides from the notebooks, and the decks that `hdrlab course slides` writes."""

import ast
import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from importlib.util import find_spec
from pathlib import Path

import nbformat
import pytest

from hdrlab import cli
from hdrlab.course.slides import rule
from hdrlab.course.slides.rule import SlideKind

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
NEEDS = ("mdit_py_plugins", "ziamath", "nbclient")
PATIENCE = 1800  # seconds: what hangs ends
FOLDED = re.compile(r"<details><summary>.*?</summary>(.*?)</details>", re.DOTALL)
QUESTION = re.compile(r"\*\*(?:Predict|Think)\.\*\*")
pytestmark = pytest.mark.skipif(
    any(find_spec(name) is None for name in NEEDS),
    reason='the slides need pip install ".[site]"',
)


def words(text):
    """Return text in one line."""
    return " ".join(text.split())


@pytest.fixture(params=NOTEBOOKS, ids=lambda path: path.stem, scope="module")
def notebook(request):
    """A notebook without outputs, as its cells and its slides."""
    cells = nbformat.read(request.param, 4).cells
    return cells, rule.make_slides(cells)


def slides_of(*cells):
    """Return the slides of cells: text, or code that begins with "code:"."""
    made = []
    for cell in cells:
        kind = "code" if cell.startswith("code:") else "markdown"
        made.append({"cell_type": kind, "source": cell.removeprefix("code:"), "metadata": {}})
    return rule.make_slides(made)


def cells_with_questions(cells):
    """Return the number of the cell of each question of a notebook, in order."""
    return [
        number
        for number, cell in enumerate(cells)
        if cell.cell_type == "markdown"
        for _ in QUESTION.findall(FOLDED.sub("", cell.source))
    ]


def test_every_notebook_gives_a_deck_without_being_run(notebook):
    cells, slides = notebook
    assert slides[0].kind is SlideKind.TITLE
    assert re.fullmatch(r"\d+ minutes", slides[0].label) and slides[0].text
    assert sum(slide.kind is SlideKind.FIGURE for slide in slides) >= 5
    for slide in slides:
        assert slide.heading and (slide.text or slide.cell is not None)


def test_each_question_is_on_a_slide_after_what_it_follows_and_before_its_answer(notebook):
    cells, slides = notebook
    question_cells = cells_with_questions(cells)
    places = [
        place
        for place, slide in enumerate(slides)
        if slide.kind is SlideKind.QUESTION and slide.text
    ]
    assert len(question_cells) == len(places) > 3
    shown = {slide.cell: k for k, slide in enumerate(slides) if slide.cell is not None}
    for cell, place in zip(question_cells, places, strict=True):
        assert all(k < place for number, k in shown.items() if number < cell)
        assert all(k >= place for number, k in shown.items() if number > cell)
        answer = slides[place].cell
        assert answer is None or "predict." in cells[answer].source


def test_folded_text_is_in_notes_and_on_no_slide(notebook):
    cells, slides = notebook
    notes = words("\n".join(note for slide in slides for note in slide.notes))
    shown = words("\n".join(f"{slide.lead}\n{slide.text}" for slide in slides))
    answers = [
        words(answer)
        for cell in cells
        if cell.cell_type == "markdown"
        for answer in FOLDED.findall(cell.source)
    ]
    assert answers
    for answer in answers:
        assert answer in notes
        assert answer not in shown


def test_a_slide_has_at_most_one_displayed_equation_and_each_equation_has_a_slide(notebook):
    cells, slides = notebook
    for slide in slides:
        assert slide.text.count("$$") in (0, 2)
        assert "$$" not in slide.lead
    text = "\n".join(FOLDED.sub("", cell.source) for cell in cells if cell.cell_type == "markdown")
    equations = re.findall(r"\$\$.*?\$\$", text, re.DOTALL)
    on_slides = "\n".join(slide.text for slide in slides)
    assert [on_slides.count(equation) for equation in equations] == [1] * len(equations)


def test_a_slide_has_only_text_of_its_notebook(notebook):
    cells, slides = notebook
    text = words("\n".join(cell.source for cell in cells))
    for slide in slides:
        for part in f"{slide.lead}\n\n{slide.text}".split("\n\n"):
            if part.startswith("|") or slide.kind is SlideKind.CODE:
                assert all(words(line) in text for line in part.splitlines())
            elif "\\(" not in part:
                sentences = re.split(r"(?<=[.?!:]) ", words(part).removeprefix("- "))
                assert all(sentence in text for sentence in sentences), part


def test_the_figure_of_every_cell_is_on_one_slide_except_still_images_of_a_slider(notebook):
    cells, slides = notebook
    on_slides = [slide.cell for slide in slides if slide.cell is not None]
    assert len(on_slides) == len(set(on_slides))
    for number, cell in enumerate(cells):
        if cell.cell_type != "code" or not cell.source:
            continue
        last = ast.unparse(ast.parse(cell.source).body[-1])
        if last.startswith("widgets.") or last.startswith("pictures.picture("):
            assert number in on_slides
        if last.startswith("pictures.strip("):
            assert number in on_slides
        if last.startswith("pictures.side_by_side("):
            assert number not in on_slides


def test_text_that_fits_on_no_slide_is_in_the_notes_of_the_last():
    sentence = "A sentence of some forty letters is here."
    paragraphs = [f"Paragraph {k} begins. " + " ".join([sentence] * 12) for k in range(5)]
    slides = slides_of("## Long\n\n" + "\n\n".join(paragraphs))
    assert [slide.kind for slide in slides] == [SlideKind.TEXT] * 2
    everything = [*(slide.text for slide in slides), *slides[-1].notes]
    assert words("\n".join(everything)) == words("\n".join(paragraphs))
    assert slides[0].notes == ()


def test_a_long_list_and_a_long_table_continue_on_more_slides_and_lose_nothing():
    items = [f"{k}. " + "Some exercise for readers, in several words. " * 4 for k in range(1, 9)]
    rows = [f"| letter {k} | what it is | shape |" for k in range(40)]
    table = ["| a | b | c |", "|---|---|---|", *rows]
    slides = slides_of("## Exercises\n\n" + "\n".join(items), "## Letters\n\n" + "\n".join(table))
    assert len(slides) > 5
    text = "\n".join(slide.text for slide in slides)
    assert [text.count(f"\n{row}") for row in rows] == [1] * 40
    assert all(item.strip() in text for item in items)
    tables = [slide.text for slide in slides if slide.heading == "Letters"]
    assert all(text.startswith("| a | b | c |\n|---|---|---|\n") for text in tables)


def test_a_prediction_is_made_on_the_slide_of_its_question():
    slides = slides_of(
        "## Light\n\n**Predict.** How many stops?",
        "code:predict.number('How many?', 12, (0, 20))",
        "code:pictures.picture(drawn, alt='A scale')",
    )
    assert [(slide.kind, slide.cell) for slide in slides] == [
        (SlideKind.QUESTION, 1),
        (SlideKind.FIGURE, 2),
    ]


def test_printed_text_is_in_the_notes_of_a_figure_and_on_a_slide_where_there_is_none():
    printing = "code:print(1)"
    figure, numbers = slides_of(
        "## One", "code:widgets.play(a, b, alt='c')", printing, "## Two", printing
    )
    assert figure.printed == (2,) and figure.kind is SlideKind.FIGURE
    assert numbers.cell == 4 and numbers.kind is SlideKind.PRINTED


def test_folded_answers_without_a_figure_become_a_slide_of_questions_with_the_answers_as_notes():
    answers = "<details><summary>Why?</summary>\n\nBecause.\n\n</details>\n\n" * 2
    [slide] = slides_of(f"## Questions\n\n{answers}")
    assert slide.text == "- Why?\n\n- Why?"
    assert len(slide.notes) == 2 and "Because." in slide.notes[0]


def test_what_concerns_readers_with_their_own_photos_is_left_out():
    slides = slides_of(
        "## Light\n\nA curve. (With your own photos, it is another.) It rises.",
        '**Your own photos.** Put a name between the quotes.\n\n```python\nFOLDER = ""\n```',
    )
    assert "own photos" not in "".join(slide.text for slide in slides)
    assert slides[0].text == "A curve. It rises."


def test_a_notebook_may_lack_a_title_and_speak_ipython():
    cells = [
        {"cell_type": "code", "source": "%matplotlib inline", "outputs": []},
        {"cell_type": "code", "source": "light = !ls\nlight", "outputs": ["a list"]},
        {"cell_type": "code", "source": "", "outputs": []},
    ]
    slides = rule.drop_empty(rule.make_slides(cells, "week1"), cells)
    assert [(slide.kind, slide.heading) for slide in slides] == [
        (SlideKind.TITLE, "week1"),
        (SlideKind.FIGURE, "week1"),
    ]
    assert slides[1].cell == 1


@pytest.mark.parametrize(
    ("name", "near"),
    [("gsolve", "04_response_gsolve"), ("4_responce_gsolv", "04_response_gsolve"), ("99", "00_")],
)
def test_a_notebook_that_is_not_there_is_refused_with_the_nearest_names(
    name, near, tmp_path, capsys
):
    with pytest.raises(SystemExit) as stop:
        cli.run(["course", "slides", name, "-o", str(tmp_path / "slides")])
    errors = capsys.readouterr().err
    assert stop.value.code == 2 and errors.count("\n") == 1
    assert name in errors and near in errors
    assert not list(tmp_path.iterdir())


PLAYED = """import numpy as np
from hdrlab.show import pictures, widgets
squares = [np.full((40, 60), 50 * k, np.uint8) for k in range(5)]
widgets.play(squares, lambda square: square, alt="A square, ever lighter")"""
TEXT = """# 01 · Steps

*5 minutes. Afterwards you can play steps.*

See [two](02_two.ipynb) and [a paper](https://doi.org/10.1145/258734.258884).

$$\\ln X = \\sum_i Z_i$$

**Think.** Which square is the lightest, for $k < 5$?"""
ANSWER = "<details><summary>Why?</summary>\n\nThe last, </script> $k = 4$.\n\n</details>"


def write_notebook(path, *code):
    """Write a notebook of a text with an equation and a question, code, and a folded answer."""
    cells = [nbformat.v4.new_markdown_cell(TEXT)]
    cells += [nbformat.v4.new_code_cell(source) for source in code]
    cells.append(nbformat.v4.new_markdown_cell(ANSWER))
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3"}}
    nbformat.write(nbformat.v4.new_notebook(cells=cells, metadata=kernel), path)
    return path


def run(folder, *arguments):
    """Run the command in a folder, as a user types it."""
    command = [sys.executable, "-m", "hdrlab", "course", "slides", *map(str, arguments)]
    return subprocess.run(
        command, cwd=folder, env=os.environ, capture_output=True, text=True, timeout=PATIENCE
    )


@pytest.fixture(scope="module")
def deck(tmp_path_factory):
    """A folder with a notebook, its deck, and what the command printed."""
    folder = tmp_path_factory.mktemp("slides")
    source = write_notebook(folder / "01_steps.ipynb", PLAYED, "print('5 < 6 squares')")
    ran = run(folder, source.name, "-o", "decks")
    assert ran.returncode == 0, ran.stderr
    return folder, folder / "decks" / "01_steps.html", ran.stdout


class Page(HTMLParser):
    """The resources, links and sections of a page, and the text of its notes."""

    def __init__(self, text):
        super().__init__()
        self.loaded = []
        self.sections = 0
        self.in_notes = False
        self.notes = ""
        self.silent = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        if tag == "aside":
            self.in_notes = True
        self.sections += tag == "section"
        if tag == "img" and not attributes.get("alt"):
            self.silent.append(attributes)
        if tag != "a":
            self.loaded += [attributes[name] for name in ("src", "href") if name in attributes]

    def handle_endtag(self, tag):
        if tag == "aside":
            self.in_notes = False

    def handle_data(self, data):
        if self.in_notes:
            self.notes += data


@pytest.mark.notebooks
def test_a_deck_is_one_file_that_refers_to_nothing_outside(deck):
    folder, path, printed = deck
    assert [file.name for file in path.parent.iterdir()] == ["01_steps.html"]
    text = path.read_text("utf-8")
    page = Page(text)
    styles = "".join(re.findall(r"<style>.*?</style>", text, re.DOTALL))
    assert styles and page.loaded
    assert [file for file in page.loaded if not file.startswith(("data:", "#"))] == []
    assert not re.search(r"@import|url\(\s*['\"]?(?!data:)", styles)
    assert "02_two.ipynb" not in text and page.silent == []
    assert f"{page.sections} slides" in printed


@pytest.mark.notebooks
def test_notes_have_the_folded_answer_and_what_was_printed(deck):
    notes = Page(deck[1].read_text("utf-8")).notes
    assert "The last, " in notes and "5 < 6 squares" in notes


@pytest.mark.notebooks
def test_a_second_run_executes_nothing_and_writes_the_same_deck(deck):
    folder, path, _ = deck
    before = path.read_bytes()
    ran = run(folder, "01_steps.ipynb", "-o", "decks")
    assert "run now: 0" in ran.stdout and path.read_bytes() == before
    assert {file.name for file in folder.iterdir()} == {"01_steps.ipynb", "decks", ".decks.cache"}


@pytest.mark.notebooks
def test_a_notebook_that_fails_is_named_and_its_earlier_deck_stays(tmp_path):
    source = write_notebook(tmp_path / "bad.ipynb", "light = 1 / 0")
    (tmp_path / "decks").mkdir()
    earlier = tmp_path / "decks" / "bad.html"
    earlier.write_text("an earlier deck")
    ran = run(tmp_path, source, "-o", "decks")
    assert ran.returncode == 1 and "bad.ipynb, cell 2" in ran.stderr
    assert "ZeroDivisionError" in ran.stderr and len(ran.stderr.splitlines()) == 1
    assert earlier.read_text() == "an earlier deck"


@pytest.mark.notebooks
def test_two_notebooks_of_one_name_are_refused(tmp_path):
    (tmp_path / "more").mkdir()
    pair = [write_notebook(folder / "one.ipynb") for folder in (tmp_path, tmp_path / "more")]
    ran = run(tmp_path, *pair)
    assert ran.returncode == 2 and "two notebooks have the name one" in ran.stderr
