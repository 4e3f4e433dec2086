"""What the assignment asks of a project, and what of it is missing, as a person would say it.

What is asked for: complete source, a report, the photographs with their EXIF, the radiance map, the artifact.
"""

import ast
import json
import re
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path, PurePosixPath
from typing import NamedTuple

import numpy as np

from hdrlab.course.archives.members import LIMITS, Limits, Member, Refused, check_names, check_sizes
from hdrlab.course.projects.project import ABOUT, ALBUMS, EXAMPLE, MANIFEST, PAGE, Project
from hdrlab.course.projects.words import ASKED
from hdrlab.io import radiance
from hdrlab.io.decode import look

TEAM = 2  # students at most


class Finding(NamedTuple):
    """A part of what is asked for: whether it is there as it should be, and a sentence."""

    part: str
    good: bool
    said: str


def review(project: Project) -> list[Finding]:
    """Return what there is to say of each part that is asked for."""
    checks = (_about, _source, _report, _photographs, _map, _artifact, _archive)
    return [finding for check in checks for finding in check(project)]


def _about(project: Project) -> Iterator[Finding]:
    students = project.about.students
    if not students:
        yield Finding("students", False, f"Write a file {ABOUT} that says who you are:\n{EXAMPLE}")
    elif len(students) > TEAM:
        yield Finding("students", False, f"Teams are of {TEAM}, {ABOUT} names {len(students)}.")
    else:
        yield Finding("students", True, " and ".join(students))
    if students and not project.about.title:
        yield Finding("title", False, f'Give your artifact a title: title = "..." in {ABOUT}.')


def _source(project: Project) -> Iterator[Finding]:
    if not project.sources:
        yield Finding("source", False, "There is no source: put your programs and notebooks into the folder.")
        return
    wrong = [one for path in project.sources for one in _unreadable(project, path)]
    wrong += _foreign(project)
    yield from (Finding("source", False, one) for one in wrong)
    if not wrong:
        yield Finding("source", True, f"{len(project.sources)} files")


def _unreadable(project: Project, path: Path) -> Iterator[str]:
    """Yield why a source cannot be read, where it is one that we can tell."""
    name = project.name(path)
    try:
        if path.suffix == ".py":
            ast.parse(path.read_bytes())
        elif path.suffix == ".ipynb":
            list(json.loads(path.read_text(encoding="utf8"))["cells"])
    except (SyntaxError, RecursionError, MemoryError) as error:
        yield f"{name}, line {getattr(error, 'lineno', '?')}: Python cannot read it ({error.args[0]})."
    except (ValueError, KeyError, TypeError):
        yield f"{name} is no notebook that can be read. Save it again."


def _foreign(project: Project) -> list[str]:
    """Return the modules that Python files import and that are neither here nor installed."""
    here = {path.stem for path in project.sources} | {path.parent.name for path in project.sources}
    missing: dict[str, str] = {}
    for path in project.sources:
        for top in _imports(path) if path.suffix == ".py" else ():
            if top not in here and top not in sys.stdlib_module_names and find_spec(top) is None:
                missing.setdefault(top, project.name(path))
    return [
        f"{name} imports {top}, which is neither in the folder nor installed."
        for top, name in missing.items()
    ]


def _imports(path: Path) -> Iterator[str]:
    try:
        tree = ast.parse(path.read_bytes())
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (one.name.split(".")[0] for one in node.names)
        elif isinstance(node, ast.ImportFrom) and not node.level and node.module:
            yield node.module.split(".")[0]


def _report(project: Project) -> Iterator[Finding]:
    if project.page is None:
        yield Finding("report", False, f"There is no {PAGE}. `hdrlab report` makes one of report.md.")
        return
    if project.words and project.words.stat().st_mtime > project.page.stat().st_mtime:
        yield Finding(
            "report", False, f"{project.words.name} is newer than {PAGE}: run `hdrlab report` again."
        )
    text = project.page.read_text(encoding="utf8", errors="replace")
    heads = " ".join(re.findall(r"<h[1-6][^>]*>(.*?)</h[1-6]>", text, re.DOTALL | re.IGNORECASE))
    missing = [name for name, says in ASKED.items() if not re.search(says, heads, re.IGNORECASE)]
    fetched = re.findall(
        r"""<(?:img|script|link)[^>]+(?:src|href)\s*=\s*["']?((?:https?:)?//[^"'\s>]+)""", text
    )
    if missing:
        yield Finding("report", False, f"{PAGE} has no heading about: {', '.join(missing)}.")
    if fetched:
        yield Finding(
            "report", False, f"{PAGE} fetches {fetched[0][:80]}, which may be gone when it is read."
        )
    if not (missing or fetched):
        yield Finding("report", True, PAGE)


def _photographs(project: Project) -> Iterator[Finding]:
    if len(project.photographs) < 2:
        count = len(project.photographs)
        yield Finding(
            "photographs", False, f"Put your bracket into the folder {ALBUMS[0]}: it holds {count}."
        )
        return
    wrong, exposures = [], set()
    for path in project.photographs:
        try:
            header = look(path)
        except ValueError as error:
            wrong.append(f"{str(error).replace(str(path), project.name(path))}.")
            continue
        if header.exposure.seconds is None:
            wrong.append(
                f"{project.name(path)} has no exposure time in its EXIF. Take the camera's own file."
            )
        exposures.add(header.exposure)
    if not wrong and len(exposures) == 1:
        wrong = ["All photographs have the same exposure, which makes no bracket."]
    yield from (Finding("photographs", False, one) for one in wrong)
    if not wrong:
        yield Finding("photographs", True, f"{len(project.photographs)}, {len(exposures)} exposures")


def _map(project: Project) -> Iterator[Finding]:
    if project.map is None:
        yield Finding("map", False, "There is no radiance map. Save it as map.hdr, map.exr or map.pfm.")
        return
    try:
        E = radiance.read_radiance(project.map, clean=True)
    except ValueError as error:
        yield Finding("map", False, str(error).replace(str(project.map), project.name(project.map)))
        return
    if not np.any(E > 0) or E.max() == E.min():
        yield Finding("map", False, f"{project.name(project.map)} holds one value everywhere.")
    else:
        yield Finding("map", True, f"{project.name(project.map)}, {E.shape[1]} x {E.shape[0]}")


def _artifact(project: Project) -> Iterator[Finding]:
    if project.artifact is None:
        yield Finding("artifact", False, "There is no artifact. Save your best picture as artifact.jpg.")
        return
    try:
        height, width = look(project.artifact).shape[:2]
    except ValueError as error:
        yield Finding(
            "artifact", False, str(error).replace(str(project.artifact), project.name(project.artifact))
        )
        return
    yield Finding("artifact", True, f"{project.name(project.artifact)}, {width} x {height}")


def _archive(project: Project, limits: Limits = LIMITS) -> Iterator[Finding]:
    """Yield what would make the course refuse the archive."""
    members = [Member(PurePosixPath(project.name(path)), path.stat().st_size) for path in project.files]
    try:
        check_names([MANIFEST, *(str(path) for path, _ in members)], limits)
        check_sizes(members, limits.total, limits)
    except Refused as reason:
        yield Finding("archive", False, f"The archive would be refused: {reason}.")
