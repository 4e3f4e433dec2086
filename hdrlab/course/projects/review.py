"""Check that a project holds everything that the assignment asks for.

The assignment asks for the source, a report, the photos with their EXIF, the radiance map and the
artifact (the tone-mapped image). Each part gets one line: what was found, or what is missing and
what to do about it.
"""

import ast
import json
import os
import re
import sys
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path, PurePosixPath

import numpy as np

from hdrlab.course.projects.project import (
    ABOUT_FILE,
    ALBUMS,
    EXAMPLE_ABOUT,
    MANIFEST_FILE,
    REPORT_PAGE,
    Project,
)
from hdrlab.course.projects.words import TOPIC_PATTERNS
from hdrlab.course.source_code import names
from hdrlab.course.submissions.archives.members import (
    LIMITS,
    ArchiveLimits,
    ArchiveRejected,
    Member,
    check_names,
    check_sizes,
)
from hdrlab.errors import InputError
from hdrlab.io import decode, radiance

EXTERNAL_RESOURCE = re.compile(
    r"""<(?:img|script|link)[^>]+(?:src|href)\s*=\s*["']?((?:https?:)?//[^"'\s>]+)"""
)


@dataclass(frozen=True)
class Finding:
    """One line of the review.

    Attributes
    ----------
    part : the part of the project, such as "photographs"
    good : whether the part is as the assignment asks
    said : what was found, or what is wrong and what to do
    """

    part: str
    good: bool
    said: str


@dataclass(frozen=True)
class PartReview:
    """The result of one check: a summary of what was found, and the problems; either may be empty."""

    summary: str = ""
    problems: tuple[str, ...] = ()


def review(project: Project) -> list[Finding]:
    """Check each part of a project; return a Finding for each problem, or one for a good part."""
    findings = []
    for part, check in CHECKS.items():
        result = _run_check(check, project)
        findings += [Finding(part, False, problem) for problem in result.problems]
        if result.summary and not result.problems:
            findings.append(Finding(part, True, result.summary))
    return findings


def _run_check(check: Callable[[Project], PartReview], project: Project) -> PartReview:
    """Run a check; an unreadable file of the project is one of its problems."""
    try:
        return check(project)
    except InputError as error:
        message = str(error).replace(f"{project.folder}{os.sep}", "")
        return PartReview(problems=(message,))


def check_students(project: Project) -> PartReview:
    """Check who hands the project in."""
    students = project.about.students
    if not students:
        return PartReview(
            problems=(f"Write a file {ABOUT_FILE} with your names:\n{EXAMPLE_ABOUT}",)
        )
    return PartReview(" and ".join(students))


def check_title(project: Project) -> PartReview:
    """Check that the artifact has a title."""
    if project.about.students and not project.about.title:
        return PartReview(problems=(f'Give your artifact a title: title = "..." in {ABOUT_FILE}.',))
    return PartReview()


def check_source(project: Project) -> PartReview:
    """Check that programs and notebooks are there, can be read, and import what exists."""
    if not project.sources:
        problem = "There is no source code: put your programs and notebooks into the folder."
        return PartReview(problems=(problem,))
    problems = []
    for path in project.sources:
        problem = _syntax_problem(project, path)
        if problem:
            problems.append(problem)
    problems += _missing_imports(project)
    return PartReview(f"{len(project.sources)} files", tuple(problems))


def _syntax_problem(project: Project, path: Path) -> str:
    """Return why a Python file or notebook cannot be read, or an empty text."""
    name = project.name(path)
    try:
        if path.suffix == ".py":
            ast.parse(path.read_bytes())
        elif path.suffix == ".ipynb":
            list(json.loads(path.read_text(encoding="utf8"))["cells"])
    except (SyntaxError, RecursionError, MemoryError) as error:
        line = getattr(error, "lineno", "?")
        return f"{name}, line {line}: Python cannot read it ({error.args[0]})."
    except (ValueError, KeyError, TypeError):  # not UTF-8, not JSON, or without a list of cells
        return f"{name} cannot be read as a notebook. Save it again."
    return ""


def _missing_imports(project: Project) -> list[str]:
    """Return a sentence for each imported module that is neither in the project nor installed."""
    own_modules = {path.stem for path in project.sources}
    own_modules |= {path.parent.name for path in project.sources}
    first_importer: dict[str, str] = {}
    for path in project.sources:
        if path.suffix != ".py":
            continue
        for module in sorted(names.modules(path.read_bytes())):
            package = module.split(".")[0]
            is_known = package in own_modules or package in sys.stdlib_module_names
            if not is_known and find_spec(package) is None:
                first_importer.setdefault(package, project.name(path))
    return [
        f"{name} imports {package}, which is neither in the folder nor installed."
        for package, name in first_importer.items()
    ]


def check_report(project: Project) -> PartReview:
    """Check that the report is up to date, has all sections, and loads nothing from the web."""
    if project.page is None:
        problem = f"There is no {REPORT_PAGE}. Run `hdrlab report`, which makes it from report.md."
        return PartReview(problems=(problem,))
    problems = []
    if project.words and project.words.stat().st_mtime > project.page.stat().st_mtime:
        problems.append(
            f"{project.words.name} is newer than {REPORT_PAGE}: run `hdrlab report` again."
        )
    html = project.page.read_text(encoding="utf8", errors="replace")
    headings = re.findall(r"<h[1-6][^>]*>(.*?)</h[1-6]>", html, re.DOTALL | re.IGNORECASE)
    all_headings = " ".join(headings)
    missing = [
        name
        for name, pattern in TOPIC_PATTERNS.items()
        if not re.search(pattern, all_headings, re.IGNORECASE)
    ]
    if missing:
        problems.append(f"{REPORT_PAGE} has no heading about: {', '.join(missing)}.")
    external = EXTERNAL_RESOURCE.search(html)
    if external:
        problems.append(f"{REPORT_PAGE} loads {external[1][:80]}, which may be gone later.")
    return PartReview(REPORT_PAGE, tuple(problems))


def check_photographs(project: Project) -> PartReview:
    """Check that the photos form a bracket whose exposures are known."""
    count = len(project.photographs)
    if count < 2:
        problem = f"Put your bracket into the folder {ALBUMS[0]}: it holds {count}."
        return PartReview(problems=(problem,))
    problems = []
    exposures = set()
    for path in project.photographs:
        name = project.name(path)
        try:
            header = decode.read_header(path)
        except InputError as error:
            problems.append(f"{error}.".replace(f"{project.folder}{os.sep}", ""))
            continue
        if header.exposure.seconds is None:
            problems.append(f"{name} has no exposure time in EXIF. Use the camera's own file.")
        exposures.add(header.exposure)
    if not problems and len(exposures) == 1:
        problems.append("All photos have the same exposure, so they are not a bracket.")
    return PartReview(f"{count}, {len(exposures)} exposures", tuple(problems))


def check_map(project: Project) -> PartReview:
    """Check that the radiance map can be read and holds light."""
    if project.map is None:
        problem = "There is no radiance map. Save it as map.hdr, map.exr or map.pfm."
        return PartReview(problems=(problem,))
    E = radiance.read_radiance(project.map, clean=True)
    name = project.name(project.map)
    if not np.any(E > 0) or E.max() == E.min():
        return PartReview(problems=(f"{name} has the same value everywhere.",))
    return PartReview(f"{name}, {E.shape[1]} x {E.shape[0]}")


def check_artifact(project: Project) -> PartReview:
    """Check that the artifact is an image that can be read."""
    if project.artifact is None:
        problem = "There is no artifact. Save your best tone-mapped image as artifact.jpg."
        return PartReview(problems=(problem,))
    height, width = decode.read_header(project.artifact).shape[:2]
    return PartReview(f"{project.name(project.artifact)}, {width} x {height}")


def check_archive(project: Project, limits: ArchiveLimits = LIMITS) -> PartReview:
    """Check that the course would accept an archive of the project."""
    members = [
        Member(PurePosixPath(project.name(path)), path.stat().st_size) for path in project.files
    ]
    try:
        check_names([MANIFEST_FILE, *(str(path) for path, _ in members)], limits)
        check_sizes(members, limits.max_total_bytes, limits)
    except ArchiveRejected as reason:
        return PartReview(problems=(f"The gallery would reject the archive: {reason}.",))
    return PartReview()


CHECKS: dict[str, Callable[[Project], PartReview]] = {
    "students": check_students,
    "title": check_title,
    "source": check_source,
    "report": check_report,
    "photographs": check_photographs,
    "map": check_map,
    "artifact": check_artifact,
    "archive": check_archive,
}
