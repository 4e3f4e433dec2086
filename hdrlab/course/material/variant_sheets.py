"""A sheet for each team: handouts of which the parameters are drawn by the course's secret."""

from collections.abc import Iterable, Iterator
from itertools import product
from pathlib import Path

from hdrlab.course import variants
from hdrlab.course.material import handouts
from hdrlab.course.plan import Plan


def build_steps(
    plan: Plan, sources: Path, teams: Iterable[str], secret: str, assignments: Path, solutions: Path | None
) -> Iterator[Path]:
    """Write the homeworks of which parameters vary for each team, in folders of their names; yield each file.

    Parameters
    ----------
    plan, sources, assignments, solutions : as `handouts.build_steps` takes them; solutions are not run
    teams : who work together, and get one sheet
    secret : the course's, which draws the variants

    Raises
    ------
    ValueError
        Where no task of the plan has parameters, and for a source that does not ask what a variant rewords.
    """
    varied = [one for one in plan.homeworks.values() if any(task.parameters for task in one.tasks)]
    if not varied:
        raise ValueError("expected a plan that gives parameters to a task, got one that asks all the same")
    for team, homework in product(teams, varied):
        made = handouts.made_of(plan, variants.draw(homework, team, secret), sources)
        for folder, sheet in ((assignments, made.assignment), (solutions, made.solution)):
            if folder is not None:
                file = folder / team / f"{homework.name}.ipynb"
                yield handouts.write_text(file, handouts.to_text(sheet))
