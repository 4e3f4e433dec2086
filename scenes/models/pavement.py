"""What stands on a pavement: lamps, a bicycle, tubs with bushes, bollards."""

import numpy as np

from scenes.models.shapes import Parts, ball, hull, lathe, placed, put, sheet, tube, turned

KERB = 2.35


def lamp_post(at: tuple[float, float, float]) -> Parts:
    """Return a street lamp: a cast post, a lantern of four panes in a frame, and the bulb inside it."""
    post = [
        (0.0, 3.3),
        (0.035, 3.3),
        (0.04, 3.2),
        (0.07, 3.16),
        (0.045, 3.1),
        (0.05, 1.3),
        (0.085, 1.24),
        (0.06, 1.16),
        (0.075, 0.5),
        (0.12, 0.42),
        (0.13, 0.12),
        (0.17, 0.08),
        (0.17, 0.0),
    ]
    parts: Parts = [
        ("iron", lathe(post, sides=20)),
        ("iron", tube([(-0.3, 3.02, 0), (0, 3.02, 0), (0.3, 3.02, 0)], 0.016, sides=8)),
    ]
    low = 0.13
    high = 0.21
    for sx in (-1, 1):
        for sz in (-1, 1):
            parts.append(
                (
                    "iron",
                    tube(
                        [
                            (sx * low, 3.34, sz * low),
                            (sx * 0.17, 3.55, sz * 0.17),
                            (sx * high, 3.78, sz * high),
                        ],
                        0.011,
                        sides=6,
                    ),
                )
            )
    for y, r in ((3.34, low), (3.78, high)):
        for turn in range(4):
            bar = tube([(-r, y, r), (0, y, r), (r, y, r)], 0.013, sides=6)
            parts.append(("iron", placed(bar, turn=turned(90 * turn))))
    cap = hull(
        [(sx * 0.25, 3.79, sz * 0.25) for sx in (-1, 1) for sz in (-1, 1)]
        + [(sx * 0.07, 3.98, sz * 0.07) for sx in (-1, 1) for sz in (-1, 1)]
    )
    finial = lathe([(0, 4.14), (0.02, 4.1), (0.035, 4.06), (0.015, 4.02), (0.05, 3.98)], sides=14)
    bulb = ball((0, 3.56, 0), (0.055, 0.075, 0.055), sides=16)
    return put(
        [
            *parts,
            ("iron", cap),
            ("iron", finial),
            ("bulb", bulb),
            ("brass", lathe([(0.02, 3.5), (0.025, 3.34)], sides=10)),
        ],
        at,
        turn=12,
    )


def bicycle() -> Parts:
    """Return a bicycle that leans on a wall, along x."""
    parts: Parts = []
    angle = np.linspace(0, 2 * np.pi, 41)
    for x in (0, 1.05):
        rim = np.column_stack([x + 0.33 * np.cos(angle), 0.34 + 0.33 * np.sin(angle), 0 * angle])
        parts.append(("rubber", tube(rim, 0.018, sides=8)))
        for k in range(12):
            a = k * np.pi / 6
            parts.append(
                (
                    "steel",
                    tube(
                        [(x, 0.34, 0), (x + 0.32 * np.cos(a), 0.34 + 0.32 * np.sin(a), 0)],
                        0.0025,
                        sides=4,
                    ),
                )
            )
    joints = {
        "rear": (0, 0.34, 0),
        "front": (1.05, 0.34, 0),
        "pedal": (0.45, 0.3, 0),
        "seat": (0.3, 0.85, 0),
        "head": (0.88, 0.86, 0),
    }
    for one, other in (
        ("rear", "pedal"),
        ("rear", "seat"),
        ("seat", "pedal"),
        ("pedal", "head"),
        ("seat", "head"),
        ("head", "front"),
    ):
        parts.append(("frame", tube([joints[one], joints[other]], 0.016, sides=8)))
    parts.append(("rubber", ball((0.28, 0.92, 0), (0.13, 0.035, 0.06), sides=12)))
    return [
        *parts,
        ("steel", tube([(0.8, 1.0, -0.25), (0.9, 0.98, 0), (0.8, 1.0, 0.25)], 0.012, sides=8)),
        ("steel", tube([(0.88, 0.86, 0), (0.9, 0.98, 0)], 0.012)),
    ]


def furniture() -> Parts:
    """Return what stands in the street: lamps, a bicycle, planters, bollards, bunting's wires."""
    parts: Parts = []
    for x, z in ((-2.75, -3.6), (2.75, -11.5), (-2.75, -18.5), (2.75, -26.5)):
        parts += lamp_post((x, 0, z))
    parts += put(bicycle(), (3.3, 0.01, -3.2), turn=90)
    tub = lathe([(0, 0.42), (0.24, 0.42), (0.27, 0.45), (0.27, 0.4), (0.22, 0.0), (0, 0)])
    rng = np.random.default_rng(3)
    for x, z in ((-3.25, -2.2), (-3.25, -8.1), (3.25, -10.0)):
        parts.append(("clay", placed(tub, (x, 0, z))))
        for _ in range(170):
            d = rng.standard_normal(3)
            at = np.array((x, 0.8, z)) + 0.36 * d / np.linalg.norm(d) * rng.uniform(0.6, 1)
            leaf = sheet(
                0.05 * np.array([[(-1, -0.6, 0), (1, -0.6, 0)], [(-1, 0.6, 0.2), (1, 0.6, 0.2)]])
            )
            parts.append(
                (
                    "leaves",
                    placed(
                        leaf,
                        at,
                        turned(float(rng.uniform(0, 360)))
                        @ turned(float(rng.uniform(-80, 80)), "x"),
                    ),
                )
            )
    for z in (-7.0, -9.0, -15.0, -17.0):
        parts.append(
            (
                "iron",
                placed(
                    lathe(
                        [
                            (0, 0.85),
                            (0.05, 0.83),
                            (0.06, 0.75),
                            (0.045, 0.7),
                            (0.06, 0.05),
                            (0.09, 0.0),
                        ]
                    ),
                    (2.55, 0, z),
                ),
            )
        )
    return parts
