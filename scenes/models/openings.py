"""Walls with windows and doors in them, as masons would build them.

u, v   places in a wall, metres: along it, and up
top    v of the upper edge of an opening at u: an arch
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from scenes.models.shapes import Mesh, merge, placed, sheet

Float = NDArray[np.float64]
# metres by which one piece of a wall overlaps the next, so that no line of sight slips through
TUCK = 1e-4


class Opening(NamedTuple):
    """A hole in a wall, metres: its middle u, its width, sill and springing v, and the rise of its arch.

    An arch is pointed, or else half an ellipse; a round window has it below its springing as well
    as above.
    """

    middle: float
    width: float
    sill: float
    spring: float
    rise: float = 0.0
    pointed: bool = True
    round: bool = False

    def widened(self, by: float) -> "Opening":
        """Return the opening larger by so much on each side."""
        rise = self.rise + by if self.rise else 0.0
        spring = self.spring if self.rise else self.spring + by
        return self._replace(
            width=self.width + 2 * by, sill=self.sill - by, spring=spring, rise=rise
        )


def top(opening: Opening, u: Float) -> Float:
    """Return the upper edge: two arcs that meet in a point, one half ellipse, or a straight lintel."""
    s = np.clip(np.abs(u - opening.middle) / (opening.width / 2), 0, 1)
    if not opening.pointed:
        return opening.spring + opening.rise * np.sqrt(1 - s**2)
    # An arc about a centre on the springing line, beyond the middle: it meets its mirror image in a
    # point.
    half = opening.width / 2
    rise = max(opening.rise, 1e-9)
    radius = (half**2 + rise**2) / (2 * half)
    x = s * half + radius - half
    arch = np.sqrt(np.maximum(radius**2 - x**2, 0)) if opening.rise else np.zeros_like(x)
    return opening.spring + arch


def bottom(opening: Opening, u: Float) -> Float:
    """Return the lower edge: a sill, or that of a round window."""
    return 2 * opening.spring - top(opening, u) if opening.round else np.full_like(u, opening.sill)


def across(opening: Opening, arc: int = 24) -> Float:
    """Return places u (arc + 1,) from left to right over an opening, closer where an arch is steep."""
    return opening.middle - opening.width / 2 * np.cos(np.linspace(0, np.pi, arc + 1))


def outline(opening: Opening, arc: int = 24) -> Float:
    """Return the edge of an opening (n, 2): up its left side, along the arch, and down again."""
    u = across(opening, arc)
    edge, below = (np.column_stack([u, each(opening, u)]) for each in (top, bottom))
    return (
        np.concatenate([edge, below[::-1]])
        if opening.round
        else np.concatenate([below[:1], edge, below[-1:]])
    )


def wall(
    width: tuple[float, float],
    height: tuple[float, float],
    openings: list[Opening],
    thick: float,
    splay: float = 0.0,
) -> Mesh:
    """Return a wall in the plane z = 0, seen from +z, with reveals that go back to z = -thick.

    The openings are `splay` wider in front than behind.
    """
    front = [opening.widened(splay) for opening in sorted(openings)]
    pieces = []
    at = width[0]
    floor = height[0]
    ceiling = height[1] + TUCK
    for wide, narrow in zip(front, sorted(openings), strict=True):
        u = across(wide)
        pieces.append(flat(np.array([at - TUCK, u[0] + TUCK]), floor, ceiling))
        pieces.append(flat(u, floor, bottom(wide, u)))
        pieces.append(flat(u, top(wide, u), ceiling))
        pieces.append(reveal(wide, narrow, thick))
        at = u[-1]
    return merge([*pieces, flat(np.array([at - TUCK, width[1]]), floor, ceiling)])


def flat(u: Float, low: Float | float, high: Float | float) -> Mesh:
    """Return the part of a wall between two edges over u."""
    uv = np.stack([np.column_stack([u, np.broadcast_to(edge, len(u))]) for edge in (low, high)])
    return sheet(np.concatenate([uv, np.zeros((2, len(u), 1))], axis=2), uv)


def reveal(front: Opening, back: Opening, thick: float) -> Mesh:
    """Return the sides of an opening, from its edge in front to its edge behind."""
    a = outline(front)
    b = outline(back)
    ring = np.stack(
        [np.column_stack([b, np.full(len(b), -thick)]), np.column_stack([a, np.zeros(len(a))])]
    )
    sides = sheet(ring, sharp=True)
    return (
        sides
        if front.round
        else merge([sides, sheet(np.stack([ring[1, [0, -1]], ring[0, [0, -1]]]))])
    )


def pane(opening: Opening, z: float = 0.0) -> Mesh:
    """Return what fills an opening; uv goes from 0 to 1 over the rectangle around it."""
    u = across(opening)
    edge = np.stack(
        [np.column_stack([u, bottom(opening, u)]), np.column_stack([u, top(opening, u)])]
    )
    low = edge.reshape(-1, 2).min(axis=0)
    high = edge.reshape(-1, 2).max(axis=0)
    return sheet(
        np.concatenate([edge, np.full((2, len(u), 1), z)], axis=2), (edge - low) / (high - low)
    )


def facing_right(mesh: Mesh, x: float) -> Mesh:
    """Return a wall moved to the left side of a room: u, which was to the right, runs towards -z."""
    R = np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]], float)
    return placed(mesh, (x, 0, 0), R)


def facing_left(mesh: Mesh, x: float) -> Mesh:
    """Return a wall moved to the right side of a room: u, which was to the right, runs towards +z."""
    R = np.array([[0, 0, -1], [0, 1, 0], [1, 0, 0]], float)
    return placed(mesh, (x, 0, 0), R)
