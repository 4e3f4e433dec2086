"""The furniture of a joiner's workshop: bench, tool board, shelves, trestles, and what lies about on them."""

import numpy as np

from scenes.models import tools
from scenes.models.shapes import Parts, ball, box, placed, put, turned

# the walls at which it stands, metres
BACK = -4.4
LEFT = -3.0


def bench() -> Parts:
    """Return the bench before the window, with the work and the tools on it."""
    x0 = -2.35
    x1 = 1.05
    z0 = BACK + 0.1
    z1 = BACK + 0.86
    y = 0.88
    parts: Parts = []
    for k in range(4):
        z = z0 + k * (z1 - z0) / 4
        parts.append(("beech", box((x0, y - 0.075, z), (x1, y, z + (z1 - z0) / 4 - 0.004))))
    for x in (x0 + 0.12, (x0 + x1) / 2, x1 - 0.12):
        for z in (z0 + 0.08, z1 - 0.08):
            parts.append(("beech", box((x - 0.05, 0, z - 0.05), (x + 0.05, y - 0.075, z + 0.05))))
        parts.append(("beech", box((x - 0.03, 0.22, z0), (x + 0.03, 0.3, z1))))
    parts.append(("pine", box((x0 + 0.1, 0.3, z0), (x1 - 0.1, 0.33, z1))))
    for k, x in enumerate((-1.9, -1.35, 0.2, 0.62)):
        parts += put(
            [(("oak", "pine")[k % 2], box((-0.2, 0, -0.15), (0.2, 0.2 + 0.05 * k, 0.15)))],
            (x, 0.33, z0 + 0.35),
            turn=9 * k,
        )
    on = [
        (tools.vise(), (-1.75, y, z1 - 0.1), 0),
        (tools.smoother(), (-0.35, y, z1 - 0.25), 24),
        (tools.mallet(), (0.4, y, z1 - 0.3), 205),
        (put(tools.square(), (0, 0, 0), turn=-90, axis="x"), (-1.0, y + 0.012, z1 - 0.17), 35),
        (tools.jar(0.16, 0.05, "amber"), (0.82, y, z0 + 0.2), 0),
        (tools.tin(0.12, 0.055, "red"), (0.66, y, z0 + 0.3), 0),
        (tools.jar(0.11, 0.042, "cream"), (0.95, y, z0 + 0.32), 0),
    ]
    for thing, at, turn in on:
        parts += put(thing, at, turn=turn)
    parts.append(("pine", box((-1.1, y, z1 - 0.52), (0.1, y + 0.045, z1 - 0.38))))
    rng = np.random.default_rng(8)
    for _ in range(26):
        parts += put(
            tools.shaving(rng),
            (rng.uniform(-1.0, 0.3), y, rng.uniform(z0 + 0.3, z1 - 0.03)),
            turn=float(rng.uniform(0, 360)),
        )
    for _ in range(90):
        parts += put(
            tools.shaving(rng),
            (rng.normal(-0.3, 0.75), 0, rng.normal(z1 + 0.45, 0.3)),
            turn=float(rng.uniform(0, 360)),
        )
    return parts


def toolboard() -> Parts:
    """Return the tools on the wall to the right of the window."""
    z = BACK + 0.02
    parts: Parts = [("pine", box((1.08, 1.05, BACK), (2.86, 2.35, z)))]
    for x, y, turn in ((1.2, 2.1, -8), (1.25, 1.83, -4), (1.3, 1.6, 0)):
        parts += put(tools.handsaw(), (x + 0.1, y, z + 0.03), turn=turn, axis="z")
    for k, x in enumerate(np.linspace(2.05, 2.7, 7)):
        parts += put(tools.chisel(0.14 + 0.015 * k), (x, 2.08, z + 0.04))
    parts.append(("beech", box((1.98, 2.05, z), (2.78, 2.07, z + 0.08))))
    for k, x in enumerate((2.1, 2.32, 2.52, 2.72)):
        parts += put(
            tools.hammer() if k != 2 else tools.square(),
            (x, 1.72, z + 0.04),
            turn=4 * k - 6,
            axis="z",
        )
    parts.append(("beech", box((1.15, 1.18, z), (2.8, 1.2, z + 0.16))))
    for k, x in enumerate(np.linspace(1.25, 2.7, 8)):
        made = (
            tools.jar(0.12 + 0.02 * (k % 3), 0.045, ("amber", "cream", "green")[k % 3])
            if k % 4
            else tools.smoother()
        )
        parts += put(made, (x, 1.2, z + 0.09))
    parts.append(("oak", box((1.25, 0, BACK), (2.75, 0.82, BACK + 0.5), bevel=0.012)))
    for k in range(6):
        x = 1.32 + 0.48 * (k % 3)
        y = 0.1 + 0.36 * (k // 3)
        parts.append(
            ("beech", box((x, y, BACK + 0.5), (x + 0.4, y + 0.3, BACK + 0.515), bevel=0.006))
        )
        parts.append(("brass", ball((x + 0.2, y + 0.17, BACK + 0.53), 0.018, sides=10)))
    return parts


def shelves() -> Parts:
    """Return the shelves on the left wall, and the timber that leans beside them."""
    rng = np.random.default_rng(4)
    x = LEFT
    parts = []
    for y in (0.55, 1.0, 1.45, 1.9):
        parts.append(("pine", box((x, y - 0.03, -3.5), (x + 0.34, y, -1.25))))
        z = -3.42
        while z < -1.4:
            kind = rng.integers(0, 4)
            radius = rng.uniform(0.045, 0.085)
            paint = ("red", "blue", "cream", "green", "amber")[rng.integers(0, 5)]
            if kind == 0:
                wide = rng.uniform(0.16, 0.3)
                parts.append(
                    (
                        ("oak", "pine", "clay")[rng.integers(0, 3)],
                        box((x + 0.05, y, z), (x + 0.3, y + rng.uniform(0.12, 0.28), z + wide)),
                    )
                )
            elif kind == 1:
                wide = 2 * radius
                parts += put(
                    tools.jar(rng.uniform(0.12, 0.24), radius * 0.9, paint),
                    (x + 0.18, y, z + radius),
                )
            else:
                wide = 2.1 * radius
                parts += put(
                    tools.tin(rng.uniform(0.1, 0.2), radius, paint), (x + 0.18, y, z + radius)
                )
            z += wide + rng.uniform(0.015, 0.08)
    for z in (-3.5, -2.4, -1.28):
        parts.append(("pine", box((x, 0, z - 0.02), (x + 0.32, 2.15, z + 0.02))))
    for k in range(7):
        board = box((-0.012, 0, -0.08), (0.012, 2.3 + 0.06 * (k % 3), 0.08))
        parts.append(
            (
                ("pine", "oak", "beech")[k % 3],
                placed(board, (x + 0.3 + 0.05 * k, 0, -0.95 + 0.06 * (k % 4)), turned(9 + k, "z")),
            )
        )
    return parts


def middle() -> Parts:
    """Return what stands on the floor: trestles with a board, a stool, a broom, a bucket."""
    parts = put(tools.sawhorse(), (1.35, 0, -2.05), turn=68) + put(
        tools.sawhorse(), (2.05, 0, -0.75), turn=72
    )
    board = box((-1.25, 0.66, -0.13), (1.25, 0.7, 0.13))
    parts += put([("oak", board)], (1.66, 0, -1.4), turn=-63) + put(
        tools.smoother(), (1.5, 0.7, -1.7), turn=110
    )
    parts += put(tools.stool(), (-0.95, 0, -2.35), turn=20)
    parts += put(tools.lantern(), (0.55, 2.0, -2.9))
    rng = np.random.default_rng(3)
    for _ in range(26):
        parts += put(
            tools.shaving(rng),
            (rng.normal(1.2, 0.35), 0, rng.normal(-1.3, 0.4)),
            turn=float(rng.uniform(0, 360)),
        )
    bucket = [("tin", placed(tools.tin(0.26, 0.14, "tin")[0][1], scale=(1, 1, 1)))]
    return parts + put(bucket, (-2.15, 0, -1.9))
