"""A shop in the front of a house: a wide lit window, an awning, a sign."""

import numpy as np

from scenes.models.houses import RIGHT, house
from scenes.models.openings import Opening, facing_left, pane, wall
from scenes.models.shapes import Parts, box, lathe, placed, put, sheet, tube


def shop(start: float) -> Parts:
    """Return a shop on the right: a wide lit window with goods on its sill, an awning and a sign."""
    u0 = 0.3
    width = 3.0
    parts: Parts = [
        (
            "shop front",
            wall(
                (0, 4.6),
                (0, 3.3),
                [Opening(u0 + width / 2, width, 0.6, 2.5), Opening(3.95, 0.95, 0.0, 2.5)],
                0.25,
                0.02,
            ),
        )
    ]
    parts.append(("shop glass", pane(Opening(u0 + width / 2, width, 0.6, 2.5), -0.9)))
    parts.append(("cream", box((u0 - 0.06, 0.5, -0.95), (u0, 2.6, -0.2))))
    parts.append(("cream", box((u0 + width, 0.5, -0.95), (u0 + width + 0.06, 2.6, -0.2))))
    parts.append(("cream", box((u0, 2.5, -0.95), (u0 + width, 2.6, -0.2))))
    parts.append(("door", pane(Opening(3.95, 0.95, 0.0, 2.5), -0.25)))
    parts.append(("door lit", pane(Opening(3.95, 0.6, 1.1, 2.3), -0.24)))
    parts += [("oak", box((u0 - 0.1, 0.52, -0.88), (u0 + width + 0.1, 0.6, 0.05), bevel=0.012))]
    rng = np.random.default_rng(9)
    for k, x in enumerate(np.linspace(u0 + 0.25, u0 + width - 0.25, 9)):
        tall = rng.uniform(0.18, 0.5)
        shape = [
            (0, tall),
            (0.04, tall),
            (0.05, 0.8 * tall),
            (0.11 * rng.uniform(0.6, 1), 0.4 * tall),
            (0.07, 0.0),
            (0, 0),
        ]
        parts.append(
            (
                ("clay", "cream", "brass")[k % 3],
                placed(lathe(shape), (x, 0.6, -0.35 + 0.15 * (k % 2))),
            )
        )
    for x in (u0, u0 + 1.0, u0 + 2.0, u0 + 3.0):
        parts.append(("shop front", box((x - 0.03, 0.6, -0.1), (x + 0.03, 2.5, -0.04))))
    folds = np.linspace(u0 - 0.15, u0 + width + 0.15, 41)
    drop = 0.02 * np.sin(folds * 12)
    parts.append(
        (
            "awning",
            sheet(
                np.stack(
                    [
                        np.column_stack([folds, 2.35 + drop, np.full(41, 0.95)]),
                        np.column_stack([folds, np.full(41, 2.95), np.full(41, 0.02)]),
                    ]
                )
            ),
        )
    )
    parts.append(
        (
            "awning",
            sheet(
                np.stack(
                    [
                        np.column_stack([folds, 2.15 + drop, np.full(41, 0.955)]),
                        np.column_stack([folds, 2.35 + drop, np.full(41, 0.955)]),
                    ]
                )
            ),
        )
    )
    parts.append(("trim", box((0, 3.0, 0), (4.6, 3.3, 0.12), bevel=0.03)))
    upper = [Opening(u, 0.95, 4.1, 5.5, 0.2, False) for u in (1.0, 2.4, 3.7)]
    parts.append(("coat 2", wall((0, 4.6), (3.3, 6.6), upper, 0.22, 0.02)))
    for each, what in zip(upper, ("dark", "lit 1", "dark"), strict=True):
        parts.append((what, pane(each, -0.22)))
    parts += house(4.6, 6.6, upper, "coat 2")[1:-2]
    parts += [
        ("iron", tube([(-0.05, 3.6, 0), (-0.05, 3.62, 0.45), (-0.05, 3.6, 0.9)], 0.014)),
        ("sign", box((-0.07, 2.95, 0.35), (-0.03, 3.5, 0.9), bevel=0.01)),
    ]
    return [(name, facing_left(mesh, RIGHT)) for name, mesh in put(parts, (start - 4.6, 0, 0))]
