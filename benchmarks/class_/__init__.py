"""A class is graded: three hundred hand-ins of the second homework, good, wrong, blank and hostile.

whole      all of them by two processes, and then without the hostile ones: for the others nothing may differ
processes  two dozen by one process, and by two; one alone keeps more than a processor busy, since it and the
           sandbox that it asks take turns, so two are less than twice as fast on two processors
workers    the same by one, two and four workers of a Dask cluster
mixed      sixty honest hand-ins, among every hostile one that the tests have, and without them
sheets     the sheets of a class in which each student is asked variants of its own
costs      submissions that are to cost much, each graded alone: the worst of each kind
books      what is done beside the grading, where all results are there: it may not grow faster than the class

What fifty thousand would take is told from what one takes here, on as many processors of this kind:
hours of the workers, which they share, and beside these what the command's own process does alone,
which limits how many it keeps busy. Four workers on two processors tell what more workers cost, and
not what they gain. The figures are those of `hdrlab grade` in the strict tier; see `grading`.
"""

import os
from collections import Counter
from dataclasses import replace
from functools import partial
from math import log
from operator import attrgetter
from pathlib import Path
from typing import Any

from benchmarks.class_ import costs, handed, judged, mixed, sheets
from benchmarks.class_.grading import TIMEOUT, Used, grade
from benchmarks.class_.workers import cluster
from benchmarks.experiments import Experiment, along, at_least, at_most
from hdrlab.course import plan
from hdrlab.course.classroom import jobs, run as classroom
from hdrlab.course.grading import results
from hdrlab.course.plan import GradingOptions
from hdrlab.course.students import roster as lists
from hdrlab.course.submissions import class_folder

COUNT, SCALE = 300, 24
PROCESSES, WORKERS = (1, 2), (1, 2, 4)
HONEST = 60  # among all that is hostile
# seconds of a processor, and by the clock, that one submission may cost
CPU, CLOCK = 60, 300
FIGURES = {
    "CPU seconds": attrgetter("cpu"),
    "seconds": attrgetter("seconds"),
    "MB": attrgetter("largest"),
}
BOOKS = (1200, 4800)  # more than are compared with each other
LARGE = f"{judged.LARGE // 1000} 000"


def whole(folder: Path, count: int = COUNT) -> dict[str, Any]:
    """Return the figures of a whole class, with the hostile ones and without them."""
    target = folder / "with"
    each = handed.handed(count, target / "results")
    others = [one for one in each if not one.hostile]
    first = grade(handed.write(folder / "class", each), target, "--jobs", "2")
    second = grade(handed.write(folder / "others", others), folder / "without", "--jobs", "2")
    graded = judged.read(target)
    number, size = judged.size(target)
    return {
        "submissions, and those that are not hostile": (len(each), len(others)),
        "submissions lost": judged.lost(graded, each),
        "files of others that differ": judged.differing(target, folder / "without", others),
        "most points of the hostile": judged.gained(graded, each),
        "right ones below all points": judged.not_whole(graded, each),
        "mistakes not named, %": judged.not_named(graded, each),
        "traps not refused in a line": judged.not_refused(graded, each),
        "minutes, with the hostile and without": (first.seconds / 60, second.seconds / 60),
        "CPU seconds of one, with and without": (first.cpu / len(each), second.cpu / len(others)),
        "MB at most, together and of one process": (first.total, first.largest),
        "kB of one: handed in, its result, all its files": (
            sum(len(one.data) for one in each) / len(each) / 1e3,
            judged.results_size(target) / len(each) / 1e3,
            size / len(each) / 1e3,
        ),
        f"core-hours of {LARGE}": judged.core_hours(first, len(each)),
        f"hours of {LARGE} on {_listed(judged.WORKERS)} processors": [
            judged.core_hours(first, len(each)) / workers for workers in judged.WORKERS
        ],
        f"GB and thousands of files of {LARGE}": (
            size / len(each) * judged.LARGE / 1e9,
            number / len(each) * judged.LARGE / 1e3,
        ),
    }


def processes(folder: Path, count: int = SCALE) -> dict[str, Any]:
    """Return how a class is graded by one process, and by two."""
    each = handed.handed(count, folder := folder / "processes")
    place = handed.write(folder / "class", each)
    used = {jobs: grade(place, folder / f"by{jobs}", "--jobs", str(jobs)) for jobs in PROCESSES}
    differ = judged.differing(folder / "by1", folder / "by2", each)
    return _scaling(list(used.values()), count, "processes", PROCESSES) | {
        "files that differ": differ
    }


def workers(folder: Path, count: int = SCALE) -> dict[str, Any]:
    """Return how a class is graded by one, two and four workers."""
    each = handed.handed(count, folder := folder / "workers")
    place = handed.write(folder / "class", each)
    used = []
    for number in WORKERS:
        with cluster(folder / f"cluster{number}", number) as (address, beside):
            used.append(grade(place, folder / f"by{number}", "--cluster", address, beside=beside))
    first, *rest = (folder / f"by{number}" for number in WORKERS)
    differ = sum(judged.differing(first, other, each) for other in rest)
    return _scaling(used, count, "workers", WORKERS) | {"files that differ": differ}


def _scaling(used: list[Used], count: int, what: str, numbers: tuple[int, ...]) -> dict[str, Any]:
    """Return the figures of the same class, graded by more and more."""
    by, last = f"{_listed(numbers)} {what}", used[-1]
    return {
        f"seconds by {by}": [one.seconds for one in used],
        f"times as fast by {_listed(numbers[1:])}": [
            used[0].seconds / one.seconds for one in used[1:]
        ],
        f"processors kept busy by {numbers[-1]} {what}": last.cpu / last.seconds,
        f"CPU seconds of one by {by}": [one.cpu / count for one in used],
        f"ms of one in the command's own process by {by}": [1e3 * one.own / count for one in used],
        f"MB at most by {by}": [one.total for one in used],
        "processors": os.cpu_count() or 1,
    }


def among_hostile(folder: Path, count: int = HONEST) -> dict[str, Any]:
    """Return how a class fares that has every kind of hostile hand-in among its own."""
    folder = folder / "mixed"  # others have written into it
    target = folder / "with"
    each = mixed.honest(count, target / "results")
    others = mixed.hostile(target / "results", each[0])
    used = grade(mixed.write(folder / "class", each, others), target, "--jobs", "2")
    grade(handed.write(folder / "honest", each), folder / "without", "--jobs", "2")
    return {
        "submissions, honest and hostile": (len(each), len(others)),
        **{f"of kind {kind}": count for kind, count in Counter(one.kind for one in others).items()},
        "files of the honest that differ": judged.differing(target, folder / "without", each),
        "honest ones lost": judged.lost(judged.read(target), each),
        "hostile ones of whom nothing is said": len(mixed.untold(target, others)),
        "minutes": used.seconds / 60,
        "CPU seconds of one": used.cpu / (len(each) + len(others)),
        "MB at most, together and of one process": (used.total, used.largest),
    }


def most_costly(folder: Path) -> dict[str, Any]:
    """Return what the worst submission of each kind costs, and which one it is."""
    each = list(costs.each())
    used = along(partial(costs.cost, folder / "costs"), range(len(each)), "costs")
    found: dict[str, Any] = {
        "CPU seconds of the worst": max(one.cpu for one in used),
        "seconds of the worst": max(one.seconds for one in used),
        "MB of the worst": max(one.largest for one in used),
    }
    for kind in dict.fromkeys(one.kind for one in each):
        mine = [(one, what) for one, what in zip(used, each, strict=True) if what.kind == kind]
        for name, figure in FIGURES.items():
            value, which = max((figure(one), what.which) for one, what in mine)
            found[f"{kind}, {name}: {which}"] = value
    return found


def books(folder: Path) -> dict[str, Any]:
    """Return what is done beside the grading for classes that are graded already."""
    right = handed.handed(1, folder)[0]
    place = handed.write(folder / "one", [right])
    grade(place, folder / "graded")
    (result,) = judged.read(folder / "graded").values()
    used = [_told(folder / str(count), right, result, count) for count in BOOKS]
    seconds = [one.own for one in used]
    return {
        f"CPU seconds of the command's own process for {_listed(BOOKS)} results": seconds,
        "power of the class that they grow with": log(seconds[1] / seconds[0])
        / log(BOOKS[1] / BOOKS[0]),
        "ms of one": 1e3 * (seconds[1] - seconds[0]) / (BOOKS[1] - BOOKS[0]),
        f"minutes of {LARGE}": seconds[1] / BOOKS[1] * judged.LARGE / 60,
        f"MB for {_listed(BOOKS)} results": [one.total for one in used],
    }


def _told(folder: Path, one: handed.Handed, result: results.Result, count: int) -> Used:
    """Return what the command takes where everybody has handed in the same, and has a result."""
    each = [
        one._replace(team=f"s{k:05d}", students=(f"s{k:05d}",), file=f"s{k:05d}_hw2.ipynb")
        for k in range(count)
    ]
    place = handed.write(folder / "class", each)
    homework = plan.read().homeworks["hw2"]
    conditions = GradingOptions(secret=handed.SECRET.strip(), timeout=float(TIMEOUT))
    found = class_folder.find(place / "submissions", lists.read(place / "roster.csv"))
    (folder / "out" / "results").mkdir(parents=True)
    for piece in classroom.make_jobs(found.submissions, homework, conditions):
        data = results.to_json(replace(result, student=piece.owner))
        jobs.result_path(folder / "out" / "results", piece).write_bytes(data)
    return grade(place, folder / "out")


def _listed(numbers: tuple[int, ...]) -> str:
    return ", ".join(map(str, numbers))


SAME = at_most("files that differ", 0)
ROWS = (
    Experiment(
        "whole",
        f"{COUNT} hand-ins by two processes, and again without the hostile ones",
        whole,
        (
            at_most("submissions lost", 0),
            at_most("files of others that differ", 0),
            at_most("most points of the hostile", 0),
            at_most("right ones below all points", 0),
            at_most("mistakes not named, %", 10),
            at_most("traps not refused in a line", 0),
        ),
    ),
    Experiment(
        "processes",
        f"{SCALE} hand-ins by one process, and by two",
        processes,
        (SAME, at_least("processors kept busy by 2 processes", 1.6)),
    ),
    Experiment("workers", f"{SCALE} hand-ins by workers of a Dask cluster", workers, (SAME,)),
    Experiment(
        "mixed",
        f"{HONEST} honest hand-ins among every hostile one that the tests have, by two processes",
        among_hostile,
        (
            at_most("files of the honest that differ", 0),
            at_most("honest ones lost", 0),
            at_most("hostile ones of whom nothing is said", 0),
        ),
    ),
    Experiment(
        "sheets",
        f"the sheets of {sheets.COUNT} students, each with variants of its own",
        sheets.build,
        (at_most("minutes", sheets.MINUTES), at_most("sheets that ask what is not graded", 0)),
    ),
    Experiment(
        "costs",
        "submissions that are to cost much, each alone",
        most_costly,
        (at_most("CPU seconds of the worst", CPU), at_most("seconds of the worst", CLOCK)),
    ),
    Experiment(
        "books",
        "what is done beside the grading, where results are there",
        books,
        (at_most("power of the class that they grow with", 1.2),),
    ),
)
