"""What stands and hangs in a chapel: pews, candles on their stands, a ring of lights, a lamp."""

import numpy as np

from scenes.models.shapes import (
    Mesh,
    Parts,
    ball,
    box,
    extrude,
    lathe,
    placed,
    put,
    sheet,
    tube,
    turned,
)

ALTAR = -15.0  # z of the wall behind the altar, metres


def pew() -> Parts:
    """Return a pew 2 m long, its back to +z: seat, back, ends with rounded tops, a shelf for books."""
    t = np.linspace(0, np.pi, 9)
    top = np.column_stack([0.13 * np.cos(t), 0.98 + 0.1 * np.sin(t)])
    lower = extrude([(0.27, 0), (0.27, 0.52), (-0.26, 0.52), (-0.26, 0)], 0.055)
    upper = extrude(np.concatenate([[(0.24, 0.5)], top, [(-0.02, 0.5)]]), 0.055)
    parts: Parts = []
    for x in (-1.0, 1.0):
        parts += put([("oak", lower), ("oak", upper)], (x, 0, 0), turn=-90)
    seat = box((-1, 0.42, -0.24), (1, 0.46, 0.16))
    back = placed(box((-1, 0, -0.018), (1, 0.5, 0.018)), (0, 0.46, 0.15), turned(9, "x"))
    rail = tube([(-1, 0.97, 0.232), (0, 0.97, 0.232), (1, 0.97, 0.232)], 0.026)
    shelf = box((-1, 0.68, 0.2), (1, 0.7, 0.36))
    kneeler = box((-0.95, 0.1, 0.42), (0.95, 0.16, 0.58), bevel=0.02)
    parts += [("oak", seat), ("oak", back), ("oak", rail), ("oak", shelf), ("leather", kneeler)]
    rng = np.random.default_rng(5)
    for x in (-0.7, -0.15, 0.55):
        book = placed(
            box((-0.06, 0, -0.085), (0.06, 0.035, 0.085)),
            (x, 0.7, 0.28),
            turned(float(rng.uniform(-20, 20))),
        )
        parts.append(("book", book))
    return parts


def candle(height: float, radius: float) -> Parts:
    """Return a burning candle that stands at the origin."""
    wax = lathe(
        [(0, height), (radius * 0.8, height), (radius, height - 0.006), (radius, 0)], sides=14
    )
    return [("wax", wax), ("flame", placed(flame(), (0, height + 0.012, 0)))]


def flame() -> Mesh:
    """Return a flame 6 cm high."""
    profile = [
        (0.0, 0.062),
        (0.003, 0.05),
        (0.0075, 0.033),
        (0.011, 0.018),
        (0.0095, 0.007),
        (0.0, 0.0),
    ]
    return lathe(profile, sides=8)


def lamp() -> Parts:
    """Return the red lamp that hangs before the altar."""
    bowl = [(0.075, 0.13), (0.085, 0.1), (0.08, 0.04), (0.045, 0.0), (0.0, -0.01)]
    parts: Parts = [
        ("ruby", lathe(bowl)),
        ("brass", placed(lathe([(0.09, 0.02), (0.09, 0.0)]), (0, 0.12, 0))),
    ]
    parts.append(("brass", placed(ball((0, -0.03, 0), 0.03), (0, 0, 0))))
    for a in np.arange(3) * 2 * np.pi / 3:
        parts.append(
            (
                "brass",
                tube([(0.088 * np.cos(a), 0.13, 0.088 * np.sin(a)), (0, 0.6, 0)], 0.004, sides=5),
            )
        )
    parts.append(("brass", tube([(0, 0.6, 0), (0, 4.6, 0)], 0.005, sides=5)))
    return put(parts, (-1.3, 2.95, -11.9))


def votives() -> Parts:
    """Return a stand of small candles, some of them burnt down."""
    rng = np.random.default_rng(11)
    parts: Parts = []
    for row in range(4):
        y = 0.78 + 0.13 * row
        z = -0.17 * row
        parts.append(("iron", box((-0.5, y - 0.02, z - 0.06), (0.5, y, z + 0.06), bevel=0.004)))
        for x in np.linspace(-0.42, 0.42, 8):
            at = (x + rng.uniform(-0.01, 0.01), y, z)
            cup = placed(lathe([(0.03, 0.035), (0.026, 0.0), (0.0, 0.0)], sides=14), at)
            parts.append(("cup", cup))
            height = float(rng.uniform(0.03, 0.11))
            parts += put(
                candle(height, 0.017)
                if rng.random() < 0.72
                else [("wax", candle(height, 0.017)[0][1])],
                at,
            )
    for x in (-0.48, 0.48):
        for z, y in ((0.04, 0.78), (-0.55, 1.17)):
            parts.append(("iron", tube([(x, 0, z), (x, y / 2, z), (x, y, z)], 0.014, sides=8)))
    return put(parts, (-2.05, 0, -0.55), turn=38)


def corona() -> Parts:
    """Return a ring of iron with candles, which hangs in the nave."""
    parts: Parts = []
    angle = np.linspace(0, 2 * np.pi, 49)
    for y, r in ((0, 0.02), (0.12, 0.014)):
        parts.append(
            (
                "iron",
                tube(
                    np.column_stack(
                        [0.8 * np.cos(angle), np.full_like(angle, y), 0.8 * np.sin(angle)]
                    ),
                    r,
                ),
            )
        )
    for k, a in enumerate(np.arange(12) * np.pi / 6):
        at = np.array([0.8 * np.cos(a), 0.1, 0.8 * np.sin(a)])
        parts.append(("iron", tube([at * (1, 0, 1), at], 0.012, sides=6)))
        parts.append(("iron", placed(lathe([(0.05, 0.02), (0.02, 0.0), (0.0, 0.0)], sides=14), at)))
        parts += put(candle(0.17 - 0.02 * (k % 3), 0.016), at + (0, 0.01, 0))
        if k % 3 == 0:
            parts.append(("iron", tube([at, (0, 1.1, 0)], 0.006, sides=5)))
    parts.append(("iron", tube([(0, 1.1, 0), (0, 4.0, 0)], 0.008, sides=6)))
    return put(parts, (0.15, 3.75, -6.6), turn=8)


def sanctuary() -> Parts:
    """Return steps, the altar with its cloth and candles, the panel behind it, and the lamp above."""
    parts: Parts = [
        (
            "pale",
            box(
                (-3.2 + 0.3 * k, 0.16 * k, ALTAR),
                (3.2 - 0.3 * k, 0.16 * (k + 1), -10.9 - 0.42 * k),
                bevel=0.015,
            ),
        )
        for k in range(3)
    ]
    parts.append(("carpet", box((-0.75, 0.481, -14.2), (0.75, 0.489, -11.8))))
    parts.append(("carpet", box((-0.62, 0.002, -10.8), (0.62, 0.01, 2.9))))
    parts.append(("stone", box((-1.15, 0.48, -14.0), (1.15, 1.42, -13.2), bevel=0.02)))
    parts.append(("pale", box((-1.25, 1.42, -14.05), (1.25, 1.5, -13.12), bevel=0.02)))
    x = np.linspace(-1.0, 1.0, 90)
    fold = 0.012 * np.sin(x * 23) + 0.008 * np.sin(x * 41 + 1)
    hem = np.stack(
        [
            np.column_stack([x, np.full_like(x, y), -13.1 + s * fold + 0.01])
            for y, s in ((0.86, 1.6), (1.2, 0.9), (1.506, 0.1))
        ]
    )
    parts += [
        ("linen", sheet(hem)),
        ("linen", box((-1.0, 1.5, -14.0), (1.0, 1.51, -13.1), bevel=0.003)),
    ]
    parts += [
        (
            "gilt",
            extrude(
                [
                    (-1.0, 0),
                    (1.0, 0),
                    (1.0, 0.42),
                    (0.5, 0.5),
                    (0, 0.62),
                    (-0.5, 0.5),
                    (-1.0, 0.42),
                ],
                0.08,
            ),
        )
    ]
    parts[-1:] = put(parts[-1:], (0, 1.42, -14.15))
    stick = [
        (0.0, 0.42),
        (0.05, 0.42),
        (0.055, 0.4),
        (0.016, 0.37),
        (0.014, 0.22),
        (0.032, 0.2),
        (0.014, 0.18),
        (0.016, 0.08),
        (0.07, 0.03),
        (0.075, 0.0),
    ]
    for side in (-1, 1):
        for k, high in enumerate((0.3, 0.24, 0.2)):
            at = (side * (0.42 + 0.24 * k), 1.51, -13.75)
            parts += [
                ("brass", placed(lathe(stick, sides=16), at)),
                *put(candle(high, 0.018), np.add(at, (0, 0.42, 0))),
            ]
    cross = [
        box((-0.02, 0, -0.02), (0.02, 0.62, 0.02)),
        box((-0.17, 0.36, -0.02), (0.17, 0.4, 0.02)),
    ]
    parts += put([("brass", each) for each in cross], (0, 1.51, -13.8))
    return parts + lamp()
