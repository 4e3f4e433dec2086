"""The question bank that `hdrlab course questions` makes from the predictions of notebooks."""

import base64
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from importlib.util import find_spec
from pathlib import Path

import nbformat
import numpy as np
import pytest

from hdrlab import cli
from hdrlab.io import web

NEEDS = ("mdit_py_plugins", "ziamath", "nbclient")
PATIENCE = 600  # seconds: what hangs ends
CELLS = [
    "# Light & shade\n\nSome text.",
    "An introduction.\n\n**Predict.** With $\\beta < 1$, which is brighter?",
    "code:import numpy as np\nfrom hdrlab.show.widgets import predict\n"
    "predict.choice('Sky or <wall>?', 1, ['the sky', 'the wall', 'neither'], because='It is lit.')",
    "code:predict.number('How many stops?', 1.0 + 10.4, (0, 20), unit='stops', because='Count.')",
    "code:gray = [np.full((9, 9), level, np.uint8) for level in (20, 200)]\n"
    "predict.choice('Which is darker?', 0, ['left', 'right'], pictures=gray)",
    "code:predict.place('Where?', gray[1] > 9, gray[1], alt='Gray')",
    "code:predict.curve('Draw it.', [0, 1], [0, 2], names=('level', 'light'))",
]
pytestmark = [
    pytest.mark.notebooks,
    pytest.mark.skipif(
        any(find_spec(name) is None for name in NEEDS),
        reason='question banks need pip install ".[site]"',
    ),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a notebook that has five predictions, and its banks in both formats."""
    folder = tmp_path_factory.mktemp("bank")
    cells = []
    for number, text in enumerate(CELLS):
        is_code = text.startswith("code:")
        new_cell = nbformat.v4.new_code_cell if is_code else nbformat.v4.new_markdown_cell
        cells.append(new_cell(text.removeprefix("code:"), id=f"cell-{number}"))
    nbformat.write(nbformat.v4.new_notebook(cells=cells), folder / "my_lesson.ipynb")
    for name in ("bank.xml", "bank.html"):
        command = [sys.executable, "-m", "hdrlab", "course", "questions", "my_lesson.ipynb"]
        subprocess.run([*command, "-o", name], cwd=folder, check=True, timeout=PATIENCE)
    return folder


@pytest.fixture(scope="module")
def questions(folder):
    """The questions of the bank by their text."""
    quiz = ET.parse(folder / "bank.xml").getroot()
    return {
        re.search(r"<b>(.*)</b>", element.findtext("questiontext/text"))[1]: element
        for element in quiz
        if element.get("type") != "category"
    }


def test_a_bank_has_each_question_that_a_quiz_can_mark(questions):
    assert list(questions) == ["Sky or &lt;wall&gt;?", "How many stops?", "Which is darker?"]


def test_the_right_choice_and_no_other_gets_the_points(questions):
    answers = questions["Sky or &lt;wall&gt;?"].findall("answer")
    points = {answer.findtext("text"): answer.get("fraction") for answer in answers}
    assert points == {"<p>the sky</p>": "0", "<p>the wall</p>": "100", "<p>neither</p>": "0"}


def test_a_number_is_right_if_its_error_is_small_in_the_notebook(questions):
    answer = questions["How many stops?"].find("answer")
    assert float(answer.findtext("text")) == pytest.approx(11.4)
    assert float(answer.findtext("tolerance")) == pytest.approx(0.1 * 20)
    question_text = questions["How many stops?"].findtext("questiontext/text")
    assert "from 0 to 20 (stops)" in question_text


def test_the_paragraph_that_asks_goes_with_its_question_alone_and_its_formulas_are_tex(questions):
    question_text = questions["Sky or &lt;wall&gt;?"].findtext("questiontext/text")
    assert r"With \(\beta &lt; 1\), which is brighter?" in question_text
    assert "Predict" not in question_text
    assert "beta" not in questions["How many stops?"].findtext("questiontext/text")


def test_an_explanation_is_the_feedback(questions):
    feedback = questions["How many stops?"].findtext("generalfeedback/text")
    assert feedback == "<p>Count.</p>"


def test_the_images_of_answers_are_in_the_bank(questions):
    means = []
    for answer in questions["Which is darker?"].findall("answer"):
        file = answer.find("file")
        assert f"@@PLUGINFILE@@/{file.get('name')}" in answer.findtext("text")
        means.append(np.mean(web.decode_picture(base64.b64decode(file.text))))
    assert means == pytest.approx([20, 200])


def test_questions_have_names_of_their_own_that_do_not_depend_on_their_order(questions):
    names = [element.findtext("idnumber") for element in questions.values()]
    assert len(set(names)) == len(names)
    assert all(name.startswith("hdrlab-my_lesson-cell-") for name in names)


def test_the_page_to_print_has_all_questions_before_the_first_answer(folder):
    page = (folder / "bank.html").read_text("utf-8")
    questions_page, _, answers = page.partition("<h1>Answers</h1>")
    for text in ("Sky or &lt;wall&gt;?", "How many stops?", "Which is darker?"):
        assert text in questions_page and text not in answers
    assert "b) the wall. It is lit." in answers and "11.4 stops. Count." in answers
    assert not re.search(r"(?:src|href)=\"(?!data:)", page)


def test_a_bank_in_another_format_is_refused_before_notebooks_run(tmp_path, capsys):
    with pytest.raises(SystemExit):
        cli.run(["course", "questions", "04", "-o", str(tmp_path / "bank.pdf")])
    assert ".xml" in capsys.readouterr().err
    assert list(Path(tmp_path).iterdir()) == []
