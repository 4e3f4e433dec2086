"""The teacher's sheets agree with the course plan and name what their notebooks contain."""

import re
from functools import cache

import nbformat
import pytest

from tools import course_minutes, teachers_sheets

pytestmark = pytest.mark.skipif(
    not course_minutes.COPY.exists(), reason="reads a clone, and this is an installed package"
)
MAX_WORDS = 500  # about one printed page; the tests in a browser print it
# minutes of an exercise by its difficulty; on average the ten minutes of the course plan
MINUTES = {"Easy": 5, "Medium": 10, "Hard": 15}
HEADINGS = [
    "Two wrong predictions",
    "If time is short",
    "On the board",
    "Exercises",
    "To end the hour",
]
LIBRARY_NAME = re.compile(r"`(\w+)`")
# numbers of a sheet that its notebook does not state, with the reason
OWN_NUMBERS = {
    "13_files": {
        "1000": "a pixel to encode at the end",
        "4": "1024 / 256, a step of its mantissas",
    },
}


@pytest.fixture(params=sorted(teachers_sheets.sheet_paths()))
def name(request):
    return request.param


@pytest.fixture
def text(name):
    return teachers_sheets.sheet_paths()[name].read_text(encoding="utf8")


def part(text, heading):
    return text.split(f"\n## {heading}\n", 1)[1].split("\n## ", 1)[0]


def with_spans(before):
    """Return "14, 15, 16, 17" for "14 to 17"."""

    def span(match):
        return ", ".join(f"{k:02}" for k in range(int(match[1]), int(match[2]) + 1))

    return re.sub(r"(\d\d) to (\d\d)", span, before)


def plain(text):
    """Return the visible text of a sheet, without markup, addresses and alternative texts."""
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", "", text)
    text = re.sub(r"\]\([^)]*\)", "]", text)
    return re.sub(r"[|*#`\[\]$]|^-+$|---", " ", text)


@cache
def source(name):
    """Return the text and the code of a notebook in one line, with strings that span lines joined."""
    lines = "\n".join("".join(cell["source"]) for cell in teachers_sheets.read_cells(name))
    joined = re.sub(r'"\n\w+ \+= f?"', "", lines)
    return " ".join(joined.split())


def test_every_notebook_has_a_sheet_with_its_title_and_a_sketch():
    titles = {name: planned.title for name, planned in course_minutes.plan_notebooks().items()}
    assert sorted(teachers_sheets.sheet_paths()) == sorted(titles)
    for name, path in teachers_sheets.sheet_paths().items():
        text = path.read_text(encoding="utf8")
        assert text.startswith(f"# Teach {titles[name]}\n")
        assert re.findall(r"^## (.+)$", text, re.M) == HEADINGS, name
        alt, sketch = re.findall(r"!\[(.*)\]\((.+)\)", text)[0]
        assert len(alt) > 30 and (path.parent / sketch).exists(), name


def test_a_sheet_has_the_minutes_and_the_prerequisites_of_the_course_plan(name, text):
    assert text == teachers_sheets.with_minutes(text, name), "run python -m tools.teachers_sheets"
    total = teachers_sheets.read_plan_rows()[name][1]
    assert sum(int(minutes) for minutes, _, _ in teachers_sheets.ROW.findall(text)) == total


def test_a_sheet_expects_no_notebook_that_the_course_plan_does_not_name(name, text):
    expected = set(re.findall(r"\((\d\d)\)", text.split("**Already known:**")[1].split("\n\n")[0]))
    assert expected <= set(
        re.findall(r"\d\d", with_spans(teachers_sheets.read_plan_rows()[name][0]))
    )


def test_the_minute_plan_has_every_section_once_and_in_order(name, text):
    planned = [
        section.heading
        for _, quotes, _ in teachers_sheets.ROW.findall(text)
        for section in teachers_sheets.sections_of_row(quotes, name)
    ]
    assert planned == [section.heading for section in teachers_sheets.read_sections(name)]


def test_each_figure_that_a_row_names_is_in_its_sections(name, text):
    for _, quotes, what in teachers_sheets.ROW.findall(text):
        code = "".join(section.code for section in teachers_sheets.sections_of_row(quotes, name))
        for figure in LIBRARY_NAME.findall(what):
            assert re.search(rf"\b{figure}\b", code), f"{quotes}: no {figure}"


def test_what_to_leave_out_are_sections_of_the_notebook(name, text):
    quotes, minutes = teachers_sheets.SKIP.findall(part(text, "If time is short").strip())[0]
    headings = [section.heading for section in teachers_sheets.read_sections(name)]
    assert set(teachers_sheets.QUOTED.findall(quotes)) <= set(headings)
    assert int(minutes) < teachers_sheets.read_plan_rows()[name][1]


def test_each_wrong_prediction_answers_a_question_of_the_notebook(name, text):
    predictions = teachers_sheets.PREDICTION.findall(part(text, "Two wrong predictions"))
    assert len(predictions) == 2
    for question, _ in predictions:
        assert " ".join(question.split()) in source(name)


@pytest.mark.notebooks
def test_a_wrong_prediction_is_an_answer_that_the_notebook_offers_and_a_wrong_one(
    name, text, execute_notebook
):
    pytest.importorskip("myst_nb", reason='the questions need pip install ".[site]"')
    from hdrlab.course.question_bank.questions import ChoiceQuestion, collect_questions

    path = teachers_sheets.notebook_path(name)
    notebook = nbformat.read(execute_notebook(path).path, as_version=4)
    choices = [
        question
        for question in collect_questions(notebook, name)
        if isinstance(question, ChoiceQuestion)
    ]
    for prediction, wrong in teachers_sheets.PREDICTION.findall(
        part(text, "Two wrong predictions")
    ):
        for question in choices:
            if " ".join(prediction.split()) in question.text:
                assert wrong in question.labels
                assert wrong != question.labels[question.right]


def test_the_exercises_are_those_of_the_notebook_and_take_ten_minutes_on_average(name, text):
    listed = teachers_sheets.EXERCISE.findall(part(text, "Exercises"))
    last = "".join(teachers_sheets.read_cells(name)[-1]["source"]).split("## Exercises")[1]
    assert sorted(number for _, _, number in listed) == re.findall(r"^(\d)\. ", last, re.M)
    assert {kind: int(minutes) for kind, minutes, _ in listed} == MINUTES


def test_each_number_of_a_sheet_is_in_its_notebook(name, text):
    text = re.sub(r"^\| \d+ \|", "", text, flags=re.M)
    text = teachers_sheets.EXERCISE.sub(
        "", teachers_sheets.SKIP.sub("", teachers_sheets.TOP.sub("", text))
    )
    text = re.sub(
        r"(?:notebooks?|homework) \d+(?: to \d+)?|\(\d\d[^)]*\)|^# .*$", "", text, flags=re.M
    )
    numbers = re.findall(r"(?<![\w.])\d[\d.,]*\d|(?<![\w.])\d", plain(text))
    known = re.sub(r"(?<=\d)[_\s\\,]+(?=\d{3}\b)", "", source(name))
    for number in numbers:
        digits = number.replace(",", "")
        if digits not in OWN_NUMBERS.get(name, {}):
            assert re.search(rf"(?<![\d.]){re.escape(digits)}(?![\d])", known), number


def test_a_sheet_is_short_enough_for_one_page(name, text):
    assert len(plain(text).split()) <= MAX_WORDS


def test_the_guides_for_instructors_lead_to_the_sheets():
    for page in ("teaching.md", "instructors.md", "course.md", "index.md"):
        assert "](teachers_sheets.md)" in (teachers_sheets.PAGES / page).read_text(encoding="utf8")
    assert "teachers_sheets/*" in teachers_sheets.INDEX.read_text(encoding="utf8")
