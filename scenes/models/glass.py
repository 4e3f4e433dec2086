"""Stained glass, drawn: the colours that light takes in a window, and the lead between them.

T  transmittance (h, w, 3), 0 to 1; rows run downwards
"""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter
from scipy.spatial import cKDTree

Float = NDArray[np.float64]
RUBY = (0.62, 0.015, 0.02)
COBALT = (0.01, 0.035, 0.5)
AZURE = (0.06, 0.26, 0.72)
EMERALD = (0.02, 0.3, 0.07)
GOLD = (0.95, 0.6, 0.08)
AMBER = (0.85, 0.3, 0.03)
PEARL = (0.8, 0.82, 0.75)
VIOLET = (0.2, 0.03, 0.34)
SKIN = (0.85, 0.55, 0.36)


def cells(at: Float, points: Float) -> tuple[NDArray[np.int_], Float]:
    """Return for each place which point is nearest, and how far it is from being nearer to another."""
    distance, index = cKDTree(points).query(at.reshape(-1, 2), k=2)
    return index[:, 0].reshape(at.shape[:2]), (distance[:, 1] - distance[:, 0]).reshape(
        at.shape[:2]
    )


def coloured(
    choice: NDArray[np.int_], palette: list[tuple[float, float, float]], *, rng: np.random.Generator
) -> Float:
    """Return a colour for each number, no two pieces of quite the same glass."""
    count = int(choice.max()) + 1
    glass = np.array(palette)[rng.integers(0, len(palette), count)]
    return (glass * np.exp(rng.normal(0, 0.28, (count, 1))))[choice]


def lancet(seed: int, *, aspect: float = 2.9, width: int = 256) -> Float:
    """Return T of a tall window: a border of beads, and medallions on a ground of small pieces."""
    rng = np.random.default_rng(seed)
    height = int(width * aspect)
    y, x = np.mgrid[:height, :width] / width  # in widths of the window, from its upper left corner
    at = np.stack([y, x], axis=2)
    field = rng.uniform((0, 0), (aspect, 1), (int(70 * aspect), 2))
    index, lead = cells(at, field)
    cold = bool(seed % 2)
    T = coloured(
        index, [COBALT, COBALT, AZURE, VIOLET] if cold else [RUBY, RUBY, VIOLET, COBALT], rng=rng
    )
    for k, middle in enumerate(np.arange(0.72, aspect - 0.3, 0.74)):
        T, lead = medallion(T, lead, at, (middle, 0.5), 0.33, rng=rng, warm=cold == (k % 2 == 0))
    edge = np.minimum(np.minimum(x, 1 - x), aspect - y)
    bead, apart = cells(at, beads(aspect))
    border = edge < 0.1
    T = np.where(border[..., None], coloured(bead, [GOLD, PEARL, EMERALD, RUBY], rng=rng), T)
    lead = np.where(
        border, np.minimum(apart, 2 * np.abs(edge - 0.1)), np.minimum(lead, 2 * np.abs(edge - 0.1))
    )
    bars = np.abs((y + 0.02) % 0.74 - 0.37)  # the iron that holds the panels
    return leaded(T, np.minimum(lead, 2 * bars - 0.012), width, rng)


def beads(aspect: float) -> Float:
    """Return the middles of the pieces along the border of a window."""
    along = np.arange(0.05, aspect, 0.11)
    sides = [np.column_stack([along, np.full_like(along, x)]) for x in (0.05, 0.95)]
    across = np.arange(0.15, 0.9, 0.11)
    return np.concatenate([*sides, np.column_stack([np.full_like(across, aspect - 0.05), across])])


def medallion(
    T: Float,
    lead: Float,
    at: Float,
    middle: tuple[float, float],
    radius: float,
    *,
    rng: np.random.Generator,
    warm: bool,
) -> tuple[Float, Float]:
    """Return a window with a round picture in it: petals, a ring, and a heart of pale glass."""
    d = at - np.array(middle)
    r = np.hypot(d[..., 0], d[..., 1]) / radius
    angle = np.arctan2(d[..., 1], d[..., 0])
    petals = 8 if warm else 6
    turn = (angle / (2 * np.pi) * petals + 0.5) % petals
    piece = (
        turn.astype(int) + petals * (r > 0.36) + petals * (r > 0.72 + 0.1 * np.cos(petals * angle))
    )
    palettes = (
        [[PEARL, GOLD], [RUBY, AMBER], [GOLD, EMERALD]],
        [[GOLD, SKIN], [AZURE, PEARL], [RUBY, GOLD]],
    )
    inside = np.zeros((*r.shape, 3))
    for ring, palette in enumerate(palettes[0] if warm else palettes[1]):
        colours = coloured(piece, palette, rng=rng)
        inside = np.where((piece // petals == ring)[..., None], colours, inside)
    spoke = np.abs(turn % 1 - 0.5)
    seam = np.minimum((0.5 - spoke) * r * radius * 5, np.abs(r - 0.36) * radius * 2)
    seam = np.minimum(seam, np.abs(r - 0.72 - 0.1 * np.cos(petals * angle)) * radius * 2)
    rim = 2 * np.abs(r - 1) * radius - 0.01
    within = (r < 1)[..., None]
    return np.where(within, inside, T), np.minimum(np.where(r < 1, seam, lead), rim)


def rose(seed: int, *, size: int = 512, petals: int = 12) -> Float:
    """Return T of a round window: stone tracery around an eye, petals, and roundels at the rim."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[:size, :size] * 2 / size - 1
    r = np.hypot(y, x)
    angle = np.arctan2(x, -y)
    index, lead = cells(np.stack([y, x], axis=2), rng.uniform(-1, 1, (420, 2)))
    turn = (angle / (2 * np.pi) * petals) % petals
    T = np.where(
        (turn.astype(int) % 2 == 0)[..., None],
        coloured(index, [COBALT, AZURE, COBALT], rng=rng),
        coloured(index, [RUBY, RUBY, VIOLET], rng=rng),
    )
    flame = np.abs(turn % 1 - 0.5) < 0.2 * np.sin(np.clip((r - 0.25) / 0.5, 0, 1) * np.pi) ** 0.7
    T = np.where(flame[..., None], coloured(index, [GOLD, AMBER, PEARL], rng=rng), T)
    stone = np.abs(turn % 1) * r < 0.09  # spokes, and the round ribs
    eye = r < 0.22
    T = np.where(eye[..., None], coloured(index, [PEARL, GOLD], rng=rng), T)
    for ring in (0.22, 0.78):
        stone |= np.abs(r - ring) < 0.022
    roundel = np.hypot((turn % 1 - 0.5) * 2 * np.pi / petals * 0.885, r - 0.885)
    T = np.where((roundel < 0.085)[..., None], coloured(index, [GOLD, PEARL, EMERALD], rng=rng), T)
    stone |= (
        (np.abs(roundel - 0.095) < 0.014)
        | ((r > 0.78) & (roundel > 0.095) & (r < 0.8))
        | (r > 0.985)
    )
    return leaded(np.where(stone[..., None], 0.0, T), lead * 0.8, size, rng)


def leaded(T: Float, lead: Float, width: int, rng: np.random.Generator) -> Float:
    """Return T with the lead drawn in, the glass streaked and darker at its edges, where dirt gathers."""
    grain = (
        gaussian_filter(rng.standard_normal(T.shape[:2]), (6, 2)) * 5
        + gaussian_filter(rng.standard_normal(T.shape[:2]), 1) * 1.2
    )
    share = np.clip(lead * width / 2 - 0.9, 0, 1) * (0.65 + 0.35 * np.clip(lead * width / 12, 0, 1))
    return np.clip(T * (share * np.exp(0.3 * grain))[..., None], 1e-4, 0.97)
