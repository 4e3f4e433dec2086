"""Somebody who walks, somebody who stands, and a cat."""

import numpy as np

from scenes.models.shapes import Parts, ball, hull, lathe, placed, put, sheet, tube


def head() -> Parts:
    """Return a head on its neck, whose foot is at the origin; it looks along +z."""
    return [
        ("skin", tube([(0, -0.02, 0), (0, 0.06, 0.01), (0, 0.1, 0.02)], [0.06, 0.055, 0.05])),
        ("skin", ball((0, 0.2, 0.02), (0.078, 0.115, 0.095))),
        ("skin", ball((0, 0.19, 0.112), (0.014, 0.022, 0.02), sides=10)),
        ("hair", ball((0, 0.235, -0.005), (0.088, 0.1, 0.103))),
    ]


def coat(cloth: str, hem: float) -> Parts:
    """Return a coat from the shoulders at 1.45 m to its hem."""
    profile = [
        (0.0, 1.475),
        (0.09, 1.47),
        (0.185, 1.425),
        (0.215, 1.36),
        (0.2, 1.2),
        (0.185, 1.05),
        (0.205, 0.9),
        (0.25, hem),
        (0.225, hem - 0.005),
    ]
    return [(cloth, placed(lathe(profile, sides=32), scale=(1.0, 1, 0.68)))]


def leg(cloth: str, hip: float, swing: float, bend: float) -> Parts:
    """Return a leg and its shoe; `swing` degrees forward at the hip, `bend` at the knee."""
    a = np.radians(swing)
    b = np.radians(swing - bend)
    top = np.array([hip, 0.9, 0])
    knee = top + 0.43 * np.array([0, -np.cos(a), np.sin(a)])
    ankle = knee + 0.41 * np.array([0, -np.cos(b), np.sin(b)])
    toe = ankle + 0.2 * np.array([0, -0.2 - 0.5 * np.sin(max(-b, 0)), 1])
    return [
        (
            cloth,
            tube(
                [top, (top + knee) / 2, knee, (knee + ankle) / 2, ankle],
                [0.095, 0.085, 0.066, 0.06, 0.048],
            ),
        ),
        (
            "hair",
            tube(
                [ankle + (0, -0.02, -0.03), (ankle + toe) / 2 + (0, -0.01, 0), toe],
                [0.045, 0.046, 0.034],
            ),
        ),
    ]


def arm(cloth: str, side: int, swing: float, bend: float) -> Parts:
    """Return an arm, its hand, `swing` degrees forward at the shoulder, `bend` at the elbow."""
    a = np.radians(swing)
    b = np.radians(swing + bend)
    shoulder = np.array([side * 0.19, 1.39, 0])
    elbow = shoulder + 0.29 * np.array([side * 0.14, -np.cos(a), np.sin(a)])
    hand = elbow + 0.27 * np.array([-side * 0.03, -np.cos(b), np.sin(b)])
    return [
        (
            cloth,
            tube(
                [shoulder, (shoulder + elbow) / 2, elbow, (elbow + hand) / 2, hand],
                [0.075, 0.066, 0.057, 0.052, 0.045],
            ),
        ),
        ("skin", ball(hand + 0.05 * (hand - elbow) / 0.27, (0.034, 0.05, 0.042), sides=12)),
    ]


def standing(cloth: str, trousers: str) -> Parts:
    """Return somebody who stands on the origin and looks along +z."""
    parts = put(head(), (0, 1.46, 0)) + coat(cloth, 0.62)
    for side in (-1, 1):
        parts += leg(trousers, side * 0.09, 2.0 * side, 3) + arm(cloth, side, 8, 22)
    return parts


def walking(cloth: str, trousers: str) -> Parts:
    """Return somebody who walks along +z under an umbrella."""
    parts = put(head(), (0, 1.46, 0.03)) + coat(cloth, 0.6)
    parts += leg(trousers, -0.09, 27, 6) + leg(trousers, 0.09, -16, 24)
    parts += arm(cloth, -1, -24, 18) + arm(cloth, 1, 18, 95)
    return parts + put(umbrella(), (0.23, 1.2, 0.3), turn=-8, axis="x")


def umbrella() -> Parts:
    """Return an open umbrella, its grip at the origin."""
    count = 8
    rim = 0.56
    angle = np.linspace(0, -2 * np.pi, 65)
    sag = 0.05 * np.abs(np.sin(angle * count / 2))
    s = np.linspace(0, 1, 12)
    r = (
        rim
        * np.sin(s * 1.25)[:, None]
        / np.sin(1.25)
        * (1 - 0.07 * np.abs(np.sin(angle * count / 2)) * s[:, None])
    )
    y = 0.98 - 0.26 * s[:, None] ** 2 + sag * s[:, None] ** 3
    P = np.stack([r * np.cos(angle), np.broadcast_to(y, r.shape), r * np.sin(angle)], axis=2)
    ribs: Parts = []
    for k in range(count):
        a = 2 * np.pi * k / count
        tips = [
            (rr * np.cos(a), yy - 0.006, rr * np.sin(a))
            for rr, yy in zip(
                rim * np.sin(s * 1.25) / np.sin(1.25), 0.98 - 0.26 * s**2, strict=True
            )
        ]
        ribs.append(("steel", tube(tips, 0.004, sides=5)))
    return [
        ("umbrella", sheet(P)),
        *ribs,
        ("steel", tube([(0, -0.02, 0), (0, 0.5, 0), (0, 1.06, 0)], 0.008, sides=8)),
    ]


def cat() -> Parts:
    """Return a cat that sits on the origin and looks along +z."""
    fur: Parts = [
        (
            "fur",
            tube(
                [(0, 0.09, -0.1), (0, 0.12, -0.06), (0, 0.2, 0), (0, 0.27, 0.045), (0, 0.31, 0.06)],
                [0.085, 0.1, 0.085, 0.062, 0.05],
            ),
        ),
        ("fur", ball((0, 0.36, 0.085), (0.056, 0.05, 0.055))),
        ("fur", ball((0, 0.345, 0.13), (0.026, 0.02, 0.022), sides=12)),
    ]
    for side in (-1, 1):
        ear = hull([(0, 0, -0.008), (0, 0, 0.008), (0.038, 0, 0), (0.012, 0.05, 0)])
        fur.append(
            (
                "fur",
                placed(ear, (side * 0.012, 0.395, 0.085), scale=(side, 1, 1))
                if side > 0
                else placed(ear, (-0.055, 0.395, 0.085)),
            )
        )
        fur.append(
            (
                "fur",
                tube(
                    [
                        (side * 0.035, 0.2, 0.06),
                        (side * 0.036, 0.1, 0.085),
                        (side * 0.036, 0.02, 0.09),
                    ],
                    [0.035, 0.024, 0.02],
                ),
            )
        )
        fur.append(("fur", ball((side * 0.036, 0.016, 0.108), (0.022, 0.017, 0.032), sides=10)))
        fur.append(("fur", ball((side * 0.075, 0.075, -0.06), (0.05, 0.075, 0.085))))
        fur.append(("fur", ball((side * 0.08, 0.018, 0.02), (0.025, 0.018, 0.05), sides=10)))
        fur.append(("eye", ball((side * 0.024, 0.368, 0.132), (0.009, 0.01, 0.007), sides=8)))
    bow = np.linspace(0, 2.6, 16)
    tail = np.column_stack(
        [0.1 + 0.07 * np.sin(bow), 0.022 + 0.0 * bow, -0.17 + 0.13 * (1 - np.cos(bow))]
    )
    fur.append(
        ("fur", tube(np.concatenate([[(0, 0.04, -0.17)], tail]), np.linspace(0.026, 0.016, 17)))
    )
    return fur
