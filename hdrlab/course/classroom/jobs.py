"""Run grading jobs so that each is done once, even if a run is killed in between.

A job is identified by its owner and a key, a digest of everything that its result depends on.
Each result is one file, written completely or not at all. A job whose file exists is finished; the
others are run by the next run. An executor does the work, on this machine (`executors.processes`)
or on a cluster (`executors.cluster`). A job that fails is tried again, `MAX_ATTEMPTS` times in all,
and then reported as failed.
"""

import contextlib
import hashlib
import os
from collections import Counter, deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, Self

from hdrlab.course import scratch
from hdrlab.course.sanitize import sanitize_line
from hdrlab.errors import InputError
from hdrlab.io.files import replacing
from hdrlab.io.temporary import remove_leftovers

MAX_ATTEMPTS = 3
KEY_LENGTH = 16  # hexadecimal digits
MAX_PROBLEM_LENGTH = 400
LOCK_NAME = ".hdrlab.lock"  # stays: deleting a lock file can let two processes hold it


@dataclass(frozen=True)
class GradingJob:
    """A submission to grade: the team that owns it, its file, and the key of its result."""

    owner: str
    path: Path
    key: str


Work = Callable[[GradingJob], bytes]  # returns the result of a job


@dataclass(frozen=True)
class JobResult:
    """The outcome of a job.

    Attributes
    ----------
    job : GradingJob
    path : the file with the result, or None if the job failed
    problem : why there is no result, or what went wrong afterwards
    is_new : whether this run produced the result, rather than an earlier one
    """

    job: GradingJob
    path: Path | None
    problem: str = ""
    is_new: bool = True


@dataclass(frozen=True)
class JobAttempt:
    """The outcome of one attempt at a job.

    Attributes
    ----------
    job : GradingJob
    result : the bytes of the result, or None if the attempt failed
    problem : why it failed
    counts : whether the failure counts against the job. Otherwise another job may have caused it,
        and this one is tried again with nothing beside it.
    """

    job: GradingJob
    result: bytes | None
    problem: str = ""
    counts: bool = True


class Executor(Protocol):
    """Runs jobs, each in its own process; used in a with statement."""

    def start(self, job: GradingJob, *, alone: bool = False) -> bool:
        """Start a job and return True, or return False if there is no free place for it.

        With `alone`, no other job may run beside it on the same machine.
        """

    def wait_for_attempts(self) -> Sequence[JobAttempt]:
        """Wait a moment, and return the attempts that have ended."""

    def __enter__(self) -> Self:
        """Start the executor."""

    def __exit__(self, *error: object) -> None:
        """Stop all running jobs."""


def make_key(*parts: str) -> str:
    """Return a digest of the parts, in which the boundaries between the parts count.

    Examples
    --------
    >>> make_key("a", "bc") != make_key("ab", "c")
    True
    """
    digest = hashlib.sha256()
    for part in parts:
        digest.update(f"{len(part)}:{part}".encode())
    return digest.hexdigest()[:KEY_LENGTH]


def result_path(folder: Path, job: GradingJob) -> Path:
    """Return the file in which the result of a job is kept."""
    return folder / f"{job.owner}.{job.key}.json"


def write_private_file(path: Path, data: bytes) -> None:
    """Write a file that only its owner can read, completely or not at all.

    The file and its folder are flushed to disk, so that this also holds after a power failure.
    """
    with replacing(path, private=True) as temporary, open(temporary, "wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    if hasattr(os, "O_DIRECTORY"):
        handle = os.open(path.parent, os.O_DIRECTORY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def make_private(folder: Path) -> Path:
    """Create a folder that only its owner can open, or restrict an existing one; return it."""
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    folder.chmod(0o700)
    return folder


@contextlib.contextmanager
def lock_folder(folder: Path) -> Iterator[None]:
    """Create a folder, lock it for this run, and remove temporary files of killed runs.

    Raises
    ------
    InputError
        If another run holds the lock. A killed process holds no lock.
    """
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    with contextlib.ExitStack() as stack:
        try:
            stack.enter_context(scratch.locked(folder.resolve() / LOCK_NAME))
        except BlockingIOError:
            raise InputError(
                f"{folder}: another run is writing to this folder; wait until it has finished"
            ) from None
        remove_leftovers(folder, recursive=True)
        yield


def delete_results(folder: Path, jobs: Sequence[GradingJob]) -> None:
    """Delete the results of jobs, so that this run or the next one does them again."""
    for job in jobs:
        result_path(folder, job).unlink(missing_ok=True)


def split_finished(
    folder: Path, jobs: Sequence[GradingJob]
) -> tuple[list[JobResult], list[GradingJob]]:
    """Return the results that an earlier run has left, and the jobs that are still to be done.

    Raises
    ------
    InputError
        If two jobs have the same owner.
    """
    if len({job.owner for job in jobs}) < len(jobs):
        raise InputError("expected one job for each owner, got two of the same owner")
    existing = set(folder.glob("*.json"))
    finished = []
    unfinished = []
    for job in jobs:
        path = result_path(folder, job)
        if path in existing:
            finished.append(JobResult(job, path, is_new=False))
        else:
            unfinished.append(job)
    return finished, unfinished


def run_jobs(jobs: Sequence[GradingJob], executor: Executor, folder: Path) -> Iterator[JobResult]:
    """Run jobs, and yield each result as soon as its file is written.

    Once a new result is written, the owner's outdated results in the folder are deleted.

    Parameters
    ----------
    jobs : one for each owner
    executor : runs them
    folder : for the results; created if it does not exist
    """
    make_private(folder)
    outdated = find_outdated_results(folder, jobs)
    for attempt in _last_attempts(jobs, executor):
        job = attempt.job
        if attempt.result is None:
            problem = f"it ended {MAX_ATTEMPTS} times without a result: {attempt.problem}"
            yield JobResult(job, None, sanitize_line(problem, MAX_PROBLEM_LENGTH))
            continue
        path = result_path(folder, job)
        write_private_file(path, attempt.result)
        for outdated_path in outdated.get(job.owner, []):
            outdated_path.unlink(missing_ok=True)
        yield JobResult(job, path)


def _last_attempts(jobs: Sequence[GradingJob], executor: Executor) -> Iterator[JobAttempt]:
    """Run jobs, and yield the last attempt at each: the successful one, or the last failure."""
    waiting = deque(jobs)
    running = 0
    failures: Counter[str] = Counter()
    to_run_alone: set[str] = set()
    while waiting or running:
        while waiting and executor.start(waiting[0], alone=waiting[0].owner in to_run_alone):
            waiting.popleft()
            running += 1
        for attempt in executor.wait_for_attempts():
            running -= 1
            owner = attempt.job.owner
            if attempt.result is not None:
                yield attempt
            elif not attempt.counts:
                to_run_alone.add(owner)
                waiting.appendleft(attempt.job)
            else:
                failures[owner] += 1
                if failures[owner] == MAX_ATTEMPTS:
                    yield attempt
                else:
                    waiting.append(attempt.job)  # last, so that the other jobs do not wait for it


def find_outdated_results(folder: Path, jobs: Sequence[GradingJob]) -> dict[str, list[Path]]:
    """Return, by owner, the results in a folder whose key is not that of the owner's job."""
    current_names = {job.owner: result_path(folder, job).name for job in jobs}
    outdated: dict[str, list[Path]] = {}
    for path in folder.glob("*.json"):
        owner = path.name.rsplit(".", 2)[0]
        if owner in current_names and path.name != current_names[owner]:
            outdated.setdefault(owner, []).append(path)
    return outdated
