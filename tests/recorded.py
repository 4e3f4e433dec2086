"""Numbers that came for some input, and must come again: a file of them beside each module of tests.

A module of tests has CASES, {function: calls}, each call without arguments. `python
tests/recorded.py FILE` writes down what its calls answer; whoever does so says in the commit why
the numbers may change.

Of an answer its parts are kept: a number or word as it is, an array of at most SMALL values in
full; of a larger one its shape, its smallest and largest value, and three means with different
weights, of one larger than LARGE over a part of its values. A call that refuses its input is
"refused".
"""

import importlib.util
import re
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

SMALL, LARGE = 8, 20_000
TOLERANCE = 2e-6  # relative to the largest value of the same part
FLOOR = 1e-14  # what rounding leaves of 0
Part = tuple[str, float]  # a value, and the largest of its part


def parts(answer: Any) -> Iterator[list[str]]:
    """Yield the parts of an answer, each as words: names, shapes and numbers."""
    match answer:
        case Enum():
            yield [answer.name]
        case str():
            yield ["'" + "_".join(answer.replace(";", ",").split())]
        case None | bool() | np.bool_():
            yield [str(answer)]
        case slice():
            yield [f"{answer.start}:{answer.stop}"]
        case int() | float() | complex() | np.number() | np.ndarray():
            yield _array(np.asarray(answer))
        case Mapping():
            for name, value in answer.items():
                yield [f"'{name}".replace(" ", "")]
                yield from parts(value)
        case _ if is_dataclass(answer):
            for one in fields(answer):
                yield from parts(getattr(answer, one.name))
        case _ if hasattr(answer, "toarray"):
            yield from parts(answer.toarray())
        case Sequence() | Iterator() | set() | frozenset():
            every = sorted(answer) if isinstance(answer, set | frozenset) else list(answer)
            yield [f"{len(every)}:"]
            for one in every:
                yield from parts(one)
        case _ if callable(answer):
            yield ["function"]
        case _:
            raise TypeError(f"no numbers of {type(answer)}")


def _array(a: np.ndarray) -> list[str]:
    shape = [f"{'x'.join(map(str, a.shape))}{a.dtype.kind}{a.dtype.itemsize}"] if a.ndim else []
    if a.dtype.kind not in "biufc":
        return [*shape, *(str(one) for one in a.ravel())]
    values = a.ravel().astype(np.complex128 if a.dtype.kind == "c" else np.float64)
    if a.dtype.kind == "c":
        values = values.view(np.float64)
    if a.size > SMALL:
        infinite = ~np.isfinite(values)
        if infinite.any():
            shape.append(
                f"not_finite={np.flatnonzero(infinite)[:3].tolist()}of{infinite.sum()}".replace(
                    " ", ""
                )
            )
            values = np.where(infinite, 0.0, values)
        low, high, values = values.min(), values.max(), values[:: values.size // LARGE + 1]
        k = np.arange(values.size)
        weights = [np.ones(k.size), np.cos(k * 0.7 + k * k * 0.31), np.sin(k * 1.3 + k * k * 0.17)]
        values = np.array([low, high, *(np.mean(values * w) for w in weights)])
    return [*shape, *(f"{one:.9g}" for one in values)]


def named(*calls: "partial[Any]") -> dict[str, list["partial[Any]"]]:
    """Return the calls by the function that each calls, as CASES has them."""
    found: dict[str, list[partial[Any]]] = {}
    for call in calls:
        room = call.func.__module__.removeprefix("hdrlab.")
        found.setdefault(f"{room}.{call.func.__name__}", []).append(call)
    return found


def answers(call: Callable[[], Any]) -> list[list[str]]:
    """Return the parts of what a call answers, or that it refuses."""
    try:
        return list(parts(call()))
    except ValueError:
        return [["refused"]]


def same(
    came: list[list[str]],
    expected: list[list[str]],
    tolerance: float = TOLERANCE,
    *,
    floor: float = FLOOR,
) -> bool:
    """Return whether all words are the same, and all numbers within the tolerance."""
    if [len(one) for one in came] != [len(one) for one in expected]:
        return False
    return all(_close(a, b, tolerance, floor) for a, b in zip(came, expected, strict=True))


def _close(came: list[str], expected: list[str], tolerance: float, floor: float) -> bool:
    a, b = [[_number(word) for word in part] for part in (came, expected)]
    largest = max((abs(x) for x in b if isinstance(x, float) and np.isfinite(x)), default=0.0)
    for x, y in zip(a, b, strict=True):
        if isinstance(x, str) or isinstance(y, str):
            if not (isinstance(x, str) and isinstance(y, str) and _alike(x, y)):
                return False
        elif not np.isfinite([x, y]).all():
            if x != y and not (x != x and y != y):
                return False
        elif abs(x - y) > tolerance * largest + floor:
            return False
    return True


def _alike(one: str, other: str) -> bool:
    """Return whether two words are the same, but for the last digit of a number that they tell."""
    a, b = (re.split(r"(\d+\.\d+)", word) for word in (one, other))
    if a[::2] != b[::2]:
        return False
    pairs = zip(a[1::2], b[1::2], strict=True)
    return all(
        abs(float(x) - float(y)) < 1.01 * 10.0 ** -len(y.partition(".")[2]) for x, y in pairs
    )


def _number(word: str) -> float | str:
    try:
        return float(word)
    except ValueError:
        return word


def read(module: str) -> dict[str, list[list[list[str]]]]:
    """Return what stands in the file beside a module of tests: function -> of each call the parts."""
    found: dict[str, list[list[list[str]]]] = {}
    for line in Path(module).with_suffix(".txt").read_text(encoding="utf8").splitlines():
        if not line.startswith(" "):
            own = found[line] = []
        else:
            own.append([part.split() for part in line.split(";")])
    return found


def check(
    cases: Mapping[str, Sequence[Callable[[], Any]]],
    name: str,
    module: str,
    tolerance: float = TOLERANCE,
) -> None:
    """Assert that the calls of a function answer what stands in the file."""
    expected = read(module)[name]
    assert len(cases[name]) == len(expected)
    for k, (call, wanted) in enumerate(zip(cases[name], expected, strict=True)):
        came = answers(call)
        assert same(came, wanted, tolerance), f"call {k} of {name}: {came} instead of {wanted}"[
            :600
        ]


def main(file: str) -> None:
    """Write down what the calls of a module of tests answer."""
    path = Path(file).resolve()
    sys.path[:0] = [str(Path(__file__).parent)]
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    lines = []
    for name, calls in module.CASES.items():
        lines.append(name)
        for k, call in enumerate(calls):
            try:
                lines.append(" " + "; ".join(" ".join(part) for part in answers(call)))
            except Exception as error:
                error.add_note(f"call {k} of {name}")
                raise
    path.with_suffix(".txt").write_text("\n".join(lines) + "\n", encoding="utf8")


if __name__ == "__main__":
    main(sys.argv[1])
