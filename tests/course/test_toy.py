"""The toy class: two commands make and grade it, and everybody gets the described result."""

import ast
import hashlib
import json
import shutil
import zipfile
from pathlib import Path

import pytest

from hdrlab import cli
from hdrlab.course import plan
from hdrlab.course.authoring import toy_class
from hdrlab.course.checks import misconceptions
from hdrlab.course.grading import results
from hdrlab.course.sandbox import tiers
from hdrlab.course.students import csv_tables

pytestmark = pytest.mark.grading

HOMEWORK = plan.read().homeworks[toy_class.HOMEWORK]
WITH_ALL_POINTS = {"s01", "s02", "s03", "s04", "s05", "s11"}  # all right
WITHOUT_POINTS = {"s10", "s12", "s13", "s14"}  # blank, a hostile archive, attacks, not handed in
HOSTILE = ("s12_hw2.zip", "s13_hw2.py")
AGAIN = ("s02", "s06", "t1")  # graded again without hostile submissions


def run(words):
    """Run a command that must succeed."""
    with pytest.raises(SystemExit) as ended:
        cli.run(words)
    assert not ended.value.code


def grade(folder, out, *words):
    """Grade a toy class with the command in its README."""
    run(
        [*toy_class.COMMAND.format(folder=folder).split()[1:-1], str(out), "--tier", tier(), *words]
    )


def tier():
    """Return the tier that this machine can run."""
    try:
        tiers.choose("strict")
    except tiers.Unavailable:
        return "practice"
    return "strict"


@pytest.fixture(scope="module")
def graded(tmp_path_factory):
    """The folder of a toy class that is made and graded by its two commands."""
    home = tmp_path_factory.mktemp("toy") / "class"
    run(["course", "toy", str(home)])
    grade(home, home / "results")
    return home


@pytest.fixture(scope="module")
def rows(graded):
    return {
        row["student"]: row for row in csv_tables.read_csv(graded / "results" / "gradebook.csv")
    }


def read(graded, team):
    (file,) = (graded / "results" / "results").glob(f"{team}.*")
    return results.from_json(file.read_bytes())


def sentence(name):
    (mistake,) = (mistake for mistake in misconceptions.known() if mistake.name == name)
    return mistake.sentence


def test_correct_work_gets_all_points_blank_or_hostile_work_none(rows):
    work = {who: float(row["work"]) for who, row in rows.items()}
    assert len(work) == 14
    assert {who for who, points in work.items() if points == HOMEWORK.points} == WITH_ALL_POINTS
    assert {who for who, points in work.items() if points == 0} == WITHOUT_POINTS
    assert work["s09"] == 30 and work["s07"] < work["s06"]


def test_late_days_cost_a_point_only_beyond_those_that_are_free(rows):
    late = {
        who: (int(row["late"]), float(row["penalty"]))
        for who, row in rows.items()
        if row["late"] != "0"
    }
    assert late == {"s03": (3, 0), "s04": (3, 0), "s05": (12, 2), "s08": (1, 0)}
    assert float(rows["s05"]["score"]) == 98 and rows["s14"]["note"] == "not handed in"


def test_each_mistake_is_named_to_its_student_and_counted_for_the_class(graded):
    made = {
        "s06": {"gsolve": "gsolve_log2_of_the_times"},
        "s07": {"gsolve": "gsolve_log2_of_the_times", "hat": "hat_zero_in_the_middle"},
        "s08": {"irradiance": "irradiance_not_weighted", "recover": "recover_one_curve_for_all"},
        "s01": {},
        "s09": {},
    }
    for team, mistakes in made.items():
        named = {task: sentence(name) for task, name in mistakes.items()}
        assert read(graded, team).misconceptions == named
    page = (graded / "results" / "class.html").read_text()
    assert all(sentence(name) in page for mistakes in made.values() for name in mistakes.values())


def test_the_hostile_archive_is_refused_and_the_plain_one_is_unpacked(graded):
    (problem,) = read(graded, "s12").problems
    assert (
        problem == "The archive is refused: '../s01_hw2.ipynb' leads out of the archive's folder."
    )
    assert not read(graded, "s11").problems
    assert not list(graded.rglob(".unpack*"))


def test_text_printed_by_attackers_is_escaped_on_every_page(graded):
    pages = [*graded.rglob("*.html")]
    assert len(pages) >= 12 + 1
    assert not any("<script>alert" in page.read_text() for page in pages)


def test_canvas_gets_the_points_after_the_penalty(graded):
    lines = (graded / "results" / "canvas.csv").read_text(encoding="utf-8-sig").splitlines()
    assert len(lines) == 1 + 1 + 14
    assert any(line.startswith("Student 05,") and "98" in line for line in lines)


def test_hostile_submissions_change_no_other_result(graded, tmp_path):
    try:
        tiers.choose("strict")
    except tiers.Unavailable as reason:
        pytest.skip(str(reason))
    home = tmp_path / "class"
    shutil.copytree(graded, home, ignore=shutil.ignore_patterns("results", *HOSTILE))
    grade(home, home / "results", *(word for team in AGAIN for word in ("--only", team)))
    for team in AGAIN:
        both = [digests(place / "results", team) for place in (graded, home)]
        assert both[0] == both[1] and len(both[0]) > 5


def digests(out, team):
    """Return the files that a run has written about a team."""
    files = [*(out / "results").glob(f"{team}.*"), *(out / "feedback" / team).iterdir()]
    return {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in files}


README = Path(__file__).parents[2] / "README.md"


@pytest.mark.quick
@pytest.mark.skipif(not README.is_file(), reason="README.md stays in the clone")
def test_the_readme_has_the_two_commands():
    text = README.read_text(encoding="utf8")
    assert "env/bin/hdrlab course toy class\n" in text
    assert f"\nenv/bin/{toy_class.COMMAND.format(folder='class')}\n" in text


@pytest.mark.quick
def test_two_toy_classes_are_the_same(tmp_path):
    for name in ("a", "b"):
        toy_class.write(tmp_path / name)
    files = [
        file.relative_to(tmp_path / "a") for file in (tmp_path / "a").rglob("*") if file.is_file()
    ]
    assert len(files) == 12 + 4
    for file in files:
        if file.name != "README.md":  # it names the folder
            assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes()


@pytest.mark.quick
def test_a_toy_class_has_files_of_the_kinds_that_their_names_say(tmp_path):
    files = toy_class.write(tmp_path / "class")
    assert all(json.loads(file.read_bytes())["cells"] for file in files if file.suffix == ".ipynb")
    assert all(ast.parse(file.read_bytes()).body for file in files if file.suffix == ".py")
    assert all(zipfile.is_zipfile(file) for file in files if file.suffix == ".zip")
    assert {file.suffix for file in files} == {".ipynb", ".py", ".zip"}


@pytest.mark.quick
def test_a_folder_that_is_not_empty_is_left_alone(tmp_path, capsys):
    (tmp_path / "roster.csv").write_text("student\nreal\n")
    with pytest.raises(SystemExit) as ended:
        cli.run(["course", "toy", str(tmp_path)])
    assert ended.value.code == 2 and "expected a new folder" in capsys.readouterr().err
    assert [file.name for file in tmp_path.iterdir()] == ["roster.csv"]


def test_without_a_sandbox_both_commands_say_what_to_do(tmp_path, capsys, monkeypatch):
    def none():
        raise tiers.Unavailable("there is no bwrap on the path")

    monkeypatch.setitem(tiers.TIERS, "strict", none)
    run(["course", "toy", str(tmp_path / "class")])
    output = capsys.readouterr()
    assert "--tier practice" in output.out
    assert "bubblewrap" in output.err
    assert "hdrlab doctor" in output.err
    with pytest.raises(SystemExit) as ended:
        cli.run(toy_class.COMMAND.format(folder=tmp_path / "class").split()[1:])
    output = capsys.readouterr().err.strip().splitlines()[-1]
    assert ended.value.code == 2 and output.startswith("hdrlab: ")
    assert "install bubblewrap" in output
    assert "hdrlab doctor" in output
    assert "--tier practice" in output
