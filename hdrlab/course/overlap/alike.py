"""The page about what is alike in a class, for instructors' eyes: side by side, with what it cannot tell.

similar.html   caveats, the shares of all pairs, the pairs from the threshold on, what is alike the library
similar.csv    the same pairs as a table

Both follow from what was handed in alone: the same class gives the same bytes.
"""

import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from copydetect import compare_files

from hdrlab.course import plan, variants
from hdrlab.course.checks import rewording
from hdrlab.course.classroom.handins import Submission
from hdrlab.course.code import inline
from hdrlab.course.overlap import authored, similarity
from hdrlab.course.reports import csv_tables
from hdrlab.io.files import write
from hdrlab.show.pages.templates import templates

PAGE = "alike_page.html"
MOST = 1_000  # works that are compared: half a million pairs, a gigabyte
SHOWN = 100  # pairs with their passages
ROWS = 10_000  # of the table
WORTH = 0.3  # share of a task, from which its passages are shown
TEXT = 8_000  # characters of a task that are shown
COLUMNS = ("one", "other", "share", "one in other", "other in one", "tasks on the other's sheet")
Piece = tuple[str, bool]  # of a text, and whether the other has it
# variants by task: a team's, and others of the sheet it has
Asked = tuple[dict[str, str], dict[str, str]]


class Row(NamedTuple):
    """A task of a pair, or "" for all together: the shares, and both texts where they are worth a look."""

    task: str
    forth: float
    back: float
    one: tuple[Piece, ...] = ()
    other: tuple[Piece, ...] = ()


def write_steps(
    out: Path, homework: plan.Homework, handins: Mapping[str, Submission], secret: str = ""
) -> Iterator[str]:
    """Write page and table of a class; yield each team when its work is read, the files are there at the end.

    Parameters
    ----------
    out : folder of the results
    homework, handins : what was asked, and what counts of each team
    secret : the course's, which draws the variants of tasks
    """
    each = []
    for one in similarity.printed_steps(works(homework, handins)):
        each.append(one)
        yield one.work.team
    found = similarity.compare(each, authored.handout_code(homework.name), library(homework))
    asked = {one.work.team: asked_of(homework, one.work, secret) for one in each}
    pairs = [
        ((each[a].work.team, each[b].work.team), shares) for a, b, *shares in found.pairs[:ROWS]
    ]
    table = [
        (*both, *map("{:.3f}".format, shares), str(exchanged(*(asked[team] for team in both))))
        for both, shares in pairs
    ]
    csv_tables.write_csv(out / "similar.csv", COLUMNS, table, private=True)
    write(out / "similar.html", page(homework, each, found, asked), private=True)


def asked_of(homework: plan.Homework, work: authored.Work, secret: str) -> Asked:
    """Return of which tasks a team is asked which variant, and its sheet another."""
    tasks = variants.draw(homework, work.team, secret, work.variants).tasks
    own = {task.id: task.variant for task in tasks}
    said = work.variants
    return own, {} if said is None else dict(
        {id: said.get(id, "") for id in own}.items() - own.items()
    )


def exchanged(one: Asked, other: Asked) -> int:
    """Return of how many tasks the sheet of one of two teams asks the variant of the other.

    Examples
    --------
    >>> exchanged(({"f": "a", "g": "a"}, {"f": "b"}), ({"f": "b", "g": "b"}, {}))
    1
    """
    return len(one[1].items() & other[0].items()) + len(other[1].items() & one[0].items())


def library(homework: plan.Homework) -> str:
    """Return the library's functions of a homework as `authored` reads those of a team."""
    alone = {
        task.id: inline.inlined({task.id: task.function})[task.id].text for task in homework.tasks
    }
    texts = [
        (task.id, rewording.reword(task.id, variant, alone[task.id]))
        for task in homework.tasks
        for variant in (rewording.every(task.id) if task.parameters else ("",))
    ]
    return "\n".join(authored.own(text, homework.name, {*alone} - {name}) for name, text in texts)


def works(homework: plan.Homework, handins: Mapping[str, Submission]) -> Iterator[authored.Work]:
    """Yield what each team wrote itself, by the teams' names; an archive is unpacked for it."""
    tasks = [task.id for task in homework.tasks]
    for team, one in sorted(handins.items()):
        yield authored.read(team, one.path, homework.name, tasks)


def page(
    homework: plan.Homework,
    each: Sequence[similarity.Printed],
    found: similarity.Likeness,
    asked: Mapping[str, Asked],
) -> str:
    """Return the page; whatever students wrote is text on it."""
    library = {
        task: sorted(
            (each[n].work.team, share) for n, share in all.items() if share >= similarity.THRESHOLD
        )
        for task, all in found.library.items()
    }
    environment = templates(Path(__file__).parent)
    environment.filters["percent"] = lambda share: int(100 * share + 1e-9)
    return environment.get_template(PAGE).render(
        homework=homework,
        works=[one.work for one in each],
        bins=[(100 * k // similarity.BINS, int(n)) for k, n in enumerate(found.counts)],
        found=found,
        asked=asked,
        exchanged=exchanged,
        shown=[(pair, rows(found, pair)) for pair in found.pairs[:SHOWN]],
        library=library,
        measure=similarity,
        most=ROWS,
    )


def rows(found: similarity.Likeness, pair: similarity.Pair) -> list[Row]:
    """Return what two works have in common: all tasks together, then each task that was compared."""
    each = []
    signs = []
    for task, prints in found.own.items():
        if pair.one in prints and pair.other in prints:
            one = prints[pair.one]
            other = prints[pair.other]
            _, (forth, back), places = compare_files(one, other)
            row = Row(task, float(forth), float(back))
            if max(forth, back) >= WORTH:
                texts = (
                    pieces(text.raw_code, at) for text, at in zip((one, other), places, strict=True)
                )
                row = Row(*row[:3], *texts)
            each.append(row)
            signs.append((one.token_coverage, other.token_coverage))
    both = np.sum(
        [np.multiply(row[1:3], size) for row, size in zip(each, signs, strict=True)], axis=0
    )
    return [Row("", *(both / np.sum(signs, axis=0)).tolist()), *each]


def pieces(text: str, places: np.ndarray) -> tuple[Piece, ...]:
    r"""Return a text in pieces that are alike and others; of a long one, what begins with the first alike.

    Examples
    --------
    >>> pieces("a = 1\nb = 2\nc = 3\n", np.array([[6], [12]]))
    (('a = 1\n', False), ('b = 2', True), ('\nc = 3\n', False))
    """
    first = int(places[0].min()) if places.size else 0
    ends = [0 if len(text) <= TEXT else text.rfind("\n", 0, first) + 1]
    last = min(len(text), ends[0] + TEXT)
    for start, end in places.T.astype(int).tolist():
        part = text[start : min(end, last)]
        ends += [start, start + len(part.rstrip())] if part.strip() else []
    ends.append(last)
    parts = [
        (_visible(text[a:b]), k % 2 == 1)
        for k, (a, b) in enumerate(zip(ends, ends[1:], strict=False))
    ]
    return tuple(part for part in parts if part[0])


def _visible(text: str) -> str:
    """Return a text in which what has no shape, or turns the direction of others, is a mark of its own."""
    hidden = {"Cc", "Cf", "Cs", "Co", "Cn"}
    odd = {one for one in set(text) - set("\n\t") if unicodedata.category(one) in hidden}
    return "".join("\ufffd" if one in odd else one for one in text)
