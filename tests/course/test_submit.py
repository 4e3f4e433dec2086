"""`hdrlab report` and `hdrlab submit` for a project: missing parts are named, and the rest arrives."""

import io
import json
import os
import re
import zipfile
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image

from hdrlab import cli, scenes
from hdrlab.capture import camera
from hdrlab.course.gallery import collect
from hdrlab.course.projects import project, report as reports, review, submit as handing, words
from hdrlab.course.students.roster import Roster, Student
from hdrlab.course.submissions.archives.unpack import unpack
from hdrlab.io import radiance, response_files
from hdrlab.io.decode import read_header

TIMES = [1 / 250, 1 / 60, 1 / 15]
REPORT = """# Dusk

## Description
A room with a *bright* window.

## What we learnt
That <script>alert(1)</script> is shown. [A link](javascript:alert(2)) is not.

## Algorithm
`gsolve`, by hand.

## Implementation
```python
g = gsolve(Z, B)
```

## Results
![The window](figures/window.png)

## Bells and whistles
None.
"""


def photograph(path, image, seconds):
    exif = Image.Exif()
    exif[0x0110] = "Model"
    exif.get_ifd(0x8769).update({0x829A: seconds, 0x829D: 8.0, 0x8827: 100, 0xA431: "SERIAL-4711"})
    exif.get_ifd(0x8825).update({1: "N", 2: (51.0, 30.0, 0.0)})
    Image.fromarray(image).save(path, quality=95, exif=exif)


@pytest.fixture
def home(tmp_path):
    """A complete project."""
    folder = tmp_path / "project"
    for name in ("photographs", "figures", "source", ".git", "__pycache__"):
        (folder / name).mkdir(parents=True)
    E = scenes.room((48, 72))
    for k, (image, time) in enumerate(
        zip(camera.shoot(E, TIMES, rng=1).images, TIMES, strict=True)
    ):
        photograph(folder / "photographs" / f"{9 - k}.jpg", image, time)
    radiance.write_radiance(folder / "map.hdr", E)
    response_files.write_curve(folder / "response.csv", np.log(np.linspace(0.01, 2, 256)))
    Image.fromarray(camera.shoot(E, [1 / 60], rng=2).images[0]).save(folder / "artifact.png")
    Image.new("RGB", (40, 30), "teal").save(folder / "figures" / "window.png")
    (folder / "source" / "hdr.py").write_text("import numpy\nfrom helpers import merge\n")
    (folder / "source" / "helpers.py").write_text("def merge():\n    pass\n")
    (folder / ".git" / "config").write_text("secret")
    (folder / "__pycache__" / "hdr.pyc").write_bytes(b"x")
    (folder / "project.toml").write_text(
        'students = ["b1", "b2"]\ntitle = "Dusk"\ncaption = "By <hand>."\n'
    )
    (folder / "report.md").write_text(REPORT)
    return folder


@pytest.fixture
def hdrlab(tmp_path, monkeypatch, capsys):
    """hdrlab(words) -> exit code, standard output and standard error."""
    monkeypatch.chdir(tmp_path)

    def command(*words):
        with pytest.raises(SystemExit) as ended:
            cli.run([str(word) for word in words])
        return ended.value.code or 0, *capsys.readouterr()

    return command


class Page(HTMLParser):
    """The headings, pictures, addresses and scripts of a page."""

    def __init__(self, text):
        super().__init__()
        self.pictures = []
        self.links = []
        self.tags = []
        self.order = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.tags.append(tag)
        if tag == "img":
            self.pictures.append(attrs)
        if tag == "a":
            self.links.append(attrs.get("href", ""))
        assert not [name for name in attrs if name.startswith("on")]

    def handle_data(self, data):
        self.order.append(data.strip())


def bad(folder):
    findings = review.review(project.read_project(folder))
    return {finding.part: finding.said for finding in findings if not finding.good}


def test_a_whole_project_can_be_reported_submitted_and_shown_in_the_gallery(home, tmp_path, hdrlab):
    code, output, notes = hdrlab("report", home)
    assert (code, notes) == (0, "") and "artifact, bracket, curves, map" in output
    code, output, notes = hdrlab("submit", home)
    assert code == 0
    assert "MISSING" not in output
    assert "location" in output
    assert "serial numbers" in output
    members = unpack(tmp_path / "submission.zip", tmp_path / "there")
    names = {str(path) for path, _ in members}
    assert {
        "map.hdr",
        "report.html",
        "photographs/9.jpg",
        "source/hdr.py",
        "submission.json",
    } <= names
    assert not [name for name in names if ".git" in name or "pycache" in name]
    described = json.loads((tmp_path / "there" / "submission.json").read_text())
    assert described["students"] == ["b1", "b2"]
    assert set(described["files"]) == names - {"submission.json"}
    roster = Roster((Student("b1", "Ada", "t"), Student("b2", "Bo", "t")))
    with collect.entry(tmp_path / "submission.zip", roster, "b1_project") as entry:
        assert (entry.team, entry.title, entry.caption) == (
            "t",
            "Dusk",
            "By <hand>.",
        )
        assert entry.picture.read_bytes()[:4] == b"\x89PNG"


def test_submitted_photos_keep_their_exposures_and_lose_their_locations(home, tmp_path, hdrlab):
    for flags, there in (((), False), (("--keep-metadata",), True)):
        hdrlab("report", home)
        assert hdrlab("submit", home, "-o", "a.zip", *flags)[0] == 0
        with zipfile.ZipFile(tmp_path / "a.zip") as archive:
            data = archive.read("photographs/9.jpg")
        assert (b"SERIAL-4711" in data) == there
        (tmp_path / "a.jpg").write_bytes(data)
        with (
            Image.open(tmp_path / "a.jpg") as now,
            Image.open(home / "photographs" / "9.jpg") as before,
        ):
            assert bool(dict(now.getexif().get_ifd(0x8825))) == there
            assert np.array_equal(np.asarray(now), np.asarray(before))
        assert read_header(tmp_path / "a.jpg").exposure.seconds == pytest.approx(TIMES[0])


@pytest.mark.parametrize("suffix", ["webp", "avif", "jpe", "jpg", "png"])
@pytest.mark.parametrize("folder", ["figures", "photographs"])
def test_photos_of_any_format_in_any_folder_go_without_their_location(
    home, tmp_path, hdrlab, suffix, folder
):
    photograph(home / folder / f"place.{suffix}", np.full((48, 72, 3), 90, np.uint8), 0.5)
    packed = {file.name: file for file in handing.pack(project.read_project(home))}
    file = packed[f"{folder}/place.{suffix}"]
    assert "location" in file.removed
    with Image.open(io.BytesIO(file.data)) as image:
        assert not dict(image.getexif().get_ifd(0x8825))


def test_a_photo_that_cannot_be_cleaned_is_refused_by_name(home, hdrlab):
    (home / "figures" / "place.rw2").write_bytes(b"something else")
    code, _, errors = hdrlab("submit", home, "--force")
    assert code == 2
    assert "figures/place.rw2" in errors


def test_a_video_is_packed_with_a_warning(home, hdrlab):
    (home / "figures" / "film.mp4").write_bytes(b"\0\0\0 ftypmp42")
    hdrlab("report", home)
    code, _, notes = hdrlab("submit", home)
    assert code == 0
    assert "figures/film.mp4" in notes


def test_the_same_project_makes_the_same_archive(home, tmp_path):
    reports.write_report(project.read_project(home))
    project_read = project.read_project(home)
    for name in ("a.zip", "b.zip"):
        handing.write(
            project_read,
            tmp_path / name,
            list(handing.pack(project_read)),
            now=handing.datetime(2026, 3, 1),
        )
    assert (tmp_path / "a.zip").read_bytes() == (tmp_path / "b.zip").read_bytes()


def spoil(home, how):
    """Remove or break a part of a project."""
    reports.write_report(project.read_project(home))
    for name in how.split():
        target = home / name
        if target.is_dir():
            for path in sorted(target.iterdir())[1:]:
                path.unlink()
        else:
            target.unlink()


@pytest.mark.parametrize(
    ("gone", "part", "message"),
    [
        ("project.toml", "students", "Write a file project.toml"),
        ("source/hdr.py source/helpers.py", "source", "no source"),
        ("source/helpers.py", "source", "imports helpers"),
        ("report.html", "report", "hdrlab report"),
        ("photographs", "photographs", "it holds 1"),
        ("map.hdr", "map", "Save it as map.hdr"),
        ("artifact.png", "artifact", "artifact.jpg"),
    ],
)
def test_a_missing_part_of_a_project_is_reported_with_what_to_do(home, gone, part, message):
    spoil(home, gone)
    assert list(bad(home)) == [part] and message in bad(home)[part]


def test_a_broken_part_of_a_project_is_reported(home):
    reports.write_report(project.read_project(home))
    assert bad(home) == {}
    (home / "source" / "hdr.py").write_text("def f(:\n")
    (home / "map.hdr").write_bytes((home / "map.hdr").read_bytes()[:200])
    (home / "artifact.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(50))
    Image.new("RGB", (72, 48)).save(home / "photographs" / "9.jpg")  # without EXIF
    os.utime(home / "report.md", (2e9, 2e9))
    problems = bad(home)
    assert set(problems) == {"source", "map", "artifact", "photographs", "report"}
    assert "line 1" in problems["source"]
    assert "newer" in problems["report"]
    assert "EXIF" in problems["photographs"]
    assert all(str(home) not in message for message in problems.values())


def test_photos_of_one_exposure_are_not_a_bracket(home):
    for path in (home / "photographs").iterdir():
        photograph(path, np.zeros((48, 72, 3), np.uint8), 0.01)
    assert "same exposure" in bad(home)["photographs"]


def test_an_incomplete_project_is_packed_only_on_request(home, tmp_path, hdrlab):
    (home / "map.hdr").unlink()
    code, output, notes = hdrlab("submit", home)
    assert code == 2 and "MISSING" in output and not (tmp_path / "submission.zip").exists()
    assert hdrlab("submit", home, "--force")[0] == 0 and (tmp_path / "submission.zip").exists()


def test_a_link_out_of_the_project_is_not_followed(home, tmp_path):
    (tmp_path / "secret.py").write_text("SECRET = 1")
    (home / "source" / "link.py").symlink_to(tmp_path / "secret.py")
    assert not [file for file in project.read_project(home).files if file.name == "link.py"]


def test_figures_are_placed_in_their_sections(home):
    page = Page(reports.write_report(project.read_project(home)).page.read_text())
    heads = [
        "Description",
        "What we learnt",
        "Algorithm",
        "Implementation",
        "Results",
        "Bells and whistles",
    ]
    at = {head: page.order.index(head) for head in heads}
    assert sorted(at.values()) == list(at.values())
    place = {
        name: next(k for k, text in enumerate(page.order) if start in text)
        for name, start in [
            ("bracket", "1/250 s"),
            ("curves", "The response curve:"),
            ("map", "the median luminance"),
        ]
    }
    assert at["Description"] < place["bracket"] < at["What we learnt"]
    assert at["Algorithm"] < place["curves"] < at["Implementation"]
    assert at["Results"] < place["map"] < at["Bells and whistles"]
    times = [text for text in page.order if re.fullmatch(r"1/\d+ s", text)]
    assert times == ["1/250 s", "1/60 s", "1/15 s"]


def test_the_report_runs_nothing_fetches_nothing_and_names_its_pictures(home):
    text = reports.write_report(project.read_project(home)).page.read_text()
    page = Page(text)
    assert "script" not in page.tags and "&lt;script&gt;" in text and "By &lt;hand&gt;." in text
    assert page.links == [] and len(page.pictures) == 7
    assert all(
        picture["src"].startswith("data:image/") and picture["alt"] for picture in page.pictures
    )


def test_figures_without_their_section_get_one_of_their_own(home):
    (home / "report.md").write_text("Only a word.\n")
    written = reports.write_report(project.read_project(home))
    order = Page(written.page.read_text()).order
    assert [heading for heading in order if heading in reports.OWN_HEADINGS.values()] == list(
        reports.OWN_HEADINGS.values()
    )
    assert sum("no section about" in note for note in written.notes) == 6


def test_an_image_outside_the_project_is_left_out_and_reported(home, tmp_path):
    Image.new("RGB", (40, 30)).save(tmp_path / "secret.png")
    (home / "figures" / "drawing.svg").write_text("<svg onload='alert(1)'/>")
    (home / "report.md").write_text(
        "![a](../secret.png) ![b](https://example.org/b.png) ![c](figures/drawing.svg)"
        " ![](figures/window.png) ![e](/etc/passwd) ![f](file:///etc/passwd)"
    )
    written = reports.write_report(project.read_project(home))
    pictures = Page(written.page.read_text()).pictures
    assert sum("left out" in note for note in written.notes) >= 4
    assert sum("no description" in note for note in written.notes) == 1
    assert len(pictures) == 7  # six figures, and the window


def test_a_report_may_be_a_notebook_instead_of_markdown(home):
    import base64

    data = base64.b64encode((home / "figures" / "window.png").read_bytes()).decode()
    cells = [
        {"cell_type": "markdown", "source": ["# Dusk\n", "\n", "## Results\n", "Seen."]},
        {
            "cell_type": "code",
            "source": ["show()"],
            "outputs": [{"data": {"image/png": data, "text/plain": ["<F>"]}}],
        },
        {
            "cell_type": "code",
            "source": [],
            "outputs": [{"data": {"text/html": "<script>alert(1)</script>"}}],
        },
    ]
    (home / "report.md").unlink()
    (home / "report.ipynb").write_text(
        json.dumps({"cells": cells, "nbformat": 4, "nbformat_minor": 5})
    )
    report_text = words.read(home / "report.ipynb")
    assert (report_text.title, [section.topic for section in report_text.sections]) == (
        "Dusk",
        ["results"],
    )
    assert "<img" in report_text.sections[0].html
    assert "script" not in report_text.sections[0].html
    assert report_text.notes == ()
    for broken in (
        "{}",
        "[]",
        "{",
        '{"cells": [1]}',
        '{"cells": [{"cell_type": "markdown", "source": 7}]}',
    ):
        (home / "report.ipynb").write_text(broken)
        with pytest.raises(ValueError, match="notebook"):
            words.read(home / "report.ipynb")


def test_the_example_project_is_complete(tmp_path, hdrlab):
    assert hdrlab("report", ".", "--example")[0] == 0
    assert words.read(tmp_path / "report.md").missing() == []
    assert hdrlab("report", ".", "--example")[0] == 2
