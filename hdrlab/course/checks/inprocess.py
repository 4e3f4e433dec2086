"""Call trusted functions in this process, such as the library's, as checks call those of students."""

from copy import deepcopy

from hdrlab.course import plan
from hdrlab.course.checks.compare import plain


class Subject:
    """The functions that a check calls: each attribute is a task's function, whose answers are plain arrays.

    `calls` lists the calls: arguments, keyword arguments, and the answer, or None if the function
    raised an exception.
    """

    def __init__(self, functions):
        self._functions = functions
        self.calls = []

    def __getattr__(self, task):
        if task.startswith("_") or task not in self._functions:
            raise AttributeError(f"no function for the task {task}")

        def function(*args, **kwargs):
            answer = None
            try:
                answer = plain(self._functions[task](*args, **kwargs))
            finally:
                self.calls.append((deepcopy(args), deepcopy(kwargs), answer))
            return answer

        return function


def library(own=None):
    """Return the Subject whose functions are the library's, or the solutions of a plan of one's own."""
    tasks = [
        task for homework in (own or plan.read()).homeworks.values() for task in homework.tasks
    ]
    return Subject({task.id: plan.function(task) for task in tasks})
