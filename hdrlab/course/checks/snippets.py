"""Write a call of a function as Python code that can be pasted into a cell."""

import ast
import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hdrlab.course.checks import shrinking

# a table (n,) with more values is written as an expression if it is one that a reader knows
MAX_LISTED_VALUES = shrinking.MAX_SINGLE_VALUES
MAX_SHOWN_NUMBERS = 12
# an array with more values, of which few differ from the others, is written as these few
MIN_SPARSE_VALUES = 8
MAX_SPARSE_FRACTION = 0.25
MAX_TEXT_CHARACTERS = 80
# so that the variables of a notebook keep their values when the code is pasted into a cell
VARIABLE_PREFIX = "small_"
# numbers of a type that np.array gives to a list by itself
PLAIN_TYPES = ("float64", "int64", "bool")


@dataclass(frozen=True)
class Snippet:
    """A call as code: the lines that set the inputs, and the call.

    Attributes
    ----------
    inputs : one line for each array
    call : an expression; the functions in it are the task's, and NumPy as `np`
    """

    inputs: tuple[str, ...]
    call: str

    @property
    def text(self) -> str:
        """The lines to paste."""
        return "\n".join([*self.inputs, self.call])

    @property
    def count(self) -> int:
        """How many numbers a reader reads in the inputs and in the call."""
        nodes = ast.walk(ast.parse(self.text))
        return sum(isinstance(node, ast.Constant) and _is_number(node.value) for node in nodes)

    def arguments(self) -> tuple[tuple[Any, ...], dict[str, Any]]:
        """Return the arguments that the code passes to the function. The code is this module's own."""
        scope: dict[str, Any] = {"np": np}
        exec("\n".join(self.inputs), scope)
        name = self.call.partition("(")[0]
        scope[name] = lambda *args, **kwargs: (args, kwargs)
        return eval(self.call, scope)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def write(
    name: str, function: Callable[..., Any], args: Sequence[Any], kwargs: Mapping[str, Any]
) -> Snippet:
    """Return a call of a function as code.

    Parameters
    ----------
    name : str
        The name of the function in the code.
    function : function
        The names of the variables are made from those of its parameters.
    args, kwargs : the arguments

    Examples
    --------
    >>> print(write("mean", lambda Y: Y.mean(), [np.array([[1, 2]], np.uint8)], {}).text)
    small_Y = np.array([[1, 2]], dtype=np.uint8)
    mean(small_Y)
    """
    names = _parameter_names(function, len(args))
    inputs: list[str] = []
    written: list[str] = []
    for parameter, value in [*zip(names, args, strict=True), *kwargs.items()]:
        if isinstance(value, np.ndarray) and value.ndim:
            text = VARIABLE_PREFIX + parameter
            inputs += _write_assignments(text, value)
        else:
            text = write_value(value)
        written.append(text if len(written) < len(args) else f"{parameter}={text}")
    return Snippet(inputs=tuple(inputs), call=f"{name}({', '.join(written)})")


def _parameter_names(function: Callable[..., Any], count: int) -> list[str]:
    names = list(inspect.signature(function).parameters)[:count]
    return names + [f"argument_{k}" for k in range(len(names), count)]


def write_value(value: Any) -> str:
    """Return an argument as an expression with the same value and type."""
    if isinstance(value, np.ndarray):
        return _write_array(value)
    if isinstance(value, list | tuple):
        items = ", ".join(write_value(item) for item in value)
        if isinstance(value, list):
            return f"[{items}]"
        return f"({items},)" if len(value) == 1 else f"({items})"
    if isinstance(value, np.generic):
        return write_value(value.item())
    if isinstance(value, float) and not np.isfinite(value):
        return f"np.float64('{value}')"
    return repr(value)


def _write_array(array: np.ndarray) -> str:
    """Return an array as an expression. Of long tables, those that are known have a short one."""
    kind = str(array.dtype.newbyteorder("="))
    suffix = "" if kind in PLAIN_TYPES else f", dtype=np.{kind}"
    first = _write_number(array.flat[0])
    if array.size > 4 and (array == array.flat[0]).all():
        shape = array.shape[0] if array.ndim == 1 else array.shape
        return f"np.full({shape}, {first}{suffix})"
    if array.size > MAX_LISTED_VALUES:
        short = _write_table(array)
        if short:
            return short if not suffix else f"({short}).astype(np.{kind})"
    return f"np.array({_write_rows(array)}{suffix})"


def _write_table(array: np.ndarray) -> str:
    """Return a long table (n,) or (n, channels) as a short expression, or ""."""
    n = len(array)
    if array.ndim == 1:
        texts = [f"np.arange({n})", f"np.minimum(np.arange({n}), {n - 1} - np.arange({n}))"]
        if array.dtype.kind == "f":
            texts = [f"1.0 * {texts[0]}", f"np.linspace(0, 1, {n})", f"1.0 * {texts[1]}"]
        for text, table in zip(texts, shrinking.simple_tables(array), strict=True):
            if np.array_equal(table.astype(array.dtype), array):
                return text
    line = np.linspace(array[0], array[-1], n)
    if array.dtype == np.float64 and array.ndim <= 2 and np.array_equal(line, array):
        return f"np.linspace({_write_rows(array[0])}, {_write_rows(array[-1])}, {n})"
    return ""


def _write_assignments(name: str, array: np.ndarray) -> list[str]:
    """Return the lines that set a variable to an array; of a nearly constant one, the exceptions."""
    if array.size <= MIN_SPARSE_VALUES or np.isnan(array).any():
        return [f"{name} = {write_value(array)}"]
    values, counts = np.unique(array, return_counts=True)
    common = values[counts.argmax()]
    places = np.argwhere(array != common)
    if len(places) == 0 or len(places) > array.size * MAX_SPARSE_FRACTION:
        return [f"{name} = {write_value(array)}"]
    lines = [f"{name} = {_write_array(np.full_like(array, common))}"]
    for place in places:
        number = _write_number(array[tuple(place)])
        lines.append(f"{name}[{', '.join(str(int(i)) for i in place)}] = {number}")
    return lines


def _write_rows(array: np.ndarray) -> str:
    if array.ndim == 0:
        return _write_number(array[()])
    return f"[{', '.join(_write_rows(row) for row in array)}]"


def _write_number(number: Any) -> str:
    """Return the shortest text that is read as the same number of the same type."""
    if isinstance(number, np.floating):
        if not np.isfinite(number):
            return f"np.{number}"
        text = str(number)
        return text if any(sign in text for sign in ".e") else f"{text}.0"
    return repr(number.item())


def show(value: Any) -> str:
    """Return an answer as a reader wants it: numbers with 6 digits, small arrays as lists."""
    if isinstance(value, tuple):
        return f"({', '.join(show(item) for item in value)})"
    if isinstance(value, list):
        return f"[{', '.join(show(item) for item in value)}]"
    if isinstance(value, np.ndarray | np.generic | int | float):
        return _show_array(np.asarray(value))
    return repr(value)[:MAX_TEXT_CHARACTERS]


def _show_array(array: np.ndarray) -> str:
    if array.size > MAX_SHOWN_NUMBERS or not array.size:
        return f"an array of shape {array.shape}"
    if array.ndim:
        return f"[{', '.join(_show_array(row) for row in array)}]"
    if array.dtype.kind == "f":
        return f"{float(array):.6g}"
    return str(array.item())[:MAX_TEXT_CHARACTERS]
