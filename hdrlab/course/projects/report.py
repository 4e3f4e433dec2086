"""The report on a student's project: their words, and bracket, curves, map and artifact where they belong.

The artifact opens the page. The bracket follows the description, the curves the algorithm, the map
the results; where such a section is missing the figure gets one of its own. Nothing on the page is
fetched, and nothing on it runs.
"""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

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

AFTER = {"bracket": "description", "curves": "algorithm", "map": "results"}  # figure -> section
ALONE = {"bracket": "The bracket", "curves": "The response", "map": "The radiance map"}
TEMPLATE = "project_report.html"


class Part(NamedTuple):
    """A section of the page: its words and the figures that were placed in it, by name."""

    heading: str
    html: Markup
    figures: dict[str, Any]


class Written(NamedTuple):
    """The page, what was placed on it, and what is missing or could not be shown, in words."""

    page: Path
    placed: tuple[str, ...]
    notes: tuple[str, ...]


def write_report(project: Project) -> Written:
    """Write `report.html` into a project's folder.

    Parameters
    ----------
    project : Project
        What `project.read_project` found.

    Raises
    ------
    ValueError
        Where there are no words to make a page of.
    """
    if project.words is None:
        raise InputError(
            f"{project.folder}: expected words for the report, in {' or '.join(REPORT_SOURCES)}"
        )
    said = words.read(project.words)
    notes = list(said.notes)
    found = dict(_figures(project, notes))
    parts = tuple(_parts(said, {name: found[name] for name in AFTER if name in found}))
    notes += [f"the report has no section about: {name}" for name in said.missing()]
    title = said.title or project.about.title or project.folder.resolve().name
    shown = {"title": title, "about": project.about, "hero": found.get("artifact"), "parts": parts}
    text = templates.render_page(Path(__file__).parent, TEMPLATE, in_words=plots.seconds, **shown)
    return Written(files.write(project.folder / REPORT_PAGE, text), tuple(found), tuple(notes))


def _figures(project: Project, notes: list[str]) -> Iterator[tuple[str, Any]]:
    """Yield what can be shown, by name; what cannot is noted."""
    makers: tuple[tuple[str, Any, Callable[[Any], Any], str], ...] = (
        (
            "artifact",
            project.artifact,
            _artifact,
            "artifact.jpg, your tone-mapped image",
        ),
        ("bracket", project.photographs, _bracket, f"photographs in the folder {ALBUMS[0]}"),
        ("curves", project.curve, _curves, "response.csv, the response curve that you recovered"),
        ("map", project.map, _map, "map.hdr, your radiance map"),
    )
    for name, source, make, wanted in makers:
        if not source:
            notes.append(f"there is no {wanted}")
            continue
        try:
            yield name, make(source)
        except (ValueError, OSError) as error:
            notes.append(f"the {name} cannot be shown: {error}")


def _artifact(path: Path) -> figures.Illustration:
    return figures.photograph(
        to_256(photos.read_photo(path)), 1600, "The artifact: the tone-mapped image"
    )


def _bracket(paths: tuple[Path, ...]) -> list[dict[str, Any]]:
    """Return the photographs from the shortest exposure to the longest, one in memory at a time."""
    frames = []
    for path in paths:
        header = decode.read_header(path)
        small = figures.fit(to_256(photos.read_photo(path)), 400)
        time = header.exposure.seconds
        alt = f"Photograph {path.name}" + (f", exposed for {plots.seconds(time)}" if time else "")
        shown = figures.photograph(small, 400, alt)
        frames.append({"name": path.name, "exposure": header.exposure, "picture": shown})
    return sorted(frames, key=lambda one: (_light(one["exposure"]), one["name"]))


def _light(exposure: exif_exposure.Exposure) -> float:
    seconds, f_number, iso = exposure
    return (seconds or 0.0) * (iso or 100.0) / (f_number or 1.0) ** 2


def _curves(path: Path) -> dict[str, Any]:
    return sections.response(response_files.read_curve(path), None)


def _map(path: Path) -> dict[str, Any]:
    E = radiance.read_radiance(path, clean=True)
    return sections.radiance(E) | {"size": f"{E.shape[1]} x {E.shape[0]}", "name": path.name}


def _parts(said: words.ReportText, found: dict[str, Any]) -> Iterator[Part]:
    """Yield the sections with their figures, then the figures whose section is missing."""
    waiting = dict(found)
    for section in said.sections:
        mine = {name: waiting.pop(name) for name in list(waiting) if AFTER[name] == section.topic}
        yield Part(section.heading, section.html, mine)
    for name, figure in waiting.items():
        yield Part(ALONE[name], Markup(), {name: figure})


def example() -> str:
    """Return words to begin a report with, and what goes into `project.toml`."""
    heads = "\n\n".join(f"## {name.capitalize()}\n\n..." for name in words.TOPIC_PATTERNS)
    return f"# The title of your project\n\n{heads}\n\n<!-- project.toml:\n{EXAMPLE_ABOUT}-->\n"
