"""Small good files of the course, by its own writers: what students hand in, and what instructors keep."""

import io
import json
import tarfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

from benchmarks.fuzz.seeds import RGB
from hdrlab.course import plan as plans
from hdrlab.course.classroom.marks import COLUMNS
from hdrlab.course.gallery import tokens
from hdrlab.course.grading import results
from hdrlab.course.projects.project import EXAMPLE_ABOUT, MANIFEST_FILE
from hdrlab.course.students import csv_tables
from hdrlab.io import web

HAT = "import numpy as np\n\ndef hat(n=256):\n    return n - 1 - abs(2 * np.arange(n) - n + 1)\n"


def plan(folder: Path) -> None:
    """Write plans: that of the package, and a short one."""
    text = plans.PLAN.read_text(encoding="utf8")
    (folder / "whole.toml").write_text(text, encoding="utf8")
    short = "[late]\nfree_days = 2\npoints_a_day = 1.5\n"
    short += '[hw1]\ntitle = "One"\ndue = 2026-03-20T23:59:00+08:00\n'
    short += 'tasks = [{ id = "hat", function = "core.weights.hat", points = 10 }]\n'
    (folder / "short.toml").write_text(
        short + 'by_hand = [{ title = "Words", points = 5 }]\n', encoding="utf8"
    )


def roster(folder: Path) -> None:
    """Write a class."""
    rows: list[list[csv_tables.Cell]] = [
        ["b01", "Ada", "a@x.org", "t1"],
        ["b02", "Bo Li", "", "t1"],
        ["b03", "=Cy", "", ""],
    ]
    csv_tables.write_csv(folder / "a.csv", ["student", "name", "email", "team"], rows)


def received(folder: Path) -> None:
    """Write when files came."""
    rows: list[list[csv_tables.Cell]] = [
        ["b01_hw2.ipynb", "2026-03-01T12:00+01:00"],
        ["./x/b03.py", "2026-03-02T12:00:30Z"],
    ]
    csv_tables.write_csv(folder / "a.csv", ["file", "received"], rows)


def answers(folder: Path) -> None:
    """Write what a class answered to the concept inventory."""
    letters: list[list[csv_tables.Cell]] = [["b01", "a", "b"], ["o'hara", "e", ""]]
    csv_tables.write_csv(folder / "a.csv", ["student", "q1", "q2"], letters)
    texts: list[list[csv_tables.Cell]] = [["o'hara@x.edu", "Finished", "10 stops", "-"]]
    columns = ["Email address", "State", "Response 1", "Response 2"]
    csv_tables.write_csv(folder / "b.csv", columns, texts)


def gradebook(folder: Path) -> None:
    """Write a gradebook."""
    row: list[csv_tables.Cell] = [
        "b01",
        "Ada",
        "t1",
        "hw1",
        "2026-03-01T12:00+01:00",
        2,
        1,
        90.5,
        100,
        1,
        89.5,
        8,
        "",
    ]
    csv_tables.write_csv(folder / "a.csv", COLUMNS, [row, row])


def project(folder: Path) -> None:
    """Write what a project says of itself."""
    (folder / "a.toml").write_text(EXAMPLE_ABOUT, encoding="utf8")


def result(folder: Path) -> None:
    """Write a result with a check that fails and its drawing."""
    drawing = results.Drawing((web.encode_webp(RGB),), ("it",), ("below",))
    check = results.Check(
        "hat", "test_hat", "It peaks.", Fraction(1, 3), Fraction(2, 3), "fails", "no", ("a", "b")
    )
    checks = (check, replace(check, drawing=drawing, kind="raised"))
    names = ("b01", "hw2", "The curve", "strict")
    whole = results.Result(
        *names, checks, {"hat": "tent"}, ("none",), "ab", "cd", "ef", {"numpy": "2"}
    )
    (folder / "a.json").write_bytes(results.to_json(whole))


def notebook(folder: Path) -> None:
    """Write what students hand in."""
    mark = {"hdrlab": {"task": "hat"}}
    cells = [
        {"cell_type": "markdown", "source": ["# A\n", "words"], "metadata": {}},
        {"cell_type": "code", "source": HAT.splitlines(True), "metadata": mark, "outputs": []},
        {
            "cell_type": "code",
            "source": "LAM = 30\ndef gsolve(Z):\n    return LAM * Z",
            "metadata": {},
        },
    ]
    whole = {"cells": cells, "nbformat": 4, "nbformat_minor": 5, "metadata": {}}
    (folder / "a.ipynb").write_text(json.dumps(whole, indent=1))
    (folder / "a.py").write_text(
        f'# %% [markdown]\n# words\n# %% task="hat"\n{HAT}# %%\nx = 1\n', encoding="utf8"
    )


def archives(folder: Path) -> None:
    """Write a submission as an archive of each kind."""
    files = {"hw2/hat.py": HAT.encode(), "hw2/notes.txt": b"some words " * 30}
    for kind in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        with zipfile.ZipFile(folder / f"{kind}.zip", "w", kind) as archive:
            for name, data in files.items():
                archive.writestr(zipfile.ZipInfo(name), data)
    for name, mode in (("a.tar", "w"), ("a.tgz", "w:gz")):
        with tarfile.open(folder / name, mode) as tar:  # type: ignore[call-overload]
            for inside, data in files.items():
                info = tarfile.TarInfo(inside)
                info.size = len(data)
                tar.addfile(info, io.BytesIO(data))


def manifest(folder: Path) -> None:
    """Write what an archive of `hdrlab submit` says of itself."""
    settings = {
        "title": "Dusk",
        "caption": "Seven frames.",
        "artifact": "artifact.png",
        "students": ["b01"],
    }
    (folder / "a.json").write_text(json.dumps(settings, indent=1))


@contextmanager
def packed(path: Path, folder: Path) -> Iterator[Path]:
    """Yield an archive with this manifest and a picture."""
    folder.mkdir()
    with zipfile.ZipFile(folder / "fuzzed.zip", "w") as archive:
        archive.writestr(MANIFEST_FILE, path.read_bytes())
        archive.writestr("artifact.png", b"a picture, which is looked at later")
    yield folder / "fuzzed.zip"


def words(folder: Path) -> None:
    """Write a report's words."""
    text = "# Title\n\nWords with **stress**, `code` and $x^2$.\n\n## Method\n\n- one\n- two\n\n"
    text += "| a | b |\n|---|---|\n| 1 | 2 |\n"
    (folder / "a.md").write_text(
        text + "\n![it](artifact.jpg) <b>x</b>\n\n```\ncode\n```\n", encoding="utf8"
    )
    picture = web.data_uri(web.encode_webp(RGB)).partition(",")[2]
    shown = [{"output_type": "display_data", "data": {"image/webp": picture, "image/png": picture}}]
    cells = [
        {"cell_type": "markdown", "source": text},
        {"cell_type": "code", "source": "x", "outputs": shown},
    ]
    (folder / "a.ipynb").write_text(json.dumps({"cells": cells, "nbformat": 4}))


def token(folder: Path) -> None:
    """Write the word that lets somebody vote."""
    (folder / "a.txt").write_text(tokens.make().text)
