"""Every method of the papers is in the library and in a notebook, and the page about it is up to date."""

import re

import pytest

from hdrlab.course.site import reference
from tools import course_minutes, methods_page

pytestmark = [
    pytest.mark.grading,
    pytest.mark.skipif(
        not course_minutes.COPY.exists(), reason="reads a clone, and this is an installed package"
    ),
]
METHODS = methods_page.read_methods()
for_each_method = pytest.mark.parametrize("method", METHODS, ids=lambda method: method.name)


def test_the_page_of_methods_equals_the_one_generated_from_the_table():
    page = methods_page.PAGE.read_text(encoding="utf8")
    assert page == methods_page.write_page(), "run python -m tools.methods_page"


def test_the_table_has_44_methods_of_five_sources_and_ten_newer_ones_with_distinct_names():
    assert len(METHODS) == 54
    assert len({method.name for method in METHODS}) == len(METHODS)
    sources = {letter for method in METHODS for letter in method.sources}
    assert sources == set(methods_page.SOURCES)


def is_part_of_course(method):
    """Return whether a method is about running a course, which the reference of lessons leaves out."""
    return method.functions[0].startswith("course.")


@for_each_method
def test_every_method_of_the_table_is_in_the_library(method):
    for name in method.functions:
        module, function = methods_page.find_function(name)
        assert function is module or callable(function), name
        is_in_reference = module.__name__ in reference.list_modules()
        assert is_in_reference or module.__name__.startswith("hdrlab.course"), name


@for_each_method
def test_the_notebook_sections_of_a_method_use_it_and_show_something(method):
    assert method.sections
    if is_part_of_course(method):
        return
    code = ""
    for section in method.sections:
        section_code = methods_page.section_code(section)
        shows_something = course_minutes.DRAWS.search(section_code) or "print" in section_code
        assert shows_something, section.heading
        code += section_code
    names = {part for name in method.functions for part in name.split(".")[-2:]}
    assert names & set(re.findall(r"\w+", code)), "these sections use none of its functions"


@for_each_method
def test_the_tasks_of_a_method_are_in_the_course_plan_and_grade_its_functions(method):
    task_functions = {
        task["id"]: task["function"]
        for table in course_minutes.read_course_tables().values()
        for task in table.get("tasks", [])
    }
    modules = {methods_page.find_function(name)[0].__name__ for name in method.functions}
    for task in method.tasks:
        module = f"hdrlab.{task_functions[task]}".rpartition(".")[0]
        assert module in modules or is_part_of_course(method), task


def test_every_task_grades_a_method_of_the_table():
    graded = {task for method in METHODS for task in method.tasks}
    assert graded == set(course_minutes.plan_tasks())


def test_the_course_plan_and_the_first_page_link_to_the_page_of_methods():
    for page in (course_minutes.PAGE, methods_page.PAGE.with_name("index.md")):
        assert "](systems.md)" in page.read_text(encoding="utf8")
