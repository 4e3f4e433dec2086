"""What goes wrong while a bracket is taken: each ill by its name."""

from functools import cache

import numpy as np
from scipy.ndimage import gaussian_filter, map_coordinates

from benchmarks.verdicts.brackets import SHAPE, Float, Ill, Plan
from hdrlab import scenes
from hdrlab.capture import movers
from hdrlab.capture.hand_motion import views
from hdrlab.core.arrays import Array
from hdrlab.core.filters import warp
from hdrlab.scenes.places import Layers

Draw = np.random.Generator


def state_one(factor: float) -> Ill:
    """Return the ill of one time that is stated too long or too short by a factor."""

    def times(plan: Plan, t: Float) -> Float:
        stated = t.copy()
        stated[plan.one] *= factor if plan.i // 4 % 2 else 1 / factor
        return stated

    return Ill(f"one time wrong by a factor of {factor:g}", times=times)


def change_iso(plan: Plan, j: int, rng: Draw, E: Array) -> Array:
    """Double the signal of one frame."""
    return E * np.float32(2) if j == plan.one else E


def open_aperture(plan: Plan, j: int, rng: Draw, E: Array) -> Array:
    """Let the corners fall off more in every frame: by nothing in the first, by two thirds in the last."""
    y, x = np.indices(E.shape[:2]) / (np.array(E.shape[:2])[:, None, None] - 1) * 2 - 1
    lost = 2 / 3 * j / (plan.frames - 1) * (x**2 + y**2) / 2
    return (E * (1 - lost)[..., None]).astype(np.float32)


def map_by_place(plan: Plan, j: int, rng: Draw, Z: Array) -> Array:
    """Multiply by L^-0.4, L the mean over a 20th of the width."""
    sigma = Z.shape[1] / 20
    L = gaussian_filter(Z.mean(axis=-1) + 1, (sigma, sigma))
    return np.clip(np.rint(Z * (L[..., None] / 128) ** -0.4), 0, 255).astype(np.uint8)


def balance_white(plan: Plan, j: int, rng: Draw, E: Array) -> Array:
    """Take one frame under another white balance."""
    return (E * np.array([1.35, 1, 0.72], np.float32)) if j == plan.one else E


def bend_curve(plan: Plan, j: int, rng: Draw, Z: Array) -> Array:
    """Bend the tone curve: by an exponent from 1.08 in the darkest frame to 0.92 in the brightest."""
    exponent = 1.08 - 0.16 * j / (plan.frames - 1)
    return np.rint(255 * (Z / 255) ** exponent).astype(np.uint8)


@cache
def blob(seed: int, share: float = 0.4) -> Array:
    """Return a soft region (H, W) that covers a share of the picture."""
    field = gaussian_filter(np.random.default_rng((17, seed)).standard_normal(SHAPE), 50)
    return np.clip((field - np.quantile(field, 1 - share)) / field.std() * 8 + 0.5, 0, 1)


def blow(plan: Plan, j: int, rng: Draw, E: Array) -> Array:
    """Let leaves move by a few pixels over 40 % of the picture."""
    leaves = np.random.default_rng((18, plan.i)).standard_normal(SHAPE)
    leaves = gaussian_filter(leaves, 1.5)
    dy, dx = (gaussian_filter(rng.standard_normal(SHAPE), 12) * 12 * 3.5 * 3 for _ in range(2))
    y, x = np.indices(SHAPE)
    moved = map_coordinates(leaves / leaves.std(), [y + dy, x + dx], order=1, mode="reflect")
    return (E * np.exp(0.6 * moved * blob(plan.i))[..., None]).astype(np.float32)


def ripple(plan: Plan, j: int, rng: Draw, E: Array) -> Array:
    """Let water glitter over the lower third."""
    waves = gaussian_filter(rng.standard_normal(SHAPE), (1.5, 6))
    water = np.clip((np.arange(SHAPE[0]) - 2 / 3 * SHAPE[0]) / 10, 0, 1)[:, None]
    return (E * np.exp(0.5 * waves / waves.std() * water)[..., None]).astype(np.float32)


def walk(plan: Plan, j: int, rng: Draw, E: Array) -> Array:
    """Let somebody walk through the picture."""
    step = 30 * (j - plan.frames // 2)
    if plan.scene != "room":
        return scenes.compose(_layers(plan.scene), (0, step))
    figure = movers.ball(
        SHAPE, (SHAPE[0] / 2, SHAPE[1] / 2), SHAPE[0] / 8, np.full(3, 2 * np.median(E))
    )
    return movers.compose_moment(E, figure, (0, step))[0]


@cache
def _layers(name: str) -> Layers:
    return scenes.layers(name, SHAPE)


def shake(plan: Plan, j: int, rng: Draw, E: Array) -> Array:
    """Turn the camera by up to 1.5 degrees and shift it by up to 8 pixels; the middle frame stays."""
    radius, degrees = rng.uniform(-8, 8, 2), rng.uniform(-1.5, 1.5)
    H = np.eye(3) if j == plan.frames // 2 else warp.turn(SHAPE, degrees, radius)
    far = np.array(
        [warp.turn(SHAPE, phi, at) for phi in (-1.5, 1.5) for at in ((8, 8), (-8, -8), (8, -8))]
    )
    return np.asarray(views(E, np.concatenate([H[None], far, np.eye(3)[None]]))[0])


def step_aside(plan: Plan, j: int, rng: Draw, E: Array) -> Array:
    """Move the camera sideways: near things shift by up to 12 pixels, far ones hardly."""
    depth = (
        _layers(plan.scene).depth
        if plan.scene != "room"
        else np.linspace(8, 1.5, SHAPE[0])[:, None]
    )
    near = np.broadcast_to(np.quantile(depth, 0.05) / np.maximum(depth, 1e-3), SHAPE)
    y, x = np.indices(SHAPE)
    dx = rng.uniform(-12, 12) * near * (j != plan.frames // 2)
    return np.stack(
        [map_coordinates(one, [y, x + dx], order=1, mode="reflect") for one in E.T.swapaxes(1, 2)],
        -1,
    )


def flicker(plan: Plan, j: int, rng: Draw, E: Array) -> Array:
    """Let the lamps be another half a stop brighter or darker in each frame, with bands over the rows."""
    gain = 2 ** rng.uniform(-0.5, 0.5)
    rows = np.sin(2 * np.pi * (np.arange(SHAPE[0]) / SHAPE[0] * 3 + rng.uniform()))
    return (E * gain * (1 + 0.15 * rows)[:, None, None]).astype(np.float32)


ILLS = {
    "time-10": state_one(1.1),
    "time-25": state_one(1.25),
    "time-stop": state_one(2.0),
    "iso": Ill("one frame at twice the ISO that is stated", light=change_iso),
    "vignetting": Ill("vignetting that changes with the aperture", light=open_aperture),
    "local": Ill("local tone mapping, L^-0.4", levels=map_by_place),
    "white": Ill("another white balance in one frame", light=balance_white),
    "curve": Ill("a tone curve that bends with exposure", levels=bend_curve),
    "wind": Ill("wind in leaves", True, light=blow),
    "water": Ill("water", True, light=ripple),
    "people": Ill("somebody walks through the picture", True, light=walk),
    "shake": Ill("hand shake with rotation", True, light=shake),
    "parallax": Ill("parallax", True, light=step_aside),
    "flicker": Ill("flicker of lamps", light=flicker),
}
