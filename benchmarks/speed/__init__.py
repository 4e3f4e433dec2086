"""How fast, beside whom: every module of this folder that has ROWS, in the order of their names."""

from importlib import import_module
from pkgutil import iter_modules

from benchmarks.rows import Row

MODULES = [import_module(f"{__name__}.{module.name}") for module in iter_modules(__path__)]
ROWS: tuple[Row, ...] = tuple(row for module in MODULES for row in getattr(module, "ROWS", ()))
