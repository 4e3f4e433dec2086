"""Estimate how long notebooks and tasks take, and write the minutes into the course plan.

    python -m tools.course_minutes

The script writes the site's page course.md and its copy COURSE.md. No class has been timed; the
minutes follow a rule. A notebook takes a minute for every 160 words, for each question and for each
cell that draws. A task takes ten minutes, and three for each line of code that hdrlab's own function
needs.
"""

import json
import math
import re
import tomllib
from dataclasses import dataclass
from functools import cache

from tools import reading_distance

ROOT = reading_distance.ROOT
PAGE = ROOT / "hdrlab/course/site/pages/course.md"
COPY = ROOT / "COURSE.md"  # the same text, with links from the top of the repository
WORDS_PER_MINUTE = 160
MINUTES_PER_QUESTION = 1
MINUTES_PER_FIGURE = 1
MINUTES_PER_ASSIGNMENT_SHEET = 10
MINUTES_PER_CODE_LINE = 3
MINUTES_STEP = 5  # all estimates are multiples of it
DRAWS = re.compile(r"pictures\.|widgets\.")
ASKS = re.compile(r"\*\*(?:Predict|Think)\.\*\*")
NOTEBOOK_ROW = r"^\| \[(\d\d · [^\]]+)\]\(notebooks/(\w+)\.ipynb\) \|(.*)\| (\d+) \|$"
TASK_ROW = r"^\| (\w+) \| `(\w+)` \|(.*)\| (\d+) \| (\d+) \|$"
WEEK_ROW = r"^\| (\d+) \| ([\d, ]+) \| (\d+) \| (.*?) \| (\d+) \|$"
LAB_ROW = r"^\| (\d\d) \| (“.*) \| (\d+) \|$"


@dataclass(frozen=True)
class PlannedNotebook:
    """A notebook: its title and its minutes."""

    title: str
    minutes: int


@dataclass(frozen=True)
class PlannedTask:
    """A task: its assignment ("hw1"), its points and its minutes."""

    assignment: str
    points: float
    minutes: int


def round_minutes(minutes):
    """Return minutes rounded to a multiple of the step, at least one step."""
    return max(MINUTES_STEP, MINUTES_STEP * round(minutes / MINUTES_STEP))


def section_minutes(path):
    """Return the minutes of each section of a notebook by its heading; the beginning has heading ''."""
    minutes = {"": 0.0}
    heading = ""
    for cell in json.loads(path.read_text(encoding="utf8"))["cells"]:
        text = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            headings = re.findall(r"^## (.+)$", text, re.M)
            if headings:
                heading = headings[0]
            reading = len(text.split()) / WORDS_PER_MINUTE
            cell_minutes = reading + MINUTES_PER_QUESTION * len(ASKS.findall(text))
        else:
            cell_minutes = MINUTES_PER_FIGURE if DRAWS.search(text) else 0
        minutes[heading] = minutes.get(heading, 0.0) + cell_minutes
    return minutes


def plan_notebooks():
    """Return the PlannedNotebook of each notebook, by the name of its file."""
    planned = {}
    for path in sorted((ROOT / "notebooks").glob("*.ipynb")):
        title = re.search(r'"# (\d\d · .+?)(?:\\n)?"', path.read_text(encoding="utf8"))[1]
        minutes = round_minutes(sum(section_minutes(path).values()))
        planned[path.stem] = PlannedNotebook(title, minutes)
    return planned


def read_course_tables():
    """Return the tables of plan.toml: the homeworks, the project and the rule for late days."""
    plan = tomllib.loads((ROOT / "hdrlab/course/plan.toml").read_text(encoding="utf8"))
    return {name: table for name, table in plan.items() if isinstance(table, dict)}


@cache
def plan_tasks():
    """Return the PlannedTask of each task, by its id."""
    library = reading_distance.read_library()
    planned = {}
    for assignment, table in read_course_tables().items():
        for task in table.get("tasks", []):
            lines = library.distance(f"hdrlab.{task['function']}").line_count
            minutes = MINUTES_PER_ASSIGNMENT_SHEET + MINUTES_PER_CODE_LINE * lines
            planned[task["id"]] = PlannedTask(assignment, task["points"], round_minutes(minutes))
    return planned


def lab_minutes(number, quoted_headings):
    """Return the minutes of the beginning of a notebook and of some of its sections.

    Parameters
    ----------
    number : the number of the notebook, "04"
    quoted_headings : the headings of the sections, each in quotes: “One”, “Another”
    """
    (path,) = (ROOT / "notebooks").glob(f"{number}_*.ipynb")
    minutes = section_minutes(path)
    headings = ["", *re.findall(r"“([^”]+)”", quoted_headings)]
    return round_minutes(sum(minutes[heading] for heading in headings))


def homework_hours(assignment, week_count):
    """Return the hours per week of an assignment that students work on for some weeks.

    If students choose among the tasks, only the tasks that count are included.
    """
    tasks = [task for task in plan_tasks().values() if task.assignment == assignment]
    minutes = sum(task.minutes for task in tasks)
    points = sum(task.points for task in tasks)
    counted_points = read_course_tables().get(assignment, {}).get("at_most", points)
    return math.ceil(minutes * counted_points / max(points, 1) / 60 / week_count)


def with_minutes(text):
    """Return the page of the course plan with the minutes of its tables as the rule gives them."""
    notebooks = plan_notebooks()
    tasks = plan_tasks()
    weeks = re.findall(WEEK_ROW, text, re.M)

    def write_notebook_row(row):
        minutes = notebooks[row[2]].minutes
        return f"| [{row[1]}](notebooks/{row[2]}.ipynb) |{row[3]}| {minutes} |"

    def write_task_row(row):
        task = tasks[row[2]]
        return f"| {row[1]} | `{row[2]}` |{row[3]}| {task.points} | {task.minutes} |"

    def write_week_row(row):
        taught = row[2].split(", ")
        minutes = sum(book.minutes for book in notebooks.values() if book.title[:2] in taught)
        assignment = row[4][:3]
        week_count = sum(week[3].startswith(assignment) for week in weeks)
        hours = homework_hours(assignment, week_count)
        other_hours = sum(int(number) for number in re.findall(r"(\d+) hours", row[4]))
        return f"| {row[1]} | {row[2]} | {minutes} | {row[4]} | {hours + other_hours or row[5]} |"

    def write_lab_row(row):
        return f"| {row[1]} | {row[2]} | {lab_minutes(row[1], row[2])} |"

    text = re.sub(WEEK_ROW, write_week_row, text, flags=re.M)
    text = re.sub(NOTEBOOK_ROW, write_notebook_row, text, flags=re.M)
    text = re.sub(TASK_ROW, write_task_row, text, flags=re.M)
    return re.sub(LAB_ROW, write_lab_row, text, flags=re.M)


def with_links_from_root(text):
    """Return the page with links that work from the top of the repository."""
    return re.sub(r"\]\((\w+\.md)", r"](hdrlab/course/site/pages/\1", text)


def main():
    """Write the page and its copy."""
    page = with_minutes(PAGE.read_text(encoding="utf8"))
    PAGE.write_text(page, encoding="utf8")
    COPY.write_text(with_links_from_root(page), encoding="utf8")


if __name__ == "__main__":
    main()
