"""Write the report on a student's project as a page: text, bracket, response curve, map and artifact.

The artifact opens the page. The bracket follows the section about the description, the response
curve the one about the algorithm, and the map the results. A figure whose section is missing gets a
section of its own. The page loads nothing from the network and runs no scripts.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from markupsafe import Markup

from hdrlab.core.arrays import to_256
from hdrlab.course.projects import words
from hdrlab.course.projects.project import (
    ALBUMS,
    EXAMPLE_ABOUT,
    REPORT_PAGE,
    REPORT_SOURCES,
    Project,
)
from hdrlab.errors import InputError
from hdrlab.io import decode, exif_exposure, files, photos, radiance, response_files
from hdrlab.show import plots
from hdrlab.show.pages import sections, templates
from hdrlab.show.plots import figures

# figure -> the topic whose section it follows
TOPIC_OF_FIGURE = {"bracket": "description", "curves": "algorithm", "map": "results"}
# figure -> heading of its own section, where that topic has none
OWN_HEADINGS = {"bracket": "The bracket", "curves": "The response", "map": "The radiance map"}
# figure -> the file from which it is made, for students who do not have it
WANTED_FILES = {
    "artifact": "artifact.jpg, your tone-mapped image",
    "bracket": f"photographs in the folder {ALBUMS[0]}",
    "curves": "response.csv, the response curve that you recovered",
    "map": "map.hdr, your radiance map",
}
ARTIFACT_SIDE_PIXELS = 1600
FRAME_SIDE_PIXELS = 400
# of photos that do not state it, so that they can be sorted
DEFAULT_ISO = 100.0
TEMPLATE = "project_report.html"


@dataclass(frozen=True)
class Part:
    """A section of the page: its text, and the figures that follow it, by name."""

    heading: str
    html: Markup
    figures: dict[str, Any]


@dataclass(frozen=True)
class WrittenReport:
    """The result of writing a report.

    Attributes
    ----------
    page : the written page
    placed : the names of its figures
    notes : what is missing or could not be shown, as sentences
    """

    page: Path
    placed: tuple[str, ...]
    notes: tuple[str, ...]


def write_report(project: Project) -> WrittenReport:
    """Write `report.html` into a project's folder.

    Parameters
    ----------
    project : Project
        The project, as `project.read_project` returns it.

    Raises
    ------
    InputError
        If the project has no text for the report.
    """
    if project.words is None:
        names = " or ".join(REPORT_SOURCES)
        raise InputError(f"{project.folder}: no text for the report; write {names}")
    text = words.read(project.words)
    notes = list(text.notes)
    figure_of_name = dict(_make_figures(project, notes))
    notes += [f"the report has no section about: {topic}" for topic in text.missing()]
    page = templates.render_page(
        Path(__file__).parent,
        TEMPLATE,
        in_words=plots.seconds,
        title=text.title or project.about.title or project.folder.resolve().name,
        about=project.about,
        hero=figure_of_name.get("artifact"),
        parts=tuple(_make_parts(text, figure_of_name)),
    )
    path = files.write(project.folder / REPORT_PAGE, page)
    return WrittenReport(path, tuple(figure_of_name), tuple(notes))


def _make_figures(project: Project, notes: list[str]) -> Iterator[tuple[str, Any]]:
    """Yield the name and the content of each figure; note those that are missing or cannot be shown."""
    makers: dict[str, Callable[[], Any] | None] = dict.fromkeys(WANTED_FILES)
    if project.artifact:
        makers["artifact"] = partial(_artifact, project.artifact)
    if project.photographs:
        makers["bracket"] = partial(_bracket, project.photographs)
    if project.curve:
        makers["curves"] = partial(_curves, project.curve)
    if project.map:
        makers["map"] = partial(_map, project.map)
    for name, make in makers.items():
        if make is None:
            notes.append(f"there is no {WANTED_FILES[name]}")
            continue
        try:
            figure = make()
        except (ValueError, OSError) as error:  # a damaged file costs one figure
            notes.append(f"cannot show the {name}: {error}")
            continue
        yield name, figure


def _artifact(path: Path) -> figures.Illustration:
    """Return the artifact as a figure."""
    pixels = to_256(photos.read_photo(path))
    return figures.photograph(pixels, ARTIFACT_SIDE_PIXELS, "The artifact: the tone-mapped image")


def _bracket(paths: tuple[Path, ...]) -> list[dict[str, Any]]:
    """Return the photos from the shortest to the longest exposure; one at a time is in memory."""
    frames = []
    for path in paths:
        exposure = decode.read_header(path).exposure
        small = figures.fit(to_256(photos.read_photo(path)), FRAME_SIDE_PIXELS)
        alt = f"Photograph {path.name}"
        if exposure.seconds:
            alt += f", exposed for {plots.seconds(exposure.seconds)}"
        picture = figures.photograph(small, FRAME_SIDE_PIXELS, alt)
        frames.append({"name": path.name, "exposure": exposure, "picture": picture})
    return sorted(frames, key=lambda frame: (_relative_light(frame["exposure"]), frame["name"]))


def _relative_light(exposure: exif_exposure.Exposure) -> float:
    """Return the exposure as time * ISO / f-number**2, with 0 for an unknown time."""
    seconds = exposure.seconds or 0.0
    iso = exposure.iso or DEFAULT_ISO
    f_number = exposure.f_number or 1.0
    return seconds * iso / f_number**2


def _curves(path: Path) -> dict[str, Any]:
    """Return the response curve as a figure."""
    return sections.response(response_files.read_curve(path), None, None)


def _map(path: Path) -> dict[str, Any]:
    """Return the radiance map as a figure."""
    E = radiance.read_radiance(path, clean=True)
    size = f"{E.shape[1]} x {E.shape[0]}"
    return sections.radiance(E) | {"size": size, "name": path.name}


def _make_parts(text: words.ReportText, figure_of_name: dict[str, Any]) -> Iterator[Part]:
    """Yield the sections with their figures, then the figures whose section is missing."""
    waiting = {name: figure_of_name[name] for name in TOPIC_OF_FIGURE if name in figure_of_name}
    for section in text.sections:
        names = [name for name in waiting if TOPIC_OF_FIGURE[name] == section.topic]
        yield Part(section.heading, section.html, {name: waiting.pop(name) for name in names})
    for name, figure in waiting.items():
        yield Part(OWN_HEADINGS[name], Markup(), {name: figure})


def example() -> str:
    """Return a report to start from, with the required headings and an example of `project.toml`."""
    headings = [f"## {topic.capitalize()}\n\n..." for topic in words.TOPIC_PATTERNS]
    body = "\n\n".join(headings)
    return f"# The title of your project\n\n{body}\n\n<!-- project.toml:\n{EXAMPLE_ABOUT}-->\n"
