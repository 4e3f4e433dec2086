"""A project with classes: a print is made in steps, as in a darkroom."""

# %%
import numpy as np
from scipy.ndimage import gaussian_filter

# %%


class Negative:
    """A scene whose log average is 1."""

    def __init__(self, light):
        self.light = np.array(light, dtype=np.float64)
        if self.light.ndim != 2 or np.isnan(self.light).any() or np.isinf(self.light).any():
            raise ValueError("a scene is (H, W) and finite")
        if (self.light < 0).any():
            raise ValueError("light cannot be negative")
        self.black = not (self.light > 0).any()

    def exposed(self, a):
        stops = np.log2(self.light[self.light > 0])
        return np.exp2(np.log2(a) - stops.mean()) * self.light


class Paper:
    def __init__(self, exposed, burnt):
        self.exposed = exposed
        rest = round(exposed.size * 1e-4)
        self.burnt = burnt or max(np.sort(exposed, axis=None)[::-1][rest], 1.0)

    def develop(self, held):
        tone = self.exposed + (self.exposed / self.burnt) ** 2
        return (tone / (held + 1)).clip(max=1.0).astype(np.float32)


def dodge(Lm, constant, epsilon):
    wide = np.stack([gaussian_filter(Lm, 0.25 * s) for s in 1.6 ** np.arange(9.0)])
    sharp = constant / 1.6 ** (2.0 * np.arange(8))[:, None, None]
    uneven = np.abs(wide[:-1] - wide[1:]) >= epsilon * (sharp + wide[:-1])
    first = np.where(uneven.any(axis=0), uneven.argmax(axis=0), 8)
    return np.take_along_axis(wide, np.maximum(first - 1, 0)[None], axis=0)[0]


# %% task="tonemap"


def tonemap(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    if any(knob is not None and not knob > 0 for knob in (key, white, phi, threshold)):
        raise ValueError("knobs are above 0")
    negative = Negative(L)
    if negative.black:
        return np.zeros_like(negative.light)
    Lm = negative.exposed(key)
    return Paper(Lm, white).develop(dodge(Lm, 2**phi * key, threshold) if local else Lm)
