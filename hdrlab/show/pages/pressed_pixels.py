"""What a report shows about a pressed pixel: the claims of all photos, on a grid over the picture.

`press.js` reads the data. Each block is deflated and in base64, and its numbers are unsigned 8-bit or
16-bit planes, as the differences of neighbors. Radiance is stored as its logarithm in 65,535 steps,
which is exact to 0.1 % over 60 stops, and 0 stands for no radiance.
"""

import zlib
from base64 import b64encode
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from hdrlab.core.arrays import Array
from hdrlab.pipeline.assembly import Assembly
from hdrlab.pipeline.explanation import (
    MIN_COUNTING_SHARE,
    PixelExplanation,
    average_shares,
    describe_pixel,
    describe_verdict,
)
from hdrlab.pipeline.pixel_claims import PixelClaims, Role, collect_claims, luminance

SCRIPT = Path(__file__).parent / "press.js"
# Photos times pixels of the grid. It bounds the size of the page: these claims, with a sentence for
# each pixel, need about 0.4 megabytes.
MAX_CLAIMS = 50_000
LARGEST_CODE = 65_535
# How a claim begins, by the role of its photo; a masked photo claims nothing.
CLAIM_PREFIXES = {Role.CLIPPED: "at least ", Role.BLACK: "at most ", Role.MASKED: None}


def describe_pixels(assembly: Assembly) -> dict[str, Any] | None:
    """Return the data of all pixels of a grid, and the explanation of the one in the middle.

    Return None if the photos are not kept.
    """
    height, width = assembly.quality.shape
    count = len(assembly.bracket.times)
    if assembly.record is None or len(assembly.bracket.images) != count:
        return None
    step = max(1, int(np.ceil(np.sqrt(height * width * count / MAX_CLAIMS))))
    rows = np.arange(min(step // 2, height - 1), height, step)
    columns = np.arange(min(step // 2, width - 1), width, step)
    y, x = (grid.ravel() for grid in np.meshgrid(rows, columns, indexing="ij"))
    claims = collect_claims(assembly, y, x, assembly.sensor_noise)
    middle = assembly.why(int(rows[len(rows) // 2]), int(columns[len(columns) // 2]))
    return {
        "first": middle,
        "step": step,
        "data": {
            "rows": rows.tolist(),
            "columns": columns.tolist(),
            "at": [len(rows) // 2, len(columns) // 2],
            "merges": list(claims.alternatives),
            **_encode_claims(claims, middle),
        },
    }


def read_script() -> tuple[str, str]:
    """Return the script of the page, and its hash for the page's content security policy."""
    text = SCRIPT.read_text("utf-8")
    return text, b64encode(sha256(text.encode()).digest()).decode()


def _encode_claims(claims: PixelClaims, middle: PixelExplanation) -> dict[str, Any]:
    """Return the numbers and sentences of all pixels, deflated."""
    count = len(claims.y)
    shares = average_shares(claims.shares)
    radiance = np.concatenate(
        [
            luminance(claims.claims),
            [luminance(values) for values in claims.alternatives.values()],
            [luminance(claims.E.astype(np.float64))],
        ]
    )
    codes, low, octaves_per_step = _encode_logarithms(radiance)
    verdicts, verdict_numbers = _number_verdicts(claims, shares)
    share_codes = np.round(shares * LARGEST_CODE)
    # only 0 and 1 mean none and all
    is_part = (shares > 0) & (shares < 1)
    share_codes = np.where(is_part, np.clip(share_codes, 1, LARGEST_CODE - 1), share_codes)
    sentences = [describe_pixel(claims, i, middle.merge) for i in range(count)]
    return {
        "channels": claims.levels.shape[2],
        "wide": claims.levels.dtype == np.uint16,
        "levels": _pack(claims.levels.transpose(0, 2, 1)),
        "radiance": _pack(codes),
        "low": low,
        "octaves": octaves_per_step,
        "shares": _pack(share_codes.astype(np.uint16)),
        "verdicts": verdicts,
        "verdict": _pack(verdict_numbers),
        "sentences": b64encode(zlib.compress("\n".join(sentences).encode())).decode(),
    }


def _number_verdicts(claims: PixelClaims, shares: Array) -> tuple[list[list[str | None]], Array]:
    """Return the different verdicts, each with the prefix of its claim, and their numbers (P, M)."""
    is_counting = shares >= MIN_COUNTING_SHARE
    kinds = 4 * claims.roles.astype(int) + 2 * claims.contradicts + is_counting
    different, indices = np.unique(kinds, return_inverse=True)
    verdicts = []
    for kind in different.tolist():
        role = Role(kind // 4)
        share = MIN_COUNTING_SHARE if kind % 2 else 0.0
        words = describe_verdict(role, bool(kind // 2 % 2), share)
        verdicts.append([words, CLAIM_PREFIXES.get(role, "")])
    return verdicts, indices.reshape(kinds.shape).astype(np.uint8)


def _encode_logarithms(values: Array) -> tuple[Array, float, float]:
    """Return values as 16-bit codes k, log2 value = low + (k - 1) step, and low and step; 0 is 0."""
    is_positive = values > 0
    if not is_positive.any():
        return np.zeros(values.shape, np.uint16), 0.0, 1.0
    logarithms = np.log2(np.where(is_positive, values, 1))
    low = float(logarithms[is_positive].min())
    high = float(logarithms[is_positive].max())
    step = max(high - low, 1e-6) / (LARGEST_CODE - 1)
    codes = np.where(is_positive, np.round((logarithms - low) / step) + 1, 0)
    return codes.astype(np.uint16), low, step


def _pack(planes: Array) -> str:
    """Return planes (..., M) of 8 or 16 bits, deflated: differences, first of all low bytes."""
    steps = np.diff(planes, axis=-1, prepend=np.zeros_like(planes[..., :1]))
    if steps.dtype == np.uint16:
        steps = np.stack([steps & 255, steps >> 8]).astype(np.uint8)
    return b64encode(zlib.compress(np.ascontiguousarray(steps).tobytes(), 9)).decode()
