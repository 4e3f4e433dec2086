"""What a regrade would change, team by team: which result is to count, by how much it moves, and why."""

import json
import os
from dataclasses import replace
from fractions import Fraction

import pytest

from hdrlab.course.classroom import jobs, regrade
from hdrlab.course.classroom.jobs import GradingJob
from hdrlab.course.classroom.regrade import ScoreChange
from hdrlab.course.classroom.roster import Roster, Student
from hdrlab.course.reports import results
from hdrlab.course.reports.results import Check, Result

JOB = GradingJob("t", "file", "new")
CLASS = Roster((Student("b1", "Ada", "t"), Student("=b2", "Bo", "u")))


def result(points, submission="digest", *, name="p", outcome="holds"):
    check = Check("a", name, f"It {name}s", Fraction(points), Fraction(10), outcome)
    return Result("t", "hw2", "", "strict", (check,), {}, (), submission, "", "seed", {})


@pytest.fixture
def folder(tmp_path):
    """folder(standing, staged, here) -> a class's results: under old checks, under the new, and in force."""

    def written(standing=None, staged=None, here=None):
        for place, found, key in (
            ("results", standing, "old"),
            ("regrade/results", staged, "new"),
            ("results", here, "new"),
        ):
            (tmp_path / place).mkdir(parents=True, exist_ok=True)
            if found is not None:
                data = found if isinstance(found, bytes) else results.to_json(found)
                jobs.write_private_file(
                    jobs.result_path(tmp_path / place, replace(JOB, key=key)), data
                )
        return tmp_path

    return written


def moves(out, policy="replace", listed=(), asked=None):
    return regrade.moves(out, [JOB], policy, listed, asked or {})


@pytest.mark.parametrize(
    ("policy", "listed", "before", "after", "submission", "counts", "taken"),
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
def test_which_result_counts_is_for_the_policy_to_say(
    policy, listed, before, after, submission, counts, taken, folder
):
    standing = None if before is None else result(before)
    (move,) = moves(folder(standing, result(after, submission)), policy, listed)
    assert move[:6] == (JOB, before, after, counts, counts - (before or 0), taken)
    same = before is None or before == after
    assert move.changes == (
        () if same else (("a", "It ps", f"holds, {before} of 10 \u2192 holds, {after} of 10"),)
    )
    assert move.asked == ()


def test_who_asks_is_answered_also_where_nothing_changes(folder):
    out = folder(here=result(5))
    assert moves(out) == [] and moves(out, asked={"u": ["x"]}) == []
    assert moves(out, asked={"t": ["x", "y"]}) == [
        ScoreChange(JOB, 5, 5, 5, 0, True, (), ("x", "y"))
    ]


def test_what_could_not_be_graded_anew_keeps_what_it_has_and_what_never_was_is_no_move(folder):
    assert moves(folder()) == [] and moves(folder(staged=b"damaged")) == []
    (move,) = moves(folder(result(5), b"damaged"))
    assert (move.before, move.after, move.counts, move.moves, move.taken, move.changes) == (
        5,
        5,
        5,
        0,
        True,
        (),
    )


def test_promises_that_come_and_go_are_told_too(folder):
    (move,) = moves(folder(result(5, name="p"), result(5, name="q", outcome="fails")))
    assert set(move.changes) == {
        ("a", "It ps", "holds, 5 of 10 \u2192 not asked"),
        ("a", "It qs", "not asked \u2192 fails, 5 of 10"),
    }


def test_of_two_results_of_a_team_the_later_one_stands(folder):
    out = folder(result(5))
    older = jobs.result_path(out / "results", replace(JOB, key="older"))
    jobs.write_private_file(older, results.to_json(result(1)))
    for when, points in ((1, 5), (2_000_000_000, 1)):
        os.utime(older, (when, when))
        assert moves(out and folder(staged=result(7)))[0].before == points


def test_requests_are_a_teams_in_four_hundred_characters(tmp_path):
    table = tmp_path / "a.csv"
    table.write_text(f"student,task,words\nB1,hat,why?\n'=b2,merge,{'n' * 500}\nb1,x,y\n", "utf8")
    found = regrade.requests([table, table], CLASS)
    assert found["t"] == ["hat: why?", "x: y"] * 2 and [len(one) for one in found["u"]] == [
        400,
        400,
    ]
    table.write_text("student,task\nb1,hat\n", "utf8")
    with pytest.raises(
        ValueError, match="expected the columns student, task, words, got student, task"
    ):
        regrade.requests([table], CLASS)


def applied(out, *found, secret="secret", **said):
    regrade.apply(out, found, [JOB], secret, **said)
    return [json.loads(one) for one in (out / "journal.jsonl").read_text("utf8").splitlines()]


def test_what_counts_is_copied_the_old_goes_into_history_and_the_journal_grows_by_a_signed_line(
    folder,
):
    out = folder(result(5), result(7))
    lines = applied(out, *moves(out), why="a bug")
    assert (
        [line["number"] for line in lines] == [1]
        and lines[0]["before"] == ""
        and lines[0]["why"] == "a bug"
    )
    assert lines[0]["moved"] == {"t": [5.0, 7.0]} and len(lines[0]["signature"]) == 64
    assert regrade._read(jobs.result_path(out / "results", JOB)) == result(7)
    old = jobs.result_path(out / "history" / "1", replace(JOB, key="old"))
    assert regrade._read(old) == result(5) and old.parent.stat().st_mode & 0o777 == 0o700
    again = applied(out, ScoreChange(JOB, 7, 6, 7, 0, False, ()))
    assert [line["number"] for line in again] == [1, 2] and again[1]["before"] == lines[0][
        "signature"
    ]
    assert again[1]["moved"] == {} and regrade._read(
        jobs.result_path(out / "results", JOB)
    ) == result(7)
    assert regrade.signed_lines(out, "secret") == again and applied(out) == again
    for secret in ("other", ""):
        with pytest.raises(
            ValueError, match="line 1: expected a line that the|expected a class that was graded"
        ):
            applied(out, secret=secret)


@pytest.mark.parametrize(
    "change", [{"number": 3}, {"before": "x"}, {"why": "none"}, {"signature": "0"}]
)
def test_a_line_that_was_changed_is_found(change, folder):
    out = folder(result(5), result(7))
    assert regrade.signed_lines(out, "secret") == []
    first, second = applied(out, *moves(out), why="a") and applied(
        out, ScoreChange(JOB, 7, 7, 7, 0, False, ()), why="b"
    )
    text = "".join(json.dumps(line) + "\n" for line in (first, second | change))
    (out / "journal.jsonl").write_text(text, "utf8")
    with pytest.raises(
        ValueError,
        match="journal.jsonl, line 2: expected a line that the course's secret has signed",
    ):
        regrade.signed_lines(out, "secret")
    (out / "journal.jsonl").write_text(json.dumps(dict(reversed(first.items()))) + "\n", "utf8")
    assert regrade.signed_lines(out, "secret") == [first]


def test_a_result_that_is_kept_stays_under_the_new_key(folder):
    out = folder(result(5), result(3))
    applied(out, *moves(out, "never-lower"))
    assert regrade._read(jobs.result_path(out / "results", JOB)) == result(5)
    assert not jobs.result_path(out / "results", replace(JOB, key="old")).exists()


def test_the_page_of_a_regrade_says_who_moves_from_where_to_where(tmp_path, monkeypatch):
    asked = []
    monkeypatch.setattr(
        regrade, "render_page", lambda *given, **words: asked.append(words) or "a page"
    )
    change = ("a", "It ps", "fails \u2192 holds")
    found = [
        ScoreChange(JOB, 0.5, 9, 9, 8.5, True, (change,)),
        ScoreChange(JOB, None, 3, 3, 3, True, (change,)),
    ]
    page = regrade.write(tmp_path, found, 10, "replace")
    assert page == tmp_path / "regrade" / "regrade.html" and page.read_text("utf8") == "a page"
    assert page.parent.stat().st_mode & 0o777 == 0o700
    (words,) = asked
    assert (words["found"], words["whole"], words["policy"]) == (found, 10, "replace")
    assert words["promises"] == [(change, 2)]
    bins = list(words["bins"])
    assert (
        bins[0] == ((0, 1), (0, 0))
        and bins[3] == ((30, 0), (30, 1))
        and bins[9] == ((90, 0), (90, 1))
    )


def test_a_teams_name_may_have_dots(tmp_path):
    piece = GradingJob("t.1", "file", "new")
    (tmp_path / "results").mkdir()
    jobs.write_private_file(
        jobs.result_path(tmp_path / "results", piece), results.to_json(result(5))
    )
    assert regrade._standing(tmp_path) == {"t.1": tmp_path / "results" / "t.1.new.json"}
