"""What is written of the questions: for the student, on paper, for the examiner, and as a notebook."""

import base64
from collections.abc import Iterator, Sequence
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from hdrlab import scenes
from hdrlab.course.sanitize import sanitize_text
from hdrlab.io import photos
from hdrlab.show.pages.templates import templates

SIDE = 128  # pixels of a photograph that are kept, about


def photographs(files: Sequence[Path]) -> list[list[list[int]]]:
    """Return gray levels of photographs, small; of an embedded scene where there are none."""
    shown = [photos.read_photo(file) for file in files] or [np.log(scenes.room() + 1e-6)]
    grays = [one.reshape(*one.shape[:2], -1).mean(axis=-1) for one in shown]
    few = [
        one[:: max(1, max(one.shape) // SIDE), :: max(1, max(one.shape) // SIDE)] for one in grays
    ]
    return [(255 * (one - one.min()) / (np.ptp(one) or 1)).astype(int).tolist() for one in few]


def pages(found: Sequence[dict[str, Any]], **words: Any) -> Iterator[tuple[str, str]]:
    """Yield the name and the text of each file, made of what the examiner has written down."""
    questions = [one["question"] for one in found if "question" in one]
    words |= {
        "questions": questions,
        "passed": next(one["passed"] for one in found if "passed" in one),
    }
    made = templates(Path(__file__).parent)
    made.filters["tidy"] = partial(sanitize_text, max_length=20_000)
    made.filters["base64"] = lambda text: base64.b64encode(str(text).encode()).decode()
    made.filters["digest"] = lambda text: sha256(text.encode()).hexdigest()
    for sheet in ("viva", "quiz", "oral", "examiner"):
        yield (
            f"{sheet}.html",
            made.get_template("viva.html").render(words, sheet=sheet, attached=False),
        )
    yield "viva.ipynb", made.get_template("notebook.plain").render(words, attached=True)
