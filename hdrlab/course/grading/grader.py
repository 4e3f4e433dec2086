"""Checking a submission: its tasks are read, the specification is run on them, and a Result comes of it.

The specification runs under pytest in a process of its own, which the student's code never enters:
that one answers from a sandbox (`subject`). How far it is kept apart is said in the Result, by the
tier's name.
"""

import base64
import hashlib
import json
import os
import platform
import tempfile
from collections.abc import Iterator, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import scipy

import hdrlab
from hdrlab.core.steps import last
from hdrlab.course import plan
from hdrlab.course.checks import SPECIFICATION, running
from hdrlab.course.grading import scoring
from hdrlab.course.grading.results import Check, Drawing, Result
from hdrlab.course.plan import GradingOptions, Homework
from hdrlab.course.sandbox import tiers
from hdrlab.course.sandbox.running import Unavailable
from hdrlab.course.sanitize import sanitize_text
from hdrlab.course.submissions import reader
from hdrlab.course.submissions.reader import SubmittedCode
from hdrlab.course.variants import rewording
from hdrlab.errors import InputError

# for all checks of an assignment; the calls of a submission have 200 s, see `checks.subject`
ALL_CHECKS_TIMEOUT_SECONDS = 240.0
MESSAGE, SAID = 2000, 4000  # characters of what is told of a check
STRICT = GradingOptions()
VERSIONS = {one.__name__: one.__version__ for one in (hdrlab, np, scipy)}
VERSIONS["python"] = platform.python_version()
SILENT = {"outcome": "no answer", "message": "This check was not answered", "said": ""}


def grade(path: str | Path, homework: Homework, conditions: GradingOptions = STRICT) -> Result:
    """Return what a notebook or a Python file is worth: the last of `grade_steps`.

    Raises
    ------
    Unavailable
        For a tier that this machine cannot give.
    ValueError
        For a homework without checks, or a hidden folder that is none.
    """
    return last(grade_steps(path, homework, conditions))


def grade_steps(
    path: str | Path, homework: Homework, conditions: GradingOptions = STRICT
) -> Iterator[Result]:
    """Yield the Result as it grows: first with all checks unanswered, then after each."""
    yield from check_steps(*read_tasks(path, homework, conditions), conditions)


def read_tasks(
    path: str | Path, homework: Homework, conditions: GradingOptions
) -> tuple[SubmittedCode, Homework]:
    """Return what a file holds of a homework's tasks, and the homework as its student was given it."""
    tasks = [task.id for task in homework.tasks]
    read = reader.read(Path(path), homework.name, tasks, reader.given_cells(homework.name))
    homework = plan.draw_variants(homework, conditions.student, conditions.secret, read.variants)
    if others := ", ".join(plan.tasks_of_other_variants(homework, read.variants)):
        said = f"The sheet is of another variant than yours, which is what the checks ask: {others}"
        read = read._replace(problems=(*read.problems, said))
    return read, homework


def check_steps(
    read: SubmittedCode, homework: Homework, conditions: GradingOptions
) -> Iterator[Result]:
    """Yield the Result of tasks that are read already, as it grows."""
    heard: list[dict[str, Any]] = []
    for line in heard_steps(read, homework, conditions):
        heard.append(line | {"drawing": _drawn(line)} if line.get("differs") else line)
        if "ended" in line:
            yield _result(heard, read, homework, conditions)
    yield _result(heard, read, homework, conditions)


def heard_steps(
    read: SubmittedCode, homework: Homework, conditions: GradingOptions, **more: Any
) -> Iterator[Any]:
    """Yield what the checks write down as they run, and first their digest; `more` stands in the job."""
    if conditions.hidden is not None and not conditions.hidden.is_dir():
        raise InputError(f"expected a folder with hidden checks, got {conditions.hidden}")
    tiers.choose(conditions.tier)  # an error where it cannot be had: no other takes its place
    with tempfile.TemporaryDirectory(prefix="hdrlab-checks-") as name:
        folder = Path(name)
        files = _reworded(files_of(homework, conditions.hidden), homework, folder)
        yield {"specification": specification(files)}
        job = _job(folder, read, homework, conditions, **more)
        for line in running.run(folder, job, files, ALL_CHECKS_TIMEOUT_SECONDS):
            if "unavailable" in line:
                raise Unavailable(line["unavailable"])
            yield line


def files_of(homework: Homework, hidden: Path | None) -> list[Path]:
    """Return the files with the checks of a homework, in its order, the hidden ones after each task's own."""
    homes = [SPECIFICATION if task.own is None else task.own.parent for task in homework.tasks]
    files = [
        folder / f"test_{task.id}.py"
        for task, home in zip(homework.tasks, homes, strict=True)
        for folder in (home, *([] if hidden is None else [hidden.resolve()]))
    ]
    if present := [file for file in files if file.is_file()]:
        return present
    raise InputError(f"expected checks for {homework.name} in {homes[0]}, got none")


def _reworded(files: Sequence[Path], homework: Homework, folder: Path) -> list[Path]:
    """Return the files with the checks; those of variants are written into a folder."""
    named, asked = {f"test_{task.id}.py": task for task in homework.tasks if task.variant}, []
    for file in files:
        task = named.get(file.name) if file.parent == SPECIFICATION else None
        asked.append(folder / file.name if task else file)
        if task:
            text = rewording.reword(task.id, task.variant, file.read_text(encoding="utf8"))
            asked[-1].write_text(text, encoding="utf8")
    return asked


def _job(
    folder: Path, read: SubmittedCode, homework: Homework, conditions: GradingOptions, **more: Any
) -> Path:
    job = {
        "sources": read.sources,
        "modules": read.modules,
        "tier": conditions.tier,
        "seeds": _seeds(homework, conditions),
        "timeout": conditions.timeout,
        "draw": conditions.draw,
        "hidden": "" if conditions.hidden is None else str(conditions.hidden.resolve()),
        "tasks": homework.tasks,
        "out": str(folder / "lines"),
        "grader": os.getpid(),
        "by": "hdrlab.course.checks.plugin:GradingPlugin",
    }
    (folder / "lines").touch()
    file = folder / "job.json"
    file.write_text(json.dumps(job | more), encoding="utf8")
    return file


def _seeds(homework: Homework, conditions: GradingOptions) -> dict[str, str]:
    """Return each task's seed, as text: it has more bits than JSON's numbers."""
    student = conditions.student
    secret = conditions.secret
    return {
        one.id: str(plan.seed(secret, student, one.id) if student else 0) for one in homework.tasks
    }


def _seed_id(homework: Homework, conditions: GradingOptions) -> str:
    """Return a digest of the seeds, or "" where anybody could draw the same inputs."""
    if not (conditions.student and conditions.secret):
        return ""
    return hashlib.sha256(json.dumps(_seeds(homework, conditions)).encode()).hexdigest()[:16]


def _result(
    heard: Sequence[Any], read: SubmittedCode, homework: Homework, conditions: GradingOptions
) -> Result:
    return Result(
        student=conditions.student,
        homework=homework.name,
        title=homework.title,
        tier=conditions.tier,
        checks=tuple(_checks(heard, homework)),
        misconceptions={
            line["recognised"]: line["sentence"] for line in heard if "recognised" in line
        },
        problems=read.problems,
        submission=read.hash,
        specification=heard[0]["specification"],
        seed=_seed_id(homework, conditions),
        versions=VERSIONS,
        at_most=homework.at_most,
    )


def _drawn(line: dict[str, Any]) -> Drawing:
    """Return the pictures of a difference whose arrays came as text.

    They are drawn here and not beside the checks: a notebook has matplotlib at hand, which takes
    its time.
    """
    from hdrlab.show.plots import differences

    differs, task = (
        line["differs"],
        Path(line["ended"].partition("::")[0]).stem.removeprefix("test_"),
    )
    both = [np.frombuffer(base64.b64decode(differs[name]), "<f8") for name in ("expected", "came")]
    draw = differences.image if differs["kind"] == "image" else differences.curve
    try:
        return Drawing(*draw(*(one.reshape(differs["shape"]) for one in both), what=task)[:3])
    except ValueError:  # neither an image nor a curve after all
        return Drawing()


def specification(files: Sequence[Path]) -> str:
    """Return a digest of the checks."""
    digest = hashlib.sha256()
    for file in files:
        digest.update(file.name.encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()


def _checks(heard: Sequence[dict[str, Any]], homework: Homework) -> Iterator[Check]:
    """Yield each promise: it holds where it holds for all of its cases."""
    cases: dict[tuple[str, str, bool], list[dict[str, Any]]] = {}
    for line in heard:
        if "check" in line:
            cases.setdefault((line["task"], line["name"], line["hidden"]), []).append(line)
    ended = {
        line["ended"]: line for line in heard if "ended" in line and line["outcome"] == "holds"
    }
    ended |= {
        line["ended"]: line for line in heard if "ended" in line and line["outcome"] != "holds"
    }
    named = {line["recognised"]: line for line in heard if "recognised" in line}
    for task in homework.tasks:
        own = [each for key, each in cases.items() if key[0] == task.id]
        weights = [Fraction(each[0]["points"]) for each in own]
        shares = scoring.split_points(Fraction(str(task.points)), weights) if own else []
        checks = [_check(each, ended, whole) for each, whole in zip(own, shares, strict=True)]
        needs = {each[0]["name"]: each[0]["needs"] for each in own}
        once = named.get(task.id, {}).get("once", False)
        yield from scoring.attribute_failures(checks, needs, named=task.id in named, once=once)


def _check(
    each: Sequence[dict[str, Any]], ended: dict[str, dict[str, Any]], whole: Fraction
) -> Check:
    """Return a promise with the first of its cases that does not hold."""
    endings = [ended.get(one["check"], SILENT) for one in each]
    shown = next((one for one in endings if one["outcome"] != "holds"), endings[0])
    return Check(
        task=each[0]["task"],
        name=each[0]["name"],
        promise=each[0]["promise"],
        points=Fraction(),
        max_points=whole,
        outcome=shown["outcome"],
        message=sanitize_text(shown["message"], MESSAGE),
        hints=tuple(each[0]["hints"]),
        drawing=shown.get("drawing", Drawing()),
        said=sanitize_text(shown["said"], SAID),
        hidden=each[0]["hidden"],
        kind=shown.get("kind", ""),
    )
