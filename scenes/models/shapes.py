"""Solids out of triangles, to build the places from.

P       points (..., 3), metres: x to the right, y up, z towards the camera
Mesh    vertices with normals and places uv on a texture, and the triangles between them
Parts   (material, Mesh) pairs: what a model is made of

A texture lies on a solid in metres: one unit of uv is one metre, along the solid's own axes.
"""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import ConvexHull

Float = NDArray[np.float64]
UP = np.array([0.0, 1.0, 0.0])


class Mesh(NamedTuple):
    """vertices (N, 3), normals (N, 3) and uv (N, 2) of N points, and faces (F, 3), three of them each."""

    vertices: Float
    normals: Float
    uv: Float
    faces: NDArray[np.int64]


Parts = list[tuple[str, Mesh]]
Places = Float | Sequence[Any]  # points (n, 3) or (m, n, 3), some of them arrays


def merge(meshes: Iterable[Mesh]) -> Mesh:
    """Return one mesh of many."""
    vertices, normals, uv, faces = zip(*meshes, strict=True)
    starts = np.cumsum([0, *(len(each) for each in vertices[:-1])])
    moved = [each + start for each, start in zip(faces, starts, strict=True)]
    return Mesh(
        np.concatenate(vertices), np.concatenate(normals), np.concatenate(uv), np.concatenate(moved)
    )


def by_material(parts: Parts) -> dict[str, Mesh]:
    """Return the parts merged, one mesh per material."""
    names = dict.fromkeys(name for name, _ in parts)
    return {name: merge(mesh for each, mesh in parts if each == name) for name in names}


def turned(degrees: float, axis: str = "y") -> Float:
    """Return the rotation (3, 3) about an axis, counterclockwise as seen against it."""
    c = np.cos(np.radians(degrees))
    s = np.sin(np.radians(degrees))
    k = "xyz".index(axis)
    R = np.eye(3)
    a = (k + 1) % 3
    b = (k + 2) % 3
    R[a, a] = c
    R[a, b] = -s
    R[b, a] = s
    R[b, b] = c
    return R


def placed(
    mesh: Mesh, at: ArrayLike = (0, 0, 0), turn: Float | None = None, scale: ArrayLike = 1.0
) -> Mesh:
    """Return a mesh scaled, then turned, then moved."""
    R = np.eye(3) if turn is None else turn
    size = np.broadcast_to(np.asarray(scale, np.float64), 3)
    vertices = (mesh.vertices * size) @ R.T + np.asarray(at)
    return Mesh(vertices, unit((mesh.normals / size) @ R.T), mesh.uv, mesh.faces)


def put(
    parts: Parts,
    at: ArrayLike = (0, 0, 0),
    *,
    turn: float = 0,
    axis: str = "y",
    scale: ArrayLike = 1.0,
) -> Parts:
    """Return a model scaled, turned by degrees about an axis, and moved."""
    return [(name, placed(mesh, at, turned(turn, axis), scale)) for name, mesh in parts]


def unit(v: Float) -> Float:
    """Return vectors (..., 3) of length 1."""
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12)


def sheet(P: Places, uv: ArrayLike | None = None, *, sharp: bool = False) -> Mesh:
    """Return the surface through a grid of points (m, n, 3), seen from where P[:, 0] runs up and P[0] right.

    Parameters
    ----------
    P : (m, n, 3), metres
    uv : (m, n, 2), or None for metres along the two sides
    sharp : True for a crease at every edge between two squares, False for a smooth surface
    """
    P = np.asarray(P, np.float64)
    across, along = (np.linalg.norm(np.diff(P, axis=k), axis=2) for k in (1, 0))
    if uv is None:
        u = np.pad(np.cumsum(across, axis=1), ((0, 0), (1, 0)))
        v = np.pad(np.cumsum(along, axis=0), ((1, 0), (0, 0)))
        uv = np.stack([u, v], axis=2)
    uv = np.asarray(uv, np.float64)
    if sharp:
        corners = [
            (slice(a, a + P.shape[0] - 1), slice(b, b + P.shape[1] - 1))
            for a in (0, 1)
            for b in (0, 1)
        ]
        square = np.stack([P[c] for c in corners], axis=2).reshape(-1, 2, 2, 3)
        places = np.stack([uv[c] for c in corners], axis=2).reshape(-1, 2, 2, 2)
        return merge(sheet(p, q) for p, q in zip(square, places, strict=True))
    m, n = P.shape[:2]
    k = np.arange(m * n).reshape(m, n)
    a = k[:-1, :-1]
    b = k[:-1, 1:]
    c = k[1:, 1:]
    d = k[1:, :-1]
    faces = np.concatenate([np.stack(t, axis=2).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
    return Mesh(P.reshape(-1, 3), smooth(P.reshape(-1, 3), faces), uv.reshape(-1, 2), faces)


def smooth(P: Float, faces: NDArray[np.int64]) -> Float:
    """Return the normals at points: means of those of their triangles, by area, across seams as well."""
    a, b, c = (P[faces[:, k]] for k in range(3))
    n = np.cross(b - a, c - a)
    _, same = np.unique(np.round(P, 6), axis=0, return_inverse=True)
    total = np.zeros((same.max() + 1, 3))
    for k in range(3):
        np.add.at(total, same.reshape(-1)[faces[:, k]], n)
    return unit(total[same.reshape(-1)])


def hull(points: ArrayLike) -> Mesh:
    """Return the convex solid around points (n, 3), with flat faces."""
    P = np.asarray(points, np.float64)
    solid = ConvexHull(P)
    n = solid.equations[:, :3]
    corners = P[solid.simplices]
    inward = (
        np.einsum("fk,fk->f", np.cross(*(corners[:, k] - corners[:, 0] for k in (1, 2))), n) < 0
    )
    corners[inward] = corners[inward][:, ::-1]
    normals = np.repeat(n, 3, axis=0)
    vertices = corners.reshape(-1, 3)
    return Mesh(
        vertices, normals, unfold(vertices, normals), np.arange(len(vertices)).reshape(-1, 3)
    )


def unfold(P: Float, n: Float) -> Float:
    """Return uv of points in metres: their places along the two axes that lie most in their surface."""
    axis = np.abs(n).argmax(axis=1)
    return np.stack(
        [np.where(axis == 0, P[:, 2], P[:, 0]), np.where(axis == 1, P[:, 2], P[:, 1])], axis=1
    )


def box(low: ArrayLike, high: ArrayLike, *, bevel: float = 0.008) -> Mesh:
    """Return a box from one corner to the other, its edges taken off: none is quite sharp."""
    low, high = np.minimum(low, high).astype(float), np.maximum(low, high).astype(float)
    cut = min(bevel, 0.3 * float((high - low).min()))
    signs = np.array(np.meshgrid(*[(0, 1)] * 3)).T.reshape(-1, 3)
    corners = low + signs * (high - low)
    inner = corners + cut * (1 - 2 * signs)
    points = [np.where(np.arange(3) == k, corners, inner) for k in range(3)]
    return hull(np.concatenate(points))


def lathe(profile: Sequence[tuple[float, float]], *, sides: int = 24, sharp: bool = False) -> Mesh:
    """Return a solid of revolution about y: profile [(radius, y), ...] from top to bottom."""
    r, y = np.array(profile, np.float64).T
    angle = np.linspace(0, -2 * np.pi, sides + 1)
    P = np.stack(
        np.broadcast_arrays(r[:, None] * np.cos(angle), y[:, None], r[:, None] * np.sin(angle)),
        axis=2,
    )
    return sheet(P[::-1], sharp=sharp)


def tube(path: Places, radius: ArrayLike, *, sides: int = 12) -> Mesh:
    """Return a tube along points (n, 3), with a radius for all or for each, rounded at its ends."""
    C = np.asarray(path, np.float64)
    r = np.broadcast_to(np.asarray(radius, np.float64), len(C))
    T = unit(np.gradient(C, axis=0))
    reach = 1 - np.cos(np.linspace(0, np.pi / 2, 4))[:-1]
    bow = np.sin(np.linspace(0, np.pi / 2, 4))[:-1]
    head = C[0] - np.outer((1 - reach) * r[0], T[0])
    tail = C[-1] + np.outer((1 - reach[::-1]) * r[-1], T[-1])
    C = np.concatenate([head, C, tail])
    T = np.concatenate([np.repeat(T[:1], 3, 0), T, np.repeat(T[-1:], 3, 0)])
    r = np.concatenate([r[0] * bow, r, r[-1] * bow[::-1]])
    side = np.eye(3)[np.abs(T).mean(axis=0).argmin()]
    N = unit(np.cross(T, side))
    B = np.cross(T, N)
    angle = np.linspace(0, 2 * np.pi, sides + 1)
    ring = np.cos(angle)[:, None] * N[:, None] + np.sin(angle)[:, None] * B[:, None]
    return sheet(C[:, None] + r[:, None, None] * ring)


def ball(at: ArrayLike, radius: ArrayLike, *, sides: int = 20) -> Mesh:
    """Return an ellipsoid about a point, with a radius for all axes or for each."""
    angle = np.linspace(0, np.pi, sides // 2 + 1)
    return placed(lathe([(np.sin(a), np.cos(a)) for a in angle], sides=sides), at, scale=radius)


def extrude(outline: ArrayLike, depth: float, *, bevel: float = 0.008) -> Mesh:
    """Return a convex plate: an outline (n, 2) in x and y, from z = -depth / 2 to depth / 2."""
    flat = np.asarray(outline, np.float64)
    middle = flat.mean(axis=0)
    inner = middle + (flat - middle) * (1 - bevel / np.abs(flat - middle).max())
    layers = [
        (inner, depth / 2),
        (flat, depth / 2 - bevel),
        (flat, bevel - depth / 2),
        (inner, -depth / 2),
    ]
    return hull(np.concatenate([np.column_stack([xy, np.full(len(xy), z)]) for xy, z in layers]))


def quad(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike, *, unit_uv: bool = False) -> Mesh:
    """Return a flat rectangle: its corners from the lower left one on, counterclockwise as it is seen."""
    P = np.array([[a, b], [d, c]], np.float64)
    return sheet(P, np.array([[[0, 0], [1, 0]], [[0, 1], [1, 1]]]) if unit_uv else None)
