"""Make text from students safe to show: printable characters only, of limited length.

This removes what HTML escaping cannot fix: control characters, unpaired surrogates, invisible
characters, characters that change the direction of the surrounding text, and stacks of combining
accents. All outside text (file names, messages, prints) passes through here before it is shown.
Escaping for HTML is done separately, in the page templates.
"""

import re
import unicodedata

# Control, format, surrogate, private-use, unassigned; line and paragraph separators.
REMOVED_CATEGORIES = frozenset({"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"})
MAX_ACCENTS_IN_A_ROW = 2  # as many as any living script puts over one letter
MAX_MARKS_IN_A_ROW = 4  # includes vowel signs that are written above and below
ANSI_ESCAPE = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]")  # sets a terminal's color or moves its cursor


def sanitize_line(text: str, max_length: int) -> str:
    r"""Return text as one line of at most `max_length` characters, in Unicode form NFC.

    Examples
    --------
    >>> sanitize_line("  Dusk\u202e at\n the  sea ", 40)
    'Dusk at the sea'
    >>> sanitize_line("a" * 10, 4)
    'aaa…'
    """
    max_read = 8 * max_length
    spaced = "".join(" " if letter.isspace() else letter for letter in text[:max_read])
    line = " ".join(sanitize_text(spaced, max_read).split())
    if len(line) <= max_length:
        return line
    return line[: max_length - 1].rstrip() + "…"


def sanitize_text(text: str, max_length: int) -> str:
    r"""Return text of at most `max_length` characters, in Unicode form NFC; line breaks stay.

    Examples
    --------
    >>> sanitize_text("\x1b[31mred\x1b[0m\n\ud800 and \u202eplain", 40)
    'red\n and plain'
    """
    kept = []
    accents = 0
    marks = 0
    for letter in ANSI_ESCAPE.sub("", text[:max_length]):
        category = unicodedata.category(letter)
        if category in REMOVED_CATEGORIES and letter not in "\n\t":
            continue
        if category in ("Mn", "Me"):
            marks += 1
            accents += unicodedata.combining(letter) > 0
        else:
            marks = 0
            accents = 0
        if accents <= MAX_ACCENTS_IN_A_ROW and marks <= MAX_MARKS_IN_A_ROW:
            kept.append(letter)
    return unicodedata.normalize("NFC", "".join(kept))
