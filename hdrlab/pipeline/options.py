"""The options of `assemble`, and the values that each of them may have."""

from collections.abc import Callable
from dataclasses import dataclass

from hdrlab.core import weights
from hdrlab.core.arrays import F64
from hdrlab.core.choices import require_choice
from hdrlab.pipeline.assembly import Method
from hdrlab.radiance.merge import METHODS

MERGES = tuple(METHODS)
TIMES = ("correct", "stated", "estimate")
GHOSTS = ("none", "auto", "regions", "reference")
FLARE = ("none", "glare")

WeightFunction = Callable[[F64], F64]


def _hat(g: F64) -> F64:
    return weights.hat(len(g))


def _gaussian(g: F64) -> F64:
    return weights.gaussian(len(g))


def _flat(g: F64) -> F64:
    return weights.flat(len(g))


# Each function returns the weight of each pixel value, (n,), for a response g.
WEIGHTS: dict[str, WeightFunction] = {
    "hat": _hat,
    "gaussian": _gaussian,
    "flat": _flat,
    "snr": weights.snr,
}


@dataclass(frozen=True, kw_only=True)
class Options:
    """The options of `assemble`, which documents them; the constructor checks their values."""

    align: Method
    response: Method
    weight: str
    merge: str
    times: str
    ghosts: str
    flare: str
    in_place: bool
    release: bool

    def __post_init__(self) -> None:
        require_choice("weight", self.weight, WEIGHTS)
        require_choice("merge", self.merge, MERGES)
        require_choice("times", self.times, TIMES)
        require_choice("ghosts", self.ghosts, GHOSTS)
        require_choice("flare", self.flare, FLARE)
