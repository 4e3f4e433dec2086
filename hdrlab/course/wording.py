"""What students write, made fit to be shown: one line, plain characters, no longer than a page bears.

Escaping is the page's affair, and it is done there; this keeps out what escaping does not mend: control
characters, marks that turn the direction of the text around them, and stacks of accents.
"""

import unicodedata

DROPPED = {"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"}  # controls, direction marks, surrogates, the unassigned
ACCENTS = 2  # in a row: as many as any living script needs over one letter


def plain(text: str, most: int) -> str:
    """Return text as one line of at most `most` characters, composed (NFC).

    Examples
    --------
    >>> plain("  Dusk\\u202e at\\n the  sea ", 40)
    'Dusk at the sea'
    >>> plain("a" * 10, 4)
    'aaa…'
    """
    kept, accents = [], 0
    for letter in unicodedata.normalize("NFC", text[: 8 * most]):
        if letter.isspace():
            letter = " "
        elif unicodedata.category(letter) in DROPPED:
            continue
        accents = accents + 1 if unicodedata.combining(letter) else 0
        if accents <= ACCENTS:
            kept.append(letter)
    line = " ".join("".join(kept).split())
    return line if len(line) <= most else line[: most - 1].rstrip() + "…"
