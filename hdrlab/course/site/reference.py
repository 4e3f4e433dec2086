"""Generate the reference: a page for each module, and the map from the lecture to the modules.

Docstrings of modules are written for readers of the code, with legends in columns and formulas with
* and |. `format_docstring` converts them to reStructuredText for Sphinx.
"""

import inspect
import pkgutil
import re
from collections.abc import Iterable, Iterator, Sequence
from importlib import import_module
from itertools import groupby, takewhile
from pathlib import Path

import hdrlab
from hdrlab.course.source_code import names
from hdrlab.show.pages.templates import templates

EXCLUDED_MODULES = (
    "hdrlab.cli",
    "hdrlab.course",
    "hdrlab.__main__",
    "hdrlab.demo",
    "hdrlab.scenes.",
)
TEMPLATE_FOLDER = Path(__file__).parent / "rst"
# An entry of a legend: a letter or name, two spaces or more, and its meaning.
LEGEND_ENTRY = re.compile(r"(\S+(?: \S+)*?) {2,}(\S.*)")
DOTTED_NAME = re.compile(r"\b[a-z_]+(?:\.[a-z_0-9]+)+\b|^pipeline\b")
# Lines of numpydoc sections (underlines) and of keyword parameters, which stay as they are.
NUMPYDOC_LINE = re.compile(r"\s*[-=]+|\*+\w+.*")
DOCTEST_PROMPT = ">>> "
# The lecture's name of a topic, links to functions, and the notebooks that use them.
MapRow = tuple[str, str, list[str]]


def list_modules() -> list[str]:
    """Return the names of the library's modules, packages before their modules."""
    modules = pkgutil.walk_packages(hdrlab.__path__, "hdrlab.")
    names_of_modules = [module.name for module in modules]
    return sorted(name for name in names_of_modules if not name.startswith(EXCLUDED_MODULES))


def summary(name: str) -> str:
    """Return the first paragraph of a module's docstring, in one line."""
    docstring = import_module(name).__doc__ or ""
    first_paragraph = docstring.split("\n\n")[0]
    return " ".join(first_paragraph.split())


def find_imports(sources: Iterable[str], known: Sequence[str]) -> set[str]:
    """Return the modules in `known` that the cells of a notebook import."""
    imports: set[str] = set()
    for source in sources:
        imports |= names.modules(source)
    return imports & set(known)


def pages(titles: dict[str, str], uses: dict[str, set[str]]) -> Iterator[tuple[str, str]]:
    """Yield the name and the text of each page of the reference.

    Parameters
    ----------
    titles : name of a notebook -> its title
    uses : name of a notebook -> the modules that it imports
    """
    known = list_modules()
    environment = templates(TEMPLATE_FOLDER)
    environment.filters |= {"short": short, "summary": summary, "escaped": escape_markup}
    chapters = [name for name in known if name.count(".") == 1]
    index_template = environment.get_template("chapters.rst")
    yield "reference/index.rst", index_template.render(chapters=chapters)
    module_template = environment.get_template("module.rst")
    for name in known:
        notebooks = [notebook for notebook in titles if name in uses[notebook]]
        parts = [module for module in known if module.startswith(f"{name}.")]
        page = module_template.render(name=name, parts=parts, played=notebooks)
        yield f"reference/{short(name)}.rst", page
    map_rows = [_make_row(lecture, where, known, uses) for lecture, where in read_lecture_map()]
    yield "map.rst", environment.get_template("map.rst").render(rows=map_rows)


def short(name: str) -> str:
    """Return a module's name without the package, as in the lecture's map."""
    return name.removeprefix("hdrlab.")


def read_lecture_map() -> list[tuple[str, str]]:
    """Return the table in the package's docstring: the lecture's topics, and their functions.

    Examples
    --------
    >>> dict(read_lecture_map())["Base and detail"]
    'tonemap.durand.tonemap, core.filters.bilateral'
    """
    lines = (hdrlab.__doc__ or "").splitlines()
    first_ruler = next(index for index, line in enumerate(lines) if line.startswith("---"))
    column = lines[first_ruler].index(" -") + 1
    table = takewhile(bool, lines[first_ruler + 1 :])
    # A second ruler separates the topics beyond the course.
    rows = [line for line in table if not line.startswith("---")]
    return [(row[:column].strip(), row[column:].strip()) for row in rows]


def _make_row(lecture: str, where: str, known: Sequence[str], uses: dict[str, set[str]]) -> MapRow:
    """Return a row of the map, with links to the functions and the notebooks that use them."""
    linked = DOTTED_NAME.sub(_link, where)
    modules = set()
    for word in DOTTED_NAME.findall(where):
        name = f"hdrlab.{word}"
        modules.add(name if name in known else name.rpartition(".")[0])
    notebooks = [notebook for notebook in uses if modules & uses[notebook]]
    return lecture, linked, notebooks


def _link(match: re.Match[str]) -> str:
    """Return a link to the function or module that a word of the map names."""
    word = match[0]
    module, _, name = f"hdrlab.{word}".rpartition(".")
    target = getattr(import_module(module), name, None)
    # The reference lists a function under the module that defines it.
    home = target.__module__ if inspect.isfunction(target) else module
    return f":py:obj:`{word} <{home}.{name}>`"


def escape_markup(line: str) -> str:
    r"""Escape the characters of a docstring's line that Sphinx would read as markup.

    Examples
    --------
    >>> print(escape_markup("2 * |a| of `b`, and *knobs"))
    2 \* \|a\| of `b`, and \*knobs
    """
    parts = line.split("`")
    # Parts with odd numbers are inside of backquotes.
    for k in range(0, len(parts), 2):
        parts[k] = re.sub(r"([\\*|])", r"\\\1", parts[k])
        parts[k] = re.sub(r"(?<=\w)_(?!\w)", r"\\_", parts[k])
    return "`".join(parts)


def format_docstring(lines: Sequence[str], *, module: bool) -> list[str]:
    """Return a docstring as reStructuredText; legends of modules become lists."""
    text: list[str] = []
    for is_text, group in groupby(lines, lambda line: bool(line.strip())):
        if not is_text:
            continue
        block = list(group)
        if any(line.lstrip().startswith(DOCTEST_PROMPT) for line in block):
            text += block
        elif module and _is_legend(block):
            text += _format_legend(block)
        else:
            for line in block:
                text.append(line if NUMPYDOC_LINE.fullmatch(line) else escape_markup(line))
        text.append("")
    return text


def _is_legend(block: Sequence[str]) -> bool:
    """Return whether all lines of a block that are not indented are entries of a legend."""
    entries = [line for line in block if not line.startswith(" ")]
    return bool(entries) and all(LEGEND_ENTRY.fullmatch(line) for line in entries)


def _format_legend(block: Sequence[str]) -> list[str]:
    """Return a legend as a definition list."""
    text = [".. rst-class:: legend", ""]
    for line in block:
        entry = None if line.startswith(" ") else LEGEND_ENTRY.fullmatch(line)
        if entry is None:
            text.append(f"   {escape_markup(line.strip())}")
        else:
            letter = entry[1].strip("`")
            meaning = re.sub(" {2,}", " · ", entry[2])
            text += [f"``{letter}``", f"   {escape_markup(meaning)}"]
    return text
