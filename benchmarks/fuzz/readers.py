"""Every reader of files from outside: small good files to begin with, and how one is read."""

import importlib.util
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL.Image import DecompressionBombError

from benchmarks.fuzz import course_seeds, seeds
from benchmarks.measure import ROOT
from hdrlab.course import plan
from hdrlab.course.classroom import marks
from hdrlab.course.gallery import collect, pictures, tokens
from hdrlab.course.grading import results
from hdrlab.course.projects import project, words
from hdrlab.course.question_bank import answers
from hdrlab.course.students import roster
from hdrlab.course.submissions import class_folder, reader
from hdrlab.course.submissions.archives import unpack
from hdrlab.io import metadata, photos, radiance, response_files, sequence, times, web
from hdrlab.io.maps import exr, layers
from hdrlab.show.describe import describe_file

# damaged files that are there already
DAMAGED = ROOT.parent / "shared" / "data" / "damaged"
# bytes of one of them: larger ones slow the others down
LARGEST = 40_000


# LibRaw names the file; to turn stderr off meanwhile, in all threads, would stop the progress bar
LIBRAW = r"(\S+\.dng: (Unexpected end of file|data corrupted at \d+)\n)*"
# of Pillow, whose own words stand
REFUSED = (ValueError, OSError, SyntaxError, DecompressionBombError)
LARGE = r"(.*: DecompressionBombWarning: .*\n.*\n)*"


class Missing(Exception):
    """Raised where a reader needs what is not installed; its text says what."""


class Reader(NamedTuple):
    """How files of a suffix are made and read.

    Attributes
    ----------
    make : writes good ones into a folder
    read : reads one, given its path
    named : whether an error is to name the file; not so where the reader gets bytes, or its caller
        names it
    errors : what it may raise
    needs : the module without which it reads nothing
    damaged : how the names of damaged files of it begin
    printed : what its C library may say past Python of a damaged file: a pattern of all of it
    """

    name: str
    suffix: str
    make: Callable[[Path], object]
    read: Callable[[Path], object]
    named: bool = True
    errors: tuple[type[Exception], ...] = (ValueError,)
    needs: str = "numpy"
    damaged: str = "-"
    printed: str = ""

    def seeds(self, folder: Path) -> list[bytes]:
        """Return the files to begin with, made in a folder, or raise Missing."""
        if importlib.util.find_spec(self.needs) is None:
            raise Missing(f"{self.needs} is not installed")
        self.make(folder)
        known = sorted(DAMAGED.glob(f"{self.damaged}*{self.suffix}")) if DAMAGED.is_dir() else []
        files = [*sorted(folder.glob(f"*{self.suffix}")), *known]
        return [file.read_bytes() for file in files if file.stat().st_size <= LARGEST]


def read_map(path: Path) -> object:
    """Read a radiance map as it is, and cleaned, and what its header says; return it as it is."""
    _each(lambda: describe_file(path), lambda: radiance.read_radiance(path))
    E = radiance.read_radiance(path, clean=True)
    if not (np.isfinite(E).all() and E.min() >= 0):
        raise ArithmeticError("cleaned, and no radiance")
    return radiance.read_radiance(path)


def read_exr(path: Path) -> object:
    """Read an OpenEXR file as a map, and all its layers."""
    _each(lambda: layers.read_layers(path), lambda: exr.read_dtypes(path))
    return read_map(path)


def read_photo(path: Path) -> object:
    """Read a photograph: what its header says, its pixels, and what is left of it for the class."""
    _each(lambda: describe_file(path), lambda: metadata.strip_metadata(path))
    return photos.read_photo(path)


def read_other(path: Path) -> object:
    """Read a photo of a telephone, and remove its metadata."""
    _each(lambda: describe_file(path), lambda: metadata.strip_metadata(path))
    return photos.read_photo(path)


def read_jxl(path: Path) -> object:
    """Read a JPEG XL as what it says that it is, a map or a photograph."""
    light = describe_file(path)["values"].startswith("float")
    return (radiance.read_radiance if light else photos.read_photo)(path)


def read_exif(path: Path) -> None:
    """Read EXIF, and what it tells."""
    metadata.keep_exposure_tags(path.read_bytes())


def read_class_answers(path: Path) -> object:
    """Read the answers of a class, and match the students with themselves."""
    class_answers = answers.read_answers(path)
    return answers.match_students(class_answers, class_answers)


def read_result(path: Path) -> None:
    """Read a result as those who write reports and gradebooks do."""
    result = results.from_json(path.read_bytes())
    results.for_team(results.to_json(result))


def read_submission(path: Path) -> None:
    """Read what was handed in, whose problems are told and not raised."""
    submission = reader.tasks_of(path, ("hat", "gsolve"))
    if sum(map(len, submission.problems)) > 8000:
        raise ArithmeticError("problems without end")


def read_archive(path: Path) -> None:
    """Unpack an archive, and leave nothing."""
    target = path.parent / "unpacked"
    with seeds.removed(target):
        unpack.unpack(path, target)


def read_manifest(path: Path) -> None:
    """Read what an archive of `hdrlab submit` says of itself."""
    with (
        seeds.removed(path.parent / "hung") as folder,
        course_seeds.packed(path, folder) as archive,
    ):
        students = roster.Roster((roster.Student("fuzzed", "Ada", "fuzzed"),))
        with collect.entry(archive, students):
            pass


def read_project(path: Path) -> None:
    """Read what a project says of itself."""
    with seeds.removed(path.parent / "work") as folder:
        folder.mkdir()
        (folder / project.ABOUT_FILE).write_bytes(path.read_bytes())
        project.read_project(folder)


def read_words(path: Path) -> None:
    """Read a report's words, which are to be text that UTF-8 can hold."""
    report = words.read(path)
    for text in (report.title, *report.notes, *(section.html for section in report.sections)):
        text.encode()


def _each(*reads: Callable[[], object]) -> None:
    """Read it in several ways, of which each may refuse it; what else is raised passes."""
    refused: list[ValueError] = []
    for read in reads:
        try:
            read()
        except UnicodeError:
            raise
        except ValueError as error:
            refused.append(error)
    if refused:
        raise refused[0]


def _frames(path: Path) -> Iterator[Any]:
    yield from sequence.read(path)


ALL: Sequence[Reader] = (
    Reader("rgbe", ".hdr", seeds.maps, read_map, damaged="rgbe"),
    Reader("exr", ".exr", seeds.maps, read_exr, damaged="exr", needs="OpenEXR"),
    Reader("pfm", ".pfm", seeds.maps, read_map, damaged="pfm"),
    Reader("float-tiff", ".tif", seeds.maps, read_map),
    Reader("ultrahdr", ".jpg", seeds.gains, read_map),
    Reader("jpeg", ".jpg", seeds.photographs, read_photo),
    Reader("png", ".png", seeds.photographs, read_photo),
    Reader("tiff", ".tif", seeds.photographs, read_photo, damaged="tiff"),
    Reader("photo-webp", ".webp", seeds.telephones, read_other),
    Reader("avif", ".avif", seeds.telephones, read_other),
    Reader("heic", ".heic", seeds.telephones, read_other, needs="pillow_heif"),
    Reader("jxl", ".jxl", seeds.jpegxl, read_jxl, needs="imagecodecs"),
    Reader("motion", ".jpg", seeds.telephones, read_photo),
    Reader("dng", ".dng", seeds.raw, read_photo, needs="rawpy", damaged="dng", printed=LIBRAW),
    Reader("film", ".mp4", seeds.films, lambda path: [*_frames(path)], needs="av"),
    Reader(
        "webp",
        ".webp",
        seeds.pages,
        lambda path: web.decode_picture(path.read_bytes()),
        False,
        REFUSED,
        printed=LARGE,
    ),
    Reader("exif", ".exif", seeds.settings, read_exif, named=False),
    Reader("times", ".txt", seeds.times, times.read_times),
    Reader("curve-csv", ".csv", seeds.curves, response_files.read_curve),
    Reader("curve-pfs", ".m", seeds.curves, response_files.read_curve),
    Reader("plan", ".toml", course_seeds.plan, plan.read, damaged="plan"),
    Reader("roster", ".csv", course_seeds.roster, roster.read),
    Reader("received", ".csv", course_seeds.received, class_folder.read_times),
    Reader("gradebook", ".csv", course_seeds.gradebook, lambda path: marks.read([path])),
    Reader("answers", ".csv", course_seeds.answers, read_class_answers),
    Reader("project", ".toml", course_seeds.project, read_project, named=False),
    Reader("result", ".json", course_seeds.result, read_result, named=False, damaged="results"),
    Reader("notebook", ".ipynb", course_seeds.notebook, read_submission, damaged="words"),
    Reader("python", ".py", course_seeds.notebook, read_submission),
    Reader("zip", ".zip", course_seeds.archives, read_archive, named=False, damaged="zip"),
    Reader("tar", ".tar", course_seeds.archives, read_archive, named=False, damaged="tar"),
    Reader("tar.gz", ".tgz", course_seeds.archives, read_archive, named=False),
    Reader("manifest", ".json", course_seeds.manifest, read_manifest, named=False),
    Reader("artifact", ".jpg", seeds.photographs, pictures.prepare),
    Reader("words", ".md", course_seeds.words, read_words),
    Reader("words-ipynb", ".ipynb", course_seeds.words, read_words, damaged="report"),
    Reader(
        "token",
        ".txt",
        course_seeds.token,
        lambda path: tokens.read(path.read_text("utf8", "replace")),
    ),
)
READERS = {reader.name: reader for reader in ALL}
