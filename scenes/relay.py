"""Light from where the sun falls: what a projector lights becomes a lamp of its own.

P    points (n, 3) that a projector lights, metres
n    their normals (n, 3)
t    how far they lie from the projector, metres
rho  their reflectance (n, 3)

Paths that run on at random would seldom meet a small bright patch on the floor, and each that did
would leave a speck. Paths that look for lamps find it [Keller97 sec. 3]: so the patch is covered
with small lamps.

References
----------
Keller, Instant radiosity, SIGGRAPH 1997.
"""

import tempfile
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hdrlab.scenes.places import mean_between
from scenes.models.place import Light, Material, Place
from scenes.models.shapes import Mesh, Parts, unit
from scenes.tracer import Float, Frame, described, scene, sensor

SMALL = (
    0.5  # side of a lamp in its cell: large ones would stand out over edges, in each other's light
)
DARK = 1e-3  # of the brightest light: what gets less, behind the lead of a window, makes no lamp
GRAZING = 0.08  # the least cosine: a surface almost along the light would get a lamp without end


def spots(mi: ModuleType, made: Any, beam: Material, count: int = 96) -> tuple[Mesh, Material]:
    """Return what a projector lights, as small squares that shine: their mesh, and their radiance.

    A camera stands where the projector does: what it sees is what is lit.
    """
    film = {"type": "hdrfilm", "height": count, "width": count, "rfilter": {"type": "box"}}
    view = {"type": "perspective", "fov": beam["fov"], "near_clip": 1.0, "film": film}
    eye = mi.load_dict(described(mi, view | {"look_at": beam["look_at"]}))
    aovs = mi.load_dict({"type": "aov", "aovs": "rho:albedo,n:geo_normal,P:position,t:depth"})
    found = np.array(
        mi.render(made, sensor=eye, integrator=aovs, spp=1, seed=0), np.float64
    ).reshape(-1, 10)
    light = np.pi * zoom(beam["irradiance"], count).reshape(-1, 3)  # as Mitsuba's projector has it
    hit = (found[:, 9] > 0) & (light.max(axis=1) > DARK * light.max())
    rho = found[hit, :3]
    n = found[hit, 3:6]
    P = found[hit, 6:9]
    t = found[hit, 9]
    ray = unit(P - np.array(beam["look_at"]["origin"]))
    n = n * -np.sign((n * ray).sum(axis=1, keepdims=True))
    cos = np.maximum(-(n * ray).sum(axis=1), GRAZING)
    side = 2 * t * np.tan(np.radians(beam["fov"]) / 2) / count / np.sqrt(cos)
    E = (
        rho * light[hit] * (cos / t**2)[:, None] / np.pi
    )  # a matt surface returns rho / pi of what it gets
    return squares(P, n, SMALL * side), chart(E / SMALL**2)


def squares(P: Float, n: Float, side: Float) -> Mesh:
    """Return a square about each point, 2 mm before its surface; each has a texel of `chart` to itself."""
    a = (
        unit(np.cross(n, np.where(np.abs(n[:, :1]) < 0.7, [1.0, 0, 0], [0, 1.0, 0])))
        * side[:, None]
        / 2
    )
    b = np.cross(n, a)
    corners = np.stack([P - a - b, P + a - b, P + a + b, P - a + b], axis=1) + 0.002 * n[:, None]
    first = 4 * np.arange(len(P))[:, None]
    faces = np.concatenate([first + [0, 1, 2], first + [0, 2, 3]])
    size = chart_size(len(P))
    texel = np.column_stack([np.arange(len(P)) % size, size - 1 - np.arange(len(P)) // size])
    uv = (texel[:, None] + [(0, 0), (1, 0), (1, 1), (0, 1)]) / size
    return Mesh(corners.reshape(-1, 3), np.repeat(n, 4, axis=0), uv.reshape(-1, 2), faces)


def chart_size(count: int) -> int:
    """Return the side of the smallest square of so many texels, at least 2."""
    return max(int(np.ceil(np.sqrt(count))), 2)


def chart(E: Float) -> Material:
    """Return a texture with a texel for each radiance (n, 3), row by row; paths prefer the bright ones."""
    size = chart_size(len(E))
    texels = np.zeros((size * size, 3), np.float32)
    texels[: len(E)] = E
    return {"type": "bitmap", "data": texels.reshape(size, size, 3), "filter_type": "nearest"}


def zoom(picture: NDArray[Any], count: int) -> NDArray[np.float64]:
    """Return a square picture at another size, by the mean over areas."""
    rows = mean_between(picture, *edges(picture, 0, count))
    return mean_between(rows, *edges(picture, 1, count)).astype(np.float64)


def edges(picture: NDArray[Any], axis: int, count: int) -> tuple[NDArray[np.float64], int]:
    """Return where `count` equal parts of a picture begin and end along an axis, and that axis."""
    return np.linspace(0, picture.shape[axis], count + 1), axis


def relayed(mi: ModuleType, place: Place) -> dict[str, Light]:
    """Return the lights of a place, projectors as two: what they light, and the light from there."""
    lights: dict[str, Light] = {}
    for name, light in place.lights.items():
        slides = [beam for beam in light.beams if beam["type"] == "projector"]
        if not slides:
            lights[name] = light
            continue
        lights[name] = light._replace(bounces=1)
        with tempfile.TemporaryDirectory() as folder:
            made = scene(
                mi, place, place.parts, light, Path(folder), sensor(mi, place.camera, Frame(1, 1))
            )
            found = [spots(mi, made, slide) for slide in slides]
        parts: Parts = [(f"spots {k}", mesh) for k, (mesh, _) in enumerate(found)]
        glow = {f"spots {k}": shine for k, (_, shine) in enumerate(found)}
        lights[name + ", scattered"] = light._replace(glow=glow, beams=(), hidden=True, parts=parts)
    return lights
