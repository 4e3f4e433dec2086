"""`python -m benchmarks.installing [EXTRA]`: what an installation takes, in seconds and megabytes by package.

An empty environment is made, hdrlab is installed into it from this clone, and the size of each
package that hdrlab names is added up, with what none but it brings along. What several of them need
is a line of its own.
"""

import importlib.metadata as metadata
import re
import subprocess
import sys
import tempfile
import time
import venv
from collections import Counter
from pathlib import Path

from benchmarks.measure import ROOT

MEGABYTE = 1e6  # bytes


def install(folder: Path, extra: str = "") -> float:
    """Make an environment in a folder, install hdrlab into it without pip's cache, and return the seconds."""
    venv.create(folder, with_pip=True)
    python = next(folder.glob("[bS]*/python*"))
    begun = time.perf_counter()
    target = f"{ROOT}[{extra}]" if extra else str(ROOT)
    subprocess.run(
        [python, "-m", "pip", "install", "--quiet", "--no-cache-dir", target], check=True
    )
    return time.perf_counter() - begun


def installed(folder: Path) -> tuple[dict[str, float], dict[str, set[str]]]:
    """Return the megabytes of each package in an environment, and the names of those that it needs itself."""
    sizes = {}
    needs = {}
    for distribution in metadata.distributions(path=[str(next(folder.rglob("site-packages")))]):
        name = canonical(distribution.metadata["Name"])
        paths = [Path(str(file.locate())) for file in distribution.files or ()]
        sizes[name] = sum(path.stat().st_size for path in paths if path.is_file()) / MEGABYTE
        required = [text for text in distribution.requires or () if "extra ==" not in text]
        needs[name] = {canonical(re.split(r"[^\w.-]", text)[0]) for text in required}
    return sizes, {name: among & sizes.keys() for name, among in needs.items()}


def canonical(name: str) -> str:
    """Return the name of a package as the index writes it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def closure(name: str, needs: dict[str, set[str]]) -> set[str]:
    """Return a package and all that it needs."""
    names = set()
    waiting = [name]
    while waiting:
        name_taken = waiting.pop()
        if name_taken not in names:
            names.add(name_taken)
            waiting += needs[name_taken]
    return names


def shares(sizes: dict[str, float], needs: dict[str, set[str]]) -> dict[str, tuple[float, int]]:
    """Return megabytes and count of packages by what hdrlab names, the largest first."""
    named = needs["hdrlab"]
    brings = {name: closure(name, needs) - (named - {name}) for name in named}
    users = Counter(package for among in brings.values() for package in among)
    rows = {
        name: [package for package in among if users[package] == 1]
        for name, among in brings.items()
    }
    # extras of others, too
    shared = sizes.keys() - {package for package, count in users.items() if count == 1}
    rows["what several of them need"] = sorted(shared - {"hdrlab", "pip", "setuptools"})
    rows["hdrlab itself"] = ["hdrlab"]
    totals = {
        name: (sum(sizes[package] for package in among), len(among)) for name, among in rows.items()
    }
    return dict(sorted(totals.items(), key=lambda row: -row[1][0]))


def main(extra: str = "") -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory(prefix="hdrlab-install-") as name:
        seconds = install(Path(name), extra)
        rows = shares(*installed(Path(name)))
    print("| package | MB | packages |\n|---|---:|---:|")
    for row, (size, count) in rows.items():
        print(f"| {row} | {size:.1f} | {count} |")
    total = sum(size for size, _ in rows.values())
    count = sum(packages for _, packages in rows.values())
    print(f"| together, in {seconds:.0f} s | {total:.0f} | {count} |")


if __name__ == "__main__":
    main(*sys.argv[1:])
