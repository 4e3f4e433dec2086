"""A regrade: a preview, a policy, all results or none, and a signed entry in the journal."""

import html
import json
import os
import random
import signal
import warnings
from fractions import Fraction
from hashlib import sha256
from pathlib import Path

import pytest
from support.one_task_homework import PLAN

from hdrlab import cli
from hdrlab.cli import classroom as command
from hdrlab.course.classroom import regrade
from hdrlab.course.classroom.jobs import JobAttempt
from hdrlab.course.grading import results
from hdrlab.course.grading.results import Check, Result
from hdrlab.course.students import csv_tables

STUDENTS = {"b1": "t", "b2": "t", "b3": "b3", "b4": "b4", "b5": "b5"}
TEAMS = sorted({*STUDENTS.values()})
BOOKS = ("gradebook.csv", "canvas.csv", "moodle.csv", "what_if.csv", "class.html")
HISTORIES = int(os.environ.get("HDRLAB_HISTORIES", "20"))  # a thousand take a quarter of an hour
WORDS = [
    "--homework",
    "hw2",
    "--plan",
    "plan.toml",
    "--roster",
    "roster.csv",
    "--received",
    "times.csv",
]
WORDS += ["--hidden", "checks"]
OPEN = [*WORDS]
WORDS += ["--secret-file", "secret.txt"]


class Guessing:
    """An executor whose results depend only on the submission and on the text of the hidden check."""

    def __init__(self, course, arguments):
        self.course = course
        self.waiting = []
        self.check = Path("checks/test_hat.py").read_bytes()

    def __enter__(self):
        return self

    def __exit__(self, *error):
        pass

    def start(self, piece, *, alone=False):
        self.waiting.append(piece)
        return True

    def wait_for_attempts(self):
        done, self.waiting = self.waiting, []
        return [JobAttempt(piece, self.result(piece)) for piece in done]

    def result(self, piece):
        digest = sha256(piece.path.read_bytes() + self.check).digest()
        checks = []
        for k, byte in enumerate(digest[:5]):
            outcome = "holds" if byte % 2 else "fails"
            earned = 2 if byte % 2 else 0
            words = f"test_{k}", f"The {k}. promise", Fraction(earned), Fraction(2), outcome
            checks.append(Check("hat", *words, hidden=k == 4))
        handed = sha256(piece.path.read_bytes()).hexdigest()
        result = Result(
            piece.owner,
            "hw2",
            "T",
            "strict",
            tuple(checks),
            {},
            (),
            handed,
            digest.hex(),
            "x",
            {"hdrlab": "1"},
        )
        return results.to_json(result)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Make a class of five, two of them a team, with random results, and change to its folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(command, "_executor", Guessing)
    monkeypatch.setattr(command, "_compare", lambda *_: None)
    # which is for the mains switch: a kill leaves the disk
    monkeypatch.setattr(os, "fsync", lambda _: None)
    make_class(tmp_path)
    return tmp_path


def make_class(folder):
    (folder / "in").mkdir()
    (folder / "checks").mkdir()
    rows = [f"{who},Student {who},{team if team != who else ''}" for who, team in STUDENTS.items()]
    (folder / "roster.csv").write_text("\n".join(["student,name,team", *rows]) + "\n")
    (folder / "plan.toml").write_text(PLAN)
    (folder / "secret.txt").write_text("a secret of sixteen letters and more\n")
    correct("0")
    for team in TEAMS:
        hand_in(team, "first", 0)


def correct(version):
    Path("checks/test_hat.py").write_text(f"# version {version}\n")


def hand_in(team, text, days):
    Path(f"in/{team}_hw2.py").write_text(f"# {team}: {text}\n")
    table = Path("times.csv")
    lines = table.read_text().splitlines() if table.exists() else ["file,received"]
    times = dict(line.split(",") for line in lines) | {
        f"{team}_hw2.py": f"2026-10-{23 + days}T12:00Z"
    }
    table.write_text("".join(f"{name},{when}\n" for name, when in times.items()))


def run(*words, code=None):
    with pytest.raises(SystemExit) as ended:
        cli.run([str(word) for word in words])
    assert ended.value.code == code


def grade(out="out", *more):
    run("grade", "in", *WORDS, "-o", out, *more)


def work(out="out"):
    """Return each student's points before late days are subtracted."""
    return {
        row["student"]: float(row["work"])
        for row in csv_tables.read_csv(Path(out) / "gradebook.csv")
    }


def contents(out, *parts):
    """Return the content of a folder, or of parts of it, by name."""
    paths = [path for part in parts for path in (Path(out) / part, *(Path(out) / part).rglob("*"))]
    return {str(path.relative_to(out)): path.read_bytes() for path in paths if path.is_file()}


def moved(seed, direction):
    """Return the scores under version 0 and under a version of the check that raises, or lowers, one of
    them.
    """
    for version in range(seed, seed + 50):
        correct(0)
        before = {team: json.loads(guessed(team))["score"] for team in TEAMS}
        correct(version)
        after = {team: json.loads(guessed(team))["score"] for team in TEAMS}
        if any(direction * (after[team] - before[team]) > 0 for team in TEAMS):
            return before, after
    raise AssertionError("no version changes a score in this direction")


def guessed(team):
    return Guessing(None, None).result(
        type("Piece", (), {"owner": team, "path": Path(f"in/{team}_hw2.py")})
    )


def test_a_regrade_shows_all_score_changes_before_it_is_applied(folder, capsys):
    before, after = moved(1, -1)
    version = Path("checks/test_hat.py").read_text()
    correct(0)
    grade()
    whole = contents("out", "")
    Path("checks/test_hat.py").write_text(version)
    capsys.readouterr()
    run("regrade", "out", "--homework", "hw2")
    output = capsys.readouterr().out
    now = contents("out", "")
    assert {name: data for name, data in now.items() if not name.startswith("regrade")} == whole
    for team in TEAMS:
        line = next((text for text in output.splitlines() if text.startswith(f"{team} ")), "")
        assert bool(line) == (before[team] != after[team])
        assert not line or f"{before[team]:g} -> {after[team]:g}" in line and "hat: The" in line
    up = sum(after[team] > before[team] for team in TEAMS)
    down = sum(after[team] < before[team] for team in TEAMS)
    assert f"{len(TEAMS)} graded again: {up} scores would go up, {down} down" in output
    page = Path("out/regrade/regrade.html").read_text()
    assert "→" in page
    assert f"{up + down} of {len(TEAMS)} submissions would get a different score" in page
    assert all(
        f"feedback/{team}/feedback.html" in page for team in TEAMS if before[team] != after[team]
    )


def test_an_applied_regrade_equals_grading_from_scratch_and_keeps_the_old_results(folder):
    grade()
    old = contents("out", "results")
    correct("other")
    run("regrade", "out", "--apply", "--why", "the check was wrong")
    grade("scratch")
    parts = (*BOOKS, "results", "feedback")
    assert contents("out", *parts) == contents("scratch", *parts)
    assert {Path(name).name: data for name, data in contents("out", "history/1").items()} == {
        Path(name).name: data for name, data in old.items()
    }
    assert all(results.from_json(data).homework == "hw2" for data in old.values())
    grade()
    assert contents("out", *parts) == contents("scratch", *parts)


def test_with_the_policy_never_lower_no_score_ever_falls(folder):
    _, after = moved(1, -1)
    version = Path("checks/test_hat.py").read_text()
    correct(0)
    grade()
    before = work()
    Path("checks/test_hat.py").write_text(version)
    run("regrade", "out", "--policy", "never-lower", "--apply")
    expected = {who: max(before[who], after[team]) for who, team in STUDENTS.items()}
    assert work() == expected
    grade()
    run("regrade", "out", "--apply")
    assert work() == expected


def test_with_the_policy_only_listed_only_listed_teams_change(folder):
    grade()
    before = work()
    while True:
        correct(random.random())
        after = {who: json.loads(guessed(team))["score"] for who, team in STUDENTS.items()}
        if all(before[who] != after[who] for who in STUDENTS):
            break
    Path("asked.csv").write_text('student,task,words\nB3,hat,"the middle, please"\n')
    run(
        "regrade",
        "out",
        "--policy",
        "only-listed",
        "--only",
        "T",  # the team t, of b1 and b2
        "--requests",
        "asked.csv",
        "--apply",
    )
    listed = ("b1", "b2", "b3")  # of a team, both
    assert work() == {who: (after if who in listed else before)[who] for who in STUDENTS}
    assert "hat: the middle, please" in Path("out/regrade/regrade.html").read_text()


def test_a_regrade_request_without_a_change_is_answered(folder):
    grade()
    Path("asked.csv").write_text("student,task,words\nb4,hat,<script>\n")
    run("regrade", "out", "--requests", "asked.csv")
    page = Path("out/regrade/regrade.html").read_text()
    assert "<h2>Requests without a change</h2>" in page and "hat: &lt;script&gt;" in page
    assert "<li><b>b4</b>" in page


def test_the_journal_records_each_regrade_and_an_altered_line_is_found(folder, capsys):
    grade()
    before = work()
    for version in ("a", "b"):
        correct(version)
        run("regrade", "out", "--apply", "--why", f"version {version}")
    log = Path("out/journal.jsonl")
    lines = [json.loads(entry) for entry in log.read_text().splitlines()]
    assert [(entry["number"], entry["why"], entry["policy"]) for entry in lines] == [
        (1, "version a", "replace"),
        (2, "version b", "replace"),
    ]
    points = {team: before[who] for who, team in STUDENTS.items()}
    for line in lines:
        assert all(points[team] == old for team, (old, _) in line["moved"].items())
        points |= {team: new for team, (_, new) in line["moved"].items()}
    assert {who: points[team] for who, team in STUDENTS.items()} == work()
    assert lines[1]["before"] == lines[0]["signature"]
    correct("c")
    whole = contents("out", *BOOKS, "results")
    for changed in (
        log.read_text().replace("version a", "version x"),
        log.read_text().splitlines(keepends=True)[1],
        log.read_text().replace(lines[1]["signature"], lines[0]["signature"]),
    ):
        kept = log.read_text()
        log.write_text(changed)
        capsys.readouterr()
        run("regrade", "out", "--apply", code=2)
        assert "journal.jsonl, line " in capsys.readouterr().err
        assert contents("out", *BOOKS, "results") == whole
        log.write_text(kept)


def test_a_submission_that_cannot_be_graded_again_keeps_its_points(folder, monkeypatch, capsys):
    grade()
    before = work()
    correct("1")
    result = Guessing.result
    monkeypatch.setattr(
        Guessing, "result", lambda self, job: None if job.owner == "b4" else result(self, job)
    )
    run("regrade", "out", "--apply")
    assert "warning: b4: it ended 3 times without a result" in capsys.readouterr().err
    expected = {
        who: json.loads(guessed(team))["score"] for who, team in STUDENTS.items() if team != "b4"
    }
    assert work() == expected | {"b4": before["b4"]}


def test_a_missing_secret_is_reported_and_not_replaced(folder, capsys):
    grade()
    Path("secret.txt").unlink()
    capsys.readouterr()
    run("regrade", "out", code=2)
    assert "secret.txt: No such file" in capsys.readouterr().err and not Path("secret.txt").exists()


def receipts(out="out"):
    """Return the receipts of a class by team, as its instructor and its teams have them."""
    lines = (Path(out) / "receipts.txt").read_text().splitlines()
    by_team = {json.loads(line)["team"]: f"{line}\n" for line in lines}
    for team, line in by_team.items():
        assert (Path(out) / "feedback" / team / "receipt.txt").read_text() == line
    return by_team


def test_each_team_gets_a_receipt_and_a_repeated_run_the_same_one(folder, capsys):
    grade("out", "--receipt-key", "key.pem")
    first = receipts()
    assert set(first) == set(TEAMS)
    contents_of_receipts = {team: json.loads(line) for team, line in first.items()}
    assert {team: content["points"] for team, content in contents_of_receipts.items()} == {
        team: json.loads(guessed(team))["score"] for team in TEAMS
    }
    assert contents_of_receipts["t"]["students"] == ["b1", "b2"]
    page = Path("out/feedback/b3/feedback.html").read_text()
    assert first["b3"].strip() in html.unescape(page)
    capsys.readouterr()
    run("receipt", "out/receipts.txt", "--key", "key.pem.pub")
    assert capsys.readouterr().out.count("valid: hw2, ") == len(TEAMS)
    grade("out", "--receipt-key", "key.pem")
    grade("elsewhere", "--receipt-key", "key.pem")
    assert receipts() == receipts("elsewhere") == first


def test_receipts_can_be_added_to_a_graded_class_and_left_out_again(folder):
    grade()
    without = contents("out", *BOOKS, "results", "feedback")
    grade("out", "--receipt-key", "key.pem")
    assert set(receipts()) == set(TEAMS)
    grade()
    assert contents("out", *BOOKS, "results", "feedback") == without
    assert not Path("out/receipts.txt").exists()


def test_a_regrade_signs_only_the_scores_that_count(folder):
    grade("out", "--receipt-key", "key.pem")
    first = receipts()
    _, after = moved(1, 1)
    run("regrade", "out")
    assert receipts() == first
    assert not list(Path("out/regrade").rglob("receipt*"))
    run("regrade", "out", "--apply")
    points = {team: json.loads(line)["points"] for team, line in receipts().items()}
    assert points == after
    run("receipt", "out/receipts.txt", "--key", "key.pem.pub")


def test_a_regrade_never_creates_a_key(folder, capsys):
    grade("out", "--receipt-key", "key.pem")
    Path("key.pem").unlink()
    capsys.readouterr()
    run("regrade", "out", code=2)
    assert "key.pem: No such file" in capsys.readouterr().err and not Path("key.pem").exists()


def test_anonymous_grading_writes_no_receipt(folder):
    grade("out", "--receipt-key", "key.pem", "--anonymous")
    assert not list(Path("out").rglob("receipt*"))
    assert not any(b"signature" in data for data in contents("out", "anonymous").values())


@pytest.mark.parametrize(
    ("prepare", "words", "message"),
    [
        (lambda: None, [], "no results of a class"),
        (
            lambda: grade("out"),
            ["--requests", "roster.csv"],
            "expected the columns student, task, words",
        ),
        (lambda: grade("out"), ["--only", "b9"], "'b9'"),
        (
            lambda: (run("grade", "in", *OPEN, "-o", "out"), correct("1")),
            ["--apply"],
            "--secret-file",
        ),
    ],
)
def test_an_impossible_regrade_is_refused_in_one_line(folder, capsys, prepare, words, message):
    Path("out").mkdir()
    prepare()
    capsys.readouterr()
    run("regrade", "out", *words, code=2)
    output = capsys.readouterr().err
    assert message in output and output.count("\n") == 1


def killed(rng, *words):
    """Run a command in a process that kills itself before one of its changes to the disk.

    Return whether it was killed.
    """
    left = rng.randrange(1, 60)
    with warnings.catch_warnings():
        # about forking in a process with threads
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if not child:

        def counted(change):
            def changed(*args, **kwargs):
                nonlocal left
                left -= 1
                if not left:
                    os.kill(os.getpid(), signal.SIGKILL)
                return change(*args, **kwargs)

            return changed

        os.replace, os.unlink, os.rmdir = map(counted, (os.replace, os.unlink, os.rmdir))
        Path.unlink, Path.mkdir = map(counted, (Path.unlink, Path.mkdir))
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        try:
            cli.run([str(word) for word in words])
        except SystemExit as ended:
            os._exit(0 if ended.code is None else 1)
        finally:
            os._exit(3)
    status = os.waitpid(child, 0)[1]
    assert os.WIFSIGNALED(status) or os.WEXITSTATUS(status) == 0, "the command failed"
    return os.WIFSIGNALED(status)


def lived(rng):
    """Run the history of a class, and return how often a command was killed."""
    kills = 0
    version = 0
    grade()
    for _ in range(rng.randrange(2, 7)):
        event = rng.choice(["correct", "hand in", "grade", "regrade", "regrade", "never-lower"])
        if event == "hand in":
            hand_in(rng.choice(TEAMS), rng.random(), rng.randrange(0, 5))
        elif event == "grade":
            kills += killed(rng, "grade", "in", *WORDS, "-o", "out")
        elif event == "regrade":
            more = rng.choice(
                [[], ["--apply"], ["--apply", "--policy", "only-listed", "--only", "b3"]]
            )
            kills += killed(rng, "regrade", "out", *more)
        elif event == "never-lower":
            grade()
            before = work()
            version = version + 1
            correct(version)
            for _ in range(3):
                if not killed(rng, "regrade", "out", "--policy", "never-lower", "--apply"):
                    break
                kills += 1
            run("regrade", "out", "--policy", "never-lower", "--apply")
            assert all(after >= before[who] for who, after in work().items())
        else:
            version += 1
            correct(version)
    return kills


@pytest.mark.grading
@pytest.mark.skipif(not hasattr(os, "fork"), reason="kills processes that it has forked")
def test_after_any_history_an_applied_regrade_equals_grading_from_scratch(folder):
    rng = random.Random(25)
    kills = 0
    for number in range(HISTORIES):
        home = folder / f"class{number}"
        home.mkdir()
        os.chdir(home)
        make_class(home)
        kills += lived(rng)
        correct(f"last {number}")  # of which no result is there yet
        while killed(rng, "regrade", "out", "--apply"):
            kills += 1
        run("regrade", "out", "--apply")
        grade("scratch")
        parts = (*BOOKS, "results", "feedback")
        assert contents("out", *parts) == contents("scratch", *parts), f"class {number}"
        assert not list(Path("out").rglob(".hdrlab-*"))
        secret = Path("secret.txt").read_text().strip()
        assert regrade.read_journal(Path("out"), secret)
    assert kills > HISTORIES
