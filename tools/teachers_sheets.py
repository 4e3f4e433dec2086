"""Write the minutes and prerequisites of the course plan into the teacher's sheets.

    python -m tools.teachers_sheets

A teacher's sheet is a page about one notebook, for an instructor who has an hour before the class.
The course plan says how many minutes a notebook takes and what to read before it. The script divides
these minutes among the rows of a sheet, in proportion to the minutes of their sections (see
`course_minutes`).
"""

import json
import re
from dataclasses import dataclass
from functools import cache

from tools import course_minutes

PAGES = course_minutes.PAGE.parent
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


def sheet_paths():
    """Return the path of each sheet by the name of its notebook."""
    return {path.stem: path for path in sorted(FOLDER.glob("*.md"))}


def notebook_path(name):
    """Return the path of a notebook."""
    return course_minutes.ROOT / "notebooks" / f"{name}.ipynb"


@cache
def read_cells(name):
    """Return the cells of a notebook."""
    return json.loads(notebook_path(name).read_text(encoding="utf8"))["cells"]


@cache
def read_sections(name):
    """Return the sections of a notebook; the text before the first one belongs to the first one."""
    minutes = course_minutes.section_minutes(notebook_path(name))
    code = dict.fromkeys(minutes, "")
    heading = ""
    for cell in read_cells(name):
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
def read_plan_rows():
    """Return what to read before a notebook, and its minutes, by the name of the notebook."""
    page = course_minutes.PAGE.read_text(encoding="utf8")
    rows = re.findall(course_minutes.NOTEBOOK_ROW, page, re.M)
    return {name: (before.strip(), int(minutes)) for _, name, before, minutes in rows}


def sections_of_row(quotes, name):
    """Return the sections of “One”, or of “One” to “Another”.

    Raises
    ------
    ValueError
        If a section is not in the notebook.
    """
    sections = read_sections(name)
    headings = [section.heading for section in sections]
    first, *last = QUOTED.findall(quotes)
    start = headings.index(first)
    end = headings.index(last[0]) if last else start
    return sections[start : end + 1]


def divide_minutes(total, weights):
    """Return whole minutes that add up to a total, in proportion to weights, and at least 1 each."""
    exact = [total * weight / sum(weights) for weight in weights]
    whole = [max(1, int(minutes)) for minutes in exact]
    by_remainder = sorted(range(len(exact)), key=lambda k: whole[k] - exact[k])
    for k in by_remainder[: total - sum(whole)]:
        whole[k] += 1
    return whole


def with_minutes(text, name):
    """Return a sheet with the minutes and the prerequisites of the course plan."""
    prerequisites, total_minutes = read_plan_rows()[name]
    row_weights = []
    for _, quotes, _ in ROW.findall(text):
        row_weights.append(sum(section.minutes for section in sections_of_row(quotes, name)))
    row_minutes = iter(divide_minutes(total_minutes, row_weights))
    scale = total_minutes / sum(row_weights)
    minutes_by_heading = {section.heading: section.minutes for section in read_sections(name)}

    def write_skipped_sections(match):
        headings = QUOTED.findall(match[1])
        saved = max(1, round(scale * sum(minutes_by_heading[heading] for heading in headings)))
        unit = "minute" if saved == 1 else "minutes"
        return f"Leave out {match[1]} ({saved} {unit})"

    link = f"[notebook {name[:2]}](../notebooks/{name}.ipynb)"
    text = TOP.sub(f"{total_minutes} minutes, with {link}. Read before: {prerequisites}.", text)
    text = ROW.sub(lambda row: f"| {next(row_minutes)} | {row[2]} |{row[3]}|", text)
    return SKIP.sub(write_skipped_sections, text)


def main():
    """Write all sheets."""
    for name, path in sheet_paths().items():
        path.write_text(with_minutes(path.read_text(encoding="utf8"), name), encoding="utf8")


if __name__ == "__main__":
    main()
