"""What the specification asks when it runs in this very process: code to trust, such as the library's own."""

from copy import deepcopy

from hdrlab.course import plan
from hdrlab.course.checks.compare import plain


class Subject:
    """What a check asks: each attribute is a task's function, whose answers come as plain arrays.

    `calls` remembers them: arguments, named arguments, and the answer, None where an error was
    raised.
    """

    def __init__(self, functions):
        self._functions = functions
        self.calls = []

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


def library(own=None):
    """Return the Subject whose functions are the library's, or the solutions of a plan of one's own."""
    tasks = [
        task for homework in (own or plan.read()).homeworks.values() for task in homework.tasks
    ]
    return Subject({task.id: plan.function(task) for task in tasks})
