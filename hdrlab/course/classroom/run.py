"""Grade all submissions of a class, one job for each submission.

RESULTS/
  results/      one file for each submission; everything else is made from these
  feedback/     for each team, a page and the files that other systems read
  and the files about the whole class: see `overview`
"""

import tempfile
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from datetime import datetime
from functools import cache
from pathlib import Path

from hdrlab.course.classroom import jobs
from hdrlab.course.classroom.jobs import GradingJob, JobResult
from hdrlab.course.grading import doctor, grader, results
from hdrlab.course.plan import GradingOptions, Homework, Late
from hdrlab.course.reports import gradebook
from hdrlab.course.sandbox.session import Unavailable
from hdrlab.course.sanitize import sanitize_line
from hdrlab.course.students.adjustments import Adjustment
from hdrlab.course.students.late_days import LateRecord
from hdrlab.course.students.roster import Roster
from hdrlab.course.submissions.class_folder import Submission
from hdrlab.course.variants import rewording
from hdrlab.errors import InputError

# They are copied into each grading job.
MAX_HIDDEN_CHECKS_BYTES = 64 * 2**20
MAX_ATTEMPTS = 3


@dataclass(frozen=True)
class GradingContext:
    """What a class is graded by.

    Attributes
    ----------
    roster : the students and their teams
    homework, conditions : what is checked, and with which options
    late : the rule for late submissions
    before : late records of earlier homeworks, in the order of their due dates
    adjustments : the instructor's own decisions, by student
    """

    roster: Roster
    homework: Homework
    conditions: GradingOptions
    late: Late = Late()
    before: Sequence[LateRecord] = ()
    adjustments: Mapping[str, Adjustment] = field(default_factory=dict)


@dataclass(frozen=True)
class Grader:
    """Grade one submission. A Grader can be pickled and sent to another process or machine.

    Attributes
    ----------
    homework, conditions : what is checked, and with which options
    hidden : the instructor's own checks and their files, by name; see `read_hidden_checks`
    """

    homework: Homework
    conditions: GradingOptions
    hidden: Sequence[tuple[str, bytes]] = ()

    def check_available(self) -> None:
        """Raise Unavailable if this machine cannot run the sandbox tier."""
        _check_tier_available(self.conditions.tier)

    def grade(self, job: GradingJob) -> bytes:
        """Return the result of a submission as JSON.

        If the process of a student's function was killed, the submission is graded again: in a tier
        for credit a function cannot kill itself, so something else did, such as a system out of
        memory. The same result each time is accepted.

        Raises
        ------
        InputError
            If the process was killed each time, but not at the same check.
        """
        attempts: list[results.Result] = []
        for _ in range(MAX_ATTEMPTS):
            result = self._grade_once(job)
            if all(check.kind != "killed" for check in result.checks):
                return results.to_json(result)
            attempts.append(result)
        if all(result == attempts[0] for result in attempts):
            return results.to_json(attempts[0])
        raise InputError(
            "its functions' process ended without an answer, each time at another check"
        )

    def _grade_once(self, job: GradingJob) -> results.Result:
        student = job.owner if self.conditions.secret else ""
        with tempfile.TemporaryDirectory(prefix="hdrlab-class-") as scratch:
            hidden_folder = None
            if self.hidden:
                hidden_folder = Path(scratch) / "hidden"
                write_files(hidden_folder, self.hidden)
            conditions = replace(self.conditions, student=student, hidden=hidden_folder)
            result = grader.grade(job.path, self.homework, conditions)
        return replace(result, student=job.owner)


@cache
def _check_tier_available(tier: str) -> None:
    """Raise Unavailable if this machine cannot run the tier. The check is cached per process."""
    examination = doctor.examine(tier)
    if not examination.works:
        raise Unavailable(examination.details)


def read_hidden_checks(folder: Path | None) -> list[tuple[str, bytes]]:
    """Read the instructor's own checks and their data files, by path in the folder.

    Raises
    ------
    InputError
        If it is not a folder, or holds more than `MAX_HIDDEN_CHECKS_BYTES`.
    """
    if folder is None:
        return []
    if not folder.is_dir():
        raise InputError(f"expected a folder with hidden checks, got {folder}")
    paths = [
        path
        for path in sorted(folder.rglob("*"))
        if path.is_file() and "__pycache__" not in path.parts
    ]
    size = sum(path.stat().st_size for path in paths)
    if size > MAX_HIDDEN_CHECKS_BYTES:
        raise InputError(
            f"{folder}: expected hidden checks of at most {MAX_HIDDEN_CHECKS_BYTES} bytes, "
            f"got {size}"
        )
    return [(path.relative_to(folder).as_posix(), path.read_bytes()) for path in paths]


def write_files(folder: Path, files: Iterable[tuple[str, bytes]]) -> None:
    """Write files into a folder, which is created if it does not exist."""
    for name, data in files:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


def make_jobs(
    submissions: Mapping[str, Submission], homework: Homework, conditions: GradingOptions
) -> list[GradingJob]:
    """Return one job for each submission.

    Its key is a digest of the submission, the checks and the options: if one of them changes, the
    submission is graded again.
    """
    variants = [rewording.FOLDER / f"{task.id}.toml" for task in homework.tasks if task.parameters]
    checks = [*grader.files_of(homework, conditions.hidden), *variants]
    checks_digest = grader.specification(checks)
    settings = repr(
        [homework.name, homework.tasks, conditions.tier, conditions.secret, conditions.timeout]
    )
    return [
        GradingJob(team, submission.path, jobs.make_key(submission.digest, checks_digest, settings))
        for team, submission in submissions.items()
    ]


def select_submissions(
    submissions: Mapping[str, Submission],
    roster: Roster,
    only: Collection[str] = (),
    since: datetime | None = None,
) -> dict[str, Submission]:
    """Return the submissions of some students or teams, or those received since some time.

    Parameters
    ----------
    submissions : by team
    roster : the class
    only : names of students or teams, in upper or lower case; all if it is empty
    since : earlier submissions are left out

    Raises
    ------
    InputError
        For a name that is not in the roster, or without a submission.
    """
    teams = {roster.find_team(name) for name in only}
    missing = sorted(teams - set(submissions))
    if missing:
        raise InputError(f"nothing was handed in by {', '.join(missing)}; check --only")
    selected = {}
    for team, submission in submissions.items():
        is_wanted = not only or team in teams
        is_recent = since is None or submission.received >= since
        if is_wanted and is_recent:
            selected[team] = submission
    return selected


def write_feedback(
    out: Path,
    result: JobResult,
    *,
    explain_hidden: bool = False,
    sign: Callable[[results.Result], str] | None = None,
) -> JobResult:
    """Write the feedback of a team, unless it exists and belongs to this result.

    The team's copy of the result, result.json, is deleted first and written last: while it exists
    and is equal, the feedback is complete. If writing fails, the returned JobResult has a `problem`,
    and the other teams still get their feedback.

    Parameters
    ----------
    out : the folder with the results of the class
    result : the outcome of the team's job
    explain_hidden : whether the feedback also says why hidden checks failed
    sign : returns the receipt for a result; without it, the feedback has no receipt
    """
    if result.path is None:
        return result
    try:
        data = result.path.read_bytes()
        if explain_hidden:
            data = results.reveal_hidden_checks(data)
        receipt = ""
        if sign is not None:
            receipt = sign(results.from_json(data))
        _write_team_folder(out / "feedback" / result.job.owner, data, receipt)
    except Exception as error:
        problem = sanitize_line(f"{type(error).__name__}: {error}", 200)
        return replace(result, problem=f"its feedback could not be written: {problem}")
    return result


def _write_team_folder(folder: Path, data: bytes, receipt: str) -> None:
    """Write all feedback files of a team from the JSON of its result, unless they are current."""
    team_json = folder / "result.json"
    team_data = results.for_team(data)
    is_complete = all((folder / name).is_file() for name in gradebook.FILES)
    if is_complete and team_json.read_bytes() == team_data and _has_receipt(folder, receipt):
        return
    jobs.make_private(folder.parent)
    jobs.make_private(folder)
    team_json.unlink(missing_ok=True)
    gradebook.write_results(folder, results.from_json(data), team_data, receipt)


def _has_receipt(folder: Path, receipt: str) -> bool:
    """Return whether a team's folder holds this receipt, or none if it is ""."""
    path = folder / gradebook.RECEIPT_FILE
    if not path.is_file():
        return not receipt
    return path.read_bytes() == f"{receipt}\n".encode()


def read_results(out: Path, all_jobs: Sequence[GradingJob]) -> Iterator[results.Result]:
    """Yield the existing results one at a time: all pictures of a large class fill the memory.

    A damaged result is skipped; `write_feedback` reports it.
    """
    for job in all_jobs:
        path = jobs.result_path(out / "results", job)
        if path.is_file():
            with suppress(InputError):
                yield results.from_json(path.read_bytes())
