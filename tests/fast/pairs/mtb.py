"""Brackets for `fast.mtb`: moved photographs of one scene, two stops apart."""

from pairs import photographs


def bracket(kind, rng):
    images = photographs(kind, rng, frames=4)
    bits = int(rng.integers(1, 5))
    return (images,), {"bits": bits, "luma": bool(rng.integers(2))}


PAIRS = {"align": (bracket, 0)}
