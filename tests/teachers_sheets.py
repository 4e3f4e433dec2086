"""Teacher's sheets: one page about each notebook, for an instructor who has an hour before the class.

    python tests/teachers_sheets.py     # writes minutes and prerequisites into the sheets

The course plan says how many minutes a notebook takes and what to read before it. A sheet divides
these minutes among its rows in proportion to the minutes of their sections (see `timetable`).
"""

import json
import re
from dataclasses import dataclass
from functools import cache

import timetable

PAGES = timetable.PAGE.parent
FOLDER = PAGES / "teachers_sheets"
INDEX = PAGES / "teachers_sheets.md"
TOP = re.compile(r"^\d+ minutes, with \[notebook (\d\d)\]\(.*$", re.M)
ROW = re.compile(r"^\| (\d+) \| (“[^|]+) \|(.*)\|$", re.M)
SKIP = re.compile(r"^Leave out ((?:“[^”]+”(?:, | and )?)+) \((\d+) minutes?\)", re.M)
EXERCISE = re.compile(r"^- \*\*(Easy|Medium|Hard)\*\*, (\d+) minutes: exercise (\d)", re.M)
PREDICTION = re.compile(r"^\*\*“(.+?)”\*\* \*“(.+?)”\*", re.M | re.S)
QUOTED = re.compile(r"“([^”]+)”")
NOT_QUOTED_HEADINGS = {"Exercises"}  # they share a cell with the section before them


@dataclass(frozen=True)
class Section:
    """A section of a notebook: its heading, its minutes by the rule of the course plan, and its code."""

    heading: str
    minutes: float
    code: str


def sheets():
    """Return the path of each sheet by the name of its notebook."""
    return {path.stem: path for path in sorted(FOLDER.glob("*.md"))}


def notebook_path(name):
    return timetable.ROOT / "notebooks" / f"{name}.ipynb"


@cache
def cells_of(name):
    return json.loads(notebook_path(name).read_text(encoding="utf8"))["cells"]


@cache
def sections(name):
    """Return the sections of a notebook; the text before the first one belongs to the first one."""
    minutes = timetable.sections(notebook_path(name))
    code = dict.fromkeys(minutes, "")
    heading = ""
    for cell in cells_of(name):
        text = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            heading = next(iter(re.findall(r"^## (.+)$", text, re.M)), heading)
        else:
            code[heading] += text + "\n"
    start, *headings = minutes
    first = headings[0]
    minutes[first] += minutes[start]
    return [
        Section(heading=heading, minutes=minutes[heading], code=code[heading])
        for heading in headings
        if heading not in NOT_QUOTED_HEADINGS
    ]


@cache
def plan_rows():
    """Return what to read before a notebook, and its minutes, by the name of the notebook."""
    page = timetable.PAGE.read_text(encoding="utf8")
    rows = re.findall(timetable.NOTEBOOK, page, re.M)
    return {name: (before.strip(), int(minutes)) for _, name, before, minutes in rows}


def sections_of_row(quotes, name):
    """Return the sections of “One”, or of “One” to “Another”.

    Raises
    ------
    ValueError
        If a section is not in the notebook.
    """
    every = sections(name)
    headings = [section.heading for section in every]
    first, *last = QUOTED.findall(quotes)
    start = headings.index(first)
    end = headings.index(last[0]) if last else start
    return every[start : end + 1]


def divide(total, shares):
    """Return whole minutes that add up to a total, in proportion to shares, and at least 1 each."""
    exact = [total * share / sum(shares) for share in shares]
    whole = [max(1, int(minutes)) for minutes in exact]
    by_rest = sorted(range(len(exact)), key=lambda k: whole[k] - exact[k])
    for k in by_rest[: total - sum(whole)]:
        whole[k] += 1
    return whole


def with_minutes(text, name):
    """Return a sheet with its minutes, and with what to read before, as the course plan has them."""
    before, total = plan_rows()[name]
    rows = ROW.findall(text)
    shares = [
        sum(section.minutes for section in sections_of_row(quotes, name)) for _, quotes, _ in rows
    ]
    minutes = iter(divide(total, shares))
    scale = total / sum(shares)
    by_heading = {section.heading: section.minutes for section in sections(name)}

    def skip(found):
        saved = sum(by_heading[heading] for heading in QUOTED.findall(found[1])) * scale
        saved = max(1, round(saved))
        return f"Leave out {found[1]} ({saved} minute{'s' * (saved > 1)})"

    link = f"[notebook {name[:2]}](../notebooks/{name}.ipynb)"
    text = TOP.sub(f"{total} minutes, with {link}. Read before: {before}.", text)
    text = ROW.sub(lambda row: f"| {next(minutes)} | {row[2]} |{row[3]}|", text)
    return SKIP.sub(skip, text)


if __name__ == "__main__":
    for name, path in sheets().items():
        path.write_text(with_minutes(path.read_text(encoding="utf8"), name), encoding="utf8")
