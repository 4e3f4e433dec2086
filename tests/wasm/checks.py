"""Run in Pyodide: the checks of answers; for each answer, print a line of JSON with the outcomes.

ARGUMENTS holds the seconds after which no other answer begins, and a file of answers: a list of
[task, text of the function]. `outcomes` is also what the test calls on this machine.
"""

import json
import sys
import time
from pathlib import Path

from hdrlab.core.steps import last
from hdrlab.course import plan
from hdrlab.course.grading import grader
from hdrlab.course.plan import GradingOptions
from hdrlab.course.source_code import closure, names
from hdrlab.course.submissions import reader


def outcomes(id: str, text: str) -> list[list[str]]:
    """Return what each check of a task says about a function, and the recognized mistake."""
    homeworks = plan.read().homeworks.values()
    homework = next(
        candidate for candidate in homeworks if id in [task.id for task in candidate.tasks]
    )
    task = next(task for task in homework.tasks if task.id == id)
    sources, problems = closure.extract_sources([closure.Cell(text)], [id])
    modules = tuple(names.imported_numpy_modules(sources.values()))
    code = reader.SubmittedCode(sources, tuple(problems), "", modules)
    # the machine of a test may be busy
    options = GradingOptions(tier="in-process", draw=False, timeout=60.0)
    result = last(grader.check_steps(code, homework._replace(tasks=(task,)), options))
    rows = [
        [check.name, check.outcome, check.kind, str(check.points), check.message]
        for check in result.checks
    ]
    return [*rows, ["mistake", result.misconceptions.get(id, "")]]


def main(seconds: str, path: str) -> None:
    """Check the answers of a file, and print the outcomes."""
    deadline = time.monotonic() + float(seconds)
    for number, (id, text) in enumerate(json.loads(Path(path).read_text("utf8"))):
        if time.monotonic() > deadline:
            return
        started = time.monotonic()
        rows = outcomes(id, text)
        line = {"number": number, "rows": rows, "seconds": round(time.monotonic() - started, 1)}
        print("RESULT " + json.dumps(line), flush=True)


if sys.platform == "emscripten":
    main(*ARGUMENTS)  # noqa: F821
