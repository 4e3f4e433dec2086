"""Every system of the papers is in the library and in a notebook, and the page that says so is right."""

import re

import pytest
import systems
import timetable

from hdrlab.course.site import reference

pytestmark = [
    pytest.mark.grading,
    pytest.mark.skipif(
        not timetable.COPY.exists(), reason="reads a clone, and this is an installed package"
    ),
]
each = pytest.mark.parametrize("row", systems.table(), ids=lambda row: row[0])


def test_the_page_of_systems_equals_the_one_generated_from_the_table():
    page = systems.PAGE.read_text(encoding="utf8")
    assert page == systems.written(), "run python tests/systems.py"


def test_there_are_forty_four_systems_of_five_documents_and_nine_newer_ones_each_with_a_name_of_its_own():
    rows = systems.table()
    assert len({row[0] for row in rows}) == len(rows) == 53
    assert {letter for row in rows for letter in row[1]} == set(systems.PAPERS)


@each
def test_every_system_of_the_table_is_in_the_library(row):
    for place in row[2]:
        module, thing = systems.find(place)
        assert thing is module or callable(thing), place
        assert module.__name__ in reference.list_modules() or module.__name__.startswith(
            "hdrlab.course"
        ), place


@each
def test_the_sections_of_a_notebook_play_it_step_by_step(row):
    assert row[3]
    if row[2][0].startswith("course."):
        return
    words = {part for place in row[2] for part in place.split(".")[-2:]}
    code = ""
    for number, heading in row[3]:
        section = systems.code_of(number, heading)
        assert timetable.DRAWS.search(section) or "print" in section, heading
        code += section
    assert words & set(re.findall(r"\w+", code)), "none of the functions stands in these sections"


@each
def test_the_tasks_that_grade_it_are_in_the_plan_and_are_functions_of_it(row):
    plan = {
        task["id"]: task["function"]
        for one in timetable.plan_of_the_course().values()
        for task in one.get("tasks", [])
    }
    modules = {systems.find(place)[0].__name__ for place in row[2]}
    for task in row[4]:
        assert f"hdrlab.{plan[task]}".rpartition(".")[0] in modules or row[2][0].startswith(
            "course."
        ), task


def test_every_task_grades_one_of_the_systems():
    graded = {task for row in systems.table() for task in row[4]}
    assert graded == set(timetable.tasks())


def test_the_planned_course_and_the_first_page_lead_to_it():
    for page in (timetable.PAGE, systems.PAGE.with_name("index.md")):
        assert "](systems.md)" in page.read_text(encoding="utf8")
