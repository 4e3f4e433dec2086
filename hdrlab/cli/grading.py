"""The commands about assignments: `check`, `grade`, `regrade`, `receipt` and `doctor`."""

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hdrlab.cli import assignments, classroom, common
from hdrlab.course.limits import CALL_TIMEOUT_SECONDS
from hdrlab.errors import InputError

if TYPE_CHECKING:
    from hdrlab.course.grading.results import Result
    from hdrlab.course.plan import GradingOptions
    from hdrlab.course.reports.receipts import SigningKey

jobs_option = click.option(
    "--jobs",
    type=click.IntRange(1),
    help="Number of submissions to grade at the same time.  [default: processors]",
)


@click.command(cls=common.Command)
@click.argument("submission", type=common.INPUT_PATH)
@assignments.homework_option
@click.option("--task", metavar="NAME", help="Check only this task, such as gsolve.")
@click.option(
    "--hints",
    type=click.IntRange(0, 3),
    metavar="N",
    default=0,
    help="Show up to N hints for each failed check.",
)
@click.option(
    "--report", type=common.OUTPUT_FILE, help="Page to write, with results and figures: .html."
)
@assignments.plan_option
def check(
    *,
    submission: Path,
    homework: str | None,
    task: str | None,
    hints: int,
    report: Path | None,
    plan: Path | None,
) -> None:
    """Check SUBMISSION, a notebook or a Python file.

    You can check a submission as often as you like. The result does not count for credit.

    hdrlab runs the functions in a separate process, but not in a sandbox. So check only code that
    you trust.
    """
    from hdrlab.course import plan as plans
    from hdrlab.course.reports import feedback
    from hdrlab.io.files import write

    assignment = assignments.find_homework(submission, homework, plan)
    if task is not None:
        tasks = {known.id: known for known in assignment.tasks}
        if task not in tasks:
            raise InputError(f"there is no task {task!r}; pass --task, one of {', '.join(tasks)}")
        assignment = assignment._replace(tasks=(tasks[task],))
    conditions = plans.GradingOptions(tier="practice", draw=report is not None)
    result = assignments.grade_submission(submission, assignment, conditions)
    click.echo(feedback.text(result, hints=hints))
    if report is not None:
        click.echo(write(report, feedback.page(result)))


@click.command(cls=common.Command)
@click.argument("submission", type=common.INPUT_PATH)
@assignments.homework_option
@assignments.tier_option
@click.option(
    "--hidden",
    type=common.EXISTING_FOLDER,
    help="Folder with your own checks, test_<task>.py.",
)
@click.option(
    "-o", "--out", type=common.OUTPUT_PATH, default="results", help="Folder for the results."
)
@click.option(
    "--student",
    default="",
    show_default=False,
    help="Student whose inputs to use, for a single submission. Requires --secret-file.",
)
@assignments.secret_option
@click.option(
    "--timeout",
    type=click.FloatRange(0.1),
    default=CALL_TIMEOUT_SECONDS,
    help="Time limit for one call of a function, in seconds, see above.",
)
@click.option(
    "--roster",
    type=common.EXISTING_FILE,
    help="Class list: a CSV file with the column student, and optionally name, email and team.",
)
@click.option(
    "--received",
    type=common.EXISTING_FILE,
    help="Times of the submissions: a CSV file with the columns file and received. Without it, "
    "nobody is late.",
)
@click.option(
    "--file-times",
    is_flag=True,
    help="Use the files' modification times to see who is late. Copies are often newer.",
)
@click.option(
    "--before",
    type=common.EXISTING_FILE,
    multiple=True,
    help="Gradebook of an earlier homework, to count late days. Repeatable.",
)
@click.option(
    "--moodle",
    type=common.EXISTING_FILE,
    help="Moodle's grading worksheet of the assignment. hdrlab writes a copy with the scores.",
)
@click.option(
    "--adjustments",
    type=common.EXISTING_FILE,
    multiple=True,
    help="Your own decisions: a CSV file with the column student and any of extension (days), "
    "points, comment and hold. Repeatable.",
)
@click.option(
    "--explain-hidden",
    is_flag=True,
    help="Say in the feedback why hidden checks failed. Only after the due date.",
)
@click.option(
    "--receipt-key",
    type=common.INPUT_PATH,
    help="File with your private key, which signs a receipt for each result. If it does not "
    "exist, hdrlab creates it, and the public key beside it. Requires --secret-file.",
)
@click.option(
    "--anonymous",
    is_flag=True,
    help="Write pages and tables with codes instead of names. Requires --secret-file.",
)
@click.option(
    "--only",
    metavar="WHO",
    multiple=True,
    help="Grade only this student or team. Repeatable.",
)
@click.option(
    "--since",
    type=click.DateTime(),
    metavar="TIME",
    help="Grade only submissions received after this time (UTC), such as 2026-11-30T12:00:00.",
)
@click.option("--regrade", is_flag=True, help="Delete earlier results and grade again.")
@jobs_option
@click.option(
    "--cluster",
    metavar="ADDRESS",
    help="Address of a Dask cluster that grades the class, such as tcp://HOST:8786.",
)
@assignments.plan_option
def grade(
    *,
    submission: Path,
    homework: str | None,
    tier: str,
    hidden: Path | None,
    out: Path,
    student: str,
    secret_file: Path | None,
    timeout: float,
    roster: Path | None,
    received: Path | None,
    file_times: bool,
    before: tuple[Path, ...],
    moodle: Path | None,
    adjustments: tuple[Path, ...],
    explain_hidden: bool,
    receipt_key: Path | None,
    anonymous: bool,
    only: tuple[str, ...],
    since: datetime | None,
    regrade: bool,
    jobs: int | None,
    cluster: str | None,
    plan: Path | None,
) -> None:
    """Grade SUBMISSION, or all submissions of a class.

    SUBMISSION is a notebook, a Python file, or a folder with the files of a class. hdrlab runs
    the submitted code in a separate process, in the sandbox of --tier. If this machine cannot run
    that tier, hdrlab stops with an error. One call of a function may take --timeout seconds, one
    check 3 times as long, and one submission 20 times as long.

    The course's secret determines the inputs of each student's checks. It is one line in the file
    of --secret-file. Do not share or lose it.

    If SUBMISSION is a folder, hdrlab grades all submissions in it, several at the same time. It
    also writes a gradebook and a page about the class. If you interrupt it, run it again to grade
    the rest. The options from --roster to --cluster apply only to a folder, which requires
    --roster.

    With --receipt-key, the feedback contains a signed receipt for the points. `hdrlab receipt`
    verifies it.

    With --anonymous, hdrlab writes the folder anonymous, in which each student has a code, and
    no page or table with names. To put the names back, run it again without --anonymous.
    """
    from hdrlab.course import plan as plans
    from hdrlab.course.scratch import temporary_folder

    options = classroom.ClassOptions(
        submissions=submission,
        homework=homework,
        tier=tier,
        hidden=hidden,
        student=student,
        secret_file=secret_file,
        timeout=timeout,
        roster=roster,
        received=received,
        file_times=file_times,
        before=before,
        moodle=moodle,
        adjustments=adjustments,
        explain_hidden=explain_hidden,
        receipt_key=receipt_key,
        plan=plan,
    )
    run_options = classroom.RunOptions(
        out=out,
        only=only,
        since=since,
        regrade=regrade,
        jobs=jobs,
        cluster=cluster,
        anonymous=anonymous,
    )
    _check_grading_options(options, run_options)
    secret, note = assignments.read_secret(secret_file)
    conditions = plans.GradingOptions(
        tier=tier, student=student, secret=secret, hidden=hidden, timeout=timeout
    )
    if submission.is_dir():
        with temporary_folder():
            classroom.grade_class(classroom.load_class(conditions, options, run_options))
        assignments.echo_secret_note(note)
        return
    key = assignments.read_receipt_key(receipt_key)
    result = _grade_file(options, conditions)
    if secret:
        assignments.echo_secret_note(note)
    _write_results(out, result, key)


def _check_grading_options(
    options: classroom.ClassOptions, run_options: classroom.RunOptions
) -> None:
    """Raise an InputError if the options contradict each other or need another option."""
    submission = options.submissions
    if options.student and options.secret_file is None:
        raise InputError(
            "--student needs --secret-file, because without a secret anybody can compute the inputs"
        )
    if submission.is_dir() and options.student:
        raise InputError(
            f"--student is for a single submission, but {submission} is a folder; "
            "leave --student out: the roster has the names"
        )
    if run_options.anonymous and options.secret_file is None:
        raise InputError(
            "--anonymous needs --secret-file, because without a secret anybody with the roster can "
            "compute the codes"
        )
    if options.receipt_key is not None:
        _require_credit(options)
    if submission.is_file():
        _require_no_class_options(options, run_options)


def _require_credit(options: classroom.ClassOptions) -> None:
    """Raise an InputError if the scores are not for credit, so that there is nothing to sign."""
    missing = []
    if options.tier == "practice":
        missing.append("--tier strict or container")
    if options.secret_file is None:
        missing.append("--secret-file")
    if options.submissions.is_file() and not options.student:
        missing.append("--student")
    if missing:
        raise InputError(
            f"--receipt-key needs {' and '.join(missing)}: hdrlab signs only scores for credit"
        )


def _require_no_class_options(
    options: classroom.ClassOptions, run_options: classroom.RunOptions
) -> None:
    """Raise an InputError that names the options that apply only to a folder of submissions."""
    class_options = {
        "--roster": options.roster,
        "--received": options.received,
        "--file-times": options.file_times,
        "--before": options.before,
        "--moodle": options.moodle,
        "--adjustments": options.adjustments,
        "--explain-hidden": options.explain_hidden,
        "--anonymous": run_options.anonymous,
        "--only": run_options.only,
        "--since": run_options.since,
        "--regrade": run_options.regrade,
        "--jobs": run_options.jobs,
        "--cluster": run_options.cluster,
    }
    names = [name for name, value in class_options.items() if value]
    if names:
        raise InputError(
            f"{', '.join(names)}: for a folder of submissions, but {options.submissions} is a file; "
            "pass the folder, or leave these options out"
        )


def _grade_file(options: classroom.ClassOptions, conditions: "GradingOptions") -> "Result":
    """Grade a single submission, and print its feedback."""
    from hdrlab.course.reports import feedback

    assignment = assignments.find_homework(options.submissions, options.homework, options.plan)
    result = assignments.grade_submission(options.submissions, assignment, conditions)
    click.echo(feedback.text(result, private=True))
    if not result.for_credit:
        common.echo_notes([f"for practice. {result.why_practice}"])
    return result


def _write_results(out: Path, result: "Result", key: "SigningKey | None") -> None:
    """Write all result files of a single submission, and print the path of the feedback page.

    With a key, the files contain a signed receipt.
    """
    from hdrlab.course.reports import gradebook

    receipt = ""
    if key is not None:
        from hdrlab.course.reports import receipts

        receipt = receipts.sign(result, [result.student], key)
    gradebook.write_results(out, result, receipt=receipt)
    click.echo(out / "feedback.html")


@click.command(cls=common.Command)
@click.argument("results", type=common.EXISTING_FOLDER)
@click.option(
    "--homework",
    metavar="NAME",
    help="Assignment, such as hw2.  [default: the one that was graded]",
)
@common.choice_option(
    "--policy",
    ["replace", "never-lower", "only-listed"],
    help="Rule for which new results to use, see above.",
)
@click.option(
    "--only",
    metavar="WHO",
    multiple=True,
    help="Student or team for --policy only-listed. Repeatable.",
)
@click.option(
    "--requests",
    type=common.EXISTING_FILE,
    multiple=True,
    help="Students' requests: a CSV file with the columns student, task and words. Repeatable.",
)
@click.option("--why", default="", show_default=False, help="Reason, for the log.")
@jobs_option
@click.option(
    "--cluster", metavar="ADDRESS", help="Address of a Dask cluster, such as tcp://HOST:8786."
)
@click.option(
    "--apply",
    "is_applied",
    is_flag=True,
    help="Apply the changes, and record them in the signed log.",
)
def regrade(
    *,
    results: Path,
    homework: str | None,
    policy: str,
    only: tuple[str, ...],
    requests: tuple[Path, ...],
    why: str,
    jobs: int | None,
    cluster: str | None,
    is_applied: bool,
) -> None:
    """Grade a class again with corrected checks.

    RESULTS is the folder that `hdrlab grade` wrote for the class. hdrlab shows which scores change
    and why. Without --apply, it does not change the results in the folder.

    --policy replace uses all new results. never-lower keeps the old result if the score would drop.
    only-listed uses the new results of students and teams named with --only or in --requests.
    """
    from hdrlab.course.classroom import jobs as grading_jobs, regrade as regrading, run
    from hdrlab.course.scratch import temporary_folder

    run_options = classroom.RunOptions(out=results, jobs=jobs, cluster=cluster)
    graded_class = classroom.load_graded_class(results, run_options, homework)
    course = graded_class.course
    all_jobs = graded_class.jobs
    requested = regrading.read_requests(requests, course.roster)
    listed = {course.roster.find_team(name) for name in only} | set(requested)
    with temporary_folder(), grading_jobs.lock_folder(results):
        _, changed = grading_jobs.split_finished(results / "results", all_jobs)
        # results that do not count yet get no receipt
        unsigned_class = replace(graded_class, receipt_key=None)
        new_results = classroom.run_jobs(unsigned_class, changed, results / "regrade")
        common.echo_warnings(classroom.describe_failures(new_results))
        changes = regrading.find_score_changes(
            results, all_jobs, policy=policy, listed=listed, requests=requested
        )
        click.echo(regrading.changes_text(changes))
        max_score = course.homework.points
        click.echo(regrading.write_changes_page(results, changes, max_score, policy))
        if is_applied:
            now = datetime.now(UTC).isoformat(timespec="seconds")
            secret = course.conditions.secret
            notes = regrading.apply_changes(
                results, changes, all_jobs, secret, policy=policy, why=why, when=now
            )
            common.echo_warnings(notes)
            for result in grading_jobs.split_finished(results / "results", all_jobs)[0]:
                run.write_feedback(
                    results,
                    result,
                    explain_hidden=graded_class.options.explain_hidden,
                    sign=graded_class.receipt_signer(),
                )
            page, _ = classroom.write_books(graded_class)
            click.echo(page)


@click.command(cls=common.Command)
@click.argument("receipts", metavar="RECEIPT", type=common.EXISTING_FILE)
@click.option(
    "--key",
    required=True,
    type=common.EXISTING_FILE,
    help="Public key of the course, a file that its instructor has published.",
)
@click.option(
    "--submission",
    type=common.EXISTING_FILE,
    help="Submitted file, to verify that the receipt is for this file.",
)
def receipt(*, receipts: Path, key: Path, submission: Path | None) -> None:
    """Verify the RECEIPT for the points of a submission.

    RECEIPT is the file receipt.txt of a student, or receipts.txt of a class. hdrlab verifies
    that the owner of the key signed each line, and that no byte was changed since. This needs
    neither the network nor the secret of the course.
    """
    common.require_modules("class", ["cryptography"])
    from hdrlab.course.reports import receipts as receipt_lines

    contents = receipt_lines.verify_file(receipts, receipt_lines.read_public_key(key))
    if submission is not None:
        receipt_lines.verify_submission(contents, submission)
    for content in contents:
        students = ", ".join(content["students"])
        click.echo(
            f"valid: {content['homework']}, {students}: "
            f"{content['points']:g} of {content['of']:g} points"
        )
    if submission is not None:
        click.echo(f"valid: {submission.name} is the submission of this receipt")


@click.command(cls=common.Command)
def doctor() -> None:
    """Report which sandbox tiers this machine can run.

    For the other tiers, hdrlab says what is missing.
    """
    from hdrlab.course.grading import doctor as sandbox_doctor

    for report in sandbox_doctor.examine_tiers():
        works = "yes" if report.works else "no"
        worth = "for credit" if report.credit else "practice"
        click.echo(f"{report.tier:<10}{works:<5}{worth:<12}{report.details}")
        if report.remedy:
            click.echo(f"{'':<10}{report.remedy}")
