"""Variants of a task: the same question with other parameters, pairs of words in `parameters/<task>.toml`.

A parameter has values, the library's own first, and a value says what is written otherwise. Its
pairs hold for all that speaks of the task: sheet, stub, solution, checks with their hints, and
mistakes. So all follow.

variant  a value of each parameter, in the order of the file: "compared/above/four"; "" is the library's own
"""

import tomllib
from collections.abc import Callable
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

from hdrlab.course.source_code import inline
from hdrlab.errors import InputError

FOLDER = Path(__file__).parent / "parameters"


@cache
def parameters(task: str) -> dict[str, dict[str, list[tuple[str, str]]]]:
    """Return the values of each parameter of a task, and of each value the pairs of old and new words."""
    file = FOLDER / f"{task}.toml"
    return tomllib.loads(file.read_text("utf8")) if file.is_file() else {}


@cache
def every(task: str) -> tuple[str, ...]:
    """Return all variants of a task, that of the library first.

    Examples
    --------
    >>> len(every("shift")), every("shift")[0], every("hat")
    (8, 'cut/goes/rows', ('',))
    """
    return tuple(map("/".join, product(*parameters(task).values())))


def reword(task: str, variant: str, text: str, *, all_of_it: bool = False) -> str:
    """Return what is written of a task, in the words of a variant.

    Raises
    ------
    ValueError
        For `all_of_it`, where nothing in the text is as the variant expects it.
    """
    values = variant.split("/") if variant else []
    for known, value in zip(parameters(task).values(), values, strict=bool(variant)):
        before = text
        for was, now in known[value]:
            text = text.replace(was, now)
        if all_of_it and known[value] and text == before:
            raise InputError(
                f"expected the sheet of {task} in hdrlab's words, to put {value!r} there"
            )
    return text


@cache
def function(task: str, dotted: str, variant: str) -> Callable[..., Any]:
    """Return the solution of a variant: the library's function, reworded.

    Examples
    --------
    >>> import numpy as np
    >>> six = function("exclusion", "align.mtb.exclusion", "compared/above/six")
    >>> six(np.uint8([123, 126, 127]), 120).tolist()
    [False, False, True]
    """
    scope: dict[str, Any] = {"__name__": task}
    exec(reword(task, variant, inline.inlined({task: dotted})[task].text), scope)
    return scope[task]
