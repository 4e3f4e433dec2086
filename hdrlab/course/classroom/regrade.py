"""A regrade is a reviewed change: what corrected checks would change is seen before any of it counts.

RESULTS/
  regrade/        the new results, until they count, and what they would change: regrade.html
  history/        the results that counted before, a folder for each regrade
  journal.jsonl   a line for each regrade, signed with the course's secret; each holds the signature before it

A run may be killed at any moment: each team has the one result or the other, and the next run does
the rest.
"""

import hmac
import json
import os
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course.classroom import jobs
from hdrlab.course.classroom.jobs import GradingJob
from hdrlab.course.classroom.overview import histogram
from hdrlab.course.classroom.roster import Roster
from hdrlab.course.reports import csv_tables, results
from hdrlab.course.sanitize import sanitize_line
from hdrlab.errors import FileFormatError, InputError
from hdrlab.show.pages.templates import render_page

LOG = "journal.jsonl"


class ScoreChange(NamedTuple):
    """What a regrade does to a team's work.

    Attributes
    ----------
    job : the submission
    before, after : points that counted so far, None where it had none, and points under the new
        checks
    counts, moves : points that are to count, and by how many it moves
    taken : whether the new result is to count
    changes : of promises: the task, the promise, and how it ended before and now
    asked : what the team asked for, in its words
    """

    job: GradingJob
    before: float | None
    after: float
    counts: float
    moves: float
    taken: bool
    changes: tuple[tuple[str, str, str], ...]
    asked: tuple[str, ...] = ()


def requests(paths: Sequence[Path], roster: Roster) -> dict[str, list[str]]:
    """Return what students ask for, by team, from tables with the columns student, task and words.

    Raises
    ------
    ValueError
        For another table, and for a student whom the roster does not know.
    """
    found: dict[str, list[str]] = {}
    for path in paths:
        for row in csv_tables.read_csv(path):
            if not {"student", "task", "words"} <= set(row):
                raise InputError(
                    f"{path}: expected the columns student, task, words, got {', '.join(row)}"
                )
            said = sanitize_line(f"{row['task']}: {row['words']}", 400)
            found.setdefault(roster.find(row["student"].removeprefix("'")).team, []).append(said)
    return found


def moves(
    out: Path,
    pieces: Sequence[GradingJob],
    policy: str,
    listed: Collection[str],
    asked: Mapping[str, list[str]],
) -> list[ScoreChange]:
    """Return what new results would change, for each team whose checks have changed, or that asked.

    Parameters
    ----------
    out : the folder of the class's results
    pieces : all submissions, with the keys that they have under the checks as they are now
    policy : "replace", "never-lower" or "only-listed": which new results count. What was handed in
        anew does.
    listed, asked : the teams of "only-listed", and what teams ask for
    """
    standing, found = _standing(out), []
    for piece in pieces:
        was, old = (
            _read(standing.get(piece.owner)),
            jobs.result_path(out / "results", piece).exists(),
        )
        new = None if old else _read(jobs.result_path(out / "regrade" / "results", piece))
        now: Any = new or was  # what could not be graded anew keeps what it has
        if now is None or (old and piece.owner not in asked):
            continue
        same = was is not None and was.submission == now.submission
        before, changes = (was.score, tuple(_changes(was, now))) if was else (None, ())
        lower, unlisted = now.score < (before or 0), piece.owner not in listed
        kept = same and {"never-lower": lower, "only-listed": unlisted}.get(policy, False)
        counts = now.score if before is None or not kept else before
        points = before, now.score, counts, counts - (before or 0)
        found.append(
            ScoreChange(piece, *points, not kept, changes, tuple(asked.get(piece.owner, ())))
        )
    return found


def _standing(out: Path) -> dict[str, Path]:
    """Return the file of the result that counts, by team."""
    files = sorted((out / "results").glob("*.json"), key=lambda one: one.stat().st_mtime_ns)
    return {one.name.rsplit(".", 2)[0]: one for one in files}


def _read(path: Path | None) -> results.Result | None:
    """Return a result, or None where there is none, or a damaged one."""
    try:
        return results.from_json(path.read_bytes()) if path else None
    except (FileNotFoundError, ValueError):
        return None


def _endings(result: results.Result) -> dict[tuple[str, str], str]:
    """Return how each promise of each task ended, and what it earned."""
    return {
        (
            one.task,
            one.promise,
        ): f"{one.outcome}, {float(one.points):g} of {float(one.max_points):g}"
        for one in result.checks
    }


def _changes(was: results.Result, now: results.Result) -> Iterator[tuple[str, str, str]]:
    """Yield each promise that ends otherwise than before, or is worth other points."""
    before, after = _endings(was), _endings(now)
    for key in before | after:
        if before.get(key) != after.get(key):
            yield *key, f"{before.get(key, 'not asked')} → {after.get(key, 'not asked')}"


def text(found: Sequence[ScoreChange]) -> str:
    """Return whose points the checks have changed, and why, as lines for a terminal."""
    return render_page(Path(__file__).parent, "regrade.plain", found=found).rstrip()


def write(out: Path, found: Sequence[ScoreChange], whole: float, policy: str) -> Path:
    """Write what a regrade would change as a page, and return it."""
    folder = jobs.make_private(out / "regrade")
    scores = (
        [one.before for one in found if one.before is not None],
        [one.counts for one in found],
    )
    bins = zip(*(histogram(each, whole) for each in scores), strict=True)
    promises = Counter(change for one in found for change in one.changes).most_common()
    words = {"found": found, "whole": whole, "policy": policy, "bins": bins, "promises": promises}
    page = render_page(Path(__file__).parent, "regrade_page.html", **words)
    jobs.write_private_file(folder / "regrade.html", page.encode())
    return folder / "regrade.html"


def apply(
    out: Path,
    found: Sequence[ScoreChange],
    pieces: Sequence[GradingJob],
    secret: str,
    **said: object,
) -> None:
    """Let a regrade count: a line in the journal, who moves and what else is `said`, and then team by team.

    Where it is killed in the midst, the rest is what the next regrade finds to be changed, or moved
    away.

    Raises
    ------
    ValueError
        Where there is no secret to sign with, and where the journal's lines are not signed with it.
    """
    lines, standing = signed_lines(out, secret), _standing(out)
    if found:
        moved = {one.job.owner: [one.before, one.counts] for one in found if one.moves}
        before = lines[-1]["signature"] if lines else ""
        line = {"number": len(lines) + 1, **said, "moved": moved, "before": before}
        lines.append(line | {"signature": _signature(line, secret)})
        jobs.write_private_file(
            out / LOG, "".join(json.dumps(one) + "\n" for one in lines).encode()
        )
    for one in found:
        staged, target = (
            jobs.result_path(out / part, one.job) for part in ("regrade/results", "results")
        )
        source = staged if one.taken and staged.is_file() else standing[one.job.owner]
        jobs.write_private_file(target, source.read_bytes())
    there = [piece for piece in pieces if jobs.result_path(out / "results", piece).is_file()]
    for path in chain.from_iterable(jobs.find_outdated_results(out / "results", there).values()):
        os.replace(path, jobs.make_private(out / "history" / str(len(lines))) / path.name)


def signed_lines(out: Path, secret: str) -> list[dict[str, Any]]:
    """Return the journal's lines, or raise a ValueError at the first that is not signed with the secret."""
    if not secret:
        raise InputError(
            "expected a class that was graded with --secret-file: it signs what is changed"
        )
    path, before = out / LOG, ""
    lines = []
    if path.exists():
        try:
            lines = [json.loads(line) for line in path.read_text("utf8").splitlines()]
        except ValueError as error:
            raise FileFormatError(
                f"{path}: expected a line of JSON for each change ({error})"
            ) from None
    for number, line in enumerate(lines, 1):
        rest = {name: value for name, value in line.items() if name != "signature"}
        right = (number, before, _signature(rest, secret))
        if (rest.get("number"), rest.get("before"), before := line.get("signature")) != right:
            raise InputError(
                f"{path}, line {number}: expected a line that the course's secret has signed"
            )
    return lines


def _signature(line: Mapping[str, object], secret: str) -> str:
    return hmac.digest(secret.encode(), json.dumps(line, sort_keys=True).encode(), "sha256").hex()
