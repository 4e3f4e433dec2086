"""Where the chapters meet: a bracket of photographs -> a radiance map -> a picture.

Its functions are loaded when they are first used, so that the command line lists the methods at
once.
"""

from importlib import import_module
from typing import Any

PLACES = {
    "assembly": ("Assembly", "Method"),
    "certainty": ("measure_deviation",),
    "pictures": ("develop", "develop_and_describe", "find_operator", "settle"),
    "registration": ("aligned", "moved"),
    "stages": ("CONTRADICTION", "STAGES", "WEIGHTS", "assemble", "assemble_steps", "calibrate"),
    "timing": ("space_by_stops",),
}


def __getattr__(name: str) -> Any:
    for module, names in PLACES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{module}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
