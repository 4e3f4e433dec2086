"""Make a deck of slides from each of some notebooks, which are run first."""

import difflib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import nbformat

from hdrlab.course import materials
from hdrlab.course.authoring import execute
from hdrlab.course.slides import render, rule
from hdrlab.errors import InputError
from hdrlab.io import files

MAX_SUGGESTIONS = 3


class Deck(NamedTuple):
    """A written deck, the number of its slides, and whether its notebook was run just now."""

    path: Path
    slides: int
    fresh: bool


def find_notebooks(names: Sequence[str]) -> list[Path]:
    """Return the notebooks of hdrlab with these names or numbers, or at these paths; all by default.

    Raises
    ------
    InputError
        For a name that no notebook has, or two notebooks whose decks would have the same name.

    Examples
    --------
    >>> [path.name for path in find_notebooks(["04", "17_fattal"])]
    ['04_response_gsolve.ipynb', '17_fattal.ipynb']
    """
    known = sorted(materials.folder("notebooks").glob("*.ipynb"))
    if not names:
        return known
    chosen = [_find(name, known) for name in names]
    stems = [path.stem for path in chosen]
    for stem in stems:
        if stems.count(stem) > 1:
            raise InputError(f"two notebooks have the name {stem}; pass each notebook once")
    return chosen


def _find(name: str, known: Sequence[Path]) -> Path:
    """Return the notebook with a name."""
    path = Path(name)
    if path.suffix == ".ipynb" and path.is_file():
        return path
    for notebook in known:
        if name in (notebook.stem, notebook.name, notebook.stem[:2]):
            return notebook
    stems = [notebook.stem for notebook in known]
    near = [stem for stem in stems if len(name) > 2 and path.stem.casefold() in stem.casefold()]
    near = near or difflib.get_close_matches(path.stem, stems, MAX_SUGGESTIONS, cutoff=0.3)
    near = near[:MAX_SUGGESTIONS] or [stems[0], stems[-1]]
    raise InputError(
        f"no notebook {name!r}; pass a file or one of hdrlab's notebooks, such as {', '.join(near)}"
    )


def write_steps(notebooks: Sequence[Path], out: Path, cache: Path, *, jobs: int) -> Iterator[Deck]:
    """Run notebooks, write a deck for each into `out`, and yield each deck when it is written."""
    for notebook in execute.run_steps(notebooks, cache, jobs=jobs):
        executed = nbformat.read(notebook.executed, 4)
        slides = rule.make_slides(executed.cells, notebook.source.stem)
        slides = rule.drop_empty(slides, executed.cells)
        html = render.render_deck(slides, executed, notebook.source.stem)
        path = files.write(out / f"{notebook.source.stem}.html", html)
        yield Deck(path, len(slides), notebook.fresh)
