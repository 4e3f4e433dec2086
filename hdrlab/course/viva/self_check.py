"""The code cell of the practice notebook that says whether a letter is right."""

import base64
import hashlib
import inspect
import sys
from collections.abc import Sequence

# of each question: the SHA-256 of its number and the right letter, and the explanation in base 64
KEY: list[str] = []
WHY: list[str] = []


def check(number, letter):  # type: ignore[no-untyped-def]  # its text stands in the notebook
    """Say whether a letter is right, and then what each option comes from."""
    if hashlib.sha256(f"{number}{letter}".encode()).hexdigest() == KEY[number - 1]:
        text = "right\n" + base64.b64decode(WHY[number - 1]).decode()
    else:
        text = "not this one: read the code again, and follow it step by step"
    sys.stdout.write(text + "\n")


def cell_text(letters: Sequence[str], explanations: Sequence[str]) -> str:
    """Return the text of the cell for questions with these right letters and explanations."""
    key = [
        hashlib.sha256(f"{number}{letter}".encode()).hexdigest()
        for number, letter in enumerate(letters, 1)
    ]
    why = [base64.b64encode(text.encode()).decode() for text in explanations]
    lines = [line.partition("  # ")[0] for line in inspect.getsource(check).rstrip().splitlines()]
    definition = "\n".join(lines)
    return f"import base64\nimport hashlib\nimport sys\n\nKEY = {key!r}\nWHY = {why!r}\n\n\n{definition}"
