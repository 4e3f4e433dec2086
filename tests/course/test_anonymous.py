"""Anonymous grading: readers see codes, and the names return at the end."""

import csv
import io
import json
import re
import subprocess
import sys
import tokenize
import zipfile
from pathlib import Path

import pytest
from support.one_task_homework import PLAN

from hdrlab import cli
from hdrlab.course.students import anonymity, csv_tables
from hdrlab.course.students.roster import Roster, Student

ROSTER_TEXT = """student,name,email,team
b0123,Ada Lovelace,ada.l@uni.example,
b0456,Max Müller,max@uni.example,Stargazers
b0789,Bo Ng,bo.ng@uni.example,Stargazers
40711,Alexander von Humboldt,humboldt@uni.example,
b0999,Grace Hopper,grace@uni.example,
"""
ROSTER = Roster(
    (
        Student("b0123", "Ada Lovelace", "b0123", "ada.l@uni.example"),
        Student("b0456", "Max Müller", "Stargazers", "max@uni.example"),
        Student("b0789", "Bo Ng", "Stargazers", "bo.ng@uni.example"),
        Student("40711", "Alexander von Humboldt", "40711", "humboldt@uni.example"),
    )
)
# what must be nowhere, in any case; Bo, Ng and Max are short or ordinary words, see below
FORBIDDEN = (
    *("b0123", "b0456", "b0789", "40711", "b0999", "lovelace", "müller", "mueller", "muller"),
    *("humboldt", "hopper", "stargazers", "uni.example"),
)
FORBIDDEN_AS_WRITTEN = ("Ada", "Bo Ng", "Max", "Alexander", "Grace")


def leaks(text):
    words = [word for word in FORBIDDEN if word in text.lower()]
    return words + [word for word in FORBIDDEN_AS_WRITTEN if re.search(rf"\b{word}\b", text)]


@pytest.fixture(scope="module")
def names():
    return anonymity.make_anonymity(ROSTER, "salt", ["max", "curve"])


def test_a_code_depends_on_student_and_secret_alone(names):
    later = Roster((*ROSTER.students, Student("b1", "New", "b1")))
    others = anonymity.make_anonymity(later, "salt")
    assert all(others.students[id] == code for id, code in names.students.items())
    elsewhere = anonymity.make_anonymity(ROSTER, "pepper").students
    assert not set(elsewhere.values()) & set(names.students.values())
    codes = anonymity.make_codes([f"b{k}" for k in range(5000)], "salt")
    assert len(set(codes.values())) == 5000


def test_a_team_of_one_has_the_code_of_its_student(names):
    assert names.teams["b0123"] == names.students["b0123"]
    assert names.teams["Stargazers"] not in names.students.values()


@pytest.mark.parametrize(
    "text",
    [
        "by Ada Lovelace (b0123)",
        "LOVELACE, ADA; lovelaceada_LATE_815_hw2.ipynb",
        "B0123_hw2.ipynb and b0123",
        "/home/ada/hw2, ada@elsewhere.example",
        "Max Muller, Max Mueller, Mu\u0308ller",
        "Alexander of Humboldt, 40711",
        "the stargazers: Bo Ng and Max",
        "mail: humboldt@uni.example",
        "__ada__ *Ada*",
    ],
)
def test_names_ids_and_addresses_are_found_however_they_are_written(names, text):
    shown = names.redact(text)
    words = set(re.findall(r"[^\W_]+", shown))
    assert not words & {"Ada", "ada", "ADA", "Bo", "Ng", "Max", "Alexander"}
    assert not [word for word in FORBIDDEN if word in shown.lower()]


@pytest.mark.parametrize(
    "text",
    ["the max of the curve", "adamant bombs, 407112 pixels, max(z)", "a von Kries transform"],
)
def test_ordinary_words_stay(names, text):
    assert names.redact(text) == text


def test_a_full_name_is_replaced_by_the_code_of_its_student(names):
    assert names.redact("Ada Lovelace") == names.students["b0123"]
    assert names.redact("Ada") == anonymity.REPLACED


CODE = '''import numpy as np
# Ada Lovelace wrote this with Bo, in max 3 hours
def hat(n=40711):
    """Max Müller's hat."""
    ada = np.max([n, 1])
    return f"by Ada {ada}"  # b0123
'''


def test_only_comments_and_strings_of_code_change(names):
    shown = names.redact_code(CODE)
    assert not re.search(r"Ada|Bo\b|Müller|b0123", shown)
    kinds = [
        [
            token.string
            for token in tokenize.generate_tokens(io.StringIO(text).readline)
            if token.type in (tokenize.NAME, tokenize.NUMBER, tokenize.OP)
        ]
        for text in (CODE, shown)
    ]
    assert kinds[0] == kinds[1]


def test_code_that_python_cannot_read_is_treated_as_text(names):
    assert not leaks(names.redact_code('"""Ada Lovelace, b0123, Max\ndef ((('))


def notebook(*cells):
    """Return a notebook of (kind, text), with outputs that reveal the author."""
    written = []
    for number, (kind, text) in enumerate(cells):
        cell = {"cell_type": kind, "id": f"c{number}", "metadata": {}, "source": text}
        if kind == "code":
            output = {"output_type": "stream", "name": "stdout", "text": "/home/lovelace"}
            cell |= {"outputs": [output], "execution_count": 1}
        written.append(cell)
    metadata = {"authors": [{"name": "Ada Lovelace"}]}
    return json.dumps({"cells": written, "metadata": metadata, "nbformat": 4, "nbformat_minor": 5})


HAT = """import numpy as np

# Grace Hopper wrote this.
def hat(n=256):
    z = np.arange(n)
    return np.minimum(z, n - 1 - z) / ((n - 1) // 2)
"""
TELLING = """import numpy as np

# Ada Lovelace, b0123
def hat(n=256):
    print("Ada Lovelace was here")
    raise ValueError("b0123 ada.l@uni.example gives up")
"""
WORDS = (
    "grade in --homework hw2 --roster roster.csv --plan plan.toml --secret-file secret.txt -o out"
)


@pytest.fixture(scope="module")
def graded(tmp_path_factory):
    """A class graded anonymously, and then with names: its folder, and both outputs."""
    folder = tmp_path_factory.mktemp("class")
    (folder / "roster.csv").write_text(ROSTER_TEXT, encoding="utf8")
    (folder / "plan.toml").write_text(PLAN)
    (folder / "in").mkdir()
    text = notebook(("markdown", "# By Ada Lovelace\nmy max"), ("code", TELLING))
    (folder / "in" / "b0123_hw2.ipynb").write_text(text)
    (folder / "in" / "lovelaceada_815_4711_old.ipynb").write_text(text)
    with zipfile.ZipFile(folder / "in" / "Stargazers.zip", "w") as archive:
        archive.writestr("hw2_müller.py", HAT.replace("Grace Hopper", "Bo Ng, Max Müller"))
    (folder / "in" / "40711.py").write_text(HAT)
    (folder / "in" / "b0999_hw2.pdf").write_text("no notebook")
    times = "file,received\n40711.py,2026-10-26T12:00Z\nb0999_hw2.pdf,2026-10-20T12:00Z\n"
    (folder / "times.csv").write_text(times)
    return folder


@pytest.fixture(scope="module")
def run(graded):
    """run(words) -> the output of a command in the folder of the class."""

    def run_command(words):
        ran = subprocess.run(
            [sys.executable, "-m", "hdrlab", *words.split()],
            cwd=graded,
            capture_output=True,
            text=True,
            timeout=900,
        )
        assert ran.returncode == 0, ran.stdout + ran.stderr
        return ran.stdout + ran.stderr

    return run_command


@pytest.fixture(scope="module")
def anonymous(graded, run):
    """The anonymous folder of the class, and the output of the command."""
    output = run(f"{WORDS} --received times.csv --anonymous")
    return graded / "out" / "anonymous", output


@pytest.mark.grading
def test_nothing_that_an_anonymous_reader_opens_has_a_name(anonymous, graded):
    folder, output = anonymous
    files = [path for path in folder.rglob("*") if path.is_file()]
    names = {path.name for path in files}
    assert {"class.html", "gradebook.csv", "points.csv", "similar.html", "feedback.html"} <= names
    assert sum(path.parent.name == "submissions" for path in files) == 3
    for path in files:
        assert not leaks(path.read_text(encoding="utf8")), path
        assert not leaks(str(path.relative_to(graded)))
    assert not leaks(output), output
    assert "1 of 5 students are late: S" in output


@pytest.mark.grading
def test_no_page_or_table_with_names_is_written(anonymous, graded):
    assert {path.name for path in (graded / "out").iterdir() if path.name[0] != "."} == {
        *("anonymous", "results", "asked.json")
    }


@pytest.mark.grading
def test_neither_rows_nor_times_tell_the_order_of_the_roster(anonymous):
    folder, _ = anonymous
    rows = csv_tables.read_csv(folder / "gradebook.csv")
    assert [row["team"] for row in rows] == sorted(row["team"] for row in rows)
    for kind in ("feedback/*/feedback.html", "submissions/*.py"):
        times = [path.stat().st_mtime_ns for path in sorted(folder.glob(kind))]
        assert len(times) == 3 and times == sorted(times)


@pytest.mark.grading
def test_a_reader_finds_the_code_and_the_results_of_the_checks(anonymous):
    folder, _ = anonymous
    texts = [path.read_text(encoding="utf8") for path in (folder / "submissions").iterdir()]
    assert all("def hat" in text for text in texts)
    (telling,) = [text for text in texts if "raise ValueError" in text]
    assert "# %% [markdown]\n# # By S" in telling and "my max" in telling
    pages = [path.read_text(encoding="utf8") for path in (folder / "feedback").glob("*/*")]
    assert any("gives up" in page for page in pages)
    links = re.findall(r'href="(feedback/[^"]+)"', (folder / "class.html").read_text())
    assert len(links) == 4 and all((folder / link).is_file() for link in links)


@pytest.mark.grading
def test_an_oral_exam_can_be_prepared_from_an_anonymous_submission(anonymous, run, graded):
    folder, _ = anonymous
    path = next(
        path for path in (folder / "submissions").iterdir() if "np.minimum" in path.read_text()
    )
    run(f"viva {path.relative_to(graded)} --homework hw2 --plan plan.toml -o viva")
    pages = list((graded / "viva").iterdir())
    assert len(pages) == 5
    for page in pages:
        assert not leaks(page.read_text(encoding="utf8")), page


@pytest.mark.grading
def test_the_names_come_back_with_the_points_that_a_reader_wrote_beside_the_codes(
    anonymous, run, graded
):
    folder, _ = anonymous
    table = folder / "points.csv"
    rows = csv_tables.read_csv(table)
    codes = anonymity.make_codes(["b0123"], (graded / "secret.txt").read_text().strip())
    for row in rows:
        row["points"] = "7.5" if row["student"] == codes["b0123"] else "1"
    lines = [list(row.values()) for row in rows]
    csv_tables.write_csv(table, ["student", "points", "comment", "hold"], lines)
    output = run(f"{WORDS} --received times.csv --anonymous")  # keeps what was filled in
    assert "0 of them now" in output and "7.5" in table.read_text()
    output = run(f"{WORDS} --received times.csv --adjustments out/anonymous/points.csv")
    assert "3 of 3 graded, 0 of them now" in output
    with open(graded / "out" / "gradebook.csv", encoding="utf-8-sig", newline="") as file:
        gradebook = {row["student"]: row for row in csv.DictReader(file)}
    by_hand = {student: float(row["by hand"]) for student, row in gradebook.items()}
    assert by_hand == {"b0123": 7.5, "b0456": 1, "b0789": 1, "40711": 1, "b0999": 1}
    assert "Ada Lovelace" in (graded / "out" / "canvas.csv").read_text()
    assert (graded / "out" / "feedback" / "b0123" / "feedback.html").is_file()


def test_codes_without_a_secret_are_refused(tmp_path, capsys):
    (tmp_path / "in").mkdir()
    with pytest.raises(SystemExit) as ended:
        cli.run(["grade", str(tmp_path / "in"), "--roster", str(Path(__file__)), "--anonymous"])
    assert ended.value.code == 2 and "--anonymous needs --secret-file" in capsys.readouterr().err
