"""What lies about in a workshop, each thing with its foot or its middle at the origin."""

import numpy as np

from scenes.models.shapes import Parts, ball, box, extrude, hull, lathe, placed, sheet, tube, turned


def handsaw() -> Parts:
    """Return a saw in the plane z = 0, its handle to the left."""
    blade = hull(
        [
            (x, y, z)
            for z in (-0.001, 0.001)
            for x, y in ((0, -0.06), (0.55, -0.015), (0.55, 0.035), (0, 0.07))
        ]
    )
    grip = [
        tube(
            [
                (-0.02, 0.07, 0),
                (-0.09, 0.05, 0),
                (-0.11, 0.0, 0),
                (-0.08, -0.05, 0),
                (-0.01, -0.06, 0),
            ],
            0.018,
        ),
        box((-0.03, -0.07, -0.012), (0.05, 0.08, 0.012)),
    ]
    return [("steel", blade), *(("handle", each) for each in grip)]


def hammer() -> Parts:
    """Return a hammer that hangs by its head."""
    head = tube([(-0.07, 0, 0), (-0.02, 0, 0), (0.04, 0, 0)], [0.019, 0.016, 0.017])
    claw = hull(
        [
            (0.03, 0.012, -0.012),
            (0.03, 0.012, 0.012),
            (0.03, -0.012, -0.012),
            (0.03, -0.012, 0.012),
            (0.1, -0.035, -0.016),
            (0.1, -0.035, 0.016),
        ]
    )
    return [
        ("iron", head),
        ("iron", claw),
        (
            "handle",
            tube([(-0.01, 0.01, 0), (-0.01, -0.15, 0), (-0.01, -0.3, 0)], [0.012, 0.011, 0.016]),
        ),
    ]


def chisel(length: float) -> Parts:
    """Return a chisel that hangs with its edge down."""
    blade = hull(
        [
            (x, y, z)
            for z in (-0.002, 0.002)
            for x, y in ((-0.009, 0), (0.009, 0), (0.011, -length), (-0.011, -length))
        ]
    )
    return [
        ("steel", blade),
        (
            "handle",
            lathe(
                [(0, 0.13), (0.014, 0.125), (0.017, 0.08), (0.012, 0.02), (0.009, 0.0)], sides=12
            ),
        ),
    ]


def square() -> Parts:
    """Return a try square."""
    return [
        ("handle", box((-0.015, -0.16, -0.01), (0.015, 0.02, 0.01))),
        ("steel", box((0.0, -0.015, -0.0015), (0.26, 0.02, 0.0015), bevel=0.0004)),
    ]


def smoother() -> Parts:
    """Return a hand plane 24 cm long, along x."""
    body = extrude(
        [(-0.12, 0), (0.12, 0), (0.12, 0.035), (0.05, 0.055), (-0.09, 0.05), (-0.12, 0.03)], 0.062
    )
    knob = lathe([(0, 0.055), (0.018, 0.05), (0.02, 0.035), (0.01, 0.012), (0.016, 0.0)], sides=14)
    iron = placed(
        box((-0.002, 0, -0.024), (0.002, 0.13, 0.024), bevel=0.0005),
        (0.0, 0.03, 0),
        turned(32, "z"),
    )
    tote = tube([(-0.085, 0.04, 0), (-0.09, 0.085, 0), (-0.105, 0.125, 0)], [0.018, 0.014, 0.016])
    return [
        ("iron", body),
        ("handle", placed(knob, (0.085, 0.045, 0))),
        ("steel", iron),
        ("handle", tote),
    ]


def vise() -> Parts:
    """Return a bench vise: two jaws, a slide, and the bar that turns its screw."""
    parts: Parts = [
        ("iron", box((-0.11, 0.0, -0.1), (0.11, 0.03, 0.1))),
        ("iron", box((-0.1, 0.03, -0.1), (0.1, 0.17, -0.03), bevel=0.015)),
    ]
    parts += [
        ("iron", box((-0.1, 0.05, 0.02), (0.1, 0.17, 0.08), bevel=0.015)),
        ("iron", box((-0.04, 0.04, -0.06), (0.04, 0.09, 0.16))),
    ]
    parts += [
        ("steel", tube([(0, 0.07, 0.1), (0, 0.07, 0.16), (0, 0.07, 0.22)], 0.016)),
        ("steel", tube([(-0.1, 0.11, 0.215), (0, 0.07, 0.215), (0.1, 0.03, 0.215)], 0.007)),
    ]
    return parts


def mallet() -> Parts:
    """Return a wooden mallet, lying with its handle along x."""
    return [
        ("beech", box((-0.05, 0, -0.09), (0.05, 0.1, 0.09), bevel=0.012)),
        (
            "handle",
            tube([(0.04, 0.05, 0), (0.2, 0.045, 0), (0.33, 0.04, 0)], [0.015, 0.013, 0.017]),
        ),
    ]


def jar(height: float, radius: float, filling: str) -> Parts:
    """Return a jar with a lid, full of something."""
    body = [
        (0, height),
        (radius * 0.8, height),
        (radius, height * 0.86),
        (radius, 0.01),
        (radius * 0.9, 0.0),
        (0, 0),
    ]
    lid = placed(
        lathe([(0, 0.022), (radius * 0.84, 0.022), (radius * 0.86, 0.0)], sides=20), (0, height, 0)
    )
    return [(filling, lathe(body, sides=20)), ("tin", lid)]


def tin(height: float, radius: float, paint: str) -> Parts:
    """Return a tin of paint."""
    rim = [
        (radius * 0.9, height - 0.006),
        (radius, height),
        (radius * 1.02, height - 0.004),
        (radius, height - 0.008),
    ]
    label = placed(
        lathe([(radius * 1.004, height * 0.8), (radius * 1.004, height * 0.2)]), (0, 0, 0)
    )
    can = lathe([(0, height - 0.006), *rim, (radius, 0.006), (radius * 0.98, 0), (0, 0)])
    return [("tin", can), (paint, label)]


def stool() -> Parts:
    """Return a stool with four legs."""
    parts: Parts = [
        (
            "beech",
            lathe(
                [(0, 0.5), (0.16, 0.5), (0.175, 0.49), (0.175, 0.47), (0.16, 0.46), (0, 0.46)],
                sides=40,
            ),
        )
    ]
    for k in range(4):
        a = np.pi / 4 + k * np.pi / 2
        foot = np.array([0.19 * np.cos(a), 0.0, 0.19 * np.sin(a)])
        parts.append(
            (
                "beech",
                tube(
                    [foot, foot * 0.8 + (0, 0.24, 0), foot * 0.6 + (0, 0.47, 0)],
                    [0.017, 0.021, 0.018],
                ),
            )
        )
    for k in range(2):
        d = 0.145 * np.array(
            [np.cos(np.pi / 4 + k * np.pi / 2), 0, np.sin(np.pi / 4 + k * np.pi / 2)]
        )
        parts.append(
            (
                "beech",
                tube(
                    [
                        d + (0, 0.2 + 0.05 * k, 0),
                        (0, 0.2 + 0.05 * k, 0),
                        -d + (0, 0.2 + 0.05 * k, 0),
                    ],
                    0.011,
                ),
            )
        )
    return parts


def shaving(rng: np.random.Generator) -> Parts:
    """Return a curl of wood as a plane leaves it."""
    turns = rng.uniform(0.7, 2.2)
    radius = rng.uniform(0.012, 0.026)
    a = np.linspace(0, 2 * np.pi * turns, 18)
    r = radius * (1 + 0.12 * a / 6)
    along = rng.uniform(0.0, 0.05) * a / a[-1]
    edge = np.column_stack([r * np.cos(a) + along, r * np.sin(a) + radius, along * 0.3])
    return [("shaving", sheet(np.stack([edge, edge + (0, 0, rng.uniform(0.012, 0.03))])))]


def sawhorse() -> Parts:
    """Return a trestle along x."""
    parts: Parts = [("pine", box((-0.5, 0.58, -0.04), (0.5, 0.66, 0.04)))]
    for x in (-0.4, 0.4):
        for side in (-1, 1):
            leg = placed(
                box((-0.035, -0.66, -0.018), (0.035, 0, 0.018)),
                (x, 0.64, 0),
                turned(-side * 17, "x"),
            )
            parts.append(("pine", leg))
        parts.append(("pine", box((x - 0.012, 0.24, -0.15), (x + 0.012, 0.31, 0.15))))
    return parts


def lantern() -> Parts:
    """Return an enamelled shade with its bulb, hanging from a cord 3 m long; the bulb is at the origin."""
    shade = [
        (0.03, 0.16),
        (0.04, 0.14),
        (0.06, 0.1),
        (0.17, 0.03),
        (0.2, -0.02),
        (0.197, -0.022),
        (0.165, 0.022),
        (0.05, 0.09),
        (0.028, 0.13),
    ]
    parts: Parts = [
        ("enamel", lathe(shade, sides=40)),
        ("iron", tube([(0, 0.15, 0), (0, 1.5, 0), (0, 3, 0)], 0.006, sides=6)),
    ]
    return [
        *parts,
        ("bulb", ball((0, 0, 0), (0.033, 0.042, 0.033))),
        ("iron", lathe([(0, 0.15), (0.02, 0.15), (0.02, 0.035), (0, 0.035)], sides=14)),
    ]
