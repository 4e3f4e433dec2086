"""A dark chapel on a bright afternoon: one nave, stained glass on three sides, and candles.

The sun stands to the right, so that its light falls through the glass of that side across the pews.
"""

import numpy as np
from numpy.typing import NDArray

from scenes.models import glass, surfaces
from scenes.models.figures import standing
from scenes.models.furnishings import corona, pew, sanctuary, votives
from scenes.models.openings import Opening, facing_left, facing_right, outline, pane, wall
from scenes.models.place import Camera, Light, Material, Place
from scenes.models.shapes import Mesh, Parts, lathe, placed, put, quad, sheet, tube
from scenes.models.sun import through

# of the nave, metres
HALF = 3.6
LENGTH = 15.0
SPRING = 4.3
APEX = 7.9
BAY = 3.0
BAYS = [-1.9 - BAY * k for k in range(4)]  # the middles of its bays along z
LANCET = Opening(0, 1.2, 1.6, 2.9, 1.1)
APSE = [
    Opening(-1.45, 0.9, 2.0, 3.6, 0.9),
    Opening(0, 1.05, 2.0, 4.0, 1.05),
    Opening(1.45, 0.9, 2.0, 3.6, 0.9),
]
ROSE = Opening(0, 1.7, 5.35, 6.2, 0.85, False, True)
SUN = np.array([0.80, 0.50, 0.26])  # towards the sun
THICK = 0.38
SPLAY = 0.2
FLAME = (26_000.0, 13_500.0, 4_200.0)


def vault(half: float, spring: float, apex: float, count: int = 33) -> NDArray[np.float64]:
    """Return the section of a pointed vault (n, 2), from one springing over the apex to the other."""
    rise = apex - spring
    radius = (half**2 + rise**2) / (2 * half)
    x = np.linspace(-half, half, count)
    return np.column_stack(
        [x, spring + np.sqrt(np.maximum(radius**2 - (np.abs(x) + radius - half) ** 2, 0))]
    )


def shell() -> Parts:
    """Return floor, vault and walls."""
    arc = vault(HALF, SPRING, APEX)
    ends = (3.0, -LENGTH)
    roof = sheet(np.stack([np.column_stack([arc, np.full(len(arc), z)]) for z in ends]))
    floor = quad((-HALF, 0, 3), (HALF, 0, 3), (HALF, 0, -LENGTH), (-HALF, 0, -LENGTH))
    left = wall(
        (-3, LENGTH), (0, SPRING + 0.02), [LANCET._replace(middle=-z) for z in BAYS], THICK, SPLAY
    )
    right = wall(
        (-LENGTH, 3), (0, SPRING + 0.02), [LANCET._replace(middle=z) for z in BAYS], THICK, SPLAY
    )
    apse = wall((-HALF, HALF), (0, 5.2), APSE, THICK, SPLAY)
    gable = wall((-HALF, HALF), (5.2, APEX + 0.1), [ROSE], THICK, SPLAY)
    back = quad((HALF, 0, 3), (-HALF, 0, 3), (-HALF, APEX, 3), (HALF, APEX, 3))
    return [
        ("plaster", roof),
        ("tiles", floor),
        ("stone", facing_right(left, -HALF)),
        ("stone", facing_left(right, HALF)),
        ("stone", placed(apse, (0, 0, -LENGTH))),
        ("plaster", placed(gable, (0, 0, -LENGTH))),
        ("plaster", back),
    ]


def panes() -> Parts:
    """Return the glass of all windows."""
    parts: Parts = []
    for k, z in enumerate(BAYS):
        parts.append(
            (f"glass left {k}", facing_right(pane(LANCET._replace(middle=-z), -THICK), -HALF))
        )
        parts.append(
            (f"glass right {k}", facing_left(pane(LANCET._replace(middle=z), -THICK), HALF))
        )
    parts += [
        (f"glass apse {k}", placed(pane(each, -THICK), (0, 0, -LENGTH)))
        for k, each in enumerate(APSE)
    ]
    return [*parts, ("glass rose", placed(pane(ROSE, -THICK), (0, 0, -LENGTH)))]


def ribs() -> Parts:
    """Return the shafts between the bays, the arches that they carry, and the mouldings along the walls."""
    parts: Parts = []
    shaft = [
        (0.0, 4.55),
        (0.27, 4.55),
        (0.27, 4.45),
        (0.2, 4.38),
        (0.15, 4.2),
        (0.16, 4.17),
        (0.125, 4.12),
        (0.12, 0.5),
        (0.15, 0.46),
        (0.2, 0.4),
        (0.2, 0.34),
        (0.25, 0.3),
        (0.25, 0.0),
    ]
    for z in [BAYS[0] + BAY / 2, *(z - BAY / 2 for z in BAYS)]:
        for side in (-1, 1):
            for dz, dx in ((0, 0.16), (-0.2, 0.04), (0.2, 0.04)):
                parts.append(
                    ("pale", placed(lathe(shaft), (side * (HALF - dx), 0, z + dz), scale=(1, 1, 1)))
                )
        for radius, depth, dz in ((0.13, 0.16, 0), (0.08, 0.04, -0.2), (0.08, 0.04, 0.2)):
            arc = vault(HALF - depth, SPRING + 0.2, APEX - depth, 61)
            parts.append(("pale", tube(np.column_stack([arc, np.full(len(arc), z + dz)]), radius)))
    for side in (-1, 1):
        for y, r in ((1.45, 0.07), (4.42, 0.06)):
            parts.append(
                (
                    "pale",
                    tube([(side * HALF, y, 3), (side * HALF, y, 0), (side * HALF, y, -LENGTH)], r),
                )
            )
    parts.append(
        ("pale", tube([(0, APEX - 0.03, 3), (0, APEX - 0.03, -5), (0, APEX - 0.03, -LENGTH)], 0.09))
    )
    for each in (*APSE, ROSE):
        parts.append(("pale", hood(each)))
    return parts


def hood(opening: Opening) -> Mesh:
    """Return the moulding around a window of the end wall."""
    edge = outline(opening.widened(SPLAY + 0.05))
    edge = edge if opening.round else edge[1:-1]
    return tube(np.column_stack([edge, np.full(len(edge), -LENGTH + 0.02)]), 0.055)


def pews() -> Parts:
    """Return two rows of pews along the aisle."""
    parts: Parts = []
    for z in np.arange(-2.2, -9.6, -1.2):
        for side in (-1, 1):
            parts += put(pew(), (side * 1.98, 0, z))
    return parts


def materials() -> dict[str, Material]:
    """Return what everything is made of."""
    oak = surfaces.wood((0.045, 0.02, 0.009), (0.2, 0.1, 0.045), seed=3)
    stone = surfaces.bricks((0.36, 0.32, 0.26), contrast=0.35)
    made = {
        "stone": surfaces.matt(stone, metres=2.4),
        "pale": surfaces.matt(surfaces.plaster((0.44, 0.39, 0.31), seed=2, depth=0.12), metres=1.5),
        "plaster": surfaces.matt(
            surfaces.plaster((0.42, 0.38, 0.31), seed=1, depth=0.13), metres=4.0
        ),
        "tiles": surfaces.glossy(
            surfaces.tiles((0.34, 0.27, 0.19), (0.16, 0.045, 0.028), seed=4), rough=0.22, metres=2.4
        ),
        "oak": surfaces.glossy(oak, rough=0.28, metres=(1.3, 0.5)),
        "leather": surfaces.glossy((0.06, 0.015, 0.012), rough=0.35),
        "book": surfaces.matt((0.05, 0.012, 0.02)),
        "carpet": surfaces.matt(
            surfaces.tinted("grass", (0.22, 0.02, 0.025), contrast=0.4), metres=0.4
        ),
        "linen": surfaces.matt((0.75, 0.73, 0.68)),
        "wax": surfaces.matt((0.78, 0.7, 0.52)),
        "cup": surfaces.glossy((0.35, 0.02, 0.02), rough=0.15),
        "brass": surfaces.metal((0.75, 0.55, 0.22), rough=0.3),
        "gilt": surfaces.metal((0.85, 0.6, 0.22), rough=0.42),
        "iron": surfaces.matt((0.025, 0.024, 0.023)),
        "flame": surfaces.matt((0.0, 0.0, 0.0)),
        "ruby": surfaces.matt((0.0, 0.0, 0.0)),
        "coat": surfaces.matt((0.09, 0.1, 0.16)),
        "skin": surfaces.matt((0.5, 0.3, 0.21)),
        "hair": surfaces.matt((0.05, 0.03, 0.02)),
        "trousers": surfaces.matt((0.04, 0.04, 0.045)),
    }
    return made | {name: surfaces.matt((0.012, 0.012, 0.013)) for name, _ in panes()}


def windows() -> dict[str, NDArray[np.float64]]:
    """Return the transmittance of every window, by the name of its glass."""
    aspect = (LANCET.spring + LANCET.rise - LANCET.sill) / LANCET.width
    found = {
        f"glass {side} {k}": glass.lancet(2 * k + (side == "right"), aspect=aspect)
        for side in ("left", "right")
        for k in range(4)
    }
    for k, each in enumerate(APSE):
        found[f"glass apse {k}"] = glass.lancet(
            20 + k, aspect=(each.spring + each.rise - each.sill) / each.width
        )
    return found | {"glass rose": glass.rose(3)}


def place() -> Place:
    """Return the chapel."""
    T = windows()
    sky = {
        "left": (55, 64, 80),
        "right": (420, 400, 350),
        "apse": (150, 165, 190),
        "rose": (220, 225, 230),
    }
    glow = {name: each * np.array(sky[name.split()[1]], float) for name, each in T.items()}
    beams = tuple(
        through(
            T[f"glass right {k}"],
            (HALF + THICK, LANCET.sill, z + LANCET.width / 2),
            (0, 0, -LANCET.width),
            (0, LANCET.spring + LANCET.rise - LANCET.sill, 0),
            SUN,
            (26_000, 23_500, 19_500),
        )
        for k, z in enumerate(BAYS)
    )
    lights = {
        "glass": Light(glow, share=0.8),
        "sun": Light({}, beams, absent=tuple(T), share=1.5),
        "candles": Light({"flame": FLAME, "ruby": (420.0, 12.0, 5.0)}, share=0.7),
    }
    parts = shell() + panes() + ribs() + pews() + sanctuary() + votives() + corona()
    visitor = put(standing("coat", "trousers"), (0.05, 0.01, -5.6), turn=180)
    return Place(
        parts, materials(), lights, Camera((-0.75, 1.62, 1.9), (0.22, 2.55, -10.0), 68), visitor
    )
