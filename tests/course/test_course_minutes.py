"""The course plan lists all notebooks and tasks with their minutes, in an order that can be taught."""

import json
import re

import pytest

from tools import course_minutes

pytestmark = pytest.mark.skipif(
    not course_minutes.COPY.exists(), reason="reads a clone, and this is an installed package"
)


@pytest.fixture(scope="module")
def page():
    return course_minutes.PAGE.read_text(encoding="utf8")


def rows(pattern, page):
    return re.findall(pattern, page, re.M)


def numbers(text):
    """Return the notebooks of a cell: "14 to 17", "04, 22"."""
    spans = re.findall(r"(\d\d) to (\d\d)", text)
    between = {f"{k:02}" for first, last in spans for k in range(int(first), int(last) + 1)}
    return between | set(re.findall(r"\b\d\d\b", text))


def prerequisites(page):
    """Return the notebooks that each notebook builds on."""
    return {
        title[:2]: numbers(needs) for title, _, needs, _ in rows(course_minutes.NOTEBOOK_ROW, page)
    }


def section(page, heading):
    return page.split(f"\n## {heading}\n", 1)[1].split("\n## ", 1)[0]


def test_the_course_plan_lists_every_notebook_by_its_title(page):
    listed = {name: title for title, name, _, _ in rows(course_minutes.NOTEBOOK_ROW, page)}
    assert listed == {
        name: planned.title for name, planned in course_minutes.plan_notebooks().items()
    }


def test_a_notebook_begins_with_its_minutes_its_prerequisites_and_what_the_reader_can_do_afterwards(
    page,
):
    for _, name, needs, minutes in rows(course_minutes.NOTEBOOK_ROW, page):
        notebook = json.loads(
            (course_minutes.ROOT / "notebooks" / f"{name}.ipynb").read_text(encoding="utf8")
        )
        sentence = "".join(notebook["cells"][0]["source"]).split("\n\n")[1].replace("\n", " ")
        begin, what = sentence.split(". Afterwards you can ")
        time, _, after = begin.partition(" minutes")
        assert time == f"*{minutes}" and numbers(after) == numbers(needs), name
        assert len(what) > 20 and what.endswith(".*"), name


def test_the_first_page_has_every_notebook_in_one_chapter_with_a_picture(page):
    first = course_minutes.PAGE.with_name("index.md").read_text(encoding="utf8")
    listed = re.findall(r'"(\d\d_\w+)"', first)
    assert sorted(listed) == sorted(course_minutes.plan_notebooks())
    cards = course_minutes.PAGE.parents[1] / "theme" / "static" / "cards"
    assert sorted(listed) == sorted(card.stem for card in cards.iterdir())


@pytest.mark.grading
def test_the_course_plan_lists_every_task_with_its_points(page):
    listed = [
        (sheet, name, int(points))
        for sheet, name, _, points, _ in rows(course_minutes.TASK_ROW, page)
    ]
    assert listed == [
        (task.assignment, name, task.points) for name, task in course_minutes.plan_tasks().items()
    ]


def test_the_minutes_in_the_course_plan_follow_the_rule_within_ten_minutes(page):
    numbers = list(map(int, re.findall(r"\d+", page)))
    counted = list(map(int, re.findall(r"\d+", course_minutes.with_minutes(page))))
    far = [pair for pair in zip(numbers, counted, strict=True) if abs(pair[0] - pair[1]) > 10]
    assert not far, "run python -m tools.course_minutes"


def test_the_copy_of_the_course_plan_is_up_to_date(page):
    assert course_minutes.COPY.read_text(encoding="utf8") == course_minutes.with_links_from_root(
        page
    ), "run python -m tools.course_minutes"


def test_the_links_of_the_copy_lead_to_existing_files():
    links = re.findall(r"\]\(([^)#]+)\)", course_minutes.COPY.read_text(encoding="utf8"))
    assert len(links) > 23
    assert not [link for link in links if not (course_minutes.ROOT / link).exists()]


def test_the_semester_has_every_notebook_once_after_those_it_builds_on(page):
    weeks = [sorted(numbers(row[1])) for row in rows(course_minutes.WEEK_ROW, page)]
    taught = [number for week in weeks for number in week]
    needs = prerequisites(page)
    assert sorted(taught) == sorted(needs)
    for number, earlier in needs.items():
        late = [notebook for notebook in earlier if taught.index(notebook) > taught.index(number)]
        assert not late, f"{number} builds on {late}"


def test_no_week_of_the_semester_takes_more_than_its_two_hours(page):
    assert all(int(minutes) <= 120 for _, _, minutes, _, _ in rows(course_minutes.WEEK_ROW, page))


def test_a_homework_is_due_in_its_week_and_after_the_notebooks_that_explain_it(page):
    weeks = rows(course_minutes.WEEK_ROW, page)
    explained = rows(course_minutes.TASK_ROW, page)
    for name, homework in course_minutes.read_course_tables().items():
        if name != "late":
            week = homework["due"]["week"]
            assert f"{name}, due" in weeks[week - 1][3], name
            taught = {number for row in weeks[:week] for number in numbers(row[1])}
            assert {
                notebook.strip() for sheet, _, notebook, _, _ in explained if sheet == name
            } <= taught


def test_the_lab_and_the_project_include_all_prerequisites_of_their_notebooks(page):
    needs = prerequisites(page)
    lab = [number for number, _, _ in rows(course_minutes.LAB_ROW, page)]
    project = [
        part
        for row in rows(r"^\| \d \| ([\d, ]+) \| [^|]+ \|$", section(page, "Three weeks"))
        for part in row.split(", ")
    ]
    assert lab == ["00", "04", "10", "16"] and project == ["00", "03", "04", "10", "14", "16"]
    for path in (lab, project):
        for number in path:
            assert needs[number] - {"22"} <= set(path[: path.index(number)])


def test_the_lab_fits_two_hours_and_states_the_minutes_left(page):
    taken = sum(int(minutes) for _, _, minutes in rows(course_minutes.LAB_ROW, page))
    assert f"That leaves {120 - taken} minutes" in page and taken <= 110


def test_reading_a_question_and_a_figure_take_a_minute_each(tmp_path):
    words = {
        "cell_type": "markdown",
        "source": ["## One\n", "word " * (2 * course_minutes.WORDS_PER_MINUTE - 2)],
    }
    questions = {
        "cell_type": "markdown",
        "source": ["**Predict.** " + "word " * (course_minutes.WORDS_PER_MINUTE - 1)],
    }
    drawn = {"cell_type": "code", "source": ["pictures.picture(x)"]}
    path = tmp_path / "x.ipynb"
    path.write_text(json.dumps({"cells": [words, questions, drawn]}), encoding="utf8")
    assert course_minutes.section_minutes(path) == {"": 0, "One": 2 + 2 + 1}


def test_the_first_notebook_links_to_the_others_by_their_titles():
    cells = json.loads(
        (course_minutes.ROOT / "notebooks/00_welcome.ipynb").read_text(encoding="utf8")
    )["cells"]
    text = "\n".join("".join(cell["source"]) for cell in cells)
    named = {
        name: title
        for title, name in re.findall(r"\| \[(\d\d · [^\]]+)\]\((\w+)\.ipynb\) \|", text)
    }
    titles = {name: planned.title for name, planned in course_minutes.plan_notebooks().items()}
    assert named == {name: title for name, title in titles.items() if name != "00_welcome"}


def test_no_page_points_to_a_slide_that_its_reader_does_not_have():
    """A sentence of a lesson must be clear by itself: it names the paper, not a slide or an overview."""
    pointed = re.compile(
        r"\b(?:the|on the|a) slides?(?:'s|')?\b(?! the edge)|\bthe overview\b|[Ll]ecture 21", re.I
    )
    pointers = []
    for path in sorted((course_minutes.ROOT / "notebooks").glob("*.ipynb")):
        for cell in json.loads(path.read_text(encoding="utf8"))["cells"]:
            if cell["cell_type"] == "markdown":
                pointers += [
                    f"{path.stem}: {match[0]}"
                    for match in pointed.finditer(" ".join("".join(cell["source"]).split()))
                ]
    assert not pointers
