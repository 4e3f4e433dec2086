"""Run a notebook once for all tests, check its sentences in the same kernel, and keep the results.

Several workers of pytest may ask for the same notebook at the same time. The first one runs it, the
others wait for its results.
"""

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import filelock
import nbformat

from hdrlab.course.authoring import execute
from hdrlab.io.files import replacing

TESTS = Path(__file__).parents[1]
SENTENCES_FILE = TESTS / "test_sentences.py"
# The code of a cell at the end of the notebook: it prints the false sentences and the broken sliders.
CHECKING_CODE = """import json as _json
import sys as _sys
_sys.path.append({tests!r})
import test_sentences as _sentences
_false_sentences = _sentences.find_false_sentences({stem!r}, dict(globals()))
print(_json.dumps([_false_sentences, _sentences.find_broken_sliders()]))"""


@dataclass(frozen=True)
class NotebookRun:
    """What came of running a notebook.

    Attributes
    ----------
    path : the notebook with outputs
    false_sentences : the sentences about numbers that are not true, and those that could not be
        checked, with the reason
    broken_sliders : the sliders that raised an error when they moved, with the error
    """

    path: Path
    false_sentences: list[str]
    broken_sliders: list[str]


def run_once(path: Path, folder: Path) -> NotebookRun:
    """Run a notebook from its first cell to its last, unless the folder has the results of a run.

    Parameters
    ----------
    path : the notebook
    folder : where the results are kept; the notebook with outputs is where `hdrlab site` would keep
        it in its cache
    """
    executed = execute.executed_path(path, folder, execute.library_key())
    digest = hashlib.sha256(executed.name.encode() + SENTENCES_FILE.read_bytes()).hexdigest()
    checks = folder / "checked" / f"{digest}.json"
    checks.parent.mkdir(parents=True, exist_ok=True)
    with filelock.FileLock(checks.with_suffix(".lock")):
        if not (executed.exists() and checks.exists()):
            notebook, results = _run_and_check(path)
            _write(checks, json.dumps(results))
            _write(executed, nbformat.writes(notebook))
    false_sentences, broken_sliders = json.loads(checks.read_text(encoding="utf8"))
    return NotebookRun(executed, false_sentences, broken_sliders)


def _write(path: Path, text: str) -> None:
    """Write a file completely, or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf8")


def _run_and_check(path: Path) -> tuple[nbformat.NotebookNode, list[list[str]]]:
    """Return a notebook with its outputs, and what CHECKING_CODE printed at its end."""
    notebook = nbformat.read(path, as_version=4)
    code = CHECKING_CODE.format(tests=str(TESTS), stem=path.stem)
    notebook.cells.append(nbformat.v4.new_code_cell(code))
    with TemporaryDirectory(prefix="run-") as folder:
        copy = Path(folder) / path.name
        nbformat.write(notebook, copy)
        (run,) = execute.run_steps([copy], Path(folder), jobs=1)
        notebook = nbformat.read(run.executed, as_version=4)
    (output,) = notebook.cells.pop().outputs
    return notebook, json.loads(output.text)
