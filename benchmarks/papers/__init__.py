"""Published experiments, run again: every module of this folder that has ROWS, a paper each."""

from importlib import import_module
from pkgutil import iter_modules

from benchmarks.experiments import Experiment

MODULES = [import_module(f"{__name__}.{module.name}") for module in iter_modules(__path__)]
ROWS: tuple[Experiment, ...] = tuple(
    row for module in MODULES for row in getattr(module, "ROWS", ())
)
