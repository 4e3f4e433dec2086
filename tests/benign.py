"""Do the tests fail for bugs, and for nothing else? Apply changes one at a time and run the tests.

    python tests/benign.py                # every change, each with the whole quick tier: an hour
    python tests/benign.py --near         # each with the tests named beside it only
    python tests/benign.py renamed typo   # the changes whose names contain one of these words

A benign change is one that no user would notice: no test may fail. A bug is one that a user would
suffer from: a test must fail, and its name should say what is wrong. Each change is made in a copy
of the repository. The script prints a table and sets no limits.
"""

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
IGNORED = shutil.ignore_patterns(".git", "__pycache__", ".*_cache", "*.egg-info")


@dataclass(frozen=True)
class Change:
    """A change to a copy of the repository, and the tests that are most likely to notice it."""

    name: str
    is_bug: bool
    apply: Callable[[Path], None]
    near: tuple[str, ...]


def replace(file: str, old: str, new: str) -> Callable[[Path], None]:
    """Return a change that replaces a text, which must occur in the file."""

    def apply(root: Path) -> None:
        path = root / file
        text = path.read_text(encoding="utf8")
        if old not in text:
            raise SystemExit(f"{file} does not contain {old!r}: adapt tests/benign.py")
        path.write_text(text.replace(old, new), encoding="utf8")

    return apply


def rename(file: str, old: str, new: str) -> Callable[[Path], None]:
    """Return a change that renames a private name in its file."""

    def apply(root: Path) -> None:
        path = root / file
        text, count = re.subn(rf"\b{old}\b", new, path.read_text(encoding="utf8"))
        if count < 2:
            raise SystemExit(f"{file} does not define and use {old}: adapt tests/benign.py")
        path.write_text(text, encoding="utf8")

    return apply


def reword(file: str, old: str, new: str) -> Callable[[Path], None]:
    """Return a change that rewords all errors of a file."""

    def apply(root: Path) -> None:
        path = root / file
        lines = path.read_text(encoding="utf8").splitlines(keepends=True)
        changed = [line.replace(old, new) if '"' in line else line for line in lines]
        if changed == lines:
            raise SystemExit(f"{file} has no message with {old!r}: adapt tests/benign.py")
        path.write_text("".join(changed), encoding="utf8")

    return apply


OPERATOR = '''"""Tone mapping by the square root, as an example of a new operator.

L   luminance          (H, W) >= 0, any linear unit
Ld  display luminance  (H, W) in [0, 1]
"""

import numpy as np

from hdrlab.core import extremes
from hdrlab.core.arrays import F32, ArrayLike, as_luminance

LAWS = ("monotone", "exposure")


def tonemap(L: ArrayLike) -> F32:
    """Return Ld = sqrt(L / Lmax), black for a scene without light; Lmax ignores hot pixels.

    Parameters
    ----------
    L : (H, W) luminance, any linear unit

    Returns
    -------
    (H, W) float32 display luminance in [0, 1]

    Raises
    ------
    ValueError
        For values that are not finite, or negative.

    Examples
    --------
    >>> tonemap(np.array([[0.25, 1.0]]))
    array([[0.5, 1. ]], dtype=float32)
    """
    L = as_luminance(L)
    highest = np.float32(extremes.robust_maximum(L) or 1.0)
    return np.sqrt(np.minimum(L, highest) / highest)
'''


def add_operator(root: Path) -> None:
    """Add a tone-mapping operator: one new file."""
    (root / "hdrlab/tonemap/square_root.py").write_text(OPERATOR, encoding="utf8")


def add_notebook(root: Path) -> None:
    """Add a notebook with one sentence and one cell."""
    import nbformat

    notebook = nbformat.v4.new_notebook()
    sentence = "# A new page\n\nWhat does a square root do to a bright sky?"
    notebook.cells = [
        nbformat.v4.new_markdown_cell(sentence, id="question"),
        nbformat.v4.new_code_cell("import numpy as np\n\nnp.sqrt(2)", id="answer"),
    ]
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}
    }
    nbformat.write(notebook, root / "notebooks/26_new.ipynb")


def move_function(root: Path) -> None:
    """Move a function to a new module and import it where it was."""
    source = root / "hdrlab/tonemap/reinhard.py"
    text = source.read_text(encoding="utf8")
    start = text.index("def white_point(")
    end = text.index("\n\n\ndef ", start)
    function = text[start:end]
    moved = '"""White points."""\n\nimport numpy as np\n\nfrom hdrlab.core.arrays import F32\n\n\n'
    moved += function + "\n"
    (root / "hdrlab/tonemap/_white.py").write_text(moved, encoding="utf8")
    text = text[:start] + text[end + 3 :]
    first_import = "from hdrlab.core.arrays import"
    imported = "from hdrlab.tonemap._white import white_point\n"
    head, separator, tail = text.partition(first_import)
    line, newline, rest = tail.partition("\n")
    source.write_text(head + separator + line + newline + imported + rest, encoding="utf8")


CHANGES = (
    Change(
        "a private function renamed",
        False,
        rename("hdrlab/show/pictures.py", "_scales", "_color_scales"),
        ("tests/show",),
    ),
    Change(
        "a sum reordered",
        False,
        replace(
            "hdrlab/radiance/merge.py",
            "np.sum(W * X * t, axis=0) / np.sum(W * t**2, axis=0)",
            "np.sum(t * X * W, axis=0) / np.sum(t**2 * W, axis=0)",
        ),
        ("tests/radiance", "tests/fast"),
    ),
    Change(
        "an equivalent formula",
        False,
        replace(
            "hdrlab/tonemap/reinhard.py",
            "return (V1 - V2) / (2**phi * key / width**2 + V1)",
            "return (V1 - V2) * width**2 / (2**phi * key + V1 * width**2)",
        ),
        ("tests/tonemap", "tests/fast"),
    ),
    Change(
        "another constant of a search",
        False,
        replace("hdrlab/pipeline/recovery.py", "STRIPE_COUNT = 20", "STRIPE_COUNT = 24"),
        ("tests/pipeline",),
    ),
    Change(
        "another number of samples in a search",
        False,
        replace("hdrlab/align/light.py", "_LATTICE_PIXELS = 8_000", "_LATTICE_PIXELS = 9_000"),
        ("tests/align", "tests/pipeline"),
    ),
    Change("a function moved, with a re-export", False, move_function, ("tests/tonemap",)),
    Change(
        "messages reworded",
        False,
        reword("hdrlab/io/times.py", ": expected a ", ": please give a "),
        ("tests/io", "tests/cli"),
    ),
    Change(
        "a new keyword with a default",
        False,
        replace(
            "hdrlab/tonemap/reinhard.py",
            "def automatic_key(L: F32) -> float:",
            "def automatic_key(L: F32, *, gray: float = 0.18) -> float:",
        ),
        ("tests/tonemap", "tests/fast"),
    ),
    Change("a new operator file", False, add_operator, ("tests/tonemap", "tests/cli")),
    Change("a new notebook", False, add_notebook, ("tests/test_notebooks.py",)),
    Change(
        "an added bound of a dependency",
        False,
        replace("pyproject.toml", '"tqdm>=4.66",', '"tqdm>=4.66,<6",'),
        ("tests/test_front_door.py",),
    ),
    Change(
        "a stage refactored into two functions",
        False,
        replace(
            "hdrlab/pipeline/checks.py",
            "    return not spread <= MIN_WORTHLESS_STOPS",
            "    return not _is_at_most(spread, MIN_WORTHLESS_STOPS)\n\n\n"
            "def _is_at_most(value: float, limit: float) -> bool:\n    return bool(value <= limit)",
        ),
        ("tests/pipeline",),
    ),
    Change(
        "late days: a started day is free",
        True,
        replace(
            "hdrlab/course/students/late_days.py",
            "-((due - received) // ONE_DAY)",
            "(received - due) // ONE_DAY",
        ),
        ("tests/course/test_late.py",),
    ),
    Change(
        "merge: the exposure time is forgotten",
        True,
        replace(
            "hdrlab/radiance/merge.py",
            "np.sum(W * np.log(X / t), axis=0)",
            "np.sum(W * np.log(X), axis=0)",
        ),
        ("tests/radiance",),
    ),
    Change(
        "Reinhard: the white point does not become white",
        True,
        replace("hdrlab/tonemap/reinhard.py", "Lm / white**2", "Lm / white"),
        ("tests/tonemap",),
    ),
    Change(
        "Debevec: the smoothness term is lost",
        True,
        replace("hdrlab/response/debevec.py", "np.array([1, -2, 1])", "np.array([0, 0, 0])"),
        ("tests/response",),
    ),
    Change(
        "MTB: pixels near the median are compared",
        True,
        replace(
            "hdrlab/align/mtb.py",
            "return (Y > t + NOISE) | (Y < t - NOISE)",
            "return np.ones_like(Y, bool)",
        ),
        ("tests/align", "hdrlab/course/checks/specification/test_exclusion.py"),
    ),
    Change(
        "EXIF: the ISO speed is ignored",
        True,
        replace(
            "hdrlab/io/exif_exposure.py",
            "t * (S / speeds[0]) * (f_numbers[0] / N) ** 2",
            "t * (f_numbers[0] / N) ** 2",
        ),
        ("tests/io",),
    ),
    Change(
        "submit: the place of a photo is kept",
        True,
        replace("hdrlab/io/metadata.py", 'IFD.GPSInfo: "location",', ""),
        ("tests/io/test_metadata.py", "tests/course/test_submit.py"),
    ),
    Change(
        "assemble: a worthless map gets a tone-mapped picture",
        True,
        replace(
            "hdrlab/pipeline/checks.py",
            "return not spread <= MIN_WORTHLESS_STOPS",
            "return False",
        ),
        ("tests/pipeline", "tests/cli"),
    ),
    Change(
        "regrade: never-lower lowers scores",
        True,
        replace(
            "hdrlab/course/classroom/regrade.py",
            "return new.score < old.score",
            "return new.score > old.score",
        ),
        ("tests/course/test_regrade.py",),
    ),
    Change(
        "gallery: a team votes for itself",
        True,
        replace("hdrlab/course/gallery/schema.sql", "RAISE(ABORT, 'own team')", "'own team'"),
        ("tests/course/test_gallery.py",),
    ),
    Change(
        "Gradescope: every check passes",
        True,
        replace(
            "hdrlab/course/reports/gradebook.py",
            '"passed" if check.outcome == "holds" else "failed"',
            '"passed"',
        ),
        ("tests/course/test_results.py",),
    ),
    Change(
        "Radiance files: colors are half as bright",
        True,
        replace("hdrlab/io/maps/rgbe.py", "np.arange(256) - 136", "np.arange(256) - 137"),
        ("tests/io",),
    ),
)


def copy_repository(folder: Path) -> Path:
    """Return a copy of the repository, with the shared data beside it."""
    tree = folder / "tree"
    shutil.copytree(ROOT, tree, ignore=IGNORED)
    shared = ROOT.parent / "shared"
    if shared.exists():
        (folder / "shared").symlink_to(shared.resolve())
    return tree


def failed_tests(tree: Path, tests: tuple[str, ...]) -> list[str]:
    """Return the tests of the quick tier that fail in a copy."""
    command = [sys.executable, "-m", "pytest", "-q", "--tier=quick", "-rfE", "--tb=no", *tests]
    result = subprocess.run(command, cwd=tree, capture_output=True, text=True)
    lines = result.stdout.splitlines()
    failed = [line.split(" ", 2)[1] for line in lines if line.startswith(("FAILED ", "ERROR "))]
    if result.returncode not in (0, 1) and not failed:
        raise SystemExit(result.stdout[-2000:] + result.stderr[-2000:])
    return failed


def main() -> None:
    """Apply the changes and print which tests failed."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("words", nargs="*", help="only the changes whose names contain a word")
    parser.add_argument("--near", action="store_true", help="run the likely tests only")
    options = parser.parse_args()
    for change in CHANGES:
        if options.words and not any(word in change.name for word in options.words):
            continue
        with tempfile.TemporaryDirectory(prefix="hdrlab-benign-") as scratch:
            tree = copy_repository(Path(scratch).resolve())
            change.apply(tree)
            failed = failed_tests(tree, change.near if options.near else ())
        kind = "bug" if change.is_bug else "benign"
        verdict = "as it should be" if change.is_bug == bool(failed) else "WRONG"
        print(f"{kind:7} {change.name}: {len(failed)} tests fail, {verdict}", flush=True)
        for name in failed[:5]:
            print(f"          {name}")


if __name__ == "__main__":
    main()
