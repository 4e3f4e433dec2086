"""A joiner's workshop with a window on a yard in the sun.

The yard has its own light; the room knows it as the light of the window's panes.
"""

import numpy as np
from numpy.typing import NDArray

from scenes.models import surfaces, tools
from scenes.models.figures import cat
from scenes.models.joinery import BACK, LEFT, bench, middle, shelves, toolboard
from scenes.models.openings import Opening, pane, wall
from scenes.models.place import Camera, Light, Material, Place
from scenes.models.shapes import Parts, ball, box, placed, put, quad, sheet, tube, turned
from scenes.models.sun import through
from scenes.models.yard import sky, yard

# metres; the wall's thickness
RIGHT = 3.0
CEILING = 2.85
THICK = 0.32
WINDOW = Opening(-0.55, 2.5, 1.02, 2.32, 0.16, False)
SUN = (-0.50, 0.62, -0.52)  # towards the sun
SUNLIGHT = (88_000.0, 80_000.0, 66_000.0)
SKY = (3000.0, 4100.0, 6000.0)
YARD = (
    "grass",
    "gravel path",
    "yard wall",
    "whitewash",
    "roof",
    "bark",
    "leaves",
    "blossom",
    "cloth",
    "sky",
    "hill",
)


def shell() -> Parts:
    """Return the room with its window, and the beams under its ceiling."""
    back = wall((LEFT, RIGHT), (0, CEILING), [WINDOW], THICK, 0.05)
    parts: Parts = [
        ("wall", placed(back, (0, 0, BACK))),
        (
            "wall",
            quad((RIGHT, 0, BACK), (RIGHT, 0, 3), (RIGHT, CEILING, 3), (RIGHT, CEILING, BACK)),
        ),
        ("wall", quad((LEFT, 0, 3), (LEFT, 0, BACK), (LEFT, CEILING, BACK), (LEFT, CEILING, 3))),
        ("wall", quad((RIGHT, 0, 3), (LEFT, 0, 3), (LEFT, CEILING, 3), (RIGHT, CEILING, 3))),
        ("boards", quad((LEFT, 0, 3), (RIGHT, 0, 3), (RIGHT, 0, BACK), (LEFT, 0, BACK))),
        (
            "ceiling",
            quad(
                (LEFT, CEILING, BACK),
                (RIGHT, CEILING, BACK),
                (RIGHT, CEILING, 3),
                (LEFT, CEILING, 3),
            ),
        ),
    ]
    for z in (-3.4, -2.1, -0.8, 0.5):
        parts.append(
            (
                "beam",
                box(
                    (LEFT, CEILING - 0.2, z - 0.09), (RIGHT, CEILING + 0.02, z + 0.09), bevel=0.015
                ),
            )
        )
    parts.append(("beam", box((LEFT, 0, BACK), (RIGHT, 0.12, BACK + 0.02))))
    return parts + frame()


def frame() -> Parts:
    """Return the window's frame and bars, its sill, and what stands on it."""
    z = BACK - 0.22
    parts = []
    left = WINDOW.middle - WINDOW.width / 2
    right = WINDOW.middle + WINDOW.width / 2
    for k, x in enumerate(np.linspace(left + 0.03, right - 0.03, 5)):
        thick = 0.035 if k in (0, 2, 4) else 0.014
        parts.append(("sash", box((x - thick, 1.02, z - 0.025), (x + thick, 2.5, z + 0.025))))
    for y, thick in ((1.05, 0.03), (1.5, 0.013), (1.95, 0.013), (2.36, 0.02)):
        parts.append(("sash", box((left, y - thick, z - 0.022), (right, y + thick, z + 0.022))))
    parts.append(
        (
            "beech",
            box((left - 0.12, 0.98, BACK - 0.2), (right + 0.12, 1.02, BACK + 0.09), bevel=0.012),
        )
    )
    pot = [("clay", tools.tin(0.13, 0.07, "clay")[0][1])]
    rng = np.random.default_rng(2)
    for k in range(46):
        a = rng.uniform(0, 2 * np.pi)
        r = rng.uniform(0.02, 0.16)
        tip = np.array([r * np.cos(a), 0.14 + rng.uniform(0.04, 0.26), 0.6 * r * np.sin(a)])
        leaf = np.array(
            [[(-0.02, 0, 0), (0.02, 0, 0)], [(-0.015, 0.06, 0.02), (0.015, 0.06, 0.02)]]
        )
        pot.append(("plant", placed(sheet(leaf), tip, turned(float(np.degrees(a))))))
        if k % 3 == 0:
            pot.append(("plant", tube([(0, 0.1, 0), tip / 2 + (0, 0.06, 0), tip], 0.003, sides=5)))
        if k % 5 == 0:
            pot.append(("geranium", ball(tip + (0, 0.06, 0), 0.028, sides=10)))
    return parts + put(pot, (right - 0.28, 1.02, BACK - 0.04))


def panes(size: int = 32) -> NDArray[np.float64]:
    """Return the radiance of the window as the room knows it: sky above, and below it the yard."""
    v = np.linspace(1, 0, size)[:, None, None]
    above = np.array([3800.0, 4600.0, 5800.0])
    below = np.array([2700.0, 2700.0, 1700.0])
    return np.broadcast_to(np.where(v > 0.45, above, below), (size, size, 3)).copy()


def materials() -> dict[str, Material]:
    """Return what everything is made of."""
    s = surfaces
    pine = s.wood((0.30, 0.17, 0.075), (0.55, 0.37, 0.19), seed=1)
    oak = s.wood((0.09, 0.045, 0.02), (0.26, 0.15, 0.07), seed=2)
    beech = s.wood((0.25, 0.13, 0.06), (0.46, 0.28, 0.15), seed=5)
    return {
        "wall": s.matt(s.bricks((0.30, 0.24, 0.19), contrast=0.8), metres=1.6),
        "boards": s.matt(
            s.wood((0.09, 0.05, 0.025), (0.3, 0.18, 0.1), seed=9, planks=8), metres=(2.6, 1.5)
        ),
        "ceiling": s.matt(
            s.wood((0.1, 0.06, 0.03), (0.2, 0.13, 0.075), seed=14, planks=10), metres=(3.0, 2.0)
        ),
        "beam": s.matt(
            s.wood((0.05, 0.03, 0.016), (0.14, 0.085, 0.045), seed=7), metres=(2.0, 0.6)
        ),
        "pine": s.matt(pine, metres=(1.4, 0.4)),
        "oak": s.glossy(oak, rough=0.3, metres=(1.2, 0.4)),
        "beech": s.glossy(beech, rough=0.36, metres=(1.4, 0.4)),
        "handle": s.glossy((0.3, 0.12, 0.045), rough=0.22),
        "steel": s.metal((0.62, 0.62, 0.62), rough=0.25),
        "iron": s.glossy((0.035, 0.038, 0.042), rough=0.3),
        "brass": s.metal((0.75, 0.55, 0.22), rough=0.25),
        "tin": s.metal((0.6, 0.6, 0.58), rough=0.35),
        "enamel": s.glossy((0.03, 0.12, 0.07), rough=0.12),
        "bulb": s.matt((0, 0, 0)),
        "red": s.glossy((0.42, 0.03, 0.022), rough=0.25),
        "blue": s.matt((0.05, 0.13, 0.36)),
        "cream": s.glossy((0.62, 0.52, 0.33), rough=0.25),
        "green": s.glossy((0.05, 0.2, 0.08), rough=0.2),
        "amber": s.glossy((0.36, 0.15, 0.02), rough=0.1),
        "clay": s.matt((0.42, 0.17, 0.085)),
        "plant": s.matt((0.07, 0.2, 0.035)),
        "geranium": s.matt((0.62, 0.035, 0.05)),
        "sunflower": s.matt((0.8, 0.5, 0.03)),
        "shaving": s.matt((0.66, 0.47, 0.27)),
        "sash": s.matt((0.5, 0.51, 0.47)),
        "pane": s.matt((0, 0, 0)),
        "fur": s.matt(s.tinted("grass", (0.3, 0.15, 0.06), contrast=0.8), metres=0.5),
        "eye": s.glossy((0.15, 0.25, 0.03), rough=0.1),
        "grass": s.matt(s.tinted("grass", (0.12, 0.21, 0.04)), metres=2.2),
        "gravel path": s.matt(s.tinted("gravel", (0.42, 0.37, 0.29), contrast=0.6), metres=1.4),
        "yard wall": s.matt(s.bricks((0.38, 0.17, 0.1)), metres=1.5),
        "whitewash": s.matt(s.plaster((0.74, 0.72, 0.66), depth=0.04), metres=3),
        "roof": s.matt(s.bricks((0.3, 0.1, 0.055)), metres=0.9),
        "bark": s.matt(s.tinted("gravel", (0.16, 0.11, 0.075)), metres=0.7),
        "leaves": s.matt((0.12, 0.26, 0.05)),
        "blossom": s.matt((0.82, 0.62, 0.66)),
        "cloth": s.matt((0.82, 0.82, 0.8)),
        "hill": s.matt(s.tinted("grass", (0.06, 0.13, 0.03)), metres=0.9),
        "sky": s.matt((0, 0, 0)),
    }


def place() -> Place:
    """Return the workshop."""
    made = materials()
    inside = tuple(
        name for name in made if name not in (*YARD, "geranium", "sunflower", "blue", "red", "sash")
    )
    sun: Material = {
        "type": "directional",
        "direction": [-c for c in SUN],
        "irradiance": {"type": "rgb", "value": list(SUNLIGHT)},
    }
    air: Material = {"type": "constant", "radiance": {"type": "rgb", "value": list(SKY)}}
    left = WINDOW.middle - WINDOW.width / 2
    upper = WINDOW.spring + WINDOW.rise
    corner = (left, WINDOW.sill, BACK - THICK)
    sides = ((WINDOW.width, 0, 0), (0, upper - WINDOW.sill, 0))
    beam = through(np.ones((4, 4, 3)), corner, *sides, SUN, SUNLIGHT)
    lights = {
        "yard": Light(
            {"sky": sky()},
            (sun, air),
            absent=("pane",),
            black=inside,
            bounces=3,
            share=0.3,
            detailed=True,
        ),
        "sun": Light({}, (beam,), absent=("pane", *YARD), share=2.0),
        "window": Light({"pane": panes()}, absent=YARD, hidden=True, share=0.7),
        "lamp": Light({"bulb": (26_000.0, 17_500.0, 8_800.0)}, absent=("pane", *YARD), share=0.15),
    }
    parts = shell() + bench() + toolboard() + shelves() + middle() + yard()
    parts.append(("pane", placed(pane(WINDOW, -0.26), (0, 0, BACK))))
    visitor = put(cat(), (0.1, 0, -2.35), turn=28, scale=1.15)
    return Place(parts, made, lights, Camera((0.45, 1.5, 0.85), (-0.32, 1.2, -4.4), 66), visitor)
