"""The moving picture of README: what `play` shows in notebook 04, as an animated WebP.

A dot is the level of a pixel in one photograph of a bracket, over ln exposure as it would be if all
pixels had the same light. As the ln E of each pixel is added, all dots slide onto one curve, the
response g.

    python -m scenes.readme -o README.webp
"""

import argparse
import io
from pathlib import Path

import numpy as np
from PIL import Image

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.core import sampling, weights
from hdrlab.response import debevec
from hdrlab.show import plots, widgets

FILM = camera.Camera(sensitivity=1 / 16, full_well=20_000, read_noise=5)
TIMES = 2.0 ** np.arange(-10, 3, 2)
# milliseconds
STEP = 70
HOLD = 1600


def player(shape: tuple[int, int] = (256, 384), steps: int = 21) -> widgets.Player:
    """Return the widget of the notebook: points of sixty pixels that slide onto one curve."""
    bracket = camera.shoot(scenes.room(shape), TIMES, FILM, rng=4)
    B = np.log(bracket.times)
    Z = sampling.by_grid(bracket.images[..., 1], 60)
    g, lE = debevec.gsolve(Z, B, 30, weights.hat())
    parts = np.linspace(0, 1, steps)
    span = (B[0] - 1, B[0] + 17)
    return widgets.play(
        parts, lambda part: plots.samples(Z, part * lE, B, g=g, span=span), alt="Onto one curve"
    )


def animate(frames: list[bytes]) -> bytes:
    """Return encoded pictures as an animated WebP without loss, there and back, with a pause at both ends."""
    there = [Image.open(io.BytesIO(frame)).convert("RGB") for frame in frames]
    lasts = [STEP] * len(there)
    lasts[0] = lasts[-1] = HOLD
    back = slice(-2, 0, -1)
    out = io.BytesIO()
    options = {"lossless": True, "quality": 100, "method": 6, "loop": 0}
    film = [*there, *there[back]]
    film[0].save(
        out,
        "WEBP",
        save_all=True,
        append_images=film[1:],
        duration=[*lasts, *lasts[back]],
        **options,
    )
    return out.getvalue()


def main() -> None:
    """Write the picture."""
    parser = argparse.ArgumentParser(
        prog="python -m scenes.readme", description="Draw README's moving picture."
    )
    parser.add_argument("-o", "--out", type=Path, default=Path("README.webp"))
    parser.parse_args().out.write_bytes(animate(player().frames))


if __name__ == "__main__":
    main()
