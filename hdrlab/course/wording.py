"""What students write, made fit to be shown: plain characters, no longer than a page or a terminal bears.

Escaping is the page's affair, and it is done there; this keeps out what escaping does not mend:
control characters, half a character, marks without shape or that turn the direction of the text
around them, and stacks of accents. Whatever comes from outside goes through here before it is told:
names of files, messages, prints.
"""

import re
import unicodedata

DROPPED = {
    "Cc",
    "Cf",
    "Cs",
    "Co",
    "Cn",
    "Zl",
    "Zp",
}  # controls, direction marks, surrogates, the unassigned
ACCENTS = 2  # in a row: as many as any living script needs over one letter
MARKS = 4  # in a row, with vowels that are written above and below
CODES = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]")  # which colour a terminal, or move its cursor


def plain(text: str, most: int) -> str:
    r"""Return text as one line of at most `most` characters, composed (NFC).

    Examples
    --------
    >>> plain("  Dusk\u202e at\n the  sea ", 40)
    'Dusk at the sea'
    >>> plain("a" * 10, 4)
    'aaa…'
    """
    spaced = "".join(" " if letter.isspace() else letter for letter in text[: 8 * most])
    line = " ".join(lines(spaced, 8 * most).split())
    return line if len(line) <= most else line[: most - 1].rstrip() + "…"


def lines(text: str, most: int) -> str:
    r"""Return text of at most `most` characters, in lines as it came.

    Examples
    --------
    >>> lines("\x1b[31mred\x1b[0m\n\ud800 and \u202eplain", 40)
    'red\n and plain'
    """
    text = CODES.sub("", text[:most])
    kept, accents, marks = [], 0, 0
    for letter in text:
        kind = unicodedata.category(letter)
        if kind in DROPPED and letter not in "\n\t":
            continue
        marks = marks + 1 if kind in ("Mn", "Me") else 0
        accents = accents + (unicodedata.combining(letter) > 0) if marks else 0
        if accents <= ACCENTS and marks <= MARKS:
            kept.append(letter)
    return unicodedata.normalize("NFC", "".join(kept))
