"""The reference: a page for each module, from its docstrings, and the map from the lecture to modules.

A module's docstring is read beside its code, so it is laid out for the eye: legends of letters in columns,
formulas with * and |. Here it becomes what Sphinx reads.
"""

import ast
import importlib.util
import inspect
import pkgutil
import re
from collections.abc import Iterable, Iterator, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

import hdrlab

NOT_LIBRARY = ("hdrlab.cli", "hdrlab.course", "hdrlab.__main__", "hdrlab.demo", "hdrlab.scenes.")
ENTRY = re.compile(r"(\S+(?: \S+)*?) {2,}(\S.*)")  # of a legend: a letter, two spaces or more, what it is
NAME = re.compile(r"\b[a-z_]+(?:\.[a-z_0-9]+)+\b|^pipeline\b")
DOCTEST = ">>> "


def modules() -> list[str]:
    """Return the names of the library's modules, chapters before what is in them."""
    found = [each.name for each in pkgutil.walk_packages(hdrlab.__path__, "hdrlab.")]
    return sorted(name for name in found if not name.startswith(NOT_LIBRARY))


def summary(name: str) -> str:
    """Return the first sentence of a module's docstring, read from its file."""
    spec = importlib.util.find_spec(name)
    assert spec is not None and spec.origin is not None
    text = ast.get_docstring(ast.parse(Path(spec.origin).read_text(encoding="utf8"))) or ""
    return " ".join(text.split("\n\n")[0].split())


def imported(sources: Iterable[str], known: Sequence[str]) -> set[str]:
    """Return the modules out of `known` that these cells of a notebook import."""
    found = set()
    for source in sources:
        try:
            tree = ast.parse(source)
        except SyntaxError:  # a cell of IPython's own language
            continue
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and node.module:
                found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
            elif isinstance(node, ast.Import):
                found |= {alias.name for alias in node.names}
    return found & set(known)


def pages(titles: dict[str, str], uses: dict[str, set[str]]) -> Iterator[tuple[str, str]]:
    """Yield the name and the text of each page of the reference.

    Parameters
    ----------
    titles : name of a notebook -> its title
    uses : name of a notebook -> the modules that it imports
    """
    names = modules()
    chapters = [name for name in names if name.count(".") == 1]
    yield "reference/index.rst", _index(chapters)
    for name in names:
        played = [notebook for notebook in titles if name in uses[notebook]]
        parts = [each for each in names if each.startswith(f"{name}.")]
        yield f"reference/{short(name)}.rst", _page(name, parts, played)
    yield "map.rst", _map(names, uses)


def short(name: str) -> str:
    """Return a module's name as the lecture's map has it: without the package."""
    return name.removeprefix("hdrlab.")


def _title(text: str) -> str:
    return f"{text}\n{'=' * len(text)}\n\n"


def _listed(names: Sequence[str]) -> str:
    rows = "".join(
        f"   * - :doc:`{short(one)} </reference/{short(one)}>`\n     - {escaped(summary(one))}\n"
        for one in names
    )
    return f".. list-table::\n   :widths: 30 70\n   :class: modules\n\n{rows}\n"


def _index(chapters: Sequence[str]) -> str:
    lead = (
        "A chapter of the lecture is a folder, and a paper is a file in it, with one function for each of "
        "its equations. :doc:`The map </map>` goes from the lecture to the functions, and ``[source]`` "
        "beside a name to its lines.\n\n"
    )
    tree = "".join(f"   {short(name)}\n" for name in chapters)
    return f"{_title('Reference')}{lead}{_listed(chapters)}\n.. toctree::\n   :hidden:\n\n{tree}"


def _page(name: str, parts: Sequence[str], played: Sequence[str]) -> str:
    text = _title(short(name))
    if played and not parts and len(played) <= 8:
        links = ", ".join(f":doc:`{notebook.split('_')[0]} </notebooks/{notebook}>`" for notebook in played)
        text += f".. rst-class:: played\n\nIn the notebooks: {links}\n\n"
    text += f".. automodule:: {name}\n   :members:\n   :member-order: bysource\n\n"
    if parts:
        tree = "".join(f"   {short(one)}\n" for one in parts)
        text += f"{_listed(parts)}\n.. toctree::\n   :hidden:\n\n{tree}"
    return text


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
    table = []
    for line in lines[ruler + 1 :]:
        if not line:
            break
        if line.startswith("---"):  # below it stands what is not on the slides
            continue
        table.append((line[:column].strip(), line[column:].strip()))
    return table


def _map(names: Sequence[str], uses: dict[str, set[str]]) -> str:
    text = _title("From the lecture to the code")
    text += "Each row is a part of the lecture, the functions that do it, and the notebooks that play it.\n\n"
    text += ".. list-table::\n   :header-rows: 1\n   :widths: 34 48 18\n   :class: map\n\n"
    text += "   * - Lecture\n     - Where\n     - Notebooks\n"
    for lecture, where in rows():
        linked = NAME.sub(lambda found: f":py:obj:`{found[0]} <{_home(found[0])}>`", where)
        told = {_module(f"hdrlab.{word}", names) for word in NAME.findall(where)}
        playing = [notebook for notebook in uses if told & uses[notebook]]
        said = (
            "most"
            if len(playing) > 8
            else ", ".join(f":doc:`{notebook.split('_')[0]} </notebooks/{notebook}>`" for notebook in playing)
        )
        text += f"   * - {escaped(lecture)}\n     - {linked}\n     - {said}\n"
    return text


def _home(word: str) -> str:
    """Return the dotted name under which the reference has what a word of the map names."""
    module, _, name = f"hdrlab.{word}".rpartition(".")
    thing = getattr(import_module(module), name, None)
    return f"{thing.__module__}.{name}" if inspect.isfunction(thing) else f"{module}.{name}"


def _module(word: str, names: Sequence[str]) -> str:
    """Return the module that a word of the map names, or the one in which what it names is."""
    return word if word in names else word.rpartition(".")[0]


def escaped(line: str) -> str:
    """Return a line of a docstring with the signs that Sphinx would read as markup made plain.

    Examples
    --------
    >>> print(escaped("2 * |a| of `b`, and *knobs"))
    2 \\* \\|a\\| of `b`, and \\*knobs
    """
    parts = line.split("`")
    for k in range(0, len(parts), 2):
        parts[k] = re.sub(r"([\\*|])", r"\\\1", parts[k])
        parts[k] = re.sub(r"(?<=\w)_(?!\w)", r"\\_", parts[k])
    return "`".join(parts)


def laid_out(lines: Sequence[str], *, module: bool) -> list[str]:
    """Return a docstring as Sphinx is to read it; a module's legends become lists."""
    blocks: list[list[str]] = [[]]
    for line in lines:
        if line.strip():
            blocks[-1].append(line)
        else:
            blocks.append([])
    text: list[str] = []
    for block in blocks:
        if any(line.lstrip().startswith(DOCTEST) for line in block):
            text += block
        elif module and _is_legend(block):
            text += _legend(block)
        else:
            text += [line if re.fullmatch(r"\s*[-=]+|\*+\w+.*", line) else escaped(line) for line in block]
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
            text += [f"``{entry[1].strip('`')}``", f"   {escaped(re.sub(' {2,}', ' · ', entry[2]))}"]
        else:
            text += [f"   {escaped(line.strip())}"]
    return text


def is_field(value: Any) -> bool:
    """Return whether a member is a NamedTuple's field, whose only words are "Alias for field number 0"."""
    return type(value).__name__ == "_tuplegetter"
