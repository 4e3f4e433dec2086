"""Texts and numbers in a user's files: an error names the file, however long, deep or odd they are."""

import json
import struct
import zipfile

import pytest

from hdrlab.course import plan
from hdrlab.course.grading import results
from hdrlab.course.projects import project, report, words
from hdrlab.course.students import roster
from hdrlab.course.submissions.archives import unpack
from hdrlab.io import metadata, tiff_directories

SHEET = """[hw1]
title = "One"
due = 2026-03-20T23:59:00+08:00
tasks = [{{ id = "hat", function = "core.weights.hat", points = {points} }}]
"""


@pytest.mark.parametrize("points", ["1" * 5000, "1" + "0" * 400, "1e400", "[" * 5000, "nan"])
def test_an_absurd_number_in_a_plan_is_refused_with_the_plans_name(tmp_path, points):
    (tmp_path / "plan.toml").write_text(SHEET.format(points=points))
    with pytest.raises(ValueError, match=r"plan\.toml"):
        plan.read(tmp_path / "plan.toml")


@pytest.mark.parametrize("title", ["[" * 5000, "1" * 5000])
def test_a_heading_of_any_level_is_the_projects_title(tmp_path, title):
    (tmp_path / "project.toml").write_text(f"title = {title}")
    with pytest.raises(ValueError, match=r"project\.toml"):
        project.read_project(tmp_path)


def test_a_deeply_nested_result_is_refused():
    with pytest.raises(ValueError, match="result"):
        results.from_json(b"[" * 100_000)


def test_a_member_without_a_name_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        archive.writestr("x", b"y")
    data = (tmp_path / "a.zip").read_bytes()
    # in its header, and in the list of members
    for at, length in (
        (0, 26),
        (data.index(b"PK\1\2"), 28),
    ):
        data = data[: at + length] + struct.pack("<H", 0) + data[at + length + 2 :]
    local = data.index(b"xy")
    listed = data.rindex(b"x")
    data = data[:local] + data[local + 1 : listed] + data[listed + 1 :]
    end = data.index(b"PK\5\6")
    size = end - data.index(b"PK\1\2")
    start = data.index(b"PK\1\2")
    (tmp_path / "a.zip").write_bytes(
        data[: end + 12] + struct.pack("<LL", size, start) + data[end + 20 :]
    )
    with pytest.raises(unpack.ArchiveRejected):
        unpack.unpack(tmp_path / "a.zip", tmp_path / "files")


def test_a_lone_surrogate_in_a_notebook_does_not_stop_the_report(tmp_path):
    cells = [{"cell_type": "markdown", "source": "# Title \ud800 x\n\nWords \udfff."}]
    (tmp_path / "report.ipynb").write_text(json.dumps({"cells": cells}))
    page = report.write_report(project.read_project(tmp_path)).page
    assert "Title ? x" in page.read_text(encoding="utf8")


def test_a_table_with_thousands_of_columns_is_shown_as_text(tmp_path):
    for columns, is_table in ((2000, False), (10, True)):
        row = "|" + "a|" * columns + "\n"
        (tmp_path / "report.md").write_text("# T\n\n" + row + "|" + "-|" * columns + "\n" + 5 * row)
        (section,) = words.read(tmp_path / "report.md").sections
        assert ("<table>" in section.html) is is_table


def test_a_photo_that_cannot_be_cleaned_is_named_among_forty():
    with pytest.raises(ValueError, match=r"IMG_7\.jpg"):
        metadata.strip_metadata("IMG_7.jpg", b"\xff\xd8\xff\xe0\x00\x04ab\x12")


def test_overlapping_exif_values_are_read_once(tmp_path):
    count = 2000
    size = 500_000
    entries = b"".join(struct.pack("<HHLL", 0x9000 + k, 7, size, 8) for k in range(count))
    block = b"II*\0" + struct.pack("<LH", 8, count) + entries + struct.pack("<L", 0)
    directory = tiff_directories.read_directory(block.ljust(size + 8, b"\0"), 8)
    assert sum(len(entry.value) for entry in directory.entries) <= size + 8


@pytest.mark.parametrize(
    "line",
    [
        '[late]\n"{long}" = 1\n',
        "[late]\nfree_days = {digits}\nx = 1\n",
        "[{long}]\n",
        "[x]\ndue = '{long}'\n",
    ],
)
def test_a_long_value_in_a_plan_is_shortened_in_the_message(line, tmp_path):
    (tmp_path / "plan.toml").write_text(
        line.format(long="x" * 5000, digits="7" * 4000) + SHEET.format(points=1)
    )
    with pytest.raises(ValueError, match=r"plan\.toml") as error:
        plan.read(tmp_path / "plan.toml")
    assert len(str(error.value)) < 1000


def test_a_cell_that_is_too_long_is_refused_with_the_tables_name(tmp_path):
    (tmp_path / "roster.csv").write_text("student\n" + "x" * 140_000)
    with pytest.raises(ValueError, match=r"roster\.csv: .*table"):
        roster.read(tmp_path / "roster.csv")


@pytest.mark.parametrize(
    "change", [(b'"1/3"', b'"1/0"'), (b'"exact": {', b'"exact": [{'), (b'"b01"', b'"\xa0"')]
)
def test_a_damaged_result_is_refused(change, tmp_path):
    course_seeds = pytest.importorskip("benchmarks.fuzz.course_seeds", reason="it makes the result")
    course_seeds.result(tmp_path)
    data = (tmp_path / "a.json").read_bytes()
    assert change[0] in data
    with pytest.raises(ValueError, match="result") as error:
        results.from_json(data.replace(*change))
    assert len(str(error.value)) < 1000


def test_a_zip_with_an_impossible_directory_offset_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        archive.writestr("x", b"y")
    data = (tmp_path / "a.zip").read_bytes()
    end = data.index(b"PK\5\6")
    (tmp_path / "a.zip").write_bytes(
        data[: end + 16] + struct.pack("<L", 1 << 20) + data[end + 20 :]
    )
    with pytest.raises(unpack.ArchiveRejected):
        unpack.unpack(tmp_path / "a.zip", tmp_path / "files")


def test_truncated_exif_is_dropped():
    assert metadata.keep_exposure_tags(b"II*\0\0")[0] == b""
