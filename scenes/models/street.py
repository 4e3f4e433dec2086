"""A street at night after rain: lamps, lit windows, wet stones, and an alley that no lamp reaches."""

import numpy as np

from scenes.models import surfaces
from scenes.models.figures import walking
from scenes.models.houses import END, LEFT, alley, church, front
from scenes.models.indoors import Float, goods, interior
from scenes.models.pavement import KERB, furniture
from scenes.models.place import Camera, Colour, Light, Material, Place
from scenes.models.shapes import Parts, box, put, quad, sheet
from scenes.models.shop import shop


def ground() -> Parts:
    """Return the road, a little higher in its middle, the kerbs and the pavements."""
    x = np.linspace(-KERB, KERB, 9)
    crown = 0.05 * (1 - (x / KERB) ** 2) - 0.1
    road = sheet(
        np.stack([np.column_stack([x, crown, np.full(9, z)]) for z in np.linspace(8, END - 6, 30)])
    )
    earth = quad(
        (-9, -0.16, 8), (9, -0.16, 8), (9, -0.16, END - 9), (-9, -0.16, END - 9)
    )  # under the gaps
    parts: Parts = [("road", road), ("brick", earth)]
    for side in (-1, 1):
        for z in np.arange(6, END, -1.2):
            parts.append(
                (
                    "kerb",
                    box(
                        (side * KERB, -0.14, z - 1.19), (side * (KERB + 0.16), 0.02, z), bevel=0.018
                    ),
                )
            )
        a, b = sorted((side * (KERB + 0.16), side * (abs(LEFT) + 0.3)))
        parts.append(
            ("pavement", quad((a, 0.01, 8), (b, 0.01, 8), (b, 0.01, END - 2), (a, 0.01, END - 2)))
        )
    return parts


def houses() -> Parts:
    """Return the houses on both sides."""
    parts: Parts = []
    row = [
        (-1, 6.0, 5.4, 3, 0, 3),
        (-1, 0.6, 5.6, 2, 1, 4),
        (-1, -7.3, 5.4, 3, 2, 8),
        (-1, -12.7, 5.7, 3, 3, 6),
        (-1, -18.4, 5.2, 2, 0, 5),
        (-1, -23.6, 10.4, 3, 1, 9),
        (1, 6.0, 4.6, 3, 2, 10),
        (1, 1.4, 4.9, 3, 3, 7),
        (1, -8.1, 5.7, 3, 0, 12),
        (1, -13.8, 6.4, 2, 1, 11),
        (1, -20.2, 5.8, 3, 2, 14),
        (1, -26.0, 8.0, 3, 3, 15),
    ]
    for side, start, width, floors, coat, seed in row:
        parts += front(side, start, width, floors, f"coat {coat}", seed=seed)
    return parts + shop(-3.5)


def materials() -> dict[str, Material]:
    """Return what everything is made of."""
    s = surfaces
    coats = [(0.46, 0.36, 0.22), (0.36, 0.2, 0.14), (0.3, 0.33, 0.32), (0.5, 0.43, 0.36)]
    made = {
        f"coat {k}": s.matt(s.plaster(c, seed=k, depth=0.13), metres=3.2)
        for k, c in enumerate(coats)
    }
    made |= {
        name: s.matt((0, 0, 0))
        for name in (
            "lit 0",
            "lit 1",
            "lit 2",
            "lit 3",
            "shop glass",
            "lit church",
            "clock",
            "bulb",
            "door lit",
        )
    }
    return made | {
        "road": s.glossy(
            s.tinted("gravel", (0.085, 0.08, 0.075), contrast=0.7), rough=0.13, metres=1.1
        ),
        "pavement": s.glossy(
            s.tiles((0.16, 0.15, 0.14), (0.13, 0.125, 0.12), seed=7, count=6), rough=0.2, metres=3.0
        ),
        "kerb": s.glossy(s.plaster((0.2, 0.19, 0.18), seed=5), rough=0.2),
        "trim": s.matt(s.plaster((0.46, 0.42, 0.36), seed=6)),
        "step": s.matt((0.3, 0.28, 0.26)),
        "brick": s.matt(s.bricks((0.24, 0.12, 0.08)), metres=1.5),
        "soot": s.matt(s.bricks((0.03, 0.022, 0.018)), metres=1.5),
        "roof": s.matt(s.bricks((0.09, 0.05, 0.045)), metres=1.2),
        "clouds": s.matt((0, 0, 0)),
        "sash": s.matt((0.32, 0.31, 0.29)),
        "dark": s.glossy((0.006, 0.007, 0.009), rough=0.05),
        "door": s.glossy((0.03, 0.085, 0.06), rough=0.2),
        "iron": s.glossy((0.018, 0.02, 0.02), rough=0.25),
        "brass": s.metal((0.75, 0.55, 0.22)),
        "oak": s.matt(s.wood((0.07, 0.035, 0.017), (0.2, 0.11, 0.055), seed=2)),
        "shop front": s.glossy((0.04, 0.075, 0.13), rough=0.2),
        "awning": s.matt(stripes((0.5, 0.06, 0.045), (0.62, 0.57, 0.46)), metres=0.5),
        "sign": s.matt((0.4, 0.28, 0.07)),
        "clay": s.matt((0.36, 0.15, 0.08)),
        "cream": s.glossy((0.6, 0.52, 0.36)),
        "leaves": s.matt((0.06, 0.14, 0.035)),
        "rubber": s.matt((0.02, 0.02, 0.02)),
        "steel": s.metal((0.6, 0.6, 0.6)),
        "frame": s.glossy((0.25, 0.025, 0.02), rough=0.15),
        "coat": s.matt((0.14, 0.1, 0.065)),
        "trousers": s.matt((0.035, 0.035, 0.045)),
        "skin": s.matt((0.46, 0.29, 0.2)),
        "hair": s.matt((0.03, 0.02, 0.015)),
        "umbrella": s.glossy((0.34, 0.022, 0.03), rough=0.25),
    }


def stripes(
    first: tuple[float, float, float], second: tuple[float, float, float], size: int = 64
) -> Float:
    """Return rho of a striped cloth."""
    first_here = np.arange(size) < size / 2
    return np.broadcast_to(np.where(first_here[:, None], first, second), (size, size, 3)).copy()


def clouds(size: int = 256) -> Float:
    """Return the radiance of the sky, cd/m^2: clouds over a town, which light them from below."""
    height = np.linspace(1, 0, size)[:, None]
    puffs = surfaces.noise((size, size), ((30, 60), (12, 24), (5, 10)), seed=17)
    glow = (0.2 + np.exp(-3.5 * height)) * np.exp(0.3 * puffs)
    return glow[..., None] * np.array([0.11, 0.082, 0.066])


def overcast() -> Parts:
    """Return the sky behind the church."""
    z = END - 40
    return [("clouds", quad((-70, 0, z), (70, 0, z), (70, 80, z), (-70, 80, z), unit_uv=True))]


def place() -> Place:
    """Return the street."""
    warm = [(34.0, 20.0, 8.5), (52.0, 36.0, 18.0), (26.0, 13.0, 4.5), (30.0, 30.0, 26.0)]
    glow: dict[str, Colour | Float] = {
        f"lit {k}": interior(30 + k, colour) for k, colour in enumerate(warm)
    }
    glow |= {
        "shop glass": goods(),
        "clock": (70.0, 62.0, 40.0),
        "lit church": (5.0, 2.6, 1.2),
        "door lit": (60.0, 40.0, 18.0),
    }
    night: Material = {
        "type": "constant",
        "radiance": {"type": "rgb", "value": [0.022, 0.021, 0.022]},
    }
    lights = {
        "lamps": Light({"bulb": (52_000.0, 33_000.0, 14_500.0)}, share=1.5),
        "windows": Light(glow, share=0.7),
        "night": Light({"clouds": clouds()}, (night,), bounces=4, share=0.3),
    }
    parts = ground() + houses() + alley() + furniture() + church() + overcast()
    visitor = put(walking("coat", "trousers"), (-0.75, -0.06, -4.3), turn=32)
    return Place(
        parts, materials(), lights, Camera((0.55, 1.65, 3.2), (-0.35, 2.35, -14.0), 62), visitor
    )
