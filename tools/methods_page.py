"""Write the page of the site that lists all methods: their functions, notebook sections and tasks.

    python -m tools.methods_page

The table is tools/methods.txt. A row has five columns, separated by `|`: the name of the method, the
letters of its sources, the functions or modules of hdrlab, the notebook sections that step through it
("04: The equation; Smoothness"), and the tasks that grade it. tests/course/test_methods_page.py
checks that all of them exist.
"""

import importlib
import json
import re
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

from hdrlab.course.site import reference
from tools import course_minutes

PAGE = course_minutes.ROOT / "hdrlab/course/site/pages/systems.md"
TABLE = Path(__file__).with_name("methods.txt")
SOURCES = {
    "M": "Mitsunaga and Nayar 1999",
    "W": "Wilburn, Xu and Matsushita 2008",
    "C": "Cerman and Hlavac 2006",
    "S": "the course's slides",
    "B": "Battiato and others 2008",
    "N": "newer than all of these",
}
INTRODUCTION = """# Methods and where to find them

The course is based on the lecture's slides and four papers. The table lists all of their methods and
ten newer ones. For each method, it links the functions of the library, the notebook sections that
step through the method, and the tasks in which students implement it. The letters name the source: """
# the pages for instructors that explain parts of the course, which the reference leaves out
COURSE_PAGES = {
    "course.plan": "homework.md",
    "course.classroom": "grading.md",
    "course.projects": "vote.md",
    "course.gallery": "vote.md",
}


@dataclass(frozen=True)
class Section:
    """A section of a notebook: the notebook's number ("04") and the heading."""

    notebook: str
    heading: str


@dataclass(frozen=True)
class Method:
    """A row of the table.

    Attributes
    ----------
    name : what the method is called
    sources : the letters of the papers that describe it
    functions : functions or modules of hdrlab, without "hdrlab."
    sections : the notebook sections that step through it
    tasks : the ids of the tasks that grade it
    """

    name: str
    sources: tuple[str, ...]
    functions: tuple[str, ...]
    sections: tuple[Section, ...]
    tasks: tuple[str, ...]


def read_methods():
    """Return the Method of each row of the table."""
    methods = []
    for line in TABLE.read_text(encoding="utf8").splitlines():
        name, sources, functions, sections, tasks = (part.strip() for part in line.split("|"))
        methods.append(
            Method(
                name=name,
                sources=tuple(sources.split()),
                functions=tuple(functions.split(", ")),
                sections=parse_sections(sections),
                tasks=tuple(tasks.split(", ")) if tasks else (),
            )
        )
    return methods


def parse_sections(text):
    """Return the sections of "04: One; Two; 05: Three"; a heading without a number keeps the last one."""
    sections = []
    number = ""
    for part in text.split("; "):
        match = re.match(r"(\d\d): (.+)", part)
        heading = part
        if match:
            number, heading = match.groups()
        sections.append(Section(number, heading))
    return tuple(sections)


def notebook_path(number):
    """Return the path of the notebook with a number."""
    (path,) = (course_minutes.ROOT / "notebooks").glob(f"{number}_*.ipynb")
    return path


def section_code(section):
    """Return the code of a notebook's section."""
    code = ""
    is_inside = False
    notebook = json.loads(notebook_path(section.notebook).read_text(encoding="utf8"))
    for cell in notebook["cells"]:
        text = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            headings = re.findall(r"^## (.+)$", text, re.M)
            if headings:
                is_inside = headings[-1] == section.heading
        elif is_inside:
            code += text + "\n"
    return code


def find_function(name):
    """Return the module that defines a function of hdrlab, and the function; a module is both."""
    try:
        module = importlib.import_module(f"hdrlab.{name}")
    except ModuleNotFoundError:
        module_name, _, attribute = name.rpartition(".")
        module = importlib.import_module(f"hdrlab.{module_name}")
        return module, getattr(module, attribute)
    return module, module


def link_function(name, reference_modules):
    """Return a Markdown link to the page that documents a function."""
    module: ModuleType = find_function(name)[0]
    if module.__name__ in reference_modules:
        page = f"reference/{reference.short(module.__name__)}.rst"
    else:
        page = COURSE_PAGES[name]
    return f"[`{name}`]({page})"


def link_sections(sections):
    """Return Markdown links to the notebooks, each with its headings."""
    headings = {}
    for section in sections:
        headings.setdefault(section.notebook, []).append(f"“{section.heading}”")
    links = []
    for number, quoted in headings.items():
        links.append(f"[{number}](notebooks/{notebook_path(number).name}): {', '.join(quoted)}")
    return "; ".join(links)


def write_page():
    """Return the text of the page."""
    planned_tasks = course_minutes.plan_tasks()
    reference_modules = reference.list_modules()
    legend = "; ".join(f"{letter}, {source}" for letter, source in SOURCES.items())
    lines = [
        f"{INTRODUCTION}{legend}.",
        "",
        "| method | library | notebook sections | tasks |",
        "|---|---|---|---|",
    ]
    for number, method in enumerate(read_methods(), 1):
        functions = [link_function(name, reference_modules) for name in method.functions]
        sheets = [planned_tasks[task].assignment for task in method.tasks]
        tasks = [
            f"[`{task}`](assignments/{sheet}.ipynb)"
            for task, sheet in zip(method.tasks, sheets, strict=True)
        ]
        cells = [
            f"{number} {method.name} ({', '.join(method.sources)})",
            ", ".join(functions),
            link_sections(method.sections),
            ", ".join(tasks),
        ]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(write_page(), encoding="utf8")
