"""How long notebooks and tasks take, by a rule, and the page that says so.

    python tests/timetable.py     # writes the minutes into the site's course.md, and makes COURSE.md of it

A notebook: a minute for every 160 words, one for each question, one for each cell that draws. A
task: ten minutes, and three for each line of code that the library's own function needs. No class
has been timed.
"""

import json
import math
import re
import tomllib
from functools import cache

import distance

ROOT = distance.ROOT
PAGE = ROOT / "hdrlab/course/site/pages/course.md"
COPY = ROOT / "COURSE.md"  # the same, with links that lead on from the top of the repository
WORDS_A_MINUTE = 160
# minutes
QUESTION, PICTURE, SHEET, CODE_LINE, STEP = 1, 1, 10, 3, 5
DRAWS = re.compile(r"pictures\.|widgets\.")
ASKS = re.compile(r"\*\*(?:Predict|Think)\.\*\*")
NOTEBOOK = r"^\| \[(\d\d · [^\]]+)\]\(notebooks/(\w+)\.ipynb\) \|(.*)\| (\d+) \|$"
TASK = r"^\| (\w+) \| `(\w+)` \|(.*)\| (\d+) \| (\d+) \|$"
WEEK = r"^\| (\d+) \| ([\d, ]+) \| (\d+) \| (.*?) \| (\d+) \|$"
PART = r"^\| (\d\d) \| (“.*) \| (\d+) \|$"


def rounded(minutes):
    return max(STEP, STEP * round(minutes / STEP))


def sections(path):
    """Return the minutes of each section of a notebook by its heading; what stands before the first is ''."""
    found, heading = {"": 0.0}, ""
    for cell in json.loads(path.read_text(encoding="utf8"))["cells"]:
        text = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            heading = next(iter(re.findall(r"^## (.+)$", text, re.M)), heading)
            minutes = len(text.split()) / WORDS_A_MINUTE + QUESTION * len(ASKS.findall(text))
        else:
            minutes = PICTURE * bool(DRAWS.search(text))
        found[heading] = found.get(heading, 0.0) + minutes
    return found


def notebooks():
    """Return title and minutes of each notebook by name."""
    found = {}
    for path in sorted((ROOT / "notebooks").glob("*.ipynb")):
        title = re.search(r'"# (\d\d · .+?)(?:\\n)?"', path.read_text(encoding="utf8"))[1]
        found[path.stem] = title, rounded(sum(sections(path).values()))
    return found


def plan_of_the_course():
    """Return the tables of the plan: the homeworks, the project and the rule for late days."""
    plan = tomllib.loads((ROOT / "hdrlab/course/plan.toml").read_text(encoding="utf8"))
    return {name: table for name, table in plan.items() if isinstance(table, dict)}


@cache
def tasks():
    """Return homework, points and minutes of each task by id."""
    library, plan = distance.read(), plan_of_the_course()
    found = {}
    for name, homework in plan.items():
        for task in homework.get("tasks", []):
            lines = library.distance(f"hdrlab.{task['function']}")[1]
            found[task["id"]] = name, task["points"], rounded(SHEET + CODE_LINE * lines)
    return found


def part(number, headings):
    """Return the minutes of a notebook's beginning and of the sections whose headings are quoted."""
    each = sections(next((ROOT / "notebooks").glob(f"{number}_*.ipynb")))
    return rounded(sum(each[name] for name in ["", *re.findall(r"“([^”]+)”", headings)]))


def with_minutes(text):
    """Return the page with the minutes of its tables as the rule gives them."""
    books, each = notebooks(), tasks()

    def book(row):
        return f"| [{row[1]}](notebooks/{row[2]}.ipynb) |{row[3]}| {books[row[2]][1]} |"

    def task(row):
        return f"| {row[1]} | `{row[2]}` |{row[3]}| {each[row[2]][1]} | {each[row[2]][2]} |"

    weeks = re.findall(WEEK, text, re.M)

    def week(row):
        minutes = sum(time for title, time in books.values() if title[:2] in row[2].split(", "))
        sheet = row[4][:3]
        share = sum(one[3].startswith(sheet) for one in weeks)
        asked = [(points, minutes) for name, points, minutes in each.values() if name == sheet]
        whole = sum(points for points, _ in asked)
        counted = (
            plan_of_the_course().get(sheet, {}).get("at_most", whole)
        )  # of what there is to choose from
        hours = math.ceil(
            sum(minutes for _, minutes in asked) * counted / max(whole, 1) / 60 / share
        )
        also = sum(map(int, re.findall(r"(\d+) hours", row[4])))  # of what is no task
        return f"| {row[1]} | {row[2]} | {minutes} | {row[4]} | {hours + also or row[5]} |"

    text = re.sub(WEEK, week, text, flags=re.M)
    text = re.sub(NOTEBOOK, book, text, flags=re.M)
    text = re.sub(TASK, task, text, flags=re.M)
    return re.sub(
        PART, lambda row: f"| {row[1]} | {row[2]} | {part(row[1], row[2])} |", text, flags=re.M
    )


def copy_of(text):
    """Return the page with links from the top of the repository."""
    return re.sub(r"\]\((\w+\.md)", r"](hdrlab/course/site/pages/\1", text)


if __name__ == "__main__":
    page = with_minutes(PAGE.read_text(encoding="utf8"))
    PAGE.write_text(page, encoding="utf8")
    COPY.write_text(copy_of(page), encoding="utf8")
