"""Places handed to Mitsuba 3, and its pictures taken back.

E         radiance (H, W, 3), cd/m^2
rho       reflectance (H, W, 3)
distance  (H, W), metres along each line of sight

References
----------
Mitchell, Consequences of stratified sampling in graphics, SIGGRAPH 1996.
"""

import tempfile
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from scenes.models.place import Camera, Light, Material, Place
from scenes.models.shapes import Mesh, Parts, by_material

Float = NDArray[np.floating[Any]]
PASS = 16  # samples per pixel at a time, spread over it as 4 x 4, which bounds the memory
LINES = 6_000_000  # lines of sight at a time, for the same reason


class Frame(NamedTuple):
    """A picture's height and width in pixels, and the rows and columns of it that are rendered."""

    height: int
    width: int
    rows: slice = slice(None)
    columns: slice = slice(None)


class Guides(NamedTuple):
    """What is seen, without its light: reflectance (H, W, 3), normal (H, W, 3), and distance (H, W)."""

    rho: Float
    normal: Float
    distance: Float


def mitsuba(variant: str) -> ModuleType:
    """Return Mitsuba, which is imported here alone."""
    try:
        mi = import_module("mitsuba")
    except ImportError:
        raise ModuleNotFoundError(
            'rendering a scene needs Mitsuba 3: pip install "hdrlab[scenes]"'
        ) from None
    mi.set_variant(variant)
    return mi


def write_ply(path: Path, mesh: Mesh) -> None:
    """Write a mesh where Mitsuba can read it."""
    names = [*"xyz", "nx", "ny", "nz", "u", "v"]
    fields = "".join(f"property float {name}\n" for name in names)
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(mesh.vertices)}\n{fields}"
    head += f"element face {len(mesh.faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    faces = np.empty(len(mesh.faces), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"] = mesh.faces
    points = np.concatenate([mesh.vertices, mesh.normals, mesh.uv], axis=1).astype("<f4")
    path.write_bytes(head.encode() + points.tobytes() + faces.tobytes())


def described(mi: ModuleType, what: Any) -> Any:
    """Return a description with every array in it made a Mitsuba texture."""
    if isinstance(what, np.ndarray):
        what = {"type": "bitmap", "data": what}
    if not isinstance(what, dict):
        return what
    made = {
        key: described(mi, value) for key, value in what.items() if key not in ("data", "repeat")
    }
    if "data" in what:
        made["bitmap"] = mi.Bitmap(np.ascontiguousarray(what["data"][::-1], np.float32))
        made["raw"] = True  # numbers as they are: reflectance and radiance, not an encoded picture
        if "repeat" in what:
            made["to_uv"] = mi.ScalarTransform4f().scale([*what["repeat"], 1])
    if "look_at" in made:
        made["to_world"] = mi.ScalarTransform4f().look_at(**made.pop("look_at"))
    return made


def halved(frame: Frame) -> Frame:
    """Return a frame half as fine, of the same view."""
    rows, columns = (
        slice(each.start and each.start // 2, each.stop and each.stop // 2) for each in frame[2:]
    )
    return Frame(frame.height // 2, frame.width // 2, rows, columns)


def sensor(mi: ModuleType, camera: Camera, frame: Frame) -> Material:
    """Return Mitsuba's camera, which sees a frame or a part of it."""
    (top, bottom, _), (left, right, _) = (
        each.indices(n) for each, n in zip(frame[2:], frame[:2], strict=True)
    )
    film = {
        "type": "hdrfilm",
        "height": frame.height,
        "width": frame.width,
        "rfilter": {"type": "box"},
        "pixel_format": "rgb",
        "component_format": "float32",
        "crop_offset_x": left,
        "crop_offset_y": top,
        "crop_width": right - left,
        "crop_height": bottom - top,
    }
    view = mi.ScalarTransform4f().look_at(origin=camera.origin, target=camera.target, up=(0, 1, 0))
    return {
        "type": "perspective",
        "fov": camera.angle,
        "fov_axis": "x",
        "to_world": view,
        "near_clip": 0.05,
        "film": film,
        "sampler": {"type": "stratified", "sample_count": PASS},
    }


def scene(
    mi: ModuleType, place: Place, parts: Parts, light: Light, folder: Path, view: Material
) -> Any:
    """Return Mitsuba's scene of a place in one of its lights."""
    black = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.0}}
    whole: Material = {"type": "scene", "camera": view}
    for k, beam in enumerate(light.beams):
        whole[f"beam{k}"] = described(mi, beam)
    for k, (name, mesh) in enumerate(solids(parts + light.parts, light)):
        path = folder / f"{k}.ply"
        write_ply(path, mesh)
        bsdf = black if name in light.black else described(mi, place.materials.get(name, black))
        solid = {"type": "ply", "filename": str(path), "bsdf": {"type": "twosided", "inner": bsdf}}
        if name in light.glow:
            glow = light.glow[name]
            colour = (
                {"type": "rgb", "value": list(glow)}
                if isinstance(glow, tuple)
                else described(mi, glow)
            )
            solid["emitter"] = {"type": "area", "radiance": colour}
        if name.startswith("spots"):  # they shine, and are not in the way
            solid["bsdf"] = {"type": "mask", "opacity": 0.0, "bsdf": {"type": "diffuse"}}
        whole[f"solid{k}"] = solid
    return mi.load_dict(whole)


def solids(parts: Parts, light: Light) -> Parts:
    """Return what is there in a light, one mesh per material.

    What shines with a texture stays apart: Mitsuba chooses a texel, and takes the one place where
    it lies.
    """
    there = [(name, mesh) for name, mesh in parts if name not in light.absent]
    apart = {name for name, glow in light.glow.items() if not isinstance(glow, tuple)}
    merged = by_material([(name, mesh) for name, mesh in there if name not in apart])
    return [*merged.items(), *((name, mesh) for name, mesh in there if name in apart)]


def traced(mi: ModuleType, scene: Any, integrator: Material, samples: int, seed: int) -> Float:
    """Return the mean of `samples` paths through each pixel, or a few more, (H, W, C)."""
    kind = mi.load_dict(integrator)
    passes = -(-samples // PASS)
    total: Any = 0.0
    for k in range(passes):
        total = total + np.array(
            mi.render(scene, integrator=kind, spp=PASS, seed=seed + k), np.float64
        )
    return np.nan_to_num(total / passes, nan=0.0, posinf=0.0).astype(
        np.float32
    )  # a path in many millions


def sharp(
    mi: ModuleType,
    scene: Any,
    camera: Camera,
    frame: Frame,
    integrator: Material,
    samples: int,
    seed: int,
) -> Float:
    """Return the mean of about `samples` lines of sight through each pixel, at most, (H, W, C).

    All of a pixel's lines are spread over it at once: an edge then errs by N^-3/4 instead of
    N^-1/2, which is what is left where passes of fewer are averaged [Mitchell96]. Strips of the
    picture bound the memory.
    """
    side = int(np.sqrt(samples))
    (top, bottom, _), (left, right, _) = (
        each.indices(n) for each, n in zip(frame[2:], frame[:2], strict=True)
    )
    kind = mi.load_dict(integrator)
    step = max(LINES // (side**2 * (right - left)), 1)
    strips = []
    for k, row in enumerate(range(top, bottom, step)):
        strip = frame._replace(rows=slice(row, min(row + step, bottom)))
        view = mi.load_dict(sensor(mi, camera, strip))
        found = mi.render(scene, sensor=view, integrator=kind, spp=side**2, seed=seed + k)
        strips.append(np.array(found, np.float32))
    return np.nan_to_num(np.concatenate(strips), nan=0.0, posinf=0.0)


def seen(
    mi: ModuleType, place: Place, parts: Parts, light: Light, frame: Frame, samples: int, seed: int
) -> Guides:
    """Return what the camera sees in a light, whatever there is of it."""
    with tempfile.TemporaryDirectory() as folder:
        made = scene(
            mi,
            place,
            parts,
            Light(absent=light.absent),
            Path(folder),
            sensor(mi, place.camera, frame),
        )
        guides = {"type": "aov", "aovs": "rho:albedo,n:sh_normal,t:depth"}
        found = sharp(mi, made, place.camera, frame, guides, samples, seed)
    return Guides(found[..., :3], found[..., 3:6], found[..., 6])


def stacked(guides: Guides) -> Float:
    """Return guides as one array (H, W, 7), in units in which a step of 0.1 is a difference."""
    ln_distance = np.log(np.maximum(guides.distance, 0.05))[..., None]
    return np.dstack([0.28 * guides.normal, 0.75 * ln_distance, 0.3 * guides.rho])
