"""Jobs for the tests of executors and clusters, in place of grading: they note that they started.

Executors send these functions to other processes, so this module is quick to import. A submission is
a file of two lines: the path of the file in which its job is noted, and some text.
"""

import os
import signal
import time
from pathlib import Path

from hdrlab.course.classroom import jobs

HARMFUL_OWNER = "s3"  # the student whose job does harm
NEIGHBOURS = {"s0", "s1", "s2"}  # the students whose jobs run beside it
NEVER_SECONDS = 600  # longer than any test waits
STARTED_FILE = "begun"


def make_jobs(folder, count=5, names="s"):
    """Write `count` submissions, unless they exist, and return a GradingJob for each."""
    folder.mkdir(exist_ok=True)
    grading_jobs = []
    for number in range(count):
        owner = f"{names}{number}"
        path = folder / f"{owner}.py"
        if not path.exists():
            path.write_text(f"{folder / STARTED_FILE}\n{'x' * number}")
        text = path.read_text().partition("\n")[2]
        grading_jobs.append(jobs.GradingJob(owner, path, jobs.make_key(text)))
    return grading_jobs


def read_started_jobs(folder):
    """Return (owner, process, parent process) of each job that has started, in this order."""
    file = folder / STARTED_FILE
    if not file.exists():
        return []
    started = []
    for line in file.read_text().splitlines():
        owner, process, parent = line.split()
        started.append((owner, int(process), int(parent)))
    return started


def grade_quickly(job):
    """Note that the job has started and return a result; it takes long enough to be killed."""
    file, text = job.path.read_text().split("\n")
    with Path(file).open("a") as started:
        started.write(f"{job.owner} {os.getpid()} {os.getppid()}\n")
    time.sleep(0.02)
    return (f'{{"of": "{job.path.name}", "bytes": {len(text)}}}' * 2000).encode()


def grade_and_kill_self(job):
    """Grade, but end the process of the harmful job as the memory limit does."""
    if job.owner == HARMFUL_OWNER:
        os.kill(os.getpid(), signal.SIGKILL)
    return grade_quickly(job)


def grade_slowly(job):
    """Grade in more than a second."""
    result = grade_quickly(job)
    time.sleep(1.4)
    return result


def kill_worker(job):
    """Grade slowly, but kill the parent process in the harmful job; on a cluster, this is the worker."""
    if job.owner != HARMFUL_OWNER:
        return grade_slowly(job)
    result = grade_quickly(job)
    time.sleep(1)  # the nanny process of a worker restarts it only if it has seen it start
    os.kill(os.getppid(), signal.SIGKILL)
    time.sleep(60)
    return result


def kill_worker_beside_others(job):
    """Kill the worker while the neighbours' jobs run on it: they started before and have not finished."""
    folder = Path(job.path.read_text().split("\n")[0]).parent
    if job.owner in NEIGHBOURS - started_owners(folder):
        grade_quickly(job)
        time.sleep(NEVER_SECONDS)
    if job.owner == HARMFUL_OWNER:
        while not started_owners(folder) >= NEIGHBOURS:
            time.sleep(0.05)
    return kill_worker(job)


def started_owners(folder):
    """Return the students whose jobs have started."""
    return {owner for owner, *_ in read_started_jobs(folder)}


def never_finish(job):
    """Start and never return a result."""
    grade_quickly(job)
    time.sleep(NEVER_SECONDS)
    return b""


def raise_error(job):
    """Raise an error with a message of two lines."""
    raise ValueError("expected this,\ngot that")
