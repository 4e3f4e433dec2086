"""No file can hurt: every reader of `hdrlab/io` and `hdrlab/course` is given files that somebody has damaged.

    python -m benchmarks fuzz [--reader NAME] [--minutes N] [--seed S] [--keep FOLDER]

Files that the project has written itself are mutated (`mutations`) and read in a process of 2 GB
and 5 s of a processor a file (`worker`). A file may be read, or be refused by a ValueError of less
than 2,000 characters that names it. Whatever else happens is a finding: another exception, a crash,
a hang, words of a C library on stderr, a file left behind, something global changed. It is made
small (`minimise`) and kept, to become a test. A file that is read as other pixels than those of any
sound file is counted, too ("other"): nobody said that it is damaged. File k of a reader is the same
whenever the seed is.
"""

import argparse
import tempfile
import time
from collections import Counter
from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

from benchmarks.experiments import Experiment, Found, Skipped, at_most
from benchmarks.fuzz import mutations
from benchmarks.fuzz.minimise import minimised
from benchmarks.fuzz.process import Process
from benchmarks.fuzz.readers import READERS, Missing, Reader
from benchmarks.fuzz.worker import CLEAN, READ

SEED = 21
# files of a reader where no time is told
FILES = 1000
HEADER = (
    f"{'reader':<16}{'files':>9}{'results':>9}{'other':>8}"
    f"{'clean errors':>14}{'findings':>10}{'files/s':>9}"
)


class Finding(NamedTuple):
    """What went wrong, at which place of our code, with which file, made small."""

    number: int
    said: str
    data: bytes


class Tally(NamedTuple):
    """What became of a reader's files; of findings that look alike, the first.

    `other_pixels` counts the results whose pixels are those of no sound file.
    """

    reader: str
    files: int
    read: int
    refused: int
    findings: tuple[Finding, ...]
    seconds: float
    other_pixels: int = 0

    @property
    def line(self) -> str:
        """The reader's line of the table."""
        numbers = f"{self.files:>9,}{self.read:>9,}{self.other_pixels:>8,}"
        numbers += f"{self.refused:>14,}{len(self.findings):>10}"
        return f"{self.reader:<16}{numbers}{self.files / max(self.seconds, 1e-9):>9.0f}"


def fuzz(
    reader: Reader, numbers: Iterable[int], *, seed: int = SEED, seconds: float = 1e9
) -> Tally:
    """Return what becomes of the mutated files of these numbers, until the seconds are over."""
    start = time.perf_counter()
    counts = Counter[str]()
    tally: dict[str, Finding] = {}
    with tempfile.TemporaryDirectory(prefix="hdrlab-fuzz-") as scratch, Process(reader) as process:
        seeds = reader.seeds(Path(scratch))
        sound_checksums = {process.judge(data).said for data in seeds}
        other_pixels = 0
        for number in numbers:
            if time.perf_counter() - start > seconds:
                break
            data = mutations.mutated(seeds, mutations.generator(seed, reader.name, number))
            kind, message = process.judge(data)
            counts[kind] += 1
            if kind == READ and message not in sound_checksums:
                other_pixels += 1
            if kind not in (READ, CLEAN) and kind not in tally:
                tally[kind] = Finding(
                    number, f"{kind}: {message}", minimised(data, process.alike(kind))
                )
    taken = time.perf_counter() - start
    return Tally(
        reader.name,
        counts.total(),
        counts[READ],
        counts[CLEAN],
        tuple(tally.values()),
        taken,
        other_pixels,
    )


def keep(folder: Path, tally: Tally, seed: int) -> None:
    """Write each finding's file, and beside it what was said, with the numbers that make it again."""
    folder.mkdir(parents=True, exist_ok=True)
    suffix = READERS[tally.reader].suffix
    for finding in tally.findings:
        path = folder / f"{tally.reader}-{seed}-{finding.number}{suffix}"
        path.write_bytes(finding.data)
        path.with_name(path.name + ".txt").write_text(
            finding.said + "\n", encoding="utf8", errors="replace"
        )


def row(name: str) -> Experiment:
    """Return the row of a reader among the other benchmarks."""

    def run(folder: Path) -> Found:
        try:
            tally = fuzz(READERS[name], range(FILES))
        except Missing as reason:
            raise Skipped(str(reason)) from None
        counts = {"files": tally.files, "results": tally.read, "clean errors": tally.refused}
        counts["other pixels"] = tally.other_pixels
        figures = counts | {"findings": len(tally.findings), "files/s": tally.files / tally.seconds}
        return {what: (float(value),) for what, value in figures.items()}

    return Experiment(
        name, "damaged files: a result, or one clear error", run, (at_most("findings", 0),)
    )


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Return the options, or end with what is wrong with them."""
    parser = argparse.ArgumentParser(
        "python -m benchmarks fuzz", description=(__doc__ or "").partition("\n")[0]
    )
    parser.add_argument(
        "--reader", action="append", choices=READERS, metavar="NAME", help=", ".join(READERS)
    )
    parser.add_argument(
        "--minutes", type=float, help=f"in all; {FILES} files of each reader by default"
    )
    parser.add_argument("--seed", type=int, default=SEED, help="the same seed, the same files")
    parser.add_argument(
        "--first", type=int, default=0, help="number of the first file of each reader"
    )
    parser.add_argument(
        "--keep", metavar="FOLDER", type=Path, help="write the findings' files here"
    )
    return parser.parse_args(arguments)


def main(arguments: Sequence[str]) -> int:
    """Print a line a reader and its findings; return 1 where there is one."""
    options = parse(arguments)
    names = options.reader or list(READERS)
    seconds = 60 * options.minutes / len(names) if options.minutes else 1e9
    numbers = partial(range, options.first, options.first + (10**9 if options.minutes else FILES))
    print(f"seed {options.seed}\n{HEADER}", flush=True)
    tallies: list[Tally] = []
    for name in names:
        try:
            tally = fuzz(READERS[name], numbers(), seed=options.seed, seconds=seconds)
        except Missing as reason:
            print(f"{name:<16}  skipped: {reason}", flush=True)
            continue
        tallies.append(tally)
        print("\n".join([tally.line, *map(describe_finding, tally.findings)]), flush=True)
        if options.keep:
            keep(options.keep, tally, options.seed)
    files = sum(tally_of_reader.files for tally_of_reader in tallies)
    findings = sum(len(tally_of_reader.findings) for tally_of_reader in tallies)
    print(f"{files:,} files, {findings} findings")
    return int(findings > 0)


def describe_finding(finding: Finding) -> str:
    """Return a finding as a line under its reader's."""
    text = finding.said.encode("ascii", "backslashreplace").decode()
    return f"  file {finding.number}, {len(finding.data)} bytes: {text[:300]!r}"


ROWS = tuple(row(name) for name in READERS)
