"""A student's project as it lies in its folder: what the assignment asks for, and where it is.

project/
  project.toml      students, title and caption of the artifact
  report.md         the words (or report.ipynb), of which `hdrlab report` makes report.html
  photographs/      the bracket as it came from the camera
  map.hdr           the radiance map, or .exr or .pfm
  response.csv      the response curve, as `hdrlab calibrate` or `io.response_files` writes it
  artifact.jpg      the picture for the wall, or .png or .tif
  *.py, *.ipynb     the source, also in folders
"""

import os
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course.sanitize import sanitize_line
from hdrlab.errors import InputError
from hdrlab.io import response_files
from hdrlab.io.album import SUFFIXES

FILES: dict[str, Any] = tomllib.loads(Path(__file__).with_name("files.toml").read_text("utf8"))
ALBUMS, MAPS, ARTIFACTS = (tuple(FILES[one]) for one in ("albums", "maps", "artifacts"))
ABOUT = "project.toml"
PAGE = "report.html"
WORDS = ("report.md", "report.ipynb")
MANIFEST = "submission.json"  # of an archive
EXAMPLE = 'students = ["b0123", "b0456"]\ntitle = "Dusk at the harbor"\ncaption = "Seven hand-held frames."\n'


class About(NamedTuple):
    """Whose project it is, and what stands under the artifact."""

    students: tuple[str, ...] = ()
    title: str = ""
    caption: str = ""


class Project(NamedTuple):
    """What was found, by its paths; None or empty where there is none."""

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


def look(folder: str | Path) -> Project:
    """Return what a project's folder holds.

    Raises
    ------
    ValueError
        For what is no folder, and a `project.toml` that cannot be read.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(f"{folder}: expected the folder of a project")
    files = tuple(sorted(_files(folder)))
    top = [path for path in files if path.parent == folder]
    album = next((folder / name for name in ALBUMS if (folder / name).is_dir()), None)
    words = next((folder / name for name in WORDS if (folder / name) in files), None)
    return Project(
        folder,
        _about(folder / ABOUT),
        files,
        tuple(path for path in files if path.parent == album and path.suffix.lower() in SUFFIXES),
        _one(top, ("map", "radiance", "hdr"), MAPS),
        _one(top, ("response", "curve", "response.luminance"), tuple(response_files.FORMS)),
        _one(top, ("artifact",), ARTIFACTS, strict=True),
        words,
        folder / PAGE if folder / PAGE in files else None,
        tuple(path for path in files if path.suffix.lower() in FILES["sources"] and path != words),
    )


def _files(folder: Path) -> Iterator[Path]:
    """Yield the plain files of a folder and those below, without caches, hidden ones and links."""
    for home, folders, names in os.walk(folder):
        folders[:] = [one for one in folders if one not in FILES["left_out"] and one[0] != "."]
        for name in names:
            path = Path(home, name)
            if (
                name[0] != "."
                and not path.is_symlink()
                and path.is_file()
                and not name.endswith(".pyc")
            ):
                yield path


def _one(
    files: list[Path], stems: tuple[str, ...], suffixes: tuple[str, ...], *, strict: bool = False
) -> Path | None:
    """Return the file of one of these names; without one, the only file of these suffixes unless `strict`."""
    fitting = [path for path in files if path.name.lower().endswith(suffixes)]
    for stem in stems:
        for path in fitting:
            if path.name.lower().split(".")[0] == stem.split(".")[0]:
                return path
    return fitting[0] if len(fitting) == 1 and not strict and suffixes == MAPS else None


def _about(path: Path) -> About:
    if not path.is_file():
        return About()
    try:
        said: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf8"))
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: {error}; expected something like\n{EXAMPLE}") from None
    students = said.get("students", ())
    if isinstance(students, str):
        students = (students,)
    if not isinstance(students, list | tuple) or not all(isinstance(one, str) for one in students):
        raise InputError(f"{path}: expected students as a list of strings, such as\n{EXAMPLE}")
    title, caption = (
        sanitize_line(str(said.get(key, "")), most)
        for key, most in (("title", 60), ("caption", 280))
    )
    return About(tuple(sanitize_line(one, 80) for one in students), title, caption)
