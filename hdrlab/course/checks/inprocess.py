"""The specification run in this very process, on code to trust: the library, wrong files, other ways."""

import inspect
import runpy
from copy import deepcopy
from importlib import import_module
from pathlib import Path

from hdrlab.course import plan
from hdrlab.course.checks.compare import plain

HERE = Path(__file__).parent


class Subject:
    """What a check asks: each attribute is a task's function, whose answers come as plain arrays.

    `calls` remembers them: arguments, named arguments, and the answer, None where an error was raised.
    """

    def __init__(self, functions):
        self._functions, self.calls = functions, []

    def __getattr__(self, task):
        if task.startswith("_") or task not in self._functions:
            raise AttributeError(f"no function for the task {task}")

        def ask(*given, **named):
            answer = None
            try:
                answer = plain(self._functions[task](*given, **named))
            finally:
                self.calls.append((deepcopy(given), deepcopy(named), answer))
            return answer

        return ask


def library():
    """Return the Subject whose functions are the library's own."""
    tasks = [task for homework in plan.read().homeworks.values() for task in homework.tasks]
    return Subject({task.id: plan.function(task) for task in tasks})


def functions(path):
    """Return the functions of a file by their names."""
    return {name: one for name, one in runpy.run_path(str(path)).items() if inspect.isfunction(one)}


def checks(task):
    """Return the checks of a task: (name, function, points, hints)."""
    module = import_module(f"hdrlab.course.checks.specification.test_{task}")
    found = []
    for name, check in vars(module).items():
        if name.startswith("test_"):
            marks = {mark.name: mark.args for mark in check.pytestmark}
            found.append((name, check, marks["points"][0], marks["hints"]))
    return found


def score(task, subject, seed=0):
    """Return what share of a task's points a subject gets, and what each check says: None where it holds."""
    total, got, said = 0.0, 0.0, {}
    for name, check, points, _ in checks(task):
        wanted = inspect.signature(check).parameters
        given = {"subject": subject, "rng": plan.generator(seed)}
        try:
            check(**{one: given[one] for one in wanted})
        except Exception as error:  # whatever a student's code raises costs that promise, and no other
            said[name] = error
        else:
            got, said[name] = got + points, None
        total += points
    return got / total, said
