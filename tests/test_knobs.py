"""What a knob is when nobody sets it: `knobs.txt` has every number, and a change of one is made on purpose.

A default is part of every picture made with it, and so is a number with a name in a module, or a
field of a state that need not be given: `constants.txt`. `python tests/test_knobs.py` writes both
lists anew.
"""

import ast
import dataclasses
import inspect
import pkgutil
from importlib import import_module
from pathlib import Path

import recorded

import hdrlab

LIST = Path(__file__).with_name("knobs.txt")
CONSTANTS = Path(__file__).with_name("constants.txt")
# of this machine
NOT_LISTED = {"PROCESSORS", "THREADS"}
ROOMS = (
    "align",
    "beyond",
    "calibration",
    "capture",
    "core",
    "diagnostics",
    "enhance",
    "fast",
    "pipeline",
)
ROOMS += ("radiance", "response", "tonemap")


def modules():
    """Yield the lessons' modules."""
    for module in pkgutil.walk_packages(hdrlab.__path__, "hdrlab."):
        if module.name.split(".")[1] in ROOMS:
            yield module


def knobs():
    """Yield a line for each public function of the lessons with numbers as defaults."""
    for module in modules():
        if "._" in module.name:
            continue
        for name, function in sorted(vars(import_module(module.name)).items()):
            if (
                inspect.isfunction(function)
                and function.__module__ == module.name
                and name[0] != "_"
            ):
                parameters = inspect.signature(function).parameters.values()
                numbers = [
                    one for one in parameters if isinstance(one.default, (int, float, tuple))
                ]
                if numbers:
                    said = ", ".join(f"{one.name}={one.default}" for one in numbers)
                    yield f"{module.name.removeprefix('hdrlab.')}.{name}: {said}"


def test_every_knob_stands_where_its_list_says():
    assert "\n".join(knobs()) == LIST.read_text(encoding="utf8").strip()


def constants():
    """Yield a line for each constant of a module, and for each field or method with values of its own."""
    for info in modules():
        module = import_module(info.name)
        for name in sorted(named(Path(module.__file__).read_text(encoding="utf8"))):
            yield told(f"{info.name}.{name}", getattr(module, name))
        for name, one in sorted(vars(module).items()):
            if inspect.isclass(one) and one.__module__ == info.name:
                for field, value in fields(one):
                    yield told(f"{info.name}.{name}.{field}", value)
            elif inspect.isfunction(one) and one.__module__ == info.name and name[0] == "_":
                yield from (told(f"{info.name}.{name}.{k}", value) for k, value in defaults(one))


def named(text):
    """Yield the names that a module gives to values in capitals."""
    for statement in ast.parse(text).body:
        targets = (
            statement.targets
            if isinstance(statement, ast.Assign)
            else [getattr(statement, "target", None)]
        )
        for node in (node for target in targets if target is not None for node in ast.walk(target)):
            if isinstance(node, ast.Name) and node.id.isupper() and node.id not in NOT_LISTED:
                yield node.id


def fields(one):
    """Yield the fields of a class that have values, and what its methods take if nothing is given."""
    if dataclasses.is_dataclass(one):
        yield from ((field.name, field.default) for field in dataclasses.fields(one))
    yield from getattr(one, "_field_defaults", {}).items()
    for name, method in sorted(vars(one).items()):
        if inspect.isfunction(method) and not hasattr(one, "_fields"):
            yield from ((f"{name}.{k}", value) for k, value in defaults(method))


def defaults(function):
    """Yield the parameters of a function that have values."""
    for one in inspect.signature(function).parameters.values():
        if one.default is not inspect.Parameter.empty:
            yield one.name, one.default


def told(name, value):
    """Return a line of words."""
    try:
        words = "; ".join(" ".join(part) for part in recorded.parts(value))
    except TypeError:
        words = type(value).__name__
    return f"{name.removeprefix('hdrlab.')} = {words}"


def test_every_constant_stands_where_its_list_says():
    lists = [*constants()], CONSTANTS.read_text(encoding="utf8").splitlines()
    came, listed = ([line.partition(" = ")[::2] for line in one] for one in lists)
    assert [name for name, _ in came] == [name for name, _ in listed]
    for (name, now), (_, then) in zip(came, listed, strict=True):
        a, b = ([part.split() for part in words.split(";")] for words in (now, then))
        assert recorded.same(a, b, 1e-7, floor=0), f"{name} is {now}, and was {then}"


if __name__ == "__main__":
    LIST.write_text("\n".join(knobs()) + "\n", encoding="utf8")
    CONSTANTS.write_text("\n".join(constants()) + "\n", encoding="utf8")
