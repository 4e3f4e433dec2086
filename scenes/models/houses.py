"""The houses of a street: fronts with windows and doors, a shop, a passage without a light, a church."""

import numpy as np

from scenes.models.openings import Opening, facing_left, facing_right, outline, pane, wall
from scenes.models.shapes import (
    Parts,
    ball,
    box,
    extrude,
    hull,
    lathe,
    placed,
    put,
    quad,
    sheet,
    tube,
    turned,
)

# the fronts of the houses, and where the street ends, metres
LEFT = -3.6
RIGHT = 3.6
END = -34.0


ALLEY = (-7.3, -5.0)  # z of its two corners, on the left


def house(width: float, height: float, openings: list[Opening], coat: str) -> Parts:
    """Return the front of a house from x = 0 to its width, seen from +z: wall, frames, sills, mouldings."""
    parts: Parts = [(coat, wall((0, width), (0, height), openings, 0.22, 0.02))]
    for each in openings:
        a = each.middle - each.width / 2
        b = each.middle + each.width / 2
        upper = each.spring + each.rise
        if each.sill > 0.3:
            parts.append(
                (
                    "trim",
                    box(
                        (a - 0.1, each.sill - 0.09, -0.05),
                        (b + 0.1, each.sill - 0.01, 0.09),
                        bevel=0.015,
                    ),
                )
            )
            for y in (each.sill + 0.02, each.sill + 0.62 * (each.spring - each.sill)):
                parts.append(("sash", box((a, y - 0.02, -0.2), (b, y + 0.03, -0.15))))
            for x in (a + 0.02, each.middle, b - 0.02):
                parts.append(("sash", box((x - 0.022, each.sill, -0.2), (x + 0.022, upper, -0.15))))
        edge = outline(each.widened(0.05))[1:-1]
        if each.rise:
            parts.append(
                ("trim", tube(np.column_stack([edge, np.full(len(edge), 0.015)]), 0.045, sides=8))
            )
        else:
            parts.append(
                (
                    "trim",
                    box(
                        (a - 0.12, upper + 0.02, -0.02), (b + 0.12, upper + 0.16, 0.07), bevel=0.015
                    ),
                )
            )
    for y, deep, tall in (
        (height - 0.2, 0.22, 0.2),
        (height - 0.34, 0.12, 0.14),
        (3.15, 0.08, 0.14),
    ):
        parts.append(("trim", box((0, y, 0), (width, y + tall, deep), bevel=0.03)))
    parts.append(("trim", box((0, 0, 0), (width, 0.45, 0.05), bevel=0.012)))
    return parts


def storeys(width: float, floors: int, *, seed: int) -> tuple[list[Opening], list[str]]:
    """Return the openings of a front and what is behind each: "lit 0" to "lit 3", "dark" or "door"."""
    rng = np.random.default_rng(seed)
    count = max(int(width // 1.75), 1)
    at = (np.arange(count) + 0.5) * width / count
    arched = bool(seed % 2)
    found = []
    behind = []
    for k, u in enumerate(at):
        door = k == seed % count
        found.append(
            Opening(
                u,
                1.0 if door else 1.05,
                0.0 if door else 0.95,
                2.25,
                0.35 if arched or door else 0.0,
                False,
            )
        )
        behind.append(
            "door" if door else f"lit {rng.integers(0, 4)}" if rng.random() < 0.5 else "dark"
        )
        for floor in range(1, floors):
            sill = 0.85 + 2.95 * floor
            found.append(Opening(u, 0.95, sill, sill + 1.45, 0.22 if arched else 0.0, False))
            behind.append(f"lit {rng.integers(0, 4)}" if rng.random() < 0.42 else "dark")
    return found, behind


def front(side: int, start: float, width: float, floors: int, coat: str, *, seed: int) -> Parts:
    """Return a house on a side of the street, from z = start away from the camera."""
    openings, behind = storeys(width, floors, seed=seed)
    height = 0.6 + 2.95 * floors + 0.3 * (seed % 3)
    order = sorted(range(len(openings)), key=lambda k: openings[k].middle)
    columns = [
        [openings[k] for k in order if openings[k].middle == u]
        for u in sorted({o.middle for o in openings})
    ]
    parts: Parts = []
    # A wall has its openings side by side; storeys are walls one upon another.
    for floor in range(floors):
        low = 0 if floor == 0 else 0.5 + 2.95 * floor
        high = height if floor == floors - 1 else 0.5 + 2.95 * (floor + 1)
        parts.append(
            (coat, wall((0, width), (low, high), [column[floor] for column in columns], 0.22, 0.02))
        )
    parts += house(width, height, openings, coat)[1:]
    for each, what in zip(openings, behind, strict=True):
        parts.append((what, pane(each, -0.22)))
        if what == "door":
            parts += door(each)
    parts.append(
        (
            "roof",
            sheet(
                [
                    [(0, height, 0.25), (width, height, 0.25)],
                    [(0, height + 1.6, -2.2), (width, height + 1.6, -2.2)],
                ]
            ),
        )
    )
    for u, turn in ((0, -90), (width, 90)):  # the sides, where a neighbour is lower
        gable = quad((-2.5, 3.2, 0), (2.5, 3.2, 0), (2.5, height, 0), (-2.5, height, 0))
        parts.append((coat, placed(gable, (u, 0, -2.5), turned(turn))))
    if side < 0:
        return [(name, facing_right(mesh, LEFT)) for name, mesh in put(parts, (-start, 0, 0))]
    return [(name, facing_left(mesh, RIGHT)) for name, mesh in put(parts, (start - width, 0, 0))]


def door(opening: Opening) -> Parts:
    """Return what makes a door of a plate of paint: panels, a knob, a step."""
    a = opening.middle - opening.width / 2
    b = opening.middle + opening.width / 2
    parts: Parts = [("step", box((a - 0.1, 0, -0.1), (b + 0.1, 0.14, 0.3), bevel=0.02))]
    for x in (a + 0.1, opening.middle + 0.05):
        for y, tall in ((0.3, 0.62), (1.05, 0.85)):
            parts.append(("door", box((x, y, -0.17), (x + 0.36, y + tall, -0.145), bevel=0.02)))
    return [*parts, ("brass", ball((b - 0.12, 1.02, -0.13), 0.03, sides=10))]


def alley() -> Parts:
    """Return the alley between two houses on the left: its walls, barrels, a crate, a door in the dark.

    Behind its arch it is wider than the arch, so that the camera looks past the light that falls
    through.
    """
    a, b = ALLEY
    back = a - 3.2
    far = LEFT - 9
    parts: Parts = [
        ("soot", quad((far, 0, back), (LEFT, 0, back), (LEFT, 3.3, back), (far, 3.3, back))),
        ("soot", quad((LEFT, 0, b), (far, 0, b), (far, 3.3, b), (LEFT, 3.3, b))),
        ("soot", quad((far, 0, b), (far, 0, back), (far, 3.3, back), (far, 3.3, b))),
        ("road", quad((far, 0.01, b), (LEFT, 0.01, b), (LEFT, 0.01, back), (far, 0.01, back))),
        ("soot", quad((LEFT, 3.3, b), (far, 3.3, b), (far, 3.3, back), (LEFT, 3.3, back))),
        ("door", box((LEFT - 2.3, 0, back), (LEFT - 1.3, 2.1, back + 0.06))),
    ]
    barrel = [(0, 0.9), (0.25, 0.9), (0.3, 0.7), (0.32, 0.45), (0.3, 0.2), (0.25, 0), (0, 0)]
    for x, z in ((-1.15, back + 1.9), (-1.8, back + 1.2), (-3.4, b - 0.45)):
        parts.append(("oak", placed(lathe(barrel), (LEFT + x, 0, z))))
    parts.append(("oak", box((LEFT - 2.9, 0, back + 0.1), (LEFT - 2.2, 0.7, back + 0.8))))
    # The arch is low: what comes in of the lamp's light falls on the stones behind it.
    arch = Opening((b - a) / 2, 1.8, 0.0, 1.55, 0.55, False)
    edge = outline(arch.widened(0.06))
    front = [
        ("coat 1", wall((0, b - a), (0, 9), [arch], 0.4)),
        ("trim", tube(np.column_stack([edge, np.full(len(edge), 0.02)]), 0.07, sides=8)),
        ("trim", box((0, 3.15, 0), (b - a, 3.29, 0.08), bevel=0.03)),
    ]
    return parts + [(name, facing_right(mesh, LEFT)) for name, mesh in put(front, (-b, 0, 0))]


def church() -> Parts:
    """Return what closes the street: a church with a lit clock on its tower."""
    porch = Opening(0, 1.5, 0, 2.2, 1.1)
    windows = [Opening(-2.4, 1.0, 2.6, 4.4, 0.9), Opening(2.4, 1.0, 2.6, 4.4, 0.9)]
    parts: Parts = [
        ("brick", wall((-8, 8), (0, 7.5), [porch, *windows], 0.4, 0.1)),
        ("door", pane(porch, -0.4)),
    ]
    parts += [("lit church", pane(each, -0.4)) for each in windows]
    parts.append(("brick", box((-1.9, 7.3, -3.9), (1.9, 13.5, -0.1))))
    parts.append(
        (
            "roof",
            hull(
                [(sx * 2.05, 13.5, -2 + sz * 2.05) for sx in (-1, 1) for sz in (-1, 1)]
                + [(0, 19.5, -2)]
            ),
        )
    )
    parts.append(
        ("roof", sheet([[(-8, 7.5, 0.2), (8, 7.5, 0.2)], [(-8, 10.5, -4), (8, 10.5, -4)]]))
    )
    t = np.linspace(0, 2 * np.pi, 33)[:-1]
    parts.append(("clock", extrude(np.column_stack([0.95 * np.cos(t), 0.95 * np.sin(t)]), 0.06)))
    parts[-1:] = put(parts[-1:], (0, 11.7, 0))
    ring = np.linspace(0, 2 * np.pi, 41)
    parts.append(
        ("iron", tube(np.column_stack([np.cos(ring), 11.7 + np.sin(ring), 0.03 + 0 * ring]), 0.05))
    )
    for k in range(12):
        a = k * np.pi / 6
        parts.append(
            (
                "iron",
                tube(
                    [
                        (0.72 * np.sin(a), 11.7 + 0.72 * np.cos(a), 0.06),
                        (0.86 * np.sin(a), 11.7 + 0.86 * np.cos(a), 0.06),
                    ],
                    0.025,
                    sides=5,
                ),
            )
        )
    for a, r in ((0.6, 0.5), (4.4, 0.72)):
        parts.append(
            (
                "iron",
                tube([(0, 11.7, 0.07), (r * np.sin(a), 11.7 + r * np.cos(a), 0.07)], 0.03, sides=5),
            )
        )
    return put(parts, (0, 0, END))
