"""The sentences of the assignments' texts, and the wrong answers that the table of sentences names."""

import importlib.util
import re
from pathlib import Path

from hdrlab.course.checks.mistakes import mistakes_of

HERE = Path(__file__).parent
SOLUTIONS = HERE.parents[1] / "solutions"
FAIRNESS = HERE.parents[1] / "benchmarks" / "fairness"

# the end of a sentence, if no lowercase letter follows
SENTENCE_END = re.compile(r"(?<=[.?!:])[)*]? +(?=[^a-z ])")
PARAGRAPH_END = re.compile(r"\n\s*\n|\n(?=\s*(?:- |\d+\. |\|))")


def sentences_of(text):
    """Return the sentences of a Markdown text in order; a displayed formula counts as one."""
    found = []
    for paragraph in PARAGRAPH_END.split(text):
        words = " ".join(paragraph.split())
        if words.startswith("#"):
            continue
        words = re.sub(r"^(- |\d+\. )", "", words)
        for part in re.split(r"(\$\$.*?\$\$)", words):
            pieces = [part] if part.startswith("$$") else SENTENCE_END.split(part)
            found += [piece.strip() for piece in pieces if re.search("[A-Za-z]", piece)]
    return found


def texts():
    """Return the sentences of each task's text in `solutions/`, by the task's id."""
    found = {}
    for path in sorted(SOLUTIONS.glob("*.py")):
        for cell in re.split(r"^# %% ?", path.read_text(encoding="utf8"), flags=re.MULTILINE):
            head, _, body = cell.partition("\n")
            about = re.fullmatch(r'\[markdown\] about="(\w+)"', head.strip())
            if about:
                lines = [line.removeprefix("#").removeprefix(" ") for line in body.splitlines()]
                found.setdefault(about[1], []).extend(sentences_of("\n".join(lines)))
    return found


def wrong_answers(task):
    """Return all wrong answers to a task by name: known mistakes, those here, and the benchmark's."""
    found = {mistake.name: mistake.function for mistake in mistakes_of(task)}
    for path in sorted((HERE / "wrong_answers").glob("*.py")):
        spec = importlib.util.spec_from_file_location(f"wrong_answers_{path.stem}", path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        found.update(vars(module))
    return found
