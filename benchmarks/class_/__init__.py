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

COUNT = 300
SCALE = 24
PROCESSES = (1, 2)
WORKERS = (1, 2, 4)
HONEST = 60  # among all that is hostile
# seconds of a processor, and by the clock, that one submission may cost
CPU = 60
CLOCK = 300
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
    members = handed.handed(count, target / "results")
    others = [member for member in members if not member.hostile]
    first = grade(handed.write(folder / "class", members), target, "--jobs", "2")
    second = grade(handed.write(folder / "others", others), folder / "without", "--jobs", "2")
    graded = judged.read(target)
    number, size = judged.size(target)
    return {
        "submissions, and those that are not hostile": (len(members), len(others)),
        "submissions lost": judged.lost(graded, members),
        "files of others that differ": judged.differing(target, folder / "without", others),
        "most points of the hostile": judged.gained(graded, members),
        "right ones below all points": judged.not_whole(graded, members),
        "mistakes not named, %": judged.not_named(graded, members),
        "traps not refused in a line": judged.not_refused(graded, members),
        "minutes, with the hostile and without": (first.seconds / 60, second.seconds / 60),
        "CPU seconds of one, with and without": (
            first.cpu / len(members),
            second.cpu / len(others),
        ),
        "MB at most, together and of one process": (first.total, first.largest),
        "kB of one: handed in, its result, all its files": (
            sum(len(member.data) for member in members) / len(members) / 1e3,
            judged.results_size(target) / len(members) / 1e3,
            size / len(members) / 1e3,
        ),
        f"core-hours of {LARGE}": judged.core_hours(first, len(members)),
        f"hours of {LARGE} on {_listed(judged.WORKERS)} processors": [
            judged.core_hours(first, len(members)) / workers for workers in judged.WORKERS
        ],
        f"GB and thousands of files of {LARGE}": (
            size / len(members) * judged.LARGE / 1e9,
            number / len(members) * judged.LARGE / 1e3,
        ),
    }


def processes(folder: Path, count: int = SCALE) -> dict[str, Any]:
    """Return how a class is graded by one process, and by two."""
    folder = folder / "processes"
    members = handed.handed(count, folder)
    place = handed.write(folder / "class", members)
    used = {jobs: grade(place, folder / f"by{jobs}", "--jobs", str(jobs)) for jobs in PROCESSES}
    differ = judged.differing(folder / "by1", folder / "by2", members)
    return _scaling(list(used.values()), count, "processes", PROCESSES) | {
        "files that differ": differ
    }


def workers(folder: Path, count: int = SCALE) -> dict[str, Any]:
    """Return how a class is graded by one, two and four workers."""
    folder = folder / "workers"
    members = handed.handed(count, folder)
    place = handed.write(folder / "class", members)
    used = []
    for number in WORKERS:
        with cluster(folder / f"cluster{number}", number) as (address, beside):
            used.append(grade(place, folder / f"by{number}", "--cluster", address, beside=beside))
    folders = [folder / f"by{number}" for number in WORKERS]
    differ = sum(judged.differing(folders[0], other, members) for other in folders[1:])
    return _scaling(used, count, "workers", WORKERS) | {"files that differ": differ}


def _scaling(used: list[Used], count: int, what: str, numbers: tuple[int, ...]) -> dict[str, Any]:
    """Return the figures of the same class, graded by more and more."""
    by = f"{_listed(numbers)} {what}"
    last = used[-1]
    return {
        f"seconds by {by}": [run_result.seconds for run_result in used],
        f"times as fast by {_listed(numbers[1:])}": [
            used[0].seconds / run_result.seconds for run_result in used[1:]
        ],
        f"processors kept busy by {numbers[-1]} {what}": last.cpu / last.seconds,
        f"CPU seconds of one by {by}": [run_result.cpu / count for run_result in used],
        f"ms of one in the command's own process by {by}": [
            1e3 * run_result.own / count for run_result in used
        ],
        f"MB at most by {by}": [run_result.total for run_result in used],
        "processors": os.cpu_count() or 1,
    }


def among_hostile(folder: Path, count: int = HONEST) -> dict[str, Any]:
    """Return how a class fares that has every kind of hostile hand-in among its own."""
    folder = folder / "mixed"  # others have written into it
    target = folder / "with"
    members = mixed.honest(count, target / "results")
    others = mixed.hostile(target / "results", members[0])
    used = grade(mixed.write(folder / "class", members, others), target, "--jobs", "2")
    grade(handed.write(folder / "honest", members), folder / "without", "--jobs", "2")
    return {
        "submissions, honest and hostile": (len(members), len(others)),
        **{
            f"of kind {kind}": count
            for kind, count in Counter(run_result.kind for run_result in others).items()
        },
        "files of the honest that differ": judged.differing(target, folder / "without", members),
        "honest ones lost": judged.lost(judged.read(target), members),
        "hostile ones of whom nothing is said": len(mixed.untold(target, others)),
        "minutes": used.seconds / 60,
        "CPU seconds of one": used.cpu / (len(members) + len(others)),
        "MB at most, together and of one process": (used.total, used.largest),
    }


def most_costly(folder: Path) -> dict[str, Any]:
    """Return what the worst submission of each kind costs, and which one it is."""
    submissions = list(costs.costly_submissions())
    used = along(partial(costs.cost, folder / "costs"), range(len(submissions)), "costs")
    costs_found: dict[str, Any] = {
        "CPU seconds of the worst": max(submission.cpu for submission in used),
        "seconds of the worst": max(submission.seconds for submission in used),
        "MB of the worst": max(submission.largest for submission in used),
    }
    for kind in dict.fromkeys(submission.kind for submission in submissions):
        mine = [
            (submission, what)
            for submission, what in zip(used, submissions, strict=True)
            if what.kind == kind
        ]
        for name, figure in FIGURES.items():
            value, which = max((figure(submission), what.which) for submission, what in mine)
            costs_found[f"{kind}, {name}: {which}"] = value
    return costs_found


def books(folder: Path) -> dict[str, Any]:
    """Return what is done beside the grading for classes that are graded already."""
    right = handed.handed(1, folder)[0]
    place = handed.write(folder / "one", [right])
    grade(place, folder / "graded")
    (result,) = judged.read(folder / "graded").values()
    used = [_told(folder / str(count), right, result, count) for count in BOOKS]
    seconds = [run_result.own for run_result in used]
    return {
        f"CPU seconds of the command's own process for {_listed(BOOKS)} results": seconds,
        "power of the class that they grow with": log(seconds[1] / seconds[0])
        / log(BOOKS[1] / BOOKS[0]),
        "ms of one": 1e3 * (seconds[1] - seconds[0]) / (BOOKS[1] - BOOKS[0]),
        f"minutes of {LARGE}": seconds[1] / BOOKS[1] * judged.LARGE / 60,
        f"MB for {_listed(BOOKS)} results": [run_result.total for run_result in used],
    }


def _told(folder: Path, member: handed.Handed, result: results.Result, count: int) -> Used:
    """Return what the command takes where everybody has handed in the same, and has a result."""
    members = [
        member._replace(team=f"s{k:05d}", students=(f"s{k:05d}",), file=f"s{k:05d}_hw2.ipynb")
        for k in range(count)
    ]
    place = handed.write(folder / "class", members)
    homework = plan.read().homeworks["hw2"]
    conditions = GradingOptions(secret=handed.SECRET.strip(), timeout=float(TIMEOUT))
    member_result = class_folder.find(place / "submissions", lists.read(place / "roster.csv"))
    (folder / "out" / "results").mkdir(parents=True)
    for piece in classroom.make_jobs(member_result.submissions, homework, conditions):
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
