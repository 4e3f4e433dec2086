"""Find the files of a student's project in its folder.

project/
  project.toml      students, title and caption of the artifact
  report.md         the text (or report.ipynb), from which `hdrlab report` makes report.html
  photographs/      the bracket as it came from the camera
  map.hdr           the radiance map, or .exr or .pfm
  response.csv      the response curve, as `hdrlab calibrate` or `io.response_files` writes it
  artifact.jpg      the tone-mapped image for the gallery, or .png or .tif
  *.py, *.ipynb     the source, also in folders
"""

import os
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hdrlab.course.sanitize import sanitize_line
from hdrlab.errors import InputError
from hdrlab.io import response_files
from hdrlab.io.album import SUFFIXES

# names of folders and suffixes of files
FILES: dict[str, Any] = tomllib.loads(Path(__file__).with_name("files.toml").read_text("utf8"))
ALBUMS: tuple[str, ...] = tuple(FILES["albums"])
MAP_SUFFIXES: tuple[str, ...] = tuple(FILES["maps"])
ARTIFACT_SUFFIXES: tuple[str, ...] = tuple(FILES["artifacts"])
MAP_STEMS = ("map", "radiance", "hdr")
CURVE_STEMS = ("response", "curve", "response.luminance")
ARTIFACT_STEM = "artifact"
ABOUT_FILE = "project.toml"
REPORT_PAGE = "report.html"
REPORT_SOURCES = ("report.md", "report.ipynb")
# in an archive of `hdrlab submit`
MANIFEST_FILE = "submission.json"
EXAMPLE_ABOUT = (
    'students = ["b0123", "b0456"]\n'
    'title = "Dusk at the harbor"\n'
    'caption = "Seven hand-held frames."\n'
)
MAX_STUDENT_CHARACTERS = 80
MAX_TITLE_CHARACTERS = 60
MAX_CAPTION_CHARACTERS = 280


@dataclass(frozen=True)
class About:
    """The students of a project, and the title and caption of its artifact."""

    students: tuple[str, ...] = ()
    title: str = ""
    caption: str = ""


@dataclass(frozen=True, kw_only=True)
class Project:
    """The files of a project; None or empty for those that it does not have.

    Attributes
    ----------
    folder : the project's folder
    about : what project.toml says
    files : all files
    photographs : the photos of the bracket
    map : the radiance map
    curve : the response curve
    artifact : the tone-mapped image
    words : the text of the report
    page : the report as a page
    sources : programs and notebooks
    """

    folder: Path
    about: About
    files: tuple[Path, ...]
    photographs: tuple[Path, ...]
    map: Path | None
    curve: Path | None
    artifact: Path | None
    words: Path | None
    page: Path | None
    sources: tuple[Path, ...]

    def name(self, path: Path) -> str:
        """Return a file's name within the project."""
        return path.relative_to(self.folder).as_posix()


def read_project(folder: str | Path) -> Project:
    """Find the files of a project in its folder.

    Raises
    ------
    InputError
        If there is no such folder, or its `project.toml` cannot be read.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(f"{folder}: expected the folder of a project")
    files = tuple(sorted(_iter_files(folder)))
    top_files = [path for path in files if path.parent == folder]
    albums = [folder / name for name in ALBUMS if (folder / name).is_dir()]
    photographs: tuple[Path, ...] = ()
    if albums:
        photographs = tuple(
            path for path in files if path.parent == albums[0] and path.suffix.lower() in SUFFIXES
        )
    report_sources = [folder / name for name in REPORT_SOURCES if folder / name in files]
    words = report_sources[0] if report_sources else None
    page = folder / REPORT_PAGE
    curves = _with_suffix(top_files, tuple(response_files.FORMS))
    artifacts = _with_suffix(top_files, ARTIFACT_SUFFIXES)
    return Project(
        folder=folder,
        about=_read_about(folder / ABOUT_FILE),
        files=files,
        photographs=photographs,
        map=find_map(top_files),
        curve=_first_named(curves, CURVE_STEMS),
        artifact=_first_named(artifacts, (ARTIFACT_STEM,)),
        words=words,
        page=page if page in files else None,
        sources=tuple(
            path for path in files if path.suffix.lower() in FILES["sources"] and path != words
        ),
    )


def find_map(files: list[Path]) -> Path | None:
    """Return the radiance map among the files of a project: by its name, or the only one."""
    maps = _with_suffix(files, MAP_SUFFIXES)
    named = _first_named(maps, MAP_STEMS)
    if named is None and len(maps) == 1:
        return maps[0]
    return named


def _iter_files(folder: Path) -> Iterator[Path]:
    """Yield the plain files in a folder and its subfolders, without caches, hidden files and links."""
    for parent, subfolders, names in os.walk(folder):
        # os.walk enters the subfolders that are left in the list
        subfolders[:] = [
            name
            for name in subfolders
            if name not in FILES["left_out"] and not name.startswith(".")
        ]
        for name in names:
            if name.startswith(".") or name.endswith(".pyc"):
                continue
            path = Path(parent, name)
            if path.is_file() and not path.is_symlink():
                yield path


def _with_suffix(files: list[Path], suffixes: tuple[str, ...]) -> list[Path]:
    """Return the files whose name ends with one of the suffixes."""
    return [path for path in files if path.name.lower().endswith(suffixes)]


def _first_named(files: list[Path], stems: tuple[str, ...]) -> Path | None:
    """Return the file with the first of these names that there is, up to the first dot, or None."""
    for stem in stems:
        for path in files:
            if path.name.lower().split(".")[0] == stem.split(".")[0]:
                return path
    return None


def _read_about(path: Path) -> About:
    """Read project.toml; return an empty About if there is none."""
    if not path.is_file():
        return About()
    try:
        entries: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf8"))
    except (ValueError, RecursionError) as error:  # no UTF-8, no TOML, or nested too deep
        raise InputError(f"{path}: {error}; expected something like\n{EXAMPLE_ABOUT}") from None
    students = entries.get("students", ())
    if isinstance(students, str):
        students = (students,)
    is_list = isinstance(students, list | tuple)
    if not is_list or not all(isinstance(student, str) for student in students):
        raise InputError(
            f"{path}: expected students as a list of strings, such as\n{EXAMPLE_ABOUT}"
        )
    return About(
        students=tuple(sanitize_line(student, MAX_STUDENT_CHARACTERS) for student in students),
        title=sanitize_line(str(entries.get("title", "")), MAX_TITLE_CHARACTERS),
        caption=sanitize_line(str(entries.get("caption", "")), MAX_CAPTION_CHARACTERS),
    )
