"""Each system of the papers: where it is in the library, in a notebook and in a graded task.

    python tests/systems.py     # writes the site's systems.md

A row of tests/systems.txt: what the system is called | whose it is | functions or modules of the
library | notebook: its sections that play it | tasks that grade it. tests/course/test_systems.py
looks for all of them.
"""

import importlib
import json
import re

import timetable

from hdrlab.course.site import reference

PAGE = timetable.ROOT / "hdrlab/course/site/pages/systems.md"
ROWS = timetable.ROOT / "tests/systems.txt"
PAPERS = {
    "M": "Mitsunaga and Nayar 1999",
    "W": "Wilburn, Xu and Matsushita 2008",
    "C": "Cerman and Hlavac 2006",
    "S": "the course's slides",
    "B": "Battiato and others 2008",
    "N": "newer than all of these",
}
HEAD = """# Methods and where to find them

The course is based on the lecture's slides and four papers. The table lists all of their methods and
nine newer ones. For each method, it links the functions of the library, the notebook sections that
step through the method, and the tasks in which students implement it. The letters name the source: """


def table():
    """Return a row for each system: name, papers, places in the library, (notebook, section) pairs, tasks."""
    rows = []
    for line in ROWS.read_text(encoding="utf8").splitlines():
        name, papers, places, played, tasks = (part.strip() for part in line.split("|"))
        number, sections = "", []
        for part in played.split("; "):
            found = re.match(r"(\d\d): (.+)", part)
            number, heading = found.groups() if found else (number, part)
            sections.append((number, heading))
        rows.append(
            (name, papers.split(), places.split(", "), sections, tasks.split(", ") if tasks else [])
        )
    return rows


def path_of(number):
    return next((timetable.ROOT / "notebooks").glob(f"{number}_*.ipynb"))


def code_of(number, heading):
    """Return the code of a notebook's section."""
    code, inside = "", False
    for cell in json.loads(path_of(number).read_text(encoding="utf8"))["cells"]:
        text = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            inside = next(
                (one == heading for one in reversed(re.findall(r"^## (.+)$", text, re.M))), inside
            )
        elif inside:
            code += text + "\n"
    return code


# the pages for instructors that explain parts of the course, which the reference leaves out
COURSE_PAGES = {
    "course.plan": "homework.md",
    "course.classroom": "grading.md",
    "course.projects": "vote.md",
    "course.gallery": "vote.md",
}


def find(place):
    """Return the module of a place in the library, and what the place names."""
    try:
        module = importlib.import_module(f"hdrlab.{place}")
        return module, module
    except ModuleNotFoundError:
        above, _, name = place.rpartition(".")
        module = importlib.import_module(f"hdrlab.{above}")
        return module, getattr(module, name)


def link(place, modules):
    name = find(place)[0].__name__
    page = f"reference/{reference.short(name)}.rst" if name in modules else COURSE_PAGES[place]
    return f"[`{place}`]({page})"


def written():
    """Return the page."""
    tasks, modules = timetable.tasks(), reference.list_modules()
    lines = [HEAD + "; ".join(f"{letter}, {name}" for letter, name in PAPERS.items()) + ".", ""]
    lines += ["| method | library | notebook sections | tasks |", "|---|---|---|---|"]
    for n, (name, papers, places, sections, graded) in enumerate(table(), 1):
        played = []
        for number in dict.fromkeys(number for number, _ in sections):
            each = ", ".join(f"“{heading}”" for other, heading in sections if other == number)
            played.append(f"[{number}](notebooks/{path_of(number).name}): {each}")
        checked = [f"[`{task}`](assignments/{tasks[task][0]}.ipynb)" for task in graded]
        cells = [
            ", ".join(link(place, modules) for place in places),
            "; ".join(played),
            ", ".join(checked),
        ]
        lines.append(f"| {n} {name} ({', '.join(papers)}) | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(written(), encoding="utf8")
