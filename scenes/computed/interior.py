"""The radiance of a room with a window, along lines of sight.

E    radiance (3, N), cd/m^2
P    points (3, N), metres: x to the right, y up, z ahead; the camera stands at z = 0
d    directions of sight (3, N), d_z = 1
w    width (N,) that a pixel covers on a surface, metres
rho  reflectance (3, N), 0 to 1

A room is a box seen from inside: each line of sight leaves it through one face, and goes on where
that face has a hole. A matt face returns rho F L, summed over window, sun, lamp and the other walls
(see `light`).
"""

from collections.abc import Callable
from functools import partial

import numpy as np

from hdrlab.core.arrays import Mask, NDArray
from scenes.computed.frames import hang, margin
from scenes.computed.garden import EYE_HEIGHT, SUN, SUN_RADIUS, outside, sky
from scenes.computed.illumination import Box, facing, from_globe, from_walls, from_window, length
from scenes.computed.textures import Points, cover, look_up, rgb, within

LEFT, RIGHT, FLOOR, CEILING, FRONT, BACK = range(6)

EYE = rgb(0.1, EYE_HEIGHT, 0)
ROOM = Box((-2.5, 0, -2), (2.5, 2.9, 4.6))
WINDOW = Box(
    (-0.95, 0.1, 4.6), (1.45, 2.5, 4.85)
)  # a hole in the back wall, with the panes at its far side
DOOR = Box((-2.15, 0, 4.6), (-1.3, 2.1, 4.6))
CELLAR = Box((-3.3, 0, 4.6), (-0.9, 2.5, 6.4))  # the unlit room behind the door
BULB = rgb(1.95, 2.0, 3.7)
BULB_RADIUS = 0.11

SKYLIGHT = rgb(900, 1050, 1300)  # the window as the room sees it, cd/m^2
WALLS = rgb(13, 11.5, 10)  # the walls as they see one another, cd/m^2
SUNBEAM = rgb(0.85, 0.68, 0.45)  # the F of the sun, and its colour at the ground
LAMPLIGHT = rgb(1, 0.72, 0.4)
PAINT = rgb(0.7, 0.68, 0.62)


def brick(P: Points, w: Points) -> Points:
    """Return rho of a brick wall."""
    x, y, z = P
    return look_up(
        "brick", y / 1.2, (x + z) / 1.2, w / 1.2
    )  # the picture shows its courses upright


def left(P: Points, w: Points) -> Points:
    """Return rho of the left wall."""
    return cover(brick(P, w) * rgb(1.5, 0.85, 0.62), within(0.09 - P[1], w), PAINT)


def right(P: Points, w: Points) -> Points:
    """Return rho of the right wall, with its picture."""
    _, y, z = P
    rho = hang(rgb(0.3, 0.4, 0.42), "coffee", 4.25 - z, 1.95 - y, 1.2, 0.8, w)
    return cover(rho, within(0.09 - y, w), PAINT)


def back(P: Points, w: Points) -> Points:
    """Return rho of the wall around the window and the door."""
    x, y, _ = P
    rho = hang(rgb(0.55, 0.5, 0.41), "astronaut", x - 1.68, 1.9 - y, 0.66, 0.66, w)
    rho = cover(rho, within(0.09 - y, w), PAINT)
    for hole in (WINDOW, DOOR):
        rho = cover(rho, within(inside(P, hole) + 0.07, w), PAINT)
    return rho


def floor(P: Points, w: Points, tile: float = 0.5) -> Points:
    """Return rho of a floor of dark and light tiles."""
    x, _, z = P
    waves = (np.abs(2 * (a / (2 * tile) % 1) - 1) - 0.5 for a in (x, z))
    column, row = (np.clip(wave * 4 * tile / w, -1, 1) for wave in waves)
    shade = cover(rgb(0.25, 0.22, 0.23), 0.5 - 0.5 * column * row, rgb(1.25, 1.2, 1.1))
    return look_up("gravel", x / 1.1, z / 1.1, w / 1.1) * shade


def ceiling(P: Points, w: Points) -> Points:
    """Return rho of a whitewashed ceiling."""
    return rgb(0.75, 0.75, 0.72)


MATERIALS = {LEFT: left, RIGHT: right, FLOOR: floor, CEILING: ceiling, BACK: back}


def inside(P: Points, hole: Box) -> Points:
    """Return how far points of the back wall lie inside a hole of it; below 0 outside."""
    (x0, y0, _), (x1, y1, _) = hole
    return margin(P[0] - x0, P[1] - y0, x1 - x0, y1 - y0)


def panes(P: Points, d: Points, blur: Points | float) -> Points:
    """Return the share of the light from P along d that passes the window's bars, their edges `blur` wide."""
    (x0, y0, _), (x1, y1, z) = WINDOW
    Q = P + (z - P[2]) * d
    share = within(inside(Q, WINDOW) - 0.05, blur)
    for q, low, size in ((Q[0], x0, (x1 - x0) / 4), (Q[1], y0, (y1 - y0) / 4)):
        share = share * within(np.abs((q - low + size / 2) % size - size / 2) - 0.03, blur)
    return share


def wall(face: int, P: Points, d: Points, w: Points, sun: float, lamp: float) -> Points:
    """Return E of a face of the room: rho F L over its lights, and the sky in the polished floor."""
    cos = np.abs(facing(d, face)) / length(d)
    depth = WINDOW.high[2] - P[2]
    E = SKYLIGHT * from_window(P, face, WINDOW) + WALLS * from_walls(P, ROOM)
    E += LAMPLIGHT * lamp * from_globe(P, face, BULB, BULB_RADIUS)
    if facing(SUN, face) > 0:
        E += SUNBEAM * sun * facing(SUN, face) * panes(P, SUN, 0.01 + SUN_RADIUS / 2 * depth)
    E *= MATERIALS[face](P, w / np.sqrt(cos))
    if face == FLOOR:
        up = d * rgb(1, -1, 1)
        fresnel = 0.04 + 0.96 * (1 - cos) ** 5  # [Schlick94 eq. 15]
        E += 0.1 * fresnel * panes(P, up, 0.02 + 0.1 * depth) * sky(up, 0.01, sun)
    return E


def through_window(P: Points, d: Points, w: Points, pixel: float, sun: float) -> Points:
    """Return E of the window: the sides of its hole, its bars, and the garden."""
    t, face = leave(P, d, WINDOW)
    _, _, z = P + t * d
    side = rgb(300, 340, 400) * (0.35 + 0.65 * (z - 4.6) / 0.25)
    garden = cover(rgb(36, 35, 31), panes(P, d, w), outside(d, pixel, sun))
    return np.where(face == BACK, garden, side)


def through_door(P: Points, d: Points, w: Points) -> Points:
    """Return E of the unlit room: bricks, a floor and a cat, all but lost in the dark."""
    t, face = leave(P, d, CELLAR)
    w = w * (1 + t / P[2])
    x, y, z = P = P + t * d
    bricks = brick(P, w) * rgb(0.9, 0.8, 0.7)
    cat = hang(bricks, "chelsea", x + 2.82, 1.65 - y, 0.75, 0.5, w)
    rho = np.where(face == BACK, cat, np.where(face == FLOOR, look_up("gravel", x, z, w), bricks))
    return rho * rgb(20, 21, 25) / (1 + (x + 1.7) ** 2 + (y - 0.2) ** 2 + (z - 4.6) ** 2) ** 1.5


def hang_lamp(E: Points, d: Points, pixel: float, lamp: float) -> Points:
    """Return E with the lamp before it: a globe, brightest in the middle, on its cord."""
    across, above, z = BULB - EYE
    x = d[0] * z - across
    y = d[1] * z - above
    away = np.hypot(x, y) / BULB_RADIUS
    globe = 15 + lamp * LAMPLIGHT * (
        0.6 + 0.4 * np.sqrt(np.maximum(1 - away**2, 0))
    )  # 15: the glass, unlit
    blur = 2 * pixel * z
    E = cover(E, within(0.012 - np.abs(x), blur) * (y > 0), 2.0)
    return cover(E, within((1 - away) * BULB_RADIUS, blur), globe)


def leave(P: Points, d: Points, box: Box) -> tuple[Points, NDArray[np.int_]]:
    """Return t, how far along d each P inside a box leaves it, and the face through which it does."""
    with np.errstate(
        divide="ignore", invalid="ignore"
    ):  # along an axis, the other faces are infinitely far
        t = np.abs((np.where(d > 0, rgb(*box.high), rgb(*box.low)) - P) / d)
    axis = np.nanargmin(t, axis=0)
    each = np.arange(d.shape[1])
    return t[axis, each], 2 * axis + (d[axis, each] > 0)


def trace(d: Points, pixel: float, sun: float, lamp: float) -> Points:
    """Return E (3, N) of the room along lines of sight, `pixel` wide at z = 1."""
    t, face = leave(EYE, d, ROOM)
    P = EYE + t * d
    w = pixel * t
    window, door = ((face == BACK) & (inside(P, hole) > 0) for hole in (WINDOW, DOOR))
    parts: list[tuple[Mask, Callable[..., Points]]]
    parts = [
        ((face == k) & ~window & ~door, partial(wall, k, sun=sun, lamp=lamp)) for k in MATERIALS
    ]
    parts += [(window, partial(through_window, pixel=pixel, sun=sun)), (door, through_door)]
    E = np.empty_like(d)
    for part, radiance in parts:
        at = np.flatnonzero(part)
        E[:, at] = radiance(P[:, at], d[:, at], w[at])
    return hang_lamp(E, d, pixel, lamp)
