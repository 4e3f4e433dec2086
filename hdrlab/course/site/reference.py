"""The reference: a page for each module, from its docstrings, and the map from the lecture to modules.

A module's docstring is read beside its code, so it is laid out for the eye: legends of letters in
columns, formulas with * and |. Here it becomes what Sphinx reads.
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

NOT_LIBRARY = ("hdrlab.cli", "hdrlab.course", "hdrlab.__main__", "hdrlab.demo", "hdrlab.scenes.")
RST = Path(__file__).parent / "rst"  # templates of the pages
# of a legend: a letter, two spaces or more, what it is
ENTRY = re.compile(r"(\S+(?: \S+)*?) {2,}(\S.*)")
NAME = re.compile(r"\b[a-z_]+(?:\.[a-z_0-9]+)+\b|^pipeline\b")
DOCTEST = ">>> "
Row = tuple[str, str, list[str]]


def modules() -> list[str]:
    """Return the names of the library's modules, chapters before what is in them."""
    found = [each.name for each in pkgutil.walk_packages(hdrlab.__path__, "hdrlab.")]
    return sorted(name for name in found if not name.startswith(NOT_LIBRARY))


def summary(name: str) -> str:
    """Return the first paragraph of a module's docstring, in one line."""
    return " ".join((import_module(name).__doc__ or "").split("\n\n")[0].split())


def imported(sources: Iterable[str], known: Sequence[str]) -> set[str]:
    """Return the modules out of `known` that these cells of a notebook import."""
    return set().union(*map(names.modules, sources)) & set(known)


def pages(titles: dict[str, str], uses: dict[str, set[str]]) -> Iterator[tuple[str, str]]:
    """Yield the name and the text of each page of the reference.

    Parameters
    ----------
    titles : name of a notebook -> its title
    uses : name of a notebook -> the modules that it imports
    """
    known = modules()
    env = templates(RST)
    env.filters |= {"short": short, "summary": summary, "escaped": escaped}
    index, page, lecture_map = map(env.get_template, ("chapters.rst", "module.rst", "map.rst"))
    yield (
        "reference/index.rst",
        index.render(chapters=[name for name in known if name.count(".") == 1]),
    )
    for name in known:
        played = [notebook for notebook in titles if name in uses[notebook]]
        parts = [each for each in known if each.startswith(f"{name}.")]
        yield f"reference/{short(name)}.rst", page.render(name=name, parts=parts, played=played)
    yield "map.rst", lecture_map.render(rows=[_row(*row, known, uses) for row in rows()])


def short(name: str) -> str:
    """Return a module's name as the lecture's map has it: without the package."""
    return name.removeprefix("hdrlab.")


def rows() -> list[tuple[str, str]]:
    """Return the map of the package's docstring: what the lecture calls it, and where it is.

    Examples
    --------
    >>> dict(rows())["Base and detail"]
    'tonemap.durand.tonemap, core.filters.bilateral'
    """
    lines = (hdrlab.__doc__ or "").splitlines()
    ruler = next(index for index, line in enumerate(lines) if line.startswith("---"))
    column = lines[ruler].index(" -") + 1
    # below another ruler stands what goes beyond the course
    table = takewhile(bool, lines[ruler + 1 :])
    return [
        (line[:column].strip(), line[column:].strip())
        for line in table
        if not line.startswith("---")
    ]


def _row(lecture: str, where: str, known: Sequence[str], uses: dict[str, set[str]]) -> Row:
    """Return a row of the map: the lecture's name, links to the functions, the notebooks that play them."""
    linked = NAME.sub(lambda found: f":py:obj:`{found[0]} <{_home(found[0])}>`", where)
    words = [f"hdrlab.{word}" for word in NAME.findall(where)]
    # a function's module
    told = {word if word in known else word.rpartition(".")[0] for word in words}
    return lecture, linked, [notebook for notebook in uses if told & uses[notebook]]


def _home(word: str) -> str:
    """Return the dotted name under which the reference has what a word of the map names."""
    module, _, name = f"hdrlab.{word}".rpartition(".")
    thing = getattr(import_module(module), name, None)
    return f"{thing.__module__}.{name}" if inspect.isfunction(thing) else f"{module}.{name}"


def escaped(line: str) -> str:
    r"""Return a line of a docstring with the signs that Sphinx would read as markup made plain.

    Examples
    --------
    >>> print(escaped("2 * |a| of `b`, and *knobs"))
    2 \* \|a\| of `b`, and \*knobs
    """
    parts = line.split("`")
    for k in range(0, len(parts), 2):
        parts[k] = re.sub(r"([\\*|])", r"\\\1", parts[k])
        parts[k] = re.sub(r"(?<=\w)_(?!\w)", r"\\_", parts[k])
    return "`".join(parts)


def laid_out(lines: Sequence[str], *, module: bool) -> list[str]:
    """Return a docstring as Sphinx is to read it; a module's legends become lists."""
    text: list[str] = []
    for block in [
        list(block) for full, block in groupby(lines, lambda line: bool(line.strip())) if full
    ]:
        if any(line.lstrip().startswith(DOCTEST) for line in block):
            text += block
        elif module and _is_legend(block):
            text += _legend(block)
        else:
            text += [
                line if re.fullmatch(r"\s*[-=]+|\*+\w+.*", line) else escaped(line)
                for line in block
            ]
        text.append("")
    return text


def _is_legend(block: Sequence[str]) -> bool:
    entries = [line for line in block if not line.startswith(" ")]
    return bool(entries) and all(ENTRY.fullmatch(line) for line in entries)


def _legend(block: Sequence[str]) -> list[str]:
    text = [".. rst-class:: legend", ""]
    for line in block:
        entry = None if line.startswith(" ") else ENTRY.fullmatch(line)
        if entry:
            text += [
                f"``{entry[1].strip('`')}``",
                f"   {escaped(re.sub(' {2,}', ' · ', entry[2]))}",
            ]
        else:
            text += [f"   {escaped(line.strip())}"]
    return text
