"""Work for the crews under test, in place of grading: it is sent elsewhere, so it is light to import.

A submission here is a file of two lines: where to note what happens, and anything.
"""

import os
import signal
import time
from pathlib import Path

from hdrlab.course.classroom import jobs

BESIDE = {"s0", "s1", "s2"}


def make_jobs(folder, count=5, names="s"):
    """Write a class of so many submissions, unless it is there, and return them."""
    folder.mkdir(exist_ok=True)
    made = []
    for k in range(count):
        path = folder / f"{names}{k}.py"
        if not path.exists():
            path.write_text(f"{folder / 'begun'}\n{'x' * k}")
        made.append(
            jobs.GradingJob(f"{names}{k}", path, jobs.make_key(path.read_text().partition("\n")[2]))
        )
    return made


def begun(folder):
    """Return what has begun: whose job, in which process, which process has started that."""
    noted = folder / "begun"
    lines = noted.read_text().splitlines() if noted.exists() else []
    return [(owner, int(own), int(parent)) for owner, own, parent in map(str.split, lines)]


def grade(job):
    """Note that it begins, and answer: slow enough to be killed."""
    where, rest = job.path.read_text().split("\n")
    with Path(where).open("a") as file:
        file.write(f"{job.owner} {os.getpid()} {os.getppid()}\n")
    time.sleep(0.02)
    return (f'{{"of": "{job.path.name}", "bytes": {len(rest)}}}' * 2000).encode()


def fatal(job):
    """Die as under the memory limit, if it is the hostile one."""
    if job.owner == "s3":
        os.kill(os.getpid(), signal.SIGKILL)
    return grade(job)


def slow(job):
    """Take more than a second."""
    answer = grade(job)
    time.sleep(1.4)
    return answer


def deadly(job):
    """End the process that has started this one, on a cluster the worker, if it is the hostile one."""
    if job.owner != "s3":
        return slow(job)
    answer = grade(job)
    time.sleep(1)  # a nanny looks after a worker when it has seen it begin
    os.kill(os.getppid(), signal.SIGKILL)
    time.sleep(60)
    return answer


def crowded(job):
    """The same, where the hostile one begins beside s0, s1 and s2, and none ends before it ends them all."""
    folder = Path(job.path.read_text().split("\n")[0]).parent
    there = {owner for owner, *_ in begun(folder)}
    if job.owner in BESIDE - there:
        grade(job)
        time.sleep(600)
    while job.owner == "s3" and not BESIDE <= {owner for owner, *_ in begun(folder)}:
        time.sleep(0.05)
    return deadly(job)


def endless(job):
    """Never answer."""
    grade(job)
    time.sleep(600)
    return b""


def failing(job):
    """Raise an error, on two lines."""
    raise ValueError("expected this,\ngot that")
