"""What the assignment asks of a project, and what of it is missing, as a person would say it.

What is asked for: complete source, a report, the photographs with their EXIF, the radiance map, the
artifact.
"""

import ast
import json
import os
import re
import sys
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path, PurePosixPath
from typing import NamedTuple

import numpy as np

from hdrlab.course.archives.members import LIMITS, Limits, Member, Refused, check_names, check_sizes
from hdrlab.course.code import names
from hdrlab.course.projects.project import ABOUT, ALBUMS, EXAMPLE, MANIFEST, PAGE, Project
from hdrlab.course.projects.words import ASKED
from hdrlab.errors import InputError
from hdrlab.io import decode, radiance

TEAM = 2  # students at most
FETCHED = re.compile(
    r"""<(?:img|script|link)[^>]+(?:src|href)\s*=\s*["']?((?:https?:)?//[^"'\s>]+)"""
)


class Finding(NamedTuple):
    """A part of what is asked for: whether it is there as it should be, and a sentence."""

    part: str
    good: bool
    said: str


def review(project: Project) -> list[Finding]:
    """Return what there is to say of each part that is asked for."""
    return [one for part, check in CHECKS.items() for one in _examined(project, part, check)]


def _examined(project: Project, part: str, check: Callable[[Project], str]) -> list[Finding]:
    """Return what a check says of a part: all is well, or each thing that is not, by names in the folder."""
    try:
        right = check(project)
    except ValueError as wrong:
        said = [str(one).replace(f"{project.folder}{os.sep}", "") for one in wrong.args]
        return [Finding(part, False, one) for one in said]
    return [Finding(part, True, right)] if right else []


def _students(project: Project) -> str:
    students = project.about.students
    if not students:
        raise InputError(f"Write a file {ABOUT} that says who you are:\n{EXAMPLE}")
    if len(students) > TEAM:
        raise InputError(f"Teams are of {TEAM}, {ABOUT} names {len(students)}.")
    return " and ".join(students)


def _title(project: Project) -> str:
    if project.about.students and not project.about.title:
        raise InputError(f'Give your artifact a title: title = "..." in {ABOUT}.')
    return ""


def _source(project: Project) -> str:
    if not project.sources:
        raise InputError("There is no source: put your programs and notebooks into the folder.")
    wrong = [one for path in project.sources for one in _unreadable(project, path)]
    if wrong := wrong + _foreign(project):
        raise InputError(*wrong)
    return f"{len(project.sources)} files"


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
    for path in (one for one in project.sources if one.suffix == ".py"):
        for top in dict.fromkeys(
            one.split(".")[0] for one in sorted(names.modules(path.read_bytes()))
        ):
            if top not in here and top not in sys.stdlib_module_names and find_spec(top) is None:
                missing.setdefault(top, project.name(path))
    why = "which is neither in the folder nor installed"
    return [f"{name} imports {top}, {why}." for top, name in missing.items()]


def _report(project: Project) -> str:
    if project.page is None:
        raise InputError(f"There is no {PAGE}. `hdrlab report` makes one of report.md.")
    wrong = []
    if project.words and project.words.stat().st_mtime > project.page.stat().st_mtime:
        wrong = [f"{project.words.name} is newer than {PAGE}: run `hdrlab report` again."]
    text = project.page.read_text(encoding="utf8", errors="replace")
    heads = " ".join(re.findall(r"<h[1-6][^>]*>(.*?)</h[1-6]>", text, re.DOTALL | re.IGNORECASE))
    if missing := [
        name for name, says in ASKED.items() if not re.search(says, heads, re.IGNORECASE)
    ]:
        wrong.append(f"{PAGE} has no heading about: {', '.join(missing)}.")
    if fetched := FETCHED.search(text):
        wrong.append(f"{PAGE} fetches {fetched[1][:80]}, which may be gone when it is read.")
    if wrong:
        raise InputError(*wrong)
    return PAGE


def _photographs(project: Project) -> str:
    count = len(project.photographs)
    if count < 2:
        raise InputError(f"Put your bracket into the folder {ALBUMS[0]}: it holds {count}.")
    wrong = []
    exposures = set()
    for path in project.photographs:
        try:
            header = decode.look(path)
        except ValueError as error:
            wrong.append(f"{error}.")
            continue
        if header.exposure.seconds is None:
            wrong.append(f"{path} has no exposure time in its EXIF. Take the camera's own file.")
        exposures.add(header.exposure)
    if not wrong and len(exposures) == 1:
        wrong = ["All photographs have the same exposure, which makes no bracket."]
    if wrong:
        raise InputError(*wrong)
    return f"{count}, {len(exposures)} exposures"


def _map(project: Project) -> str:
    if project.map is None:
        raise InputError("There is no radiance map. Save it as map.hdr, map.exr or map.pfm.")
    E = radiance.read_radiance(project.map, clean=True)
    if not np.any(E > 0) or E.max() == E.min():
        raise InputError(f"{project.name(project.map)} holds one value everywhere.")
    return f"{project.name(project.map)}, {E.shape[1]} x {E.shape[0]}"


def _artifact(project: Project) -> str:
    if project.artifact is None:
        raise InputError("There is no artifact. Save your best picture as artifact.jpg.")
    height, width = decode.look(project.artifact).shape[:2]
    return f"{project.name(project.artifact)}, {width} x {height}"


def _archive(project: Project, limits: Limits = LIMITS) -> str:
    """Return "", unless the course would refuse the archive."""
    members = [
        Member(PurePosixPath(project.name(path)), path.stat().st_size) for path in project.files
    ]
    try:
        check_names([MANIFEST, *(str(path) for path, _ in members)], limits)
        check_sizes(members, limits.total, limits)
    except Refused as reason:
        raise InputError(f"The archive would be refused: {reason}.") from None
    return ""


# each returns a sentence on what is right, if any, or raises a ValueError of all that is wrong
CHECKS: dict[str, Callable[[Project], str]] = {
    **{"students": _students, "title": _title, "source": _source, "report": _report},
    **{"photographs": _photographs, "map": _map, "artifact": _artifact, "archive": _archive},
}
