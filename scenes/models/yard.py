"""A yard in the sun: grass, a tree in blossom, a shed, washing on a line, and clouds over all of it."""

import numpy as np
from numpy.typing import NDArray

from scenes.models import surfaces
from scenes.models.shapes import Parts, ball, box, placed, quad, sheet, tube, turned


def yard() -> Parts:
    """Return the yard: grass, a path, a wall, a white shed, a tree in blossom, and washing on a line."""
    rng = np.random.default_rng(6)
    parts: Parts = [
        ("grass", quad((-40, -0.25, -4.8), (40, -0.25, -4.8), (40, -0.25, -70), (-40, -0.25, -70))),
        (
            "gravel path",
            sheet(
                [
                    [(0.4, -0.24, -5), (1.7, -0.24, -5)],
                    [(-0.2, -0.24, -9), (1.0, -0.24, -9)],
                    [(-2.2, -0.24, -13.8), (-1.2, -0.24, -13.8)],
                ]
            ),
        ),
        ("yard wall", box((-20, -0.3, -14.4), (-2.3, 1.55, -14.0), bevel=0.03)),
        ("yard wall", box((-1.1, -0.3, -14.4), (20, 1.55, -14.0), bevel=0.03)),
        ("whitewash", box((1.7, -0.3, -11.2), (5.5, 2.0, -8.0), bevel=0.02)),
        (
            "roof",
            sheet(
                [
                    [(1.5, 1.95, -7.8), (1.5, 1.95, -11.4)],
                    [(3.6, 3.3, -7.8), (3.6, 3.3, -11.4)],
                    [(5.7, 1.95, -7.8), (5.7, 1.95, -11.4)],
                ],
                sharp=True,
            ),
        ),
        (
            "whitewash",
            sheet([[(1.7, 1.9, -8.0), (5.5, 1.9, -8.0)], [(3.6, 3.2, -8.0), (3.6, 3.2, -8.0)]]),
        ),
        ("sash", box((1.66, 0.5, -9.4), (1.72, 1.3, -8.8))),
        ("bark", box((1.65, -0.25, -10.7), (1.71, 1.5, -9.9))),
        ("sky", quad((-90, -4, -75), (90, -4, -75), (90, 36, -75), (-90, 36, -75), unit_uv=True)),
    ]
    trunk = [(-3.1, -0.3, -10.2), (-3.05, 0.8, -10.2), (-2.95, 1.7, -10.3), (-2.7, 2.6, -10.3)]
    parts.append(("bark", tube(trunk, [0.22, 0.17, 0.14, 0.09])))
    crowns = [
        (-2.6, 2.7, -10.3, 1.25),
        (-3.7, 2.4, -10.0, 1.0),
        (-1.8, 2.3, -10.2, 0.8),
        (-3.0, 3.5, -10.6, 1.1),
    ]
    for cx, cy, cz, r in crowns:
        parts.append(
            (
                "bark",
                tube(
                    [trunk[2], ((trunk[2][0] + cx) / 2, (1.8 + cy) / 2, -10.2), (cx, cy, cz)],
                    [0.09, 0.06, 0.03],
                    sides=8,
                ),
            )
        )
        parts += foliage((cx, cy, cz), r, int(900 * r), rng)
    for x in np.arange(-19, 20, 1.7):
        at = (x + rng.uniform(-0.5, 0.5), 0.7 + rng.uniform(0, 0.9), -16.5 - rng.uniform(0, 3))
        parts.append(("hill", ball(at, (1.5, 1.3 + rng.uniform(0, 0.9), 1.3), sides=14)))
    for k in range(60):
        x = rng.uniform(-7, -1.2)
        z = -13.7 + rng.uniform(-0.2, 0.25)
        parts.append(
            (
                ("blossom", "geranium", "sunflower")[k % 3],
                ball((x, rng.uniform(-0.05, 0.5), z), 0.06, sides=8),
            )
        )
        parts.append(("leaves", ball((x + 0.1, -0.1, z), (0.16, 0.2, 0.12), sides=8)))
    return parts + washing()


def foliage(
    middle: tuple[float, float, float], radius: float, count: int, rng: np.random.Generator
) -> Parts:
    """Return leaves and blossoms all about a point."""
    parts: Parts = []
    for k in range(count):
        d = rng.standard_normal(3)
        at = np.array(middle) + radius * d / np.linalg.norm(d) * rng.uniform(0.55, 1.0)
        size = 0.085 if k % 3 else 0.06
        leaf = sheet(
            size * np.array([[(-1, -0.6, 0), (1, -0.6, 0)], [(-1, 0.6, 0.2), (1, 0.6, 0.2)]])
        )
        R = turned(float(rng.uniform(0, 360))) @ turned(float(rng.uniform(-80, 80)), "x")
        parts.append(("leaves" if k % 3 else "blossom", placed(leaf, at, R)))
    return parts


def washing() -> Parts:
    """Return linen on a line between two posts."""
    parts: Parts = [
        ("bark", tube([(x, -0.3, z), (x, 0.8, z), (x, 1.72, z)], 0.035))
        for x, z in ((-2.2, -7.6), (1.2, -9.2))
    ]
    s = np.linspace(0, 1, 12)
    line = np.column_stack([-2.2 + 3.4 * s, 1.66 - 0.35 * s * (1 - s), -7.6 - 1.6 * s])
    parts.append(("sash", tube(line, 0.006, sides=5)))
    for start, wide, long, cloth in (
        (0.12, 0.2, 0.85, "cloth"),
        (0.36, 0.1, 0.5, "blue"),
        (0.5, 0.22, 0.95, "cloth"),
        (0.77, 0.09, 0.45, "red"),
    ):
        t = start + wide * np.linspace(0, 1, 14)
        top = np.column_stack([-2.2 + 3.4 * t, 1.65 - 0.35 * t * (1 - t), -7.6 - 1.6 * t])
        hem = top + np.column_stack([0 * t, -long + 0 * t, 0.07 * np.sin(t * 60)])
        parts.append((cloth, sheet(np.stack([hem, 0.5 * (hem + top) + (0, 0, 0.03), top]))))
    return parts


def sky(size: int = 512) -> NDArray[np.float64]:
    """Return the radiance of the sky over the yard, cd/m^2: blue, paler low down, with clouds."""
    height = np.linspace(1, 0, size)[:, None, None]
    blue = (
        np.array([1500.0, 2900.0, 6200.0]) * (0.6 + 0.4 * height)
        + np.array([3200.0, 3100.0, 2600.0]) * (1 - height) ** 2
    )
    puffs = surfaces.noise((size, size), ((26, 40), (11, 17), (5, 8), (2, 3)), seed=12)
    share = np.clip(1.1 * puffs + 0.35 - 0.5 * height[..., 0], 0, 1)[..., None] ** 1.3
    shade = np.clip(0.75 + 0.25 * np.roll(puffs, -6, axis=0), 0.5, 1.1)[..., None]
    return blue * (1 - share) + share * shade * np.array([13_500.0, 13_000.0, 12_200.0])
