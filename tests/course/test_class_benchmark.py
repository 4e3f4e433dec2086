"""The benchmark that grades a class: its submissions, its figures, and how it measures processes."""

import ast
import os
import sys
from collections import Counter
from fractions import Fraction
from pathlib import Path

import pytest

pytest.importorskip("benchmarks", reason="the benchmarks are no part of the installed package")

from support import attack_fixtures, hostile_submissions
from support.malicious_archives import MALICIOUS_ARCHIVES

from benchmarks import __main__ as command, class_
from benchmarks.class_ import costs, grading, handed, judged, mixed
from benchmarks.class_.grading import Used
from benchmarks.class_.handed import Handed
from hdrlab.course import plan
from hdrlab.course.checks import misconceptions
from hdrlab.course.grading import results
from hdrlab.course.grading.results import Check, Result
from hdrlab.course.students import csv_tables
from hdrlab.course.students.roster import read

pytestmark = pytest.mark.grading

HW2 = {task.id for task in plan.read().homeworks["hw2"].tasks}


@pytest.fixture(scope="module")
def everybody(tmp_path_factory):
    return handed.handed(300, tmp_path_factory.mktemp("target"))


def test_a_class_of_300_contains_every_mistake_attack_and_trap(everybody):
    which = {
        kind: {member.which for member in everybody if member.kind == kind}
        for kind in handed.SHARES
    }
    assert len(everybody) == 300 == sum(handed.SHARES.values())
    assert which["mistake"] == {
        member.name for member in misconceptions.known() if member.task in HW2
    }
    assert which["attack"] == set(attack_fixtures.ATTACK_NAMES)
    assert which["trap"] == set(MALICIOUS_ARCHIVES)
    assert len(which["equivalent"]) == 3 and {"empty", "cut short"} < which["blank"]


@pytest.mark.parametrize("count", [24, 100, 300])
def test_a_smaller_class_has_the_same_mixture(count):
    made = Counter(handed.kinds(count))
    assert sum(made.values()) == count
    for kind, share in handed.SHARES.items():
        assert abs(made[kind] - share * count / 300) < 1


def test_the_command_can_read_the_class_that_the_benchmark_writes(everybody, tmp_path):
    folder = handed.write(tmp_path / "class", everybody[:9])
    roster = read(folder / "roster.csv")
    assert set(roster.teams()) == {member.team for member in everybody[:9]}
    assert {len(team) for team in roster.teams().values()} == {1, 2}
    times = csv_tables.read_csv(folder / "received.csv")
    assert [row["file"] for row in times] == [member.file for member in everybody[:9]]


def test_the_results_attack_targets_the_output_folder_of_the_run(everybody):
    (member,) = (member for member in everybody if member.which == "a07_results")
    assert b"def double(" not in member.data and str(Path("target")).encode() in member.data


def one_of(team, kind, which="", score=1.0, problems=(), named=None):
    check = Check(
        "hat", "test_it", "it", Fraction(score), Fraction(1), "holds" if score else "fails"
    )
    result = Result(team, "hw2", "T", "strict", (check,), named or {}, problems, "", "", "", {})
    return Handed(team, (team,), f"{team}.py", b"", 0.0, kind, which), result


def test_wrong_scores_and_missed_mistakes_are_counted():
    known = next(mistake for mistake in misconceptions.known() if mistake.task == "hat")
    good = [
        one_of("a", "right"),
        one_of("b", "trap", score=0, problems=("The archive is refused: a link.",)),
        one_of("c", "attack", score=0),
        one_of("d", "mistake", known.name, named={"hat": known.sentence}),
    ]
    bad = [
        one_of("a", "right", score=0.5),
        one_of("b", "trap", score=0),
        one_of("c", "attack", score=0.25),
        one_of("d", "mistake", known.name, named={"hat": "Another one."}),
    ]
    measures = (judged.gained, judged.not_whole, judged.not_named, judged.not_refused)
    for members, expected in ((good, (0, 0, 0, 0)), (bad, (0.25, 1, 100, 1))):
        members_alone = [mistake for mistake, _ in members]
        graded = {result.student: result for _, result in members}
        assert tuple(measure(graded, members_alone) for measure in measures) == expected
        assert judged.lost(graded, members_alone) == 0
    assert judged.lost({}, members_alone) == 4
    assert judged.not_whole({}, members_alone) == 1
    assert judged.not_refused({}, members_alone) == 1


def test_two_runs_that_differ_in_one_byte_or_cell_are_distinguished(tmp_path):
    results_of_members = [one_of("a", "right")[0], one_of("b", "right")[0]]
    for out in ("one", "same", "other"):
        (tmp_path / out / "results").mkdir(parents=True)
        (tmp_path / out / "feedback" / "a").mkdir(parents=True)
        (tmp_path / out / "results" / "a.0123.json").write_bytes(
            results.to_json(one_of("a", "right")[1])
        )
        (tmp_path / out / "feedback" / "a" / "feedback.html").write_text("<p>well done")
        csv_tables.write_csv(
            tmp_path / out / "gradebook.csv", ("student", "score"), [("a", 1), ("b", 2)]
        )
    assert judged.differing(tmp_path / "one", tmp_path / "same", results_of_members) == 0
    (tmp_path / "other" / "feedback" / "a" / "feedback.html").write_text("<p>well gone")
    csv_tables.write_csv(
        tmp_path / "other" / "gradebook.csv", ("student", "score"), [("a", 1), ("b", 3)]
    )
    (tmp_path / "other" / "results" / "b.0123.json").write_text("{}")
    assert judged.differing(tmp_path / "one", tmp_path / "other", results_of_members) == 3
    assert set(judged.read(tmp_path / "one")) == {"a"} and judged.size(tmp_path / "one")[0] == 3


def test_core_hours_of_a_large_class_scale_only_the_time_per_submission():
    used = Used(seconds=300, cpu=606, own=6, total=0, largest=0)
    assert judged.core_hours(used, 300) == pytest.approx(2 * judged.LARGE / 3600)


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="processes are watched in /proc")
def test_a_measured_command_includes_its_child_processes():
    child = "x = bytearray(60_000_000)\nimport time\nwhile time.process_time() < 1: pass"
    parent = f"import subprocess, sys; subprocess.run([sys.executable, '-S', '-c', {child!r}])"
    used = grading.watched([sys.executable, "-S", "-c", parent])
    assert used.seconds > 0.9 and 0.9 < used.cpu < 5 and used.own < 0.5
    assert 60 < used.largest <= used.total < 300


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="processes are watched in /proc")
def test_a_process_tree_starts_with_its_root():
    assert next(grading.tree(os.getpid())) == os.getpid()


def test_a_failed_command_raises_its_error_output():
    with pytest.raises(RuntimeError, match="no chalk"):
        grading.watched([sys.executable, "-S", "-c", "raise SystemExit('no chalk')"])


def test_the_benchmark_of_a_class_is_called_class():
    assert "class" in command.subjects()
    assert [row.name for row in command.chosen("class", None)] == [
        *("whole", "processes", "workers", "mixed", "sheets", "costs", "books")
    ]


def test_a_mixed_class_has_every_hostile_kind_and_sixty_honest_students(tmp_path):
    honest_members = mixed.honest(60, tmp_path)
    assert len(honest_members) == 60 == len({member.team for member in honest_members})
    assert not any(member.hostile for member in honest_members)
    others = mixed.hostile(tmp_path, honest_members[0])
    which = {
        kind: {member.which for member in others if member.kind == kind}
        for kind in {member.kind for member in others}
    }
    taken = which.pop("taken")
    assert which == {
        "code": set(hostile_submissions.HOSTILE_CODE),
        "text": set(hostile_submissions.CODE_WITH_NASTY_TEXTS),
        "file": set(hostile_submissions.UNREADABLE_FILES),
        "name": set(hostile_submissions.NASTY_FILE_NAMES),
        "odd": set(hostile_submissions.ODD_FILES),
        "attack": set(attack_fixtures.ATTACK_NAMES),
        "trap": set(MALICIOUS_ARCHIVES),
    }
    assert len(others) >= 120 and honest_members[0].file in taken


def test_benchmark_rows_write_into_separate_folders(tmp_path, monkeypatch):
    written = []
    used = Used(1.0, 1.0, 1.0, 1.0, 1.0)

    def graded(place, out, *words, **_):
        written.append(out)
        out.mkdir(parents=True)
        (out / "gradebook.csv").write_text(
            "student,note\n" + "\n".join(f"x{k:03d},n" for k in range(300))
        )
        return used

    monkeypatch.setattr(class_, "grade", graded)
    monkeypatch.setattr(class_, "along", lambda work, items, _: [used] * len(items))
    class_.whole(tmp_path, 12)
    rows = class_.among_hostile(tmp_path, 3)
    assert len(set(written)) == len(written) == 4
    assert rows["hostile ones of whom nothing is said"] == 0
    assert class_.most_costly(tmp_path)["CPU seconds of the worst"] == 1


@pytest.mark.skipif(os.name == "nt", reason="there are names that this system cannot write")
def test_hostile_students_without_a_note_are_found(tmp_path):
    honest_members = mixed.honest(2, tmp_path)
    kinds = {member.kind: member for member in mixed.hostile(tmp_path, honest_members[0])}
    others = list(kinds.values())
    folder = mixed.write(tmp_path / "class", honest_members, others)
    assert set(read(folder / "roster.csv").teams()) == {
        member.team for member in honest_members
    } | {member.student for member in others}
    names = [os.fsdecode(path.name) for path in (folder / "submissions").iterdir()]
    assert all(any(name.startswith(member.student) for name in names) for member in others)
    (tmp_path / "out" / "results").mkdir(parents=True)
    (tmp_path / "out" / "results" / f"{others[0].student}.0123.json").write_text("{}")
    rows = [(member.student, "refused" if member is others[1] else "") for member in others]
    csv_tables.write_csv(tmp_path / "out" / "gradebook.csv", ("student", "note"), rows)
    assert mixed.untold(tmp_path / "out", others) == others[2:]


def test_costly_submissions_are_valid_python_with_unique_names():
    submissions = list(costs.costly_submissions())
    assert (
        len({(submission.kind, submission.which) for submission in submissions})
        == len(submissions)
        > 30
    )
    for submission in submissions:
        if submission.kind == "code":
            assert {
                node.name for node in ast.parse(submission.data()).body if hasattr(node, "name")
            } == HW2
