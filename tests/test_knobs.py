"""What a knob is when nobody sets it: `knobs.txt` has every number, and a change of one is made on purpose.

A default is part of every picture made with it. `python tests/test_knobs.py` writes the list anew.
"""

import inspect
import pkgutil
from importlib import import_module
from pathlib import Path

import hdrlab

LIST = Path(__file__).with_name("knobs.txt")
ROOMS = ("align", "beyond", "calibration", "capture", "core", "diagnostics", "enhance", "fast", "pipeline")
ROOMS += ("radiance", "response", "tonemap")


def knobs():
    """Yield a line for each public function of the lessons with numbers as defaults."""
    for module in pkgutil.walk_packages(hdrlab.__path__, "hdrlab."):
        if module.name.split(".")[1] not in ROOMS or "._" in module.name:
            continue
        for name, function in sorted(vars(import_module(module.name)).items()):
            if inspect.isfunction(function) and function.__module__ == module.name and name[0] != "_":
                parameters = inspect.signature(function).parameters.values()
                numbers = [one for one in parameters if isinstance(one.default, (int, float, tuple))]
                if numbers:
                    said = ", ".join(f"{one.name}={one.default}" for one in numbers)
                    yield f"{module.name.removeprefix('hdrlab.')}.{name}: {said}"


def test_every_knob_stands_where_its_list_says():
    assert "\n".join(knobs()) == LIST.read_text(encoding="utf8").strip()


if __name__ == "__main__":
    LIST.write_text("\n".join(knobs()) + "\n", encoding="utf8")
