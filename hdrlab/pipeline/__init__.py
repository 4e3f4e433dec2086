"""Where the chapters meet: a bracket of photos becomes a radiance map, and the map a picture.

Each name is imported from its module when it is first used, so that the command line starts
quickly.
"""

import warnings
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hdrlab.pipeline.assembly import Assembly, Method
    from hdrlab.pipeline.camera_noise import measure_camera_noise
    from hdrlab.pipeline.camera_noise_file import read_camera_noise, write_camera_noise
    from hdrlab.pipeline.certainty import measure_deviation
    from hdrlab.pipeline.options import WEIGHTS
    from hdrlab.pipeline.pictures import (
        develop,
        develop_and_describe,
        find_operator,
        find_view_transform,
        resolve_settings,
    )
    from hdrlab.pipeline.registration import align_bracket, apply_alignment
    from hdrlab.pipeline.stages import (
        STAGES,
        assemble,
        assemble_steps,
        calibrate,
    )
    from hdrlab.pipeline.timing import space_by_stops

__all__ = [
    "STAGES",
    "WEIGHTS",
    "Assembly",
    "Method",
    "align_bracket",
    "apply_alignment",
    "assemble",
    "assemble_steps",
    "calibrate",
    "develop",
    "develop_and_describe",
    "find_operator",
    "find_view_transform",
    "measure_camera_noise",
    "measure_deviation",
    "read_camera_noise",
    "resolve_settings",
    "space_by_stops",
    "write_camera_noise",
]

# The module of each public name.
_MODULES = {
    "Assembly": "assembly",
    "Method": "assembly",
    "measure_camera_noise": "camera_noise",
    "read_camera_noise": "camera_noise_file",
    "write_camera_noise": "camera_noise_file",
    "measure_deviation": "certainty",
    "WEIGHTS": "options",
    "develop": "pictures",
    "develop_and_describe": "pictures",
    "find_operator": "pictures",
    "find_view_transform": "pictures",
    "resolve_settings": "pictures",
    "align_bracket": "registration",
    "apply_alignment": "registration",
    "STAGES": "stages",
    "assemble": "stages",
    "assemble_steps": "stages",
    "calibrate": "stages",
    "space_by_stops": "timing",
}

# The new name of each deprecated one.
_DEPRECATED = {
    "aligned": "align_bracket",
    "moved": "apply_alignment",
    "settle": "resolve_settings",
}


def __getattr__(name: str) -> Any:
    if name in _DEPRECATED:
        new_name = _DEPRECATED[name]
        warnings.warn(
            f"hdrlab.pipeline.{name} is deprecated; use {new_name}",
            DeprecationWarning,
            stacklevel=2,
        )
        name = new_name
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = import_module(f"{__name__}.{_MODULES[name]}")
    return getattr(module, name)


def __dir__() -> list[str]:
    return sorted({*globals(), *_MODULES})
