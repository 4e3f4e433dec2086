"""Text and numbers from outside end in words that name the file, however long, deep or odd they are."""

import json
import struct
import zipfile

import pytest

from hdrlab.course import plan
from hdrlab.course.archives import unpack
from hdrlab.course.projects import exif, privacy, project, report, words
from hdrlab.course.reports import results

SHEET = """[hw1]
title = "One"
due = 2026-03-20T23:59:00+08:00
tasks = [{{ id = "hat", function = "core.weights.hat", points = {points} }}]
"""


@pytest.mark.parametrize("points", ["1" * 5000, "1" + "0" * 400, "1e400", "[" * 5000, "nan"])
def test_a_number_beyond_counting_in_a_plan_names_the_plan(tmp_path, points):
    (tmp_path / "plan.toml").write_text(SHEET.format(points=points))
    with pytest.raises(ValueError, match=r"plan\.toml: expected"):
        plan.read(tmp_path / "plan.toml")


@pytest.mark.parametrize("title", ["[" * 5000, "1" * 5000])
def test_a_title_of_any_depth_names_the_project(tmp_path, title):
    (tmp_path / "project.toml").write_text(f"title = {title}")
    with pytest.raises(ValueError, match=r"project\.toml"):
        project.look(tmp_path)


def test_a_result_in_brackets_in_brackets_is_refused():
    with pytest.raises(ValueError, match="expected a result"):
        results.from_json(b"[" * 100_000)


def test_a_member_without_a_name_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        archive.writestr("x", b"y")
    data = (tmp_path / "a.zip").read_bytes()
    for at, length in ((0, 26), (data.index(b"PK\1\2"), 28)):  # in its header, and in the list of members
        data = data[: at + length] + struct.pack("<H", 0) + data[at + length + 2 :]
    local, listed = data.index(b"xy"), data.rindex(b"x")
    data = data[:local] + data[local + 1 : listed] + data[listed + 1 :]
    end = data.index(b"PK\5\6")
    size, start = end - data.index(b"PK\1\2"), data.index(b"PK\1\2")
    (tmp_path / "a.zip").write_bytes(data[: end + 12] + struct.pack("<LL", size, start) + data[end + 20 :])
    with pytest.raises(unpack.Refused):
        unpack.unpack(tmp_path / "a.zip", tmp_path / "files")


def test_half_a_character_in_a_notebook_does_not_stop_the_report(tmp_path):
    cells = [{"cell_type": "markdown", "source": "# Title \ud800 x\n\nWords \udfff."}]
    (tmp_path / "report.ipynb").write_text(json.dumps({"cells": cells}))
    page = report.write_report(project.look(tmp_path)).page
    assert "Title ? x" in page.read_text(encoding="utf8")


def test_a_table_of_thousands_of_columns_is_text_and_one_of_ten_a_table(tmp_path):
    for columns, is_table in ((2000, False), (10, True)):
        row = "|" + "a|" * columns + "\n"
        (tmp_path / "report.md").write_text("# T\n\n" + row + "|" + "-|" * columns + "\n" + 5 * row)
        (section,) = words.read(tmp_path / "report.md").sections
        assert ("<table>" in section.html) is is_table


def test_which_of_forty_photographs_cannot_be_cleaned_is_said():
    with pytest.raises(ValueError, match=r"IMG_7\.jpg: expected"):
        privacy.clean("IMG_7.jpg", b"\xff\xd8\xff\xe0\x00\x04ab\x12")


def test_values_of_exif_that_lie_over_each_other_are_read_no_more_than_once(tmp_path):
    count, size = 2000, 500_000
    entries = b"".join(struct.pack("<HHLL", 0x9000 + k, 7, size, 8) for k in range(count))
    block = b"II*\0" + struct.pack("<LH", 8, count) + entries + struct.pack("<L", 0)
    found, _ = exif.directory(block.ljust(size + 8, b"\0"), 8, "<")
    assert sum(len(one.value) for one in found) <= size + 8
