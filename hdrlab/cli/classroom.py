"""Grade all submissions of a class: the work of `hdrlab grade FOLDER` and `hdrlab regrade`."""

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hdrlab.cli import assignments, common
from hdrlab.errors import FileFormatError, InputError

if TYPE_CHECKING:
    from hdrlab.course import plan as plans
    from hdrlab.course.classroom.jobs import Executor, GradingJob, JobResult
    from hdrlab.course.classroom.run import GradingContext
    from hdrlab.course.grading.results import Result
    from hdrlab.course.reports.receipts import SigningKey
    from hdrlab.course.students.anonymity import Anonymity
    from hdrlab.course.submissions.class_folder import SubmissionScan

# in a class's results: the folder of the submissions and the ClassOptions, for `hdrlab regrade`
OPTIONS_FILE = "asked.json"
RECEIPTS_FILE = "receipts.txt"


@dataclass(frozen=True)
class ClassOptions:
    """The options of `hdrlab grade` that belong to a class; a regrade uses the same.

    Attributes
    ----------
    submissions : the folder of what the class has handed in
    homework : the name of the assignment, or None for the one in the folder's name
    tier, timeout, hidden, secret_file : the conditions of each check
    student : used by submissions of one student only, and recorded here
    roster, received, before : CSV files: the class, when files came in, earlier gradebooks
    file_times : whether the files' own times tell who is late
    moodle : the assignment's grading worksheet
    adjustments : the instructor's decisions about students, CSV files
    explain_hidden : whether feedback says why hidden checks failed
    receipt_key : the private key that signs receipts, or None for no receipts
    plan : the course plan, or None for the package's
    """

    submissions: Path
    homework: str | None
    tier: str
    hidden: Path | None
    student: str
    secret_file: Path | None
    timeout: float
    roster: Path | None
    received: Path | None
    before: tuple[Path, ...]
    moodle: Path | None
    plan: Path | None
    file_times: bool = False
    adjustments: tuple[Path, ...] = ()
    explain_hidden: bool = False
    receipt_key: Path | None = None


@dataclass(frozen=True)
class RunOptions:
    """The options of `hdrlab grade` that belong to one run.

    Attributes
    ----------
    out : the folder for the results
    only, since : which submissions to grade
    regrade : grade again what was graded before
    jobs, cluster : how many at a time, and on which Dask cluster
    anonymous : write pages with codes instead of names, and none with names
    """

    out: Path
    only: tuple[str, ...] = ()
    since: datetime | None = None
    regrade: bool = False
    jobs: int | None = None
    cluster: str | None = None
    anonymous: bool = False

    def __post_init__(self) -> None:
        if self.cluster is not None and self.jobs is not None:
            raise InputError(
                "--jobs and --cluster exclude each other; "
                "with a cluster, set the threads of its workers"
            )


@dataclass(frozen=True)
class GradedClass:
    """A class with its submissions, a grading job for each of them, and the options.

    Attributes
    ----------
    anonymity : codes of the class, if the readers must not see names
    receipt_key : signs a receipt for each result; None for no receipts
    """

    course: "GradingContext"
    scan: "SubmissionScan"
    jobs: "list[GradingJob]"
    options: ClassOptions
    run: RunOptions
    anonymity: "Anonymity | None" = None
    receipt_key: "SigningKey | None" = None

    def shown(self, text: str) -> str:
        """Return a text as its readers may see it."""
        return text if self.anonymity is None else self.anonymity.redact(text)

    def receipt_signer(self) -> "Callable[[Result], str] | None":
        """Return the function that signs the receipt for a result; None if there are no receipts."""
        key = self.receipt_key
        if key is None:
            return None
        from hdrlab.course.reports import receipts

        return lambda result: receipts.sign(
            result, self.scan.submissions[result.student].students, key
        )


def load_class(
    conditions: "plans.GradingOptions", options: ClassOptions, run_options: RunOptions
) -> GradedClass:
    """Read the roster, the plan and the submissions of a class."""
    from hdrlab.course import plan as plans
    from hdrlab.course.classroom import anonymous, marks, moodle, run
    from hdrlab.course.students import adjustments, anonymity, roster
    from hdrlab.course.submissions import class_folder

    if options.roster is None:
        raise InputError(
            f"{options.submissions} is a folder, which hdrlab grades as a class; "
            "pass the class list with --roster"
        )
    homework = assignments.find_homework(options.submissions, options.homework, options.plan)
    if options.explain_hidden:
        _require_due_date_passed(homework)
    plan = plans.read(options.plan)
    students = roster.read(options.roster, team_size=plan.team_size)
    ids_by_code = {}
    codes = None
    if conditions.secret:
        words = anonymous.words_of_assignment(homework.name)
        codes = anonymity.make_anonymity(students, conditions.secret, words)
        ids_by_code = {code: id for id, code in codes.students.items()}
    decisions = adjustments.merge(
        adjustments.read(path, students, ids_by_code) for path in options.adjustments
    )
    course = run.GradingContext(
        roster=students,
        homework=homework,
        conditions=conditions,
        late=plan.late,
        before=marks.read(options.before),
        adjustments=decisions,
    )
    times = class_folder.read_times(options.received) if options.received else {}
    teams_by_number = {}
    if options.moodle is not None:
        teams_by_number = moodle.find_teams_by_number(options.moodle, course.roster, homework)
    scan = class_folder.find(
        options.submissions,
        course.roster,
        times,
        file_times=options.file_times,
        teams_by_number=teams_by_number,
    )
    jobs = run.make_jobs(scan.submissions, homework, conditions)
    return GradedClass(
        course=course,
        scan=scan,
        jobs=jobs,
        options=options,
        run=run_options,
        anonymity=codes if run_options.anonymous else None,
        receipt_key=assignments.read_receipt_key(options.receipt_key),
    )


def _require_due_date_passed(homework: "plans.Homework") -> None:
    """Raise an InputError if students can still hand in what hidden checks would tell them."""
    if isinstance(homework.due, datetime) and datetime.now(UTC) < homework.due:
        raise InputError(
            f"{homework.name} is due on {homework.due:%Y-%m-%d %H:%M %Z}; "
            "pass --explain-hidden after that"
        )


def grade_class(graded_class: GradedClass) -> None:
    """Grade the submissions of a class that have no result yet; write its gradebook and page."""
    from hdrlab.course.classroom import jobs as grading_jobs, run

    course = graded_class.course
    out = graded_class.run.out
    submissions = graded_class.scan.submissions
    since = graded_class.run.since
    if since is not None:
        since = since.replace(tzinfo=UTC)
    selected = run.select_submissions(submissions, course.roster, graded_class.run.only, since)
    notes = [graded_class.shown(note) for note in graded_class.scan.notes]
    common.echo_notes([*notes, _describe_lateness(graded_class)])
    with grading_jobs.lock_folder(out):
        grading_jobs.write_private_file(out / OPTIONS_FILE, _options_to_json(graded_class.options))
        jobs = [job for job in graded_class.jobs if job.owner in selected]
        results = run_jobs(graded_class, jobs, out)
        failures = describe_failures(results)
        common.echo_warnings(graded_class.shown(failure) for failure in failures)
        page, graded_count = write_books(graded_class, failures)
        _compare(page.parent, graded_class)
    fresh = sum(result.is_new for result in results if result.path)
    click.echo(f"{page}: {graded_count} of {len(submissions)} graded, {fresh} of them now")


def _describe_lateness(graded_class: GradedClass) -> str:
    """Return who is late, by which times, before anybody is graded."""
    from hdrlab.course.classroom import marks
    from hdrlab.course.due_dates import DueInWeek

    options = graded_class.options
    if options.received is None and not options.file_times:
        return (
            "no times of the submissions, so nobody is late; "
            "to count late days, pass --received FILE or --file-times"
        )
    if isinstance(graded_class.course.homework.due, DueInWeek):
        return (
            f"the plan does not say on which date {graded_class.course.homework.name} is due, so "
            "nobody is late; set the first day of your term with `hdrlab course move`"
        )
    source = "the files' modification times" if options.received is None else str(options.received)
    codes = graded_class.anonymity.students if graded_class.anonymity else {}
    late = marks.describe_late(graded_class.course, graded_class.scan.submissions, codes)
    return f"by {source}, {late or 'nobody is late'}"


def describe_failures(results: "Sequence[JobResult]") -> list[str]:
    """Return a line about each submission that could not be graded."""
    return [f"{result.job.owner}: {result.problem}" for result in results if result.problem]


def write_books(graded_class: GradedClass, failures: Sequence[str] = ()) -> tuple[Path, int]:
    """Write the gradebooks and the page of a class; return the page and the number of results.

    With --anonymous, hdrlab writes the anonymous folder instead.
    """
    from hdrlab.course.classroom import anonymous, moodle, overview, run

    course = graded_class.course
    out = graded_class.run.out
    worksheet = graded_class.options.moodle
    statistics = overview.collect_statistics(run.read_results(out, graded_class.jobs))
    if graded_class.anonymity is not None:
        page = anonymous.write_class(
            out,
            course.homework,
            overview.gradebook_rows(course, graded_class.scan, statistics),
            statistics,
            run.read_results(out, graded_class.jobs),
            graded_class.scan.submissions,
            [*graded_class.scan.notes, *failures],
            graded_class.anonymity,
        )
        return page, len(statistics.points)
    *_, page = overview.write_class_files(out, course, graded_class.scan, statistics, failures)
    _write_receipts(graded_class)
    if worksheet:
        rows = overview.gradebook_rows(course, graded_class.scan, statistics)
        notes = moodle.write(out, worksheet, rows, course.roster, course.homework)
        common.echo_notes(notes)
    return page, len(statistics.points)


def _write_receipts(graded_class: GradedClass) -> None:
    """Write receipts.txt, a line for each result; delete an earlier one if there are no receipts."""
    from hdrlab.course.classroom import jobs as grading_jobs, run

    path = graded_class.run.out / RECEIPTS_FILE
    sign = graded_class.receipt_signer()
    if sign is None:
        path.unlink(missing_ok=True)
        return
    results = run.read_results(graded_class.run.out, graded_class.jobs)
    text = "".join(f"{sign(result)}\n" for result in results)
    grading_jobs.write_private_file(path, text.encode())


def run_jobs(
    graded_class: GradedClass, jobs: "Sequence[GradingJob]", out: Path
) -> "list[JobResult]":
    """Run grading jobs, and write each team's feedback as soon as its result exists.

    Jobs whose results exist are not run again, except with --regrade.
    """
    from hdrlab.course.classroom import jobs as grading_jobs, run

    folder = out / "results"
    if graded_class.run.regrade:
        finished: list[JobResult] = []
        remaining = list(jobs)
    else:
        finished, remaining = grading_jobs.split_finished(folder, jobs)

    sign = graded_class.receipt_signer()

    def write_feedback(result: "JobResult") -> "JobResult":
        if graded_class.anonymity is not None:  # `write_books` writes it, in the order of the codes
            return result
        return run.write_feedback(
            out,
            result,
            explain_hidden=graded_class.options.explain_hidden,
            sign=sign,
        )

    results = [write_feedback(result) for result in finished]
    if finished:
        click.echo(f"{len(finished)} of {len(jobs)} were graded before", err=True)
    if remaining:
        with _executor(graded_class.course, graded_class.run) as executor:
            grading_jobs.delete_results(folder, remaining)
            steps = map(write_feedback, grading_jobs.run_jobs(remaining, executor, folder))
            name = graded_class.course.homework.name
            results.extend(common.progress(steps, name, len(remaining)))
    return results


def _compare(out: Path, graded_class: GradedClass) -> None:
    """Write similar.html, which compares all submissions of the class, old and new."""
    course = graded_class.course
    submissions = graded_class.scan.submissions
    try:
        from hdrlab.course.similarity import report
    except ImportError as error:
        common.echo_notes([f'similar.html needs {error.name}: pip install "hdrlab[class]"'])
        return
    if len(submissions) > report.MAX_SUBMISSIONS:
        common.echo_notes(
            [f"no similar.html: hdrlab compares at most {report.MAX_SUBMISSIONS:,} submissions"]
        )
        return
    steps = report.write_steps(
        out, course.homework, submissions, course.conditions.secret, graded_class.anonymity
    )
    for _ in common.progress(steps, "comparing", len(submissions)):
        pass


def _executor(course: "GradingContext", options: RunOptions) -> "Executor":
    """Return what runs the grading jobs: processes of this machine, or a Dask cluster."""
    from hdrlab.course.classroom import run
    from hdrlab.course.classroom.executors import processes
    from hdrlab.course.grading import doctor

    conditions = course.conditions
    grader = run.Grader(course.homework, conditions, run.read_hidden_checks(conditions.hidden))
    if options.cluster is None:
        # tested once, before the jobs, and not by each of them
        examination = doctor.examine(conditions.tier)
        if not examination.works:
            raise common.tier_error(examination.details)
        return processes.Processes(grader.grade, options.jobs)
    common.require_modules("cluster", ["dask", "distributed"])
    from hdrlab.course.classroom.executors import cluster

    return cluster.Cluster(options.cluster, grader.grade, grader.check_available)


def load_graded_class(results: Path, run_options: RunOptions, homework: str | None) -> GradedClass:
    """Load a class with the options that `hdrlab grade` recorded in its results.

    A homework that is given replaces the recorded one.
    """
    from hdrlab.course import plan as plans

    options = _read_options(results)
    if homework is not None:
        options = replace(options, homework=homework)
    secret = ""
    if options.secret_file:
        # unlike `grade`, never create a secret: all inputs would change
        secret, _is_new = plans.read_secret(options.secret_file.resolve(strict=True))
    if options.receipt_key:  # nor a key, whose public key nobody has
        options = replace(options, receipt_key=options.receipt_key.resolve(strict=True))
    conditions = plans.GradingOptions(
        tier=options.tier, secret=secret, hidden=options.hidden, timeout=options.timeout
    )
    return load_class(conditions, options, run_options)


def _options_to_json(options: ClassOptions) -> bytes:
    """Return the record of the options of a class. Its paths are absolute."""
    values = asdict(options)
    folder = values.pop("submissions")
    return json.dumps([folder, values], default=lambda path: str(path.resolve())).encode()


def _read_options(results: Path) -> ClassOptions:
    """Read the record of the options of a class."""
    file = results / OPTIONS_FILE
    if not file.is_file():
        raise InputError(
            f"{results}: contains no results of a class; pass the folder that `hdrlab grade` wrote"
        )
    try:
        folder, values = json.loads(file.read_bytes())
        return ClassOptions(
            submissions=Path(folder),
            homework=values["homework"],
            tier=values["tier"],
            hidden=_path_or_none(values["hidden"]),
            student=values["student"],
            secret_file=_path_or_none(values["secret_file"]),
            timeout=values["timeout"],
            roster=_path_or_none(values["roster"]),
            received=_path_or_none(values["received"]),
            before=tuple(Path(path) for path in values["before"]),
            moodle=_path_or_none(values["moodle"]),
            plan=_path_or_none(values["plan"]),
            # options without this entry are of a class that was graded by the files' times
            file_times=values.get("file_times", True),
            adjustments=tuple(Path(path) for path in values.get("adjustments") or ()),
            explain_hidden=values.get("explain_hidden", False),
            receipt_key=_path_or_none(values.get("receipt_key")),
        )
    except (ValueError, TypeError, KeyError) as error:
        raise FileFormatError(
            f"{file}: expected the options that `hdrlab grade` recorded ({error!r}); "
            "grade the class again"
        ) from None


def _path_or_none(text: Any) -> Path | None:
    return None if text is None else Path(text)
