"""Grade a class again after its checks were corrected, and review the changes before they count.

RESULTS/
  regrade/        the new results, until they count, and the changes: regrade.html
  history/        the results that counted before, one folder for each regrade
  journal.jsonl   one line for each regrade, signed with the course's secret; each line holds the
                  signature of the line before

A run may be killed at any moment. Each team then has either its old or its new result, and the next
run does the rest.
"""

import hmac
import json
import os
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hdrlab.course.classroom import jobs
from hdrlab.course.classroom.jobs import GradingJob
from hdrlab.course.classroom.overview import histogram
from hdrlab.course.grading import results
from hdrlab.course.sanitize import sanitize_line
from hdrlab.course.students import csv_tables
from hdrlab.course.students.roster import Roster
from hdrlab.errors import FileFormatError, InputError
from hdrlab.show.pages.templates import render_page

JOURNAL_NAME = "journal.jsonl"
REQUEST_COLUMNS = ("student", "task", "words")
MAX_REQUEST_LENGTH = 400


class JournalError(InputError):
    """The journal of regrades was changed, or its lines were not signed with this secret."""


@dataclass(frozen=True)
class CheckChange:
    """A check that ends in another way than before, or is worth other points."""

    task: str
    promise: str
    change: str


@dataclass(frozen=True)
class ScoreChange:
    """What a regrade does to the score of a team.

    Attributes
    ----------
    job : the submission
    old_score : the points that counted so far; None if the team had no result
    new_score : the points under the new checks
    final_score : the points that will count
    uses_new : whether the new result will replace the old one
    check_changes : the checks that changed
    requests : what the team asked for, in its own words
    """

    job: GradingJob
    old_score: float | None
    new_score: float
    final_score: float
    uses_new: bool
    check_changes: tuple[CheckChange, ...] = ()
    requests: tuple[str, ...] = ()

    @property
    def difference(self) -> float:
        """By how many points the score of the team changes."""
        return self.final_score - (self.old_score or 0)


def read_requests(paths: Sequence[Path], roster: Roster) -> dict[str, list[str]]:
    """Read what students ask for, from tables with the columns student, task and words.

    Returns
    -------
    dict
        The requests, by team.

    Raises
    ------
    InputError
        For another table, or a student who is not in the roster.
    """
    requests: dict[str, list[str]] = {}
    for path in paths:
        for row in csv_tables.read_csv(path):
            if not set(REQUEST_COLUMNS) <= set(row):
                expected = ", ".join(REQUEST_COLUMNS)
                raise InputError(f"{path}: expected the columns {expected}, got {', '.join(row)}")
            student = roster.find(csv_tables.unescape_cell(row["student"]))
            request = sanitize_line(f"{row['task']}: {row['words']}", MAX_REQUEST_LENGTH)
            requests.setdefault(student.team, []).append(request)
    return requests


def find_score_changes(
    out: Path,
    grading_jobs: Sequence[GradingJob],
    *,
    policy: str,
    listed: Collection[str],
    requests: Mapping[str, Sequence[str]],
) -> list[ScoreChange]:
    """Return what the new results would change.

    The list has an entry for each team whose checks or submission changed, or that asked for
    something.

    Parameters
    ----------
    out : the folder with the results of the class
    grading_jobs : all submissions, with their keys under the current checks
    policy : "replace", "never-lower" or "only-listed": which new results count. The result of a new
        submission always counts.
    listed : the teams for which the policy "only-listed" uses the new result
    requests : what teams ask for
    """
    current_paths = _current_results(out)
    changes = []
    for job in grading_jobs:
        old = _read_result(current_paths.get(job.owner))
        new = None
        is_up_to_date = jobs.result_path(out / "results", job).exists()
        if not is_up_to_date:
            new = _read_result(_staged_path(out, job))
        elif job.owner not in requests:
            continue
        if old is None and new is None:
            continue
        keeps_old = _keeps_old(old, new, policy, is_listed=job.owner in listed)
        changes.append(_score_change(job, old, new, keeps_old, requests.get(job.owner, ())))
    return changes


def _keeps_old(
    old: results.Result | None, new: results.Result | None, policy: str, *, is_listed: bool
) -> bool:
    """Return whether the policy keeps the old result of a team.

    A submission that could not be graded again keeps the result that it has.
    """
    if new is None:
        return True
    if old is None or old.submission != new.submission:
        return False
    if policy == "never-lower":
        return new.score < old.score
    if policy == "only-listed":
        return not is_listed
    return False


def _score_change(
    job: GradingJob,
    old: results.Result | None,
    new: results.Result | None,
    keeps_old: bool,
    requests: Sequence[str],
) -> ScoreChange:
    """Return the change of a team's score; one of the two results exists."""
    old_score = None if old is None else old.score
    new_score = old_score if new is None else new.score
    final_score = old_score if keeps_old else new_score
    assert new_score is not None
    assert final_score is not None
    check_changes: tuple[CheckChange, ...] = ()
    if old is not None and new is not None:
        check_changes = tuple(_check_changes(old, new))
    return ScoreChange(
        job=job,
        old_score=old_score,
        new_score=new_score,
        final_score=final_score,
        uses_new=not keeps_old,
        check_changes=check_changes,
        requests=tuple(requests),
    )


def _staged_path(out: Path, job: GradingJob) -> Path:
    """Return the file of a new result that does not count yet."""
    return jobs.result_path(out / "regrade" / "results", job)


def _current_results(out: Path) -> dict[str, Path]:
    """Return the file with the result that counts, by team: the one that was written last."""
    paths = sorted((out / "results").glob("*.json"), key=lambda path: path.stat().st_mtime_ns)
    return {path.name.rsplit(".", 2)[0]: path for path in paths}


def _read_result(path: Path | None) -> results.Result | None:
    """Return a result, or None if there is none or its file is damaged."""
    if path is None:
        return None
    try:
        return results.from_json(path.read_bytes())
    except (FileNotFoundError, InputError):
        return None


def _check_outcomes(result: results.Result) -> dict[tuple[str, str], str]:
    """Return how each check ended and what it earned, by its task and promise."""
    outcomes = {}
    for check in result.checks:
        points = f"{float(check.points):g} of {float(check.max_points):g}"
        outcomes[check.task, check.promise] = f"{check.outcome}, {points}"
    return outcomes


def _check_changes(old: results.Result, new: results.Result) -> Iterator[CheckChange]:
    """Yield each check that ends in another way than before, or is worth other points."""
    old_outcomes = _check_outcomes(old)
    new_outcomes = _check_outcomes(new)
    for task, promise in old_outcomes | new_outcomes:
        old_outcome = old_outcomes.get((task, promise), "not asked")
        new_outcome = new_outcomes.get((task, promise), "not asked")
        if old_outcome != new_outcome:
            yield CheckChange(task, promise, f"{old_outcome} → {new_outcome}")


def changes_text(changes: Sequence[ScoreChange]) -> str:
    """Return the changes of a regrade as lines for a terminal."""
    lines = []
    for change in changes:
        if change.old_score == change.new_score:
            continue
        old_score = "not graded" if change.old_score is None else f"{change.old_score:10g}"
        kept = "" if change.uses_new else f", kept {change.final_score:g}"
        checks = "; ".join(f"{check.task}: {check.promise}" for check in change.check_changes)
        lines.append(f"{change.job.owner:16} {old_score} -> {change.new_score:g}{kept}  {checks}")
    up = sum(change.difference > 0 for change in changes)
    down = sum(change.difference < 0 for change in changes)
    graded = "No check and no submission has changed"
    if changes:
        graded = f"{len(changes)} graded again"
    lines.append(f"{graded}: {up} scores would go up, {down} down")
    return "\n".join(lines)


def write_changes_page(
    out: Path, changes: Sequence[ScoreChange], max_score: float, policy: str
) -> Path:
    """Write the changes of a regrade as an HTML page, and return its path."""
    folder = jobs.make_private(out / "regrade")
    old_scores = [change.old_score for change in changes if change.old_score is not None]
    final_scores = [change.final_score for change in changes]
    check_counts = Counter(check for change in changes for check in change.check_changes)
    page = render_page(
        Path(__file__).parent,
        "regrade_page.html",
        changes=changes,
        max_score=max_score,
        policy=policy,
        bins=list(
            zip(
                histogram(old_scores, max_score),
                histogram(final_scores, max_score),
                strict=True,
            )
        ),
        check_counts=check_counts.most_common(),
    )
    path = folder / "regrade.html"
    jobs.write_private_file(path, page.encode())
    return path


def apply_changes(
    out: Path,
    changes: Sequence[ScoreChange],
    grading_jobs: Sequence[GradingJob],
    secret: str,
    **details: object,
) -> list[str]:
    """Make the results of a regrade count: first a line in the journal, then team by team.

    If the run is killed in between, the next regrade finds the rest. A new result that is damaged
    is deleted, so that the next regrade grades the submission again; the old result stays.

    Parameters
    ----------
    out : the folder with the results of the class
    changes : from `find_score_changes`
    grading_jobs : all submissions, with their keys under the current checks
    secret : signs the journal
    details : what else the line of the journal holds

    Returns
    -------
    list of str
        A note for each damaged result.

    Raises
    ------
    JournalError
        If there is no secret, or if the journal was not signed with it.
    """
    entries = read_journal(out, secret)
    current_paths = _current_results(out)
    sources: dict[GradingJob, Path] = {}
    notes = []
    for change in changes:
        job = change.job
        staged_path = _staged_path(out, job)
        if staged_path.is_file() and _read_result(staged_path) is None:
            staged_path.unlink()
            notes.append(
                f"{job.owner}: its new result is damaged, so the old one stays; regrade again"
            )
        else:
            sources[job] = staged_path if change.uses_new else current_paths[job.owner]
    applied = [change for change in changes if change.job in sources]
    if applied:
        entries.append(_sign_entry(entries, applied, secret, details))
        text = "".join(json.dumps(entry) + "\n" for entry in entries)
        jobs.write_private_file(out / JOURNAL_NAME, text.encode())
    for job, source in sources.items():
        target = jobs.result_path(out / "results", job)
        jobs.write_private_file(target, source.read_bytes())
    _move_to_history(out, grading_jobs, len(entries))
    return notes


def _move_to_history(out: Path, grading_jobs: Sequence[GradingJob], number: int) -> None:
    """Move the results that no longer count into the folder of a regrade in the history."""
    folder = out / "results"
    finished = [job for job in grading_jobs if jobs.result_path(folder, job).is_file()]
    for paths in jobs.find_outdated_results(folder, finished).values():
        for path in paths:
            history = jobs.make_private(out / "history" / str(number))
            os.replace(path, history / path.name)


def _sign_entry(
    entries: Sequence[Mapping[str, Any]],
    changes: Sequence[ScoreChange],
    secret: str,
    details: Mapping[str, object],
) -> dict[str, Any]:
    """Return the next line of the journal."""
    entry: dict[str, Any] = {"number": len(entries) + 1, **details}
    entry["moved"] = {
        change.job.owner: [change.old_score, change.final_score]
        for change in changes
        if change.difference
    }
    entry["before"] = entries[-1]["signature"] if entries else ""
    return entry | {"signature": _signature(entry, secret)}


def read_journal(out: Path, secret: str) -> list[dict[str, Any]]:
    """Read the lines of the journal, and verify that each was signed with the secret.

    Raises
    ------
    JournalError
        If there is no secret, or at the first line with a wrong number or signature.
    FileFormatError
        If a line is not JSON.
    """
    if not secret:
        raise JournalError(
            "a regrade is signed with the class's secret, but the class was graded without "
            "--secret-file"
        )
    path = out / JOURNAL_NAME
    if not path.exists():
        return []
    try:
        entries = [json.loads(line) for line in path.read_text("utf8").splitlines()]
    except ValueError as error:
        raise FileFormatError(f"{path}: expected one JSON object in each line ({error})") from None
    previous_signature = ""
    for number, entry in enumerate(entries, 1):
        unsigned = {name: value for name, value in entry.items() if name != "signature"}
        signature = str(entry.get("signature"))
        if entry.get("number") != number or entry.get("before") != previous_signature:
            raise JournalError(f"{path}, line {number}: a line before it was changed or removed")
        if not hmac.compare_digest(signature, _signature(unsigned, secret)):
            raise JournalError(f"{path}, line {number}: not signed with the course's secret")
        previous_signature = signature
    return entries


def _signature(entry: Mapping[str, object], secret: str) -> str:
    text = json.dumps(entry, sort_keys=True)
    return hmac.digest(secret.encode(), text.encode(), "sha256").hex()
