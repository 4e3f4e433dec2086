"""What a regrade changes for each team: which result counts, the new score, and the journal."""

import json
import os
from dataclasses import replace
from fractions import Fraction

import pytest

from hdrlab.course.classroom import jobs, regrade
from hdrlab.course.classroom.jobs import GradingJob
from hdrlab.course.classroom.regrade import CheckChange, JournalError, ScoreChange
from hdrlab.course.grading import results
from hdrlab.course.grading.results import Check, Result
from hdrlab.course.students.roster import Roster, Student
from hdrlab.errors import InputError

JOB = GradingJob("t", "file", "new")
CLASS = Roster((Student("b1", "Ada", "t"), Student("=b2", "Bo", "u")))


def result(points, submission="digest", *, name="p", outcome="holds"):
    check = Check("a", name, f"It {name}s", Fraction(points), Fraction(10), outcome)
    return Result("t", "hw2", "", "strict", (check,), {}, (), submission, "", "seed", {})


def write_result(folder, content, key):
    folder.mkdir(parents=True, exist_ok=True)
    data = content if isinstance(content, bytes) else results.to_json(content)
    jobs.write_private_file(jobs.result_path(folder, replace(JOB, key=key)), data)


@pytest.fixture
def folder(tmp_path):
    """folder(...) -> a class's results under the old checks, staged ones, and current ones."""

    def make_folder(old=None, staged=None, current=None):
        (tmp_path / "results").mkdir(exist_ok=True)
        if old is not None:
            write_result(tmp_path / "results", old, "old")
        if staged is not None:
            write_result(tmp_path / "regrade" / "results", staged, "new")
        if current is not None:
            write_result(tmp_path / "results", current, "new")
        return tmp_path

    return make_folder


def find_changes(out, policy="replace", listed=(), requests=None):
    return regrade.find_score_changes(
        out, [JOB], policy=policy, listed=listed, requests=requests or {}
    )


def read_current(out, key="new"):
    return results.from_json(jobs.result_path(out / "results", replace(JOB, key=key)).read_bytes())


@pytest.mark.parametrize(
    ("policy", "listed", "old", "new", "submission", "final", "uses_new"),
    [
        ("replace", (), 5, 3, "digest", 3, True),
        ("replace", (), 5, 7, "digest", 7, True),
        ("never-lower", (), 5, 3, "digest", 5, False),
        ("never-lower", (), 5, 5, "digest", 5, True),
        ("never-lower", (), 5, 7, "digest", 7, True),
        ("never-lower", (), 5, 3, "another", 3, True),
        ("never-lower", (), 0, 0.5, "digest", 0.5, True),
        ("only-listed", (), 5, 7, "digest", 5, False),
        ("only-listed", ("t",), 5, 7, "digest", 7, True),
        ("only-listed", ("u",), 5, 7, "another", 7, True),
        ("never-lower", (), None, 3, "digest", 3, True),
        ("only-listed", (), None, 3, "digest", 3, True),
    ],
)
def test_the_policy_decides_which_result_counts(
    policy, listed, old, new, submission, final, uses_new, folder
):
    old_result = None if old is None else result(old)
    (change,) = find_changes(folder(old_result, result(new, submission)), policy, listed)
    assert (change.job, change.old_score, change.new_score) == (JOB, old, new)
    assert (change.final_score, change.uses_new) == (final, uses_new)
    assert change.difference == final - (old or 0)


def test_a_check_that_earns_other_points_is_listed_with_both_outcomes(folder):
    (change,) = find_changes(folder(result(5), result(7)))
    assert change.check_changes == (CheckChange("a", "It ps", "holds, 5 of 10 → holds, 7 of 10"),)
    (change,) = find_changes(folder(result(5), result(5, "another")))
    assert change.check_changes == ()


def test_new_and_removed_checks_are_listed(folder):
    (change,) = find_changes(folder(result(5, name="p"), result(5, name="q", outcome="fails")))
    assert set(change.check_changes) == {
        CheckChange("a", "It ps", "holds, 5 of 10 → not asked"),
        CheckChange("a", "It qs", "not asked → fails, 5 of 10"),
    }


def test_a_regrade_request_is_answered_even_if_no_score_changes(folder):
    out = folder(current=result(5))
    assert find_changes(out) == []
    assert find_changes(out, requests={"u": ["x"]}) == []
    (change,) = find_changes(out, requests={"t": ["x", "y"]})
    assert change.requests == ("x", "y")
    assert change.difference == 0


def test_a_team_without_any_readable_result_has_no_change(folder):
    assert find_changes(folder()) == []
    assert find_changes(folder(staged=b"damaged")) == []


def test_a_damaged_new_result_never_replaces_a_good_one(folder):
    out = folder(result(5), b"damaged")
    (change,) = find_changes(out)
    assert (change.final_score, change.difference) == (5, 0)
    (note,) = regrade.apply_changes(out, [change], [JOB], "secret")
    assert note.startswith("t: ")
    assert read_current(out, "old") == result(5)
    assert not jobs.result_path(out / "results", JOB).exists()
    assert not (out / "history").exists()


def test_a_result_that_is_damaged_after_the_review_never_replaces_a_good_one(folder):
    out = folder(result(5), result(7))
    (change,) = find_changes(out)
    write_result(out / "regrade" / "results", b'{"version": 1', "new")
    (note,) = regrade.apply_changes(out, [change], [JOB], "secret")
    assert note.startswith("t: ")
    assert read_current(out, "old") == result(5)
    assert regrade.read_journal(out, "secret") == []


def test_a_damaged_new_result_is_deleted_so_that_the_next_regrade_grades_again(folder):
    out = folder(result(5), b"damaged")
    regrade.apply_changes(out, find_changes(out), [JOB], "secret")
    _, unfinished = jobs.split_finished(out / "regrade" / "results", [JOB])
    assert unfinished == [JOB]


def test_the_later_of_two_results_of_a_team_is_the_one_that_counts(folder):
    out = folder(result(5), staged=result(7))
    write_result(out / "results", result(1), "older")
    older = jobs.result_path(out / "results", replace(JOB, key="older"))
    for modified, score in ((1, 5), (2_000_000_000, 1)):
        os.utime(older, (modified, modified))
        (change,) = find_changes(out)
        assert change.old_score == score


def test_a_team_name_may_contain_dots(tmp_path):
    job = GradingJob("t.1", "file", "old")
    (tmp_path / "results").mkdir()
    path = jobs.result_path(tmp_path / "results", job)
    jobs.write_private_file(path, results.to_json(result(5)))
    staged = jobs.result_path(
        jobs.make_private(tmp_path / "regrade" / "results"), replace(job, key="new")
    )
    jobs.write_private_file(staged, results.to_json(result(7)))
    (change,) = regrade.find_score_changes(
        tmp_path, [replace(job, key="new")], policy="replace", listed=(), requests={}
    )
    assert (change.old_score, change.new_score) == (5, 7)


def test_requests_are_collected_by_team(tmp_path):
    table = tmp_path / "a.csv"
    table.write_text(f"student,task,words\nB1,hat,why?\n'=b2,merge,{'n' * 500}\nb1,x,y\n", "utf8")
    requests = regrade.read_requests([table, table], CLASS)
    assert requests["t"] == ["hat: why?", "x: y", "hat: why?", "x: y"]
    assert all(len(request) == regrade.MAX_REQUEST_LENGTH for request in requests["u"])
    table.write_text("student,task\nb1,hat\n", "utf8")
    with pytest.raises(InputError, match="words"):
        regrade.read_requests([table], CLASS)


def apply_changes(out, *changes, secret="secret", **details):
    assert regrade.apply_changes(out, changes, [JOB], secret, **details) == []
    lines = (out / "journal.jsonl").read_text("utf8").splitlines()
    return [json.loads(line) for line in lines]


KEPT = ScoreChange(JOB, old_score=7, new_score=6, final_score=7, uses_new=False)


def test_applying_copies_the_result_and_moves_the_old_one_into_the_history(folder):
    out = folder(result(5), result(7))
    (entry,) = apply_changes(out, *find_changes(out), why="a bug")
    assert (entry["number"], entry["before"], entry["why"]) == (1, "", "a bug")
    assert entry["moved"] == {"t": [5.0, 7.0]}
    assert read_current(out) == result(7)
    old = jobs.result_path(out / "history" / "1", replace(JOB, key="old"))
    assert results.from_json(old.read_bytes()) == result(5)
    assert old.parent.stat().st_mode & 0o777 == 0o700


def test_each_line_of_the_journal_continues_the_one_before(folder):
    out = folder(result(5), result(7))
    (first,) = apply_changes(out, *find_changes(out))
    entries = apply_changes(out, KEPT)
    assert [entry["number"] for entry in entries] == [1, 2]
    assert entries[0] == first
    assert entries[1]["before"] == first["signature"]
    assert entries[1]["moved"] == {}
    assert read_current(out) == result(7)
    assert regrade.read_journal(out, "secret") == entries
    assert apply_changes(out) == entries  # without changes, no line


@pytest.mark.parametrize("secret", ["other", ""])
def test_nothing_is_applied_with_another_secret_or_without_one(folder, secret):
    out = folder(result(5), result(7))
    changes = find_changes(out)
    apply_changes(out, *changes)
    with pytest.raises(JournalError):
        regrade.apply_changes(out, changes, [JOB], secret)


@pytest.mark.parametrize(
    "alteration", [{"number": 3}, {"before": "x"}, {"why": "none"}, {"signature": "0"}]
)
def test_an_altered_line_of_the_journal_is_found(alteration, folder):
    out = folder(result(5), result(7))
    assert regrade.read_journal(out, "secret") == []
    apply_changes(out, *find_changes(out), why="a")
    first, second = apply_changes(out, KEPT, why="b")
    text = "".join(json.dumps(line) + "\n" for line in (first, second | alteration))
    (out / "journal.jsonl").write_text(text, "utf8")
    with pytest.raises(JournalError, match=r"journal\.jsonl, line 2"):
        regrade.read_journal(out, "secret")


def test_the_order_of_a_journal_lines_fields_does_not_matter(folder):
    out = folder(result(5), result(7))
    (first,) = apply_changes(out, *find_changes(out))
    reordered = dict(reversed(first.items()))
    (out / "journal.jsonl").write_text(json.dumps(reordered) + "\n", "utf8")
    assert regrade.read_journal(out, "secret") == [first]


def test_a_kept_score_counts_under_the_new_checks(folder):
    out = folder(result(5), result(3))
    apply_changes(out, *find_changes(out, "never-lower"))
    assert read_current(out) == result(5)
    assert not jobs.result_path(out / "results", replace(JOB, key="old")).exists()


def test_the_page_shows_each_change_and_its_reason(tmp_path):
    check = CheckChange("a", "It <p>s", "fails → holds")
    changes = [
        ScoreChange(JOB, 0.5, 9, 9, uses_new=True, check_changes=(check,)),
        ScoreChange(replace(JOB, owner="u"), None, 3, 3, uses_new=True, requests=("why?",)),
    ]
    page = regrade.write_changes_page(tmp_path, changes, 10, "replace")
    text = page.read_text("utf8")
    assert page.parent.stat().st_mode & 0o777 == 0o700
    for part in ("It &lt;p&gt;s", "fails → holds", "+8.5", "why?", "not graded before", "replace"):
        assert part in text
