"""A class's gradebook and page, and a whole run of `hdrlab grade` on a folder."""

import csv
import os
import pickle
import re
import zipfile
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from fractions import Fraction
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from support.one_task_homework import CORRECT_CODE, PLAN

from hdrlab import cli
from hdrlab.course.classroom import marks, overview, run as classroom
from hdrlab.course.classroom.jobs import GradingJob
from hdrlab.course.grading import grader
from hdrlab.course.grading.results import Check, Result, to_json
from hdrlab.course.plan import GradingOptions, Homework, Late, Task
from hdrlab.course.students import csv_tables
from hdrlab.course.students.late_days import LateRecord
from hdrlab.course.students.roster import Roster, Student
from hdrlab.course.submissions import reader
from hdrlab.course.submissions.class_folder import Submission

DUE = datetime(2026, 10, 9, 23, 59, tzinfo=UTC)
HOMEWORK = Homework(
    "hw2", "The response curve", DUE, (Task("hat", "core.weights.hat", 50), Task("g", "x.g", 50))
)
ROSTER = Roster((Student("b1", "=Ada", "t"), Student("b2", "Bo", "t"), Student("b3", "Cy", "b3")))
COURSE = classroom.GradingContext(ROSTER, HOMEWORK, GradingOptions(), Late(10, 1.0))


def handin(team, students, days, path=None):
    return Submission(team, students, path, DUE + timedelta(days=days), "digest")


def result(student, holds, misconceptions=None):
    checks = tuple(
        Check(
            "hat",
            f"test_{k}",
            f"promise {k}",
            Fraction(25 * good),
            Fraction(25),
            "holds" if good else "fails",
        )
        for k, good in enumerate(holds)
    )
    return Result(student, "hw2", "T", "strict", checks, misconceptions or {}, (), "", "", "", {})


def test_each_team_member_uses_their_own_late_days():
    before = [
        LateRecord("hw1", late, (who,), 90.0) for who, late in (("b1", 8), ("b2", 0), ("b3", 3))
    ]
    course = replace(COURSE, before=before)
    rows = marks.gradebook_rows(course, {"t": handin("t", ("b1", "b2"), 4)}, {"t": 80.0})
    assert [(row.late, row.excused, row.penalty, row.score, row.left) for row in rows[:2]] == [
        (4, 2, 2.0, 78.0, 0),
        (4, 4, 0.0, 80.0, 6),
    ]
    assert (rows[2].note, rows[2].score, rows[2].left) == ("not handed in", 0.0, 7)


def test_late_days_are_read_back_from_a_gradebook(tmp_path):
    rows = marks.gradebook_rows(COURSE, {"t": handin("t", ("b1", "b2"), 7)}, {"t": 80.0})
    csv_tables.write_csv(tmp_path / "gradebook.csv", marks.COLUMNS, [row.cells for row in rows])
    assert marks.read([tmp_path / "gradebook.csv"]) == [
        LateRecord("hw2", 7, ("b1",), 80.0),
        LateRecord("hw2", 7, ("b2",), 80.0),
    ]
    (tmp_path / "other.csv").write_text("a,b\n1,2\n")
    with pytest.raises(ValueError, match="gradebook"):
        marks.read([tmp_path / "other.csv"])


def test_an_id_with_an_apostrophe_keeps_its_own_late_days(tmp_path):
    students = tuple(Student(id, id, id) for id in ("b1", "'b1", "=b1", "'=b1"))
    course = replace(COURSE, roster=Roster(students))
    handins = {
        student.id: handin(student.id, (student.id,), days) for days, student in enumerate(students)
    }
    rows = marks.gradebook_rows(course, handins, {})
    rows = [replace(row, note="") for row in rows]
    csv_tables.write_csv(tmp_path / "gradebook.csv", marks.COLUMNS, [row.cells for row in rows])
    read = marks.read([tmp_path / "gradebook.csv"])
    assert [(student.students, student.late) for student in read] == [
        (("b1",), 0),
        (("'b1",), 1),
        (("=b1",), 2),
        (("'=b1",), 3),
    ]


def test_the_canvas_table_has_points_possible_and_no_formulas():
    rows = marks.gradebook_rows(COURSE, {"t": handin("t", ("b1", "b2"), 0)}, {"t": 80.0})
    lines = list(csv.reader(csv_tables.csv_text(*marks.canvas_table(rows, HOMEWORK)).splitlines()))
    assert lines[0][:4] == ["Student", "ID", "SIS User ID", "SIS Login ID"]
    assert lines[0][5].startswith("hw2")
    assert lines[1][0] == "Points Possible" and float(lines[1][5]) == 100
    assert lines[2][0] == "'=Ada" and float(lines[2][5]) == 80


def test_the_what_if_table_shows_the_score_for_each_number_of_late_days():
    before = [
        LateRecord("hw1", late, (who,), 90.0) for who, late in (("b1", 8), ("b2", 0), ("b3", 10))
    ]
    course = replace(COURSE, before=before)
    points = {"t": 80.0}
    header, rows = marks.what_if_table(course, points)
    table = {row[0]: dict(zip(header, row, strict=True)) for row in rows}
    assert [table["b1"][f"late {days}"] for days in (0, 2, 4, 14)] == [80, 80, 78, 68]
    assert [table["b2"][f"late {days}"] for days in (0, 10, 14)] == [80, 80, 76]
    # nothing came: were it all right
    assert [table["b3"][f"late {days}"] for days in (0, 3)] == [
        100,
        97,
    ]
    rows = marks.gradebook_rows(course, {"t": handin("t", ("b1", "b2"), 4)}, points)
    scores = {row.student: row.score for row in rows}
    assert scores["b1"] == table["b1"]["late 4"] and scores["b2"] == table["b2"]["late 4"]


def test_the_class_page_counts_checks_and_misconceptions_and_escapes_them():
    script = "<script>alert(1)</script>"
    class_results = [
        result("t", (1, 0), {"hat": script}),
        result("b3", (1, 1), {"hat": script}),
        result("x", (0, 0)),
    ]
    text = overview.class_page(
        HOMEWORK, overview.collect_statistics(class_results), [f"{script} came late"]
    )
    assert "script" not in {tag for tag, _ in tags(text)} and text.count("&lt;script&gt;") == 2
    assert "<b>2</b> in <b>hat</b>" in text and "2 of 3" in text and "1 of 3" in text
    assert text.count('<td class="right">1</td>') == 1
    assert text.count('<td class="right">2</td>') == 1  # fail


def tags(text):
    tags_found = []
    reader = HTMLParser()
    reader.handle_starttag = lambda tag, attrs: tags_found.append((tag, attrs))
    reader.feed(text)
    return tags_found


def test_the_key_of_a_result_depends_on_everything_that_affects_it(tmp_path):
    def keys(conditions, digest="digest"):
        job = replace(handin("t", ("b1",), 0), digest=digest)
        homework = HOMEWORK._replace(tasks=HOMEWORK.tasks[:1])
        return classroom.make_jobs({"t": job}, homework, conditions)[0].key

    (tmp_path / "test_hat.py").write_text("def test_hidden(subject): pass\n")
    different = [
        keys(GradingOptions()),
        keys(GradingOptions(), "other"),
        keys(GradingOptions(secret="s")),
        keys(GradingOptions(tier="practice")),
        keys(GradingOptions(hidden=tmp_path)),
    ]
    assert len(set(different)) == 5 and keys(GradingOptions()) == different[0]


@pytest.mark.parametrize(
    ("members", "message"),
    [
        ({"../hw2.py": b""}, "refused"),
        ({"a.py": b"", "b.py": b""}, "one notebook"),
        ({"notes.txt": b""}, "none"),
        ({"hw2.py": b"x", "helpers.py": b""}, ""),
    ],
)
def test_an_archive_is_opened_or_refused_with_a_one_line_reason(members, message, tmp_path):
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    (tmp_path / "scratch").mkdir()
    path, refused = reader.extract_code_file(tmp_path / "a.zip", tmp_path / "scratch", "hw2")
    assert message in refused and bool(refused) == bool(message) and "\n" not in refused
    assert message or path.read_bytes() == b"x"


def test_a_submission_killed_twice_at_the_same_check_is_graded_a_third_time(monkeypatch):
    killed = replace(
        result("b1", ()), checks=(Check("hat", "a", "A", 0, 1, "no answer", kind="killed"),)
    )
    died = replace(
        result("b1", ()), checks=(Check("hat", "a", "A", 0, 1, "no answer", kind="died"),)
    )
    elsewhere = replace(killed, checks=(*killed.checks, *died.checks))
    class_grader = classroom.Grader(HOMEWORK, GradingOptions(tier="practice"))
    job = GradingJob("b1", Path("b1.py"), "key")
    for last in (died, killed):
        answers = iter([killed, killed, last])
        monkeypatch.setattr(grader, "grade", lambda *_, answers=answers: next(answers))
        assert class_grader.grade(job) == to_json(last)
        assert next(answers, None) is None
    answers = iter([killed, killed, elsewhere])
    monkeypatch.setattr(grader, "grade", lambda *_: next(answers))
    with pytest.raises(ValueError, match="each time at another check"):
        class_grader.grade(job)


@pytest.mark.parametrize("secret", ["", "x"])
def test_a_submission_is_graded_with_the_hidden_checks_and_with_inputs_of_the_secret(
    secret, monkeypatch
):
    hidden = (("test_hat.py", b"checks"), ("data/hat.csv", b"1,2"))
    homes = []

    def grade(path, homework, conditions):
        home = conditions.hidden
        files = [file for file in home.rglob("*") if file.is_file()]
        assert {file.relative_to(home).as_posix(): file.read_bytes() for file in files} == dict(
            hidden
        )
        assert conditions.student == ("b1" if secret else "")
        homes.append(home)
        return result(conditions.student, (True,))

    monkeypatch.setattr(grader, "grade", grade)
    class_grader = classroom.Grader(
        HOMEWORK, GradingOptions(tier="practice", secret=secret), hidden
    )
    assert class_grader.grade(GradingJob("b1", Path("b1.py"), "key")) == to_json(
        result("b1", (True,))
    )
    assert not homes[0].exists()


def test_the_histogram_counts_every_score_and_full_points_in_the_last_bin():
    scores = [0.0, 0.1, 24.0, 49.9, 50.0, 50.0]
    bins = overview.histogram(scores, 50.0)
    starts = [start for start, _ in bins]
    assert starts[0] == 0 and np.allclose(np.diff(starts), starts[1], atol=1)
    assert bins[0][1] == 2 and bins[-1][1] == 3
    assert sum(count for _, count in bins) == len(scores)
    assert overview.histogram([0.0, 0.0], 0)[0] == (0, 2)


def test_a_grader_can_be_pickled():
    class_grader = classroom.Grader(HOMEWORK, GradingOptions())
    assert pickle.loads(pickle.dumps(class_grader.grade)).__self__ == class_grader


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Make a class of four students, of whom a team and a student have submitted, and change to its
    folder.
    """
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in").mkdir()
    (tmp_path / "roster.csv").write_text("student,name,team\nb1,Ada,t\nb2,Bo,t\nb3,Cy,\nb4,Di,\n")
    (tmp_path / "plan.toml").write_text(PLAN)
    (tmp_path / "in" / "t_hw2.py").write_text(CORRECT_CODE)
    (tmp_path / "in" / "b3.zip").write_bytes(b"PK\3\4 no archive")
    (tmp_path / "times.csv").write_text(
        "file,received\nt_hw2.py,2026-10-23T12:00Z\nb3.zip,2026-10-26T12:00Z\n"
    )
    return tmp_path


WORDS = [
    "grade",
    "in",
    "--homework",
    "hw2",
    "--tier",
    "practice",
    "--plan",
    "plan.toml",
    "-o",
    "out",
]
WORDS_WITHOUT_TIMES = [*WORDS, "--roster", "roster.csv"]
WORDS = [*WORDS_WITHOUT_TIMES, "--received", "times.csv"]


@pytest.fixture
def grade(folder, capsys):
    """Return a function that runs the command with further words, and returns its output."""

    def run(*more, code=None):
        with pytest.raises(SystemExit) as ended:
            cli.run([*WORDS, *more])
        output = capsys.readouterr()
        assert ended.value.code == code, output.err
        return output.err if code else output.out

    return run


@pytest.mark.grading
def test_grading_a_class_writes_a_gradebook_and_a_page(folder, grade):
    assert "2 of 2 graded, 2 of them now" in grade()
    whole = {path: path.read_bytes() for path in (folder / "out").rglob("*") if path.is_file()}
    rows = {row["student"]: row for row in csv_tables.read_csv(folder / "out" / "gradebook.csv")}
    assert float(rows["b1"]["work"]) > 0
    assert rows["b1"]["score"] == rows["b2"]["score"] == rows["b1"]["work"]
    assert (rows["b3"]["late"], rows["b3"]["grace left"], float(rows["b3"]["work"])) == (
        "3",
        "7",
        0,
    )
    assert rows["b4"]["note"] == "not handed in"
    page = (folder / "out" / "class.html").read_text()
    links = [dict(attrs)["href"] for tag, attrs in tags(page) if tag == "a"]
    assert links == ["feedback/t/feedback.html"] * 2 + ["feedback/b3/feedback.html"]
    assert all((folder / "out" / link).is_file() for link in links)
    assert "<h2>Not handed in</h2><p>b4 (Di)</p>" in page
    assert "<li>b3 (Cy): 3 days, 3 of them free" in page
    assert "refused" in (folder / "out" / "feedback" / "b3" / "feedback.html").read_text()
    names = {"gradebook.csv", "canvas.csv", "moodle.csv", "what_if.csv", "class.html"}
    assert names <= {path.name for path in whole}
    feedback = folder / "out" / "feedback"  # a run that was killed may have left any of this
    (feedback / "t" / "feedback.html").unlink()
    (feedback / "t" / ".hdrlab-0123456789ab.html").write_text("<p>hal")
    (feedback / "b3" / "result.json").write_text("of another submission")
    (feedback / "b3" / "junit.xml").write_text("of another submission")
    (folder / "out" / "class.html").unlink()
    assert "2 of 2 graded, 0 of them now" in grade()
    assert {
        path: path.read_bytes() for path in (folder / "out").rglob("*") if path.is_file()
    } == whole


@pytest.mark.grading
def test_grading_a_part_of_the_class_keeps_the_gradebook_complete(folder, grade):
    assert "1 of 2 graded, 1 of them now" in grade("--only", "B2")  # of team t
    assert "1 of 2 graded, 0 of them now" in grade("--since", "2026-10-27")
    assert "2 of 2 graded, 1 of them now" in grade("--since", "2026-10-25")
    result = next((folder / "out" / "results").glob("t.*.json"))
    before = result.stat().st_mtime_ns, result.read_bytes()
    assert "2 of 2 graded, 1 of them now" in grade("--regrade", "--only", "t")
    assert result.stat().st_mtime_ns > before[0] and result.read_bytes() == before[1]
    # nothing is forgotten for nothing
    output = grade("--regrade", "--cluster", "tcp://127.0.0.1:1", code=2)
    assert "expected a Dask cluster at tcp://127.0.0.1:1" in output
    assert result.read_bytes() == before[1]
    rows = {row["student"]: row for row in csv_tables.read_csv(folder / "out" / "gradebook.csv")}
    assert not rows["b1"]["note"] and "The archive is refused" in rows["b3"]["note"]
    # what is refused has come, and took its days
    handed = marks.read([folder / "out" / "gradebook.csv"])
    assert [(record.students, record.late) for record in handed] == [
        (("b1",), 0),
        (("b2",), 0),
        (("b3",), 3),
    ]


HIDDEN_CHECK = """
import pytest

@pytest.mark.points(1)
def test_seven_levels_have_a_weight_of_42(subject):
    assert subject.hat(7)[0] == 42, "the first weight is not 42"
"""


@pytest.mark.grading
def test_after_the_due_date_feedback_explains_hidden_checks_without_a_new_grading(
    folder, grade, capsys
):
    (folder / "checks").mkdir()
    (folder / "checks" / "test_hat.py").write_text(HIDDEN_CHECK)
    page = folder / "out" / "feedback" / "t" / "feedback.html"
    passed = PLAN.replace("2026-10-23", "2020-10-23")
    (folder / "plan.toml").write_text(passed.replace("2020", "2999"))
    output = grade("--hidden", "checks", "--explain-hidden", code=2)
    assert "due on 2999-10-23" in output and not page.exists()
    (folder / "plan.toml").write_text(passed)
    grade("--hidden", "checks")
    assert "the first weight is not 42" not in page.read_text()
    assert "0 of them now" in grade("--hidden", "checks", "--explain-hidden")
    assert "the first weight is not 42" in page.read_text()


@pytest.mark.grading
def test_a_plan_without_dates_makes_nobody_late_and_is_reported(folder, capsys):
    in_week = 'due = { week = 5, day = "Friday", time = "23:59Z" }'
    (folder / "plan.toml").write_text(re.sub(r"due = .*", in_week, PLAN))
    with pytest.raises(SystemExit):
        cli.run(WORDS)
    assert "does not say on which date hw2 is due, so nobody is late" in capsys.readouterr().err
    rows = csv_tables.read_csv(folder / "out" / "gradebook.csv")
    assert {row["late"] for row in rows} == {"0"}


@pytest.mark.grading
@pytest.mark.parametrize(
    ("words", "late", "message"),
    [
        (["--received", "times.csv"], "3", "by times.csv, 1 of 4 students are late: b3 3 days"),
        (["--file-times"], "3", "by the files' modification times, 1 of 4"),
        ([], "0", "nobody is late; to count late days, pass --received FILE or --file-times"),
    ],
)
def test_the_command_reports_late_submissions_and_the_times_it_uses_before_grading(
    words, late, message, folder, capsys
):
    on_time = datetime.fromisoformat("2026-10-23T12:00+00:00").timestamp()
    days_later = datetime.fromisoformat("2026-10-26T12:00+00:00").timestamp()
    os.utime(folder / "in" / "t_hw2.py", (on_time, on_time))
    os.utime(folder / "in" / "b3.zip", (days_later, days_later))
    with pytest.raises(SystemExit):
        cli.run([*WORDS_WITHOUT_TIMES, *words])
    assert message in capsys.readouterr().err
    rows = {row["student"]: row for row in csv_tables.read_csv(folder / "out" / "gradebook.csv")}
    assert rows["b1"]["late"] == "0" and rows["b3"]["late"] == late


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (["--only", "b4"], "b4"),
        (["--only", "b9"], "'b9'"),
        (["--cluster", "tcp://127.0.0.1:1", "--jobs", "2"], "--jobs and --cluster"),
    ],
)
def test_an_ungradable_class_is_reported_in_one_line(more, message, grade):
    output = grade(*more, code=2)
    assert message in output and output.count("\n") == 1


def test_hidden_checks_are_sent_without_compiled_files(tmp_path):
    (tmp_path / "more" / "__pycache__").mkdir(parents=True)
    for name in ("test_a.py", "more/data.csv", "more/__pycache__/test_a.cpython-311.pyc"):
        (tmp_path / name).write_text(name)
    assert classroom.read_hidden_checks(tmp_path) == [
        ("more/data.csv", b"more/data.csv"),
        ("test_a.py", b"test_a.py"),
    ]
