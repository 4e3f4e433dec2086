"""Limits of grading a class: the largest values that are accepted, and the messages beyond them."""

from dataclasses import replace
from datetime import timedelta

import pytest
from support.small_class import HOMEWORK, NOON, ROSTER, make_result

from hdrlab.course.classroom import jobs, marks, moodle, overview, run
from hdrlab.course.classroom.jobs import GradingJob, JobResult
from hdrlab.course.classroom.run import GradingContext
from hdrlab.course.grading import results
from hdrlab.course.plan import GradingOptions, Late
from hdrlab.course.reports import gradebook
from hdrlab.course.students import csv_tables
from hdrlab.course.students.late_days import LateRecord
from hdrlab.course.submissions import class_folder
from hdrlab.course.submissions.class_folder import Submission

HANDINS = {
    team: Submission(team, (), None, NOON + timedelta(hours=hours), team)
    for team, hours in (("t", 0), ("b3", 1))
}


@pytest.mark.parametrize(
    ("only", "hours", "teams"),
    [
        ((), None, "t b3"),
        (("b1",), None, "t"),
        (("B2", "t"), None, "t"),
        (("T",), None, "t"),
        (("b3", "b1"), None, "t b3"),
        ((), 0, "t b3"),
        ((), 0.5, "b3"),
        ((), 1, "b3"),
        ((), 1.1, ""),
        (("t",), 0.5, ""),
        (("t",), 0, "t"),
    ],
)
def test_only_and_since_select_the_submissions_to_grade(only, hours, teams, monkeypatch):
    since = None if hours is None else NOON + timedelta(hours=hours)
    assert " ".join(run.select_submissions(HANDINS, ROSTER, only, since)) == teams
    with pytest.raises(ValueError, match="nothing was handed in by b3"):
        run.select_submissions({"t": HANDINS["t"]}, ROSTER, ["b1", "b3"])


@pytest.fixture
def done(tmp_path):
    """A job with a result."""
    job = GradingJob("t", "file", "key")
    jobs.make_private(tmp_path / "results")
    jobs.write_private_file(
        jobs.result_path(tmp_path / "results", job), results.to_json(make_result("t"))
    )
    return JobResult(job, jobs.result_path(tmp_path / "results", job))


def test_feedback_is_rewritten_if_a_file_is_missing_or_belongs_to_another_result(done, tmp_path):
    folder = tmp_path / "feedback" / "t"
    shown = results.for_team(done.path.read_bytes())
    for spoil in (None, "result.json", "feedback.html", "result.csv"):
        if spoil:
            (folder / spoil).unlink()
        assert run.write_feedback(tmp_path, done) is done
        assert all((folder / name).is_file() for name in gradebook.FILES)
        assert (folder / "result.json").read_bytes() == shown
    (folder / "result.json").write_bytes(b"other")
    (folder / "feedback.html").write_bytes(b"other")
    run.write_feedback(tmp_path, done)
    assert (folder / "result.json").read_bytes() == shown
    assert (folder / "feedback.html").stat().st_size > 5
    (folder / "feedback.html").write_bytes(b"kept")
    run.write_feedback(tmp_path, done)
    assert (folder / "feedback.html").read_bytes() == b"kept"
    for place in (folder, folder.parent):
        assert place.stat().st_mode & 0o777 == 0o700
    assert list(run.read_results(tmp_path, [done.job, GradingJob("x", "file", "key")])) == [
        make_result("t")
    ]


def test_a_failure_to_write_feedback_is_reported_as_a_problem_of_that_submission(done, tmp_path):
    done.path.write_bytes(b"damaged")
    warnings = run.write_feedback(tmp_path, done)
    assert warnings.problem.startswith("its feedback could not be written: ")
    assert warnings.path == done.path
    missing = replace(done, path=None)
    assert run.write_feedback(tmp_path, missing) is missing
    assert list(run.read_results(tmp_path, [done.job])) == []


def test_a_gradebook_row_has_the_time_received_the_late_days_and_the_score():
    course = GradingContext(
        ROSTER, HOMEWORK, GradingOptions(), Late(1, 2.0), [LateRecord("hw1", 1, ("b3",), 5.0)]
    )
    handins = {
        "t": Submission("t", ("b1", "b2"), None, NOON + timedelta(days=1, hours=1), "d", "a note")
    }
    first, second, third = marks.gradebook_rows(course, handins, {"t": 8.0}, {"b3": "refused"})
    assert (first.student, first.name, first.team) == ("b1", "Ada", "t")
    assert first.received == "2026-03-02T13:00+00:00"
    assert (first.late, first.excused, first.left) == (2, 1, 0)
    assert (first.work, first.of, first.penalty, first.score) == (8, 10, 2, 6)
    assert first.note == "a note"
    assert second.cells[5:] == first.cells[5:]
    assert (third.student, third.received, third.score) == ("b3", "", 0)
    assert third.note == "not handed in; refused"
    assert dict(zip(marks.COLUMNS, first.cells, strict=True))["grace left"] == 0
    ungraded = marks.gradebook_rows(course, handins, {})[0]
    assert (ungraded.work, ungraded.penalty, ungraded.note) == (0, 0, "not graded; a note")
    _, rows = moodle.gradebook([first], ROSTER, HOMEWORK)
    assert rows == [["b1", "b1", "a@x", 6.0]]
    header, table = marks.what_if_table(course, {"t": 8.0})
    assert header[:6] == ["student", "name", "team", "homework", "work", "late 0"]
    assert len(header) == 20
    assert table[0][4:9] == [8.0, 8.0, 8.0, 6.0, 4.0] and table[2][4:8] == [10.0, 10.0, 8.0, 6.0]


def test_the_next_homework_reads_late_days_from_the_gradebook(tmp_path):
    lines = ["student,homework,received,late,work,note"]
    lines += ["'=b1,hw1,2026,3,7.5,", "b2,hw1,,0,0,not handed in", "b3,hw1,2026,1,2,not graded; x"]
    (tmp_path / "a.csv").write_text("\n".join(lines), encoding="utf8")
    assert marks.read([tmp_path / "a.csv"]) == [LateRecord("hw1", 3, ("=b1",), 7.5)]


def test_class_statistics_count_outcomes_and_give_the_reason_of_ungradable_submissions():
    results = [
        make_result("a", "", "raised", misconceptions={"hat": "S"}),
        make_result("b", "missing", "missing", problems=("no file", "more")),
        make_result("c", "missing", "", problems=("a problem",)),
    ]
    statistics = overview.collect_statistics(results)
    assert statistics.points == {"a": 1, "b": 0, "c": 1} and statistics.refused == {"b": "no file"}
    assert statistics.outcomes["a", "P0"] == {
        "holds": 1,
        "no answer": 2,
    }
    assert statistics.misconceptions == {("hat", "S"): 1}
    bins = overview.histogram([0, 0.01, 9.99, 10, 12], 10)
    assert bins[0] == (0, 2)
    assert bins[-1][1] == 3 and sum(count for _, count in bins) == 5


def test_a_table_larger_than_the_limit_is_refused(tmp_path):
    (tmp_path / "a.csv").write_bytes(b" A ,b\n1\n\n 2 ,3\n")
    size = (tmp_path / "a.csv").stat().st_size
    assert csv_tables.read_csv(tmp_path / "a.csv", max_bytes=size) == [
        {"a": "1", "b": ""},
        {"a": "2", "b": "3"},
    ]
    with pytest.raises(ValueError, match=f"at most {size - 1} bytes.*{size}"):
        csv_tables.read_csv(tmp_path / "a.csv", max_bytes=size - 1)


def test_files_and_folders_at_the_size_limit_are_accepted(tmp_path, monkeypatch):
    monkeypatch.setattr(class_folder, "MAX_FILE_MEGABYTES", 1)
    monkeypatch.setattr(class_folder, "MAX_FILES_PER_FOLDER", 2)
    for name, size in (
        ("b1/a.py", 1 << 20),
        ("b1/b.py", 0),
        ("b3/a.py", (1 << 20) + 1),
        ("b3/.x", 0),
    ):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()
        with (tmp_path / name).open("r+b") as file:
            file.truncate(size)
    scan = class_folder.find(tmp_path, ROSTER)
    assert set(scan.submissions) == {"t"}
    assert scan.refused == {"b3": "b3/a.py: expected at most 1 MB, got 1"}
    (tmp_path / "b1" / "c.py").touch()
    scan = class_folder.find(tmp_path, ROSTER)
    assert scan.submissions == {}
    assert scan.refused["t"] == "b1: expected at most 2 files in a folder"
