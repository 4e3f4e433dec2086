"""Grade one submission: read the code of its tasks, run the checks on it, and return a Result.

The checks run under pytest in a process of their own, which never runs the student's code: that
runs in a sandbox (`checks.subject`). The Result names the tier of the sandbox.
"""

import base64
import contextlib
import hashlib
import json
import os
import platform
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

import hdrlab
from hdrlab.core.arrays import F64
from hdrlab.core.steps import last
from hdrlab.course import plan
from hdrlab.course.checks import SPECIFICATION
from hdrlab.course.checks.pytest_process import run_pytest, run_pytest_here
from hdrlab.course.grading import scoring
from hdrlab.course.grading.results import Check, Counterexample, Drawing, Result
from hdrlab.course.plan import GradingOptions, Homework, Task
from hdrlab.course.sandbox import in_process, tiers
from hdrlab.course.sandbox.session import Unavailable
from hdrlab.course.sanitize import sanitize_text
from hdrlab.course.submissions import reader
from hdrlab.course.submissions.reader import SubmittedCode
from hdrlab.course.variants import rewording
from hdrlab.errors import InputError

# for all checks of a homework: 40 s more than the calls of the student's functions may take by
# default (20 times 10 s, see `checks.subject`)
ALL_CHECKS_TIMEOUT_SECONDS = 240.0
MAX_MESSAGE_LENGTH = 2000
MAX_PRINTED_LENGTH = 4000
FOR_CREDIT = GradingOptions()
VERSIONS = {
    "hdrlab": hdrlab.__version__,
    "numpy": np.__version__,
    "python": platform.python_version(),
}
# SciPy takes long to import, and a page in a browser loads it only for the tasks that need it
with contextlib.suppress(metadata.PackageNotFoundError):
    VERSIONS["scipy"] = metadata.version("scipy")
NO_ANSWER = {"outcome": "no answer", "message": "This check was not answered", "printed": ""}

# What the checks write down, one after another: a dictionary for each check and for each end of one.
Event = dict[str, Any]


def grade(path: str | Path, homework: Homework, options: GradingOptions = FOR_CREDIT) -> Result:
    """Return the result of a notebook or a Python file: the last of `grade_steps`.

    Raises
    ------
    Unavailable
        If this machine cannot run the requested sandbox tier.
    InputError
        If the homework has no checks, or the folder of hidden checks does not exist.
    """
    return last(grade_steps(path, homework, options))


def grade_steps(
    path: str | Path, homework: Homework, options: GradingOptions = FOR_CREDIT
) -> Iterator[Result]:
    """Yield the Result after each check; at first, no check is answered."""
    code, homework = read_tasks(path, homework, options)
    yield from check_steps(code, homework, options)


def read_tasks(
    path: str | Path, homework: Homework, options: GradingOptions
) -> tuple[SubmittedCode, Homework]:
    """Return the code of a submission, and the homework with the variants that its student is asked."""
    tasks = [task.id for task in homework.tasks]
    code = reader.read(Path(path), homework.name, tasks, reader.given_cells(homework.name))
    homework = plan.draw_variants(homework, options.student, options.secret, code.variants)
    others = plan.tasks_of_other_variants(homework, code.variants)
    if others:
        problem = (
            "This is the assignment of another student: the checks expect your variant of "
            + ", ".join(others)
        )
        code = replace(code, problems=(*code.problems, problem))
    return code, homework


def check_steps(
    code: SubmittedCode, homework: Homework, options: GradingOptions
) -> Iterator[Result]:
    """Yield the Result of code that is already read, after each check."""
    events: list[Event] = []
    for event in iter_events(code, homework, options):
        if event.get("differs"):
            event = event | {"drawing": _draw_difference(event)}
        events.append(event)
        if "ended" in event:
            yield _result(events, code, homework, options)
    yield _result(events, code, homework, options)


def iter_events(
    code: SubmittedCode, homework: Homework, options: GradingOptions, **more: Any
) -> Iterator[Event]:
    """Run the checks, and yield their events as they come; the first has the digest of the checks.

    `more` is added to the job that the checks read, as `viva` does.
    """
    if options.hidden is not None and not options.hidden.is_dir():
        raise InputError(f"expected a folder with hidden checks, got {options.hidden}")
    tiers.choose(options.tier)  # raises Unavailable: no other tier replaces it
    with tempfile.TemporaryDirectory(prefix="hdrlab-checks-") as name:
        folder = Path(name)
        files = _apply_variants(files_of(homework, options.hidden), homework, folder)
        yield {"specification": specification(files)}
        job = _write_job(folder, code, homework, options, **more)
        if options.tier == in_process.TIER:
            lines = run_pytest_here(folder, job, files)
        else:
            lines = run_pytest(folder, job, files, timeout=ALL_CHECKS_TIMEOUT_SECONDS)
        for event in lines:
            if "unavailable" in event:
                raise Unavailable(event["unavailable"])
            yield event


def files_of(homework: Homework, hidden: Path | None) -> list[Path]:
    """Return the files with the checks of a homework: of each task the public and the hidden ones."""
    files = []
    for task in homework.tasks:
        name = f"test_{task.id}.py"
        files.append(_folder_of_checks(task) / name)
        if hidden is not None:
            files.append(hidden.resolve() / name)
    present = [path for path in files if path.is_file()]
    if not present:
        folder = _folder_of_checks(homework.tasks[0])
        raise InputError(f"expected checks for {homework.name} in {folder}, got none")
    return present


def _folder_of_checks(task: Task) -> Path:
    """Return the folder of a task's checks: hdrlab's, or the one of the instructor's own task."""
    return SPECIFICATION if task.own is None else task.own.parent


def _apply_variants(files: Sequence[Path], homework: Homework, folder: Path) -> list[Path]:
    """Return the files with the checks; those of tasks with a variant are written into a folder."""
    with_variant = {f"test_{task.id}.py": task for task in homework.tasks if task.variant}
    applied = []
    for path in files:
        task = with_variant.get(path.name)
        if task is None or path.parent != SPECIFICATION:
            applied.append(path)
            continue
        text = rewording.reword(task.id, task.variant, path.read_text(encoding="utf8"))
        copy = folder / path.name
        copy.write_text(text, encoding="utf8")
        applied.append(copy)
    return applied


def _write_job(
    folder: Path, code: SubmittedCode, homework: Homework, options: GradingOptions, **more: Any
) -> Path:
    """Write the job that the process with the checks reads, and return its file."""
    events = folder / "lines"
    events.touch()
    job = {
        "sources": code.sources,
        "modules": code.modules,
        "tier": options.tier,
        "seeds": _seeds(homework, options),
        "timeout": options.timeout,
        "draw": options.draw,
        "hidden": "" if options.hidden is None else str(options.hidden.resolve()),
        "tasks": homework.tasks,
        "out": str(events),
        "grader": os.getpid(),
        "by": "hdrlab.course.checks.plugin:GradingPlugin",
    }
    path = folder / "job.json"
    path.write_text(json.dumps(job | more), encoding="utf8")
    return path


def _seeds(homework: Homework, options: GradingOptions) -> dict[str, str]:
    """Return each task's seed as text, because it has more bits than a number in JSON."""
    seeds = {}
    for task in homework.tasks:
        seed = 0
        if options.student:
            seed = plan.seed(options.secret, options.student, task.id)
        seeds[task.id] = str(seed)
    return seeds


def _seed_id(homework: Homework, options: GradingOptions) -> str:
    """Return a digest of the seeds, or "" if anybody could draw the same inputs."""
    if not (options.student and options.secret):
        return ""
    return hashlib.sha256(json.dumps(_seeds(homework, options)).encode()).hexdigest()[:16]


def specification(files: Sequence[Path]) -> str:
    """Return a digest of the checks."""
    digest = hashlib.sha256()
    for path in files:
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def _result(
    events: Sequence[Event], code: SubmittedCode, homework: Homework, options: GradingOptions
) -> Result:
    """Return the Result of the events that have come so far."""
    mistakes = {event["recognised"]: event["sentence"] for event in events if "recognised" in event}
    return Result(
        student=options.student,
        homework=homework.name,
        title=homework.title,
        tier=options.tier,
        checks=tuple(_checks(events, homework)),
        misconceptions=mistakes,
        problems=code.problems,
        submission=code.hash,
        specification=events[0]["specification"],
        seed=_seed_id(homework, options),
        versions=VERSIONS,
        at_most=homework.at_most,
    )


def _draw_difference(event: Event) -> Drawing:
    """Return the pictures of a difference between an expected and a returned array.

    They are drawn here, not in the process of the checks, because importing matplotlib takes time
    and a notebook has it already.
    """
    from hdrlab.show.plots import differences

    difference = event["differs"]
    task = Path(event["ended"].partition("::")[0]).stem.removeprefix("test_")
    draw = differences.image if difference["kind"] == "image" else differences.curve
    expected = _decode_array(difference["expected"], difference["shape"])
    returned = _decode_array(difference["answer"], difference["shape"])
    try:
        drawn = draw(expected, returned, what=task)
    except ValueError:  # a student's values may be such that matplotlib cannot draw them
        return Drawing()
    return Drawing(*drawn[:3])


def _decode_array(text: str, shape: Sequence[int]) -> F64:
    """Return the array that a text encodes."""
    return np.frombuffer(base64.b64decode(text), "<f8").reshape(shape)


def _checks(events: Sequence[Event], homework: Homework) -> Iterator[Check]:
    """Yield the checks of all tasks with their points. A check holds if all of its cases hold."""
    cases: dict[tuple[str, str, bool], list[Event]] = {}
    for event in events:
        if "check" in event:
            cases.setdefault((event["task"], event["name"], event["hidden"]), []).append(event)
    ends = _ends(events)
    examples = {
        event["counterexample"]: shown_counterexample(event)
        for event in events
        if "counterexample" in event
    }
    mistakes = {event["recognised"]: event for event in events if "recognised" in event}
    for task in homework.tasks:
        of_task = [events for (id, _, _), events in cases.items() if id == task.id]
        if not of_task:
            continue
        weights = [Fraction(first["points"]) for first, *_ in of_task]
        points = scoring.split_points(Fraction(str(task.points)), weights)
        checks = [
            _check(of_check, ends, examples, max_points)
            for of_check, max_points in zip(of_task, points, strict=True)
        ]
        checks = _without_repeated_counterexamples(checks)
        needs = {first["name"]: first["needs"] for first, *_ in of_task}
        yield from scoring.attribute_failures(
            checks,
            needs,
            named=task.id in mistakes and mistakes[task.id]["explains_all"],
            once=mistakes.get(task.id, {}).get("once", False),
        )


def _without_repeated_counterexamples(checks: Sequence[Check]) -> list[Check]:
    """Return the checks of a task. Only the first of those with the same counterexample keeps it."""
    shown: set[str] = set()
    unrepeated = []
    for check in checks:
        if check.counterexample and check.counterexample.code in shown:
            unrepeated.append(replace(check, counterexample=None))
        else:
            unrepeated.append(check)
        if check.counterexample:
            shown.add(check.counterexample.code)
    return unrepeated


def _ends(events: Sequence[Event]) -> dict[str, Event]:
    """Return how each case ended; a case that ended twice, holding once, does not hold."""
    ends: dict[str, Event] = {}
    for event in events:
        if "ended" not in event:
            continue
        before = ends.get(event["ended"])
        if before is None or before["outcome"] == "holds" or event["outcome"] != "holds":
            ends[event["ended"]] = event
    return ends


def shown_counterexample(event: Mapping[str, Any]) -> Counterexample:
    """Return the counterexample of an event, with text that a page can show."""
    return Counterexample(
        code=sanitize_text("\n".join([*event["inputs"], event["call"]]), MAX_MESSAGE_LENGTH),
        yours=sanitize_text(event["yours"], MAX_MESSAGE_LENGTH),
        correct=sanitize_text(event["correct"], MAX_MESSAGE_LENGTH),
    )


def _check(
    cases: Sequence[Event],
    ends: dict[str, Event],
    examples: dict[str, Counterexample],
    max_points: Fraction,
) -> Check:
    """Return a check with the end of its first case that does not hold; its points come later."""
    ends_of_cases = [ends.get(case["check"], NO_ANSWER) for case in cases]
    examples_of_cases = [examples[case["check"]] for case in cases if case["check"] in examples]
    failures = [end for end in ends_of_cases if end["outcome"] != "holds"]
    shown = failures[0] if failures else ends_of_cases[0]
    case = cases[0]
    return Check(
        task=case["task"],
        name=case["name"],
        promise=case["promise"],
        points=Fraction(),
        max_points=max_points,
        outcome=shown["outcome"],
        message=sanitize_text(shown["message"], MAX_MESSAGE_LENGTH),
        hints=tuple(case["hints"]),
        drawing=shown.get("drawing", Drawing()),
        printed=sanitize_text(shown["printed"], MAX_PRINTED_LENGTH),
        hidden=case["hidden"],
        kind=shown.get("kind", ""),
        counterexample=examples_of_cases[0] if examples_of_cases else None,
    )
