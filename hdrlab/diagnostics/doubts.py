"""The sentences that say why not to trust a map, in one file, to be read beside each other."""

import tomllib
from pathlib import Path

SENTENCES: dict[str, str] = tomllib.loads(Path(__file__).with_name("doubts.toml").read_text("utf8"))


def say(name: str, **found: object) -> str:
    """Return a sentence with what was found.

    Examples
    --------
    >>> say("rivals", frames="a.jpg")
    '; it may also be a.jpg that is wrong, and with it the map'
    """
    return SENTENCES[name].format(**found)
