"""A notebook is run once: what came of it is kept, and its sentences are judged in the same kernel."""

import hashlib
import json
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import nbformat

from hdrlab.course.authoring import execute
from hdrlab.io.files import replacing

HERE = Path(__file__).parents[1]
SENTENCES = HERE / "test_sentences.py"
# behind the last cell of a notebook: what its names say of its sentences, and whether its sliders
# answer
JUDGE = """import json as _json, sys as _sys
_sys.path.append({here!r})
import test_sentences as _sentences
print(_json.dumps([_sentences.untrue({stem!r}, dict(globals())), _sentences.unanswered()]))"""


class Ran(NamedTuple):
    """A notebook that was run: its file with outputs, its untrue sentences and stuck sliders, with why."""

    executed: Path
    untrue: list[str]
    unanswered: list[str]


def run_once(path: Path, kept: Path) -> Ran:
    """Run a notebook from the top, in a kernel of its own, unless this very one has been run before.

    It is kept where `hdrlab site` would keep it in its cache.
    """
    executed = execute.executed_path(path, kept, execute.library_key())
    judged = (
        kept
        / "judged"
        / f"{hashlib.sha256(executed.name.encode() + SENTENCES.read_bytes()).hexdigest()}.json"
    )
    if not (executed.exists() and judged.exists()):
        notebook, said = _run(path)
        for file, text in ((judged, json.dumps(said)), (executed, nbformat.writes(notebook))):
            file.parent.mkdir(parents=True, exist_ok=True)
            with replacing(file) as temporary:
                temporary.write_text(text, encoding="utf8")
    return Ran(executed, *json.loads(judged.read_text(encoding="utf8")))


def _run(path: Path) -> tuple[nbformat.NotebookNode, list[list[str]]]:
    """Return a notebook with its outputs, its untrue sentences, and the sliders that do not answer."""
    with TemporaryDirectory(prefix="run-") as folder:
        notebook = nbformat.read(path, as_version=4)
        notebook.cells.append(
            nbformat.v4.new_code_cell(JUDGE.format(here=str(HERE), stem=path.stem))
        )
        judging = Path(folder) / path.name
        nbformat.write(notebook, judging)
        (done,) = execute.run_steps([judging], Path(folder), jobs=1)
        notebook = nbformat.read(done.executed, as_version=4)
    (said,) = notebook.cells.pop().outputs
    return notebook, json.loads(said.text)
