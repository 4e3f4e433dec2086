"""Which variant of a task a student is asked: the course's secret draws it, and her sheet says it.

Whoever has no secret believes the sheet, as a student does who checks her own work.
"""

from collections.abc import Mapping

from hdrlab.course.checks import rewording
from hdrlab.course.plan import Homework, Task, seed


def draw(
    homework: Homework, student: str, secret: str, said: Mapping[str, str] | None = None
) -> Homework:
    """Return a homework with the variants that a student's sheet asks.

    Where there is a secret, it draws the parameters that the plan names. Else the sheet is believed
    in what it has `said`, by task.
    """

    def asked(task: Task) -> str:
        if not (student and secret):
            variant = (said or {}).get(task.id, "")
            return variant if variant in rewording.every(task.id) else ""
        drawn = {name: seed(secret, student, f"{task.id} {name}") for name in task.parameters}
        known = rewording.parameters(task.id).items() if drawn else ()
        return "/".join([*values][drawn.get(name, 0) % len(values)] for name, values in known)

    return homework._replace(
        tasks=tuple(one._replace(variant=asked(one)) for one in homework.tasks)
    )


def others(homework: Homework, said: Mapping[str, str] | None) -> list[str]:
    """Return the tasks of which a sheet asks another variant; where it has `said` nothing, none."""
    return [
        task.id
        for task in homework.tasks
        if said is not None and said.get(task.id, "") != task.variant
    ]
