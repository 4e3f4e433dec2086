"""Where the chapters meet: a bracket of photographs -> a radiance map -> a picture.

Its functions are loaded when they are first used, so that the command line lists the methods at once.
"""

from importlib import import_module
from typing import Any

PLACES = {
    "Assembly": "assembly",
    "Method": "assembly",
    "aligned": "registration",
    "moved": "registration",
    "assemble": "stages",
    "assemble_steps": "stages",
    "STAGES": "stages",
    "WEIGHTS": "stages",
    "CONTRADICTION": "stages",
    "develop": "pictures",
    "own_saturation": "pictures",
}
__all__ = list(PLACES)  # names, all of them


def __getattr__(name: str) -> Any:
    if name not in PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{PLACES[name]}"), name)
