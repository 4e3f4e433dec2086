"""Three hundred students get a sheet of their own of each homework in which tasks have parameters."""

import time
from pathlib import Path
from typing import Any

from benchmarks.measure import ROOT
from hdrlab.course import plan
from hdrlab.course.authoring import solutions
from hdrlab.course.submissions import reader
from hdrlab.course.variants import rewording

SECRET = "sheets of a class"
COUNT = 300
MINUTES = 3


def varied() -> plan.Plan:
    """Return hdrlab's own plan with all the parameters that there are."""
    read = plan.read()
    homeworks = {
        name: homework._replace(
            tasks=tuple(
                task._replace(parameters=(*rewording.parameters(task.id),))
                for task in homework.tasks
            )
        )
        for name, homework in read.homeworks.items()
    }
    return read._replace(homeworks=homeworks)


def build(folder: Path, count: int = COUNT) -> dict[str, Any]:
    """Return how long the sheets of a class take, and whether each asks what its student is graded by."""
    homeworks = varied()
    teams = [f"s{number:03d}" for number in range(count)]
    clock = time.perf_counter()
    processor = time.process_time()
    files = [
        *solutions.build_for_teams_steps(
            homeworks, ROOT / "solutions", teams, SECRET, folder / "sheets", None
        )
    ]
    clock = time.perf_counter() - clock
    processor = time.process_time() - processor
    wrong = 0
    different = set()
    for file in files:
        drawn = plan.draw_variants(homeworks.homeworks[file.stem], file.parent.name, SECRET)
        variants = reader.tasks_of(file, []).variants
        wrong += bool(plan.tasks_of_other_variants(drawn, variants))
        different.add(file.read_bytes())
    return {
        "sheets": len(files),
        "different ones": len(different),
        "sheets that ask what is not graded": wrong,
        "minutes": clock / 60,
        "CPU ms of a sheet": 1e3 * processor / len(files),
    }
