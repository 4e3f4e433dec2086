"""Explain pixels of a radiance map in words: which photos made a value, and which contradict it.

`pixel_claims` has the numbers. For a color pixel, a sentence states luminances.
"""

import html
from dataclasses import dataclass

import numpy as np

from hdrlab.core.arrays import F64, Array
from hdrlab.core.exposure_text import exposures
from hdrlab.diagnostics.noise import Noise
from hdrlab.errors import InputError
from hdrlab.pipeline.assembly import Assembly
from hdrlab.pipeline.pixel_claims import (
    ChangeKind,
    PixelClaims,
    Role,
    collect_claims,
    luminance,
    require_record,
)
from hdrlab.radiance.merge import Quality

# Photos with a smaller part of the mean hardly count.
MIN_COUNTING_SHARE = 0.01
# The smallest and the largest claim of a group are both stated if they differ by more than this.
MAX_SINGLE_RATIO = 1.05
# stops by which another merge must differ to be part of the sentence
MIN_DIFFERENT_STOPS = 0.25
TABLE_HEADER = ("photo", "exposure", "pixel value", "weight", "share", "claim", "verdict")
NUMBER_WORDS = (
    "no",
    "one",
    "two",
    "three",
    "four",
    "five",
    "six",
    "seven",
    "eight",
    "nine",
    "ten",
    "eleven",
    "twelve",
)

ROLE_WORDS = {
    Role.MEASURED: "measured",
    Role.FLOOR: "black floor",
    Role.BLACK: "black",
    Role.CLIPPED: "clipped",
    Role.MOVED: "left out: moved",
    Role.MASKED: "left out: masked",
}

CHANGE_WORDS = {
    ChangeKind.LIMITED: "Even the longest photo is dark here, which limits the map to {value}.",
    ChangeKind.STUCK: "The pixel is stuck, so the map has the median of its neighbors, {value}.",
    ChangeKind.WHITE: "The reference photo is clipped, and its bound is {value}.",
    ChangeKind.BLENDED: "At the edge of a moving region, it is blended with the map around: {value}.",
    ChangeKind.FADED: "It is too dark to have a color, so the map shows gray, {value}.",
    ChangeKind.REWEIGHTED: "Weighted by the noise of each photo, the mean is {value}.",
    ChangeKind.DEGLARED: "Without the light that the lens scattered here, {value} is left.",
}


@dataclass(frozen=True, kw_only=True)
class PhotoClaim:
    """What one photo shows of a pixel, and which radiance that means.

    Attributes
    ----------
    name : str
    time : float
        Exposure time in seconds.
    exposure : str
        The time in words, or the stops from the shortest photo if only ratios are known.
    levels : tuple of int
        The pixel value of each channel.
    weights : tuple of float
        Weight of each pixel value, 1 for the largest one; 0 where the photo does not count.
    shares : tuple of float
        Part of the mean that is this photo's, in each channel.
    radiance : tuple of float
        The radiance that each pixel value stands for; a bound where it is clipped or 0.
    luminance : float
        Luminance of the radiance, or the radiance itself for a gray photo.
    share : float
        The mean of the shares over the channels, by their weights in the luminance.
    role : Role
        What the photo can measure of the pixel.
    contradicts : bool
        Whether its claim contradicts the map, beyond noise and a quarter of a stop.
    """

    name: str
    time: float
    exposure: str
    levels: tuple[int, ...]
    weights: tuple[float, ...]
    shares: tuple[float, ...]
    radiance: tuple[float, ...]
    luminance: float
    share: float
    role: Role
    contradicts: bool

    @property
    def claim(self) -> str:
        """The luminance in words, such as "3.1" or "at least 40"."""
        return describe_claim(self.luminance, self.role)

    @property
    def share_text(self) -> str:
        """The share in percent."""
        return describe_share(self.share)

    @property
    def verdict(self) -> str:
        """The role in words, and whether the photo contradicts the map."""
        return describe_verdict(self.role, self.contradicts, self.share)

    def row(self) -> tuple[str, ...]:
        """Return the cells of this photo in a table with the header TABLE_HEADER."""
        return (
            self.name,
            self.exposure,
            " ".join(str(level) for level in self.levels),
            " ".join(f"{weight:.3f}" for weight in self.weights),
            self.share_text,
            self.claim,
            self.verdict,
        )


@dataclass(frozen=True, kw_only=True)
class PixelExplanation:
    """What each photo shows of a pixel of a map, and how the map's value came from that.

    Attributes
    ----------
    y, x : int
        Row and column in the map.
    photos : tuple of PhotoClaim
        From the shortest exposure to the longest.
    merge : str
        The method of the merge.
    mean : tuple of float
        The mean of the claims in each channel; a bound if no photo measures the pixel.
    changes : tuple of (str, tuple of float)
        What happened after the mean, in words, and the radiance after each change.
    radiance : tuple of float
        The map's value in each channel.
    deviation : tuple of float
        Its standard deviation, infinite where unknown.
    luminance, luminance_deviation : float
        Of these two. The deviation assumes that the errors of the channels add up.
    quality : Quality
        How the pixel was measured.
    alternatives : dict of str to float
        The luminance that each method of the merge would give.
    sentence : str
        All of this in short.
    """

    y: int
    x: int
    photos: tuple[PhotoClaim, ...]
    merge: str
    mean: tuple[float, ...]
    changes: tuple[tuple[str, tuple[float, ...]], ...]
    radiance: tuple[float, ...]
    deviation: tuple[float, ...]
    luminance: float
    luminance_deviation: float
    quality: Quality
    alternatives: dict[str, float]
    sentence: str

    def __str__(self) -> str:
        """Return a table of the photos as plain text, and the sentence."""
        rows = [TABLE_HEADER, *(photo.row() for photo in self.photos)]
        widths = [max(len(row[k]) for row in rows) for k in range(len(TABLE_HEADER))]
        lines = [self._title(), ""]
        for row in rows:
            cells = [text.ljust(width) for text, width in zip(row, widths, strict=True)]
            lines.append("  ".join(cells).rstrip())
        return "\n".join([*lines, "", self._describe_alternatives(), "", self.sentence])

    def _repr_html_(self) -> str:
        """Return the table and the sentence as HTML, which notebooks show."""
        head = "".join(f"<th scope='col'>{name}</th>" for name in TABLE_HEADER)
        rows = []
        for photo in self.photos:
            columns = "".join(f"<td>{html.escape(text)}</td>" for text in photo.row())
            rows.append(f"<tr>{columns}</tr>")
        return (
            f"<p>{html.escape(self._title())}</p>"
            f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table>"
            f"<p>{html.escape(self._describe_alternatives())}</p>"
            f"<p><b>{html.escape(self.sentence)}</b></p>"
        )

    def _title(self) -> str:
        return f"Pixel x {self.x}, y {self.y}: {self._describe_value()}"

    def _describe_value(self) -> str:
        return describe_value(self.luminance, self.luminance_deviation)

    def _describe_alternatives(self) -> str:
        texts = [f"{name} {shorten(value)}" for name, value in self.alternatives.items()]
        return f"By method of the merge: {', '.join(texts)}. The map's is {self.merge}."


def explain_pixel(state: Assembly, y: int, x: int, noise: Noise | None) -> PixelExplanation:
    """Return the explanation of the pixel E[y, x], see `Assembly.why`.

    Without the noise of the camera, the standard deviation is infinite.

    Raises
    ------
    InputError
        If the pixel is outside of the map, or the photos are not kept.
    """
    require_record(state)
    height, width = state.quality.shape
    if not (0 <= y < height and 0 <= x < width):
        raise InputError(
            f"pixel x {x}, y {y} is outside of the map, which has {width} x {height} pixels"
        )
    claims = collect_claims(state, np.array([y]), np.array([x]), noise)
    return _explain(state, claims, 0)


def _explain(state: Assembly, claims: PixelClaims, i: int) -> PixelExplanation:
    """Return the explanation of the pixel number i."""
    record = require_record(state)
    luminances = luminance(claims.claims[:, i])
    shares = average_shares(claims.shares[:, i])
    texts = exposures(state.bracket)
    photos = []
    for j, name in enumerate(state.bracket.names):
        photos.append(
            PhotoClaim(
                name=name,
                time=float(state.bracket.times[j]),
                exposure=texts[j],
                levels=tuple(claims.levels[j, i].tolist()),
                weights=tuple(claims.weights[j, i].tolist()),
                shares=tuple(claims.shares[j, i].tolist()),
                radiance=tuple(claims.claims[j, i].tolist()),
                luminance=float(luminances[j]),
                share=float(shares[j]),
                role=Role(claims.roles[j, i]),
                contradicts=bool(claims.contradicts[j, i]),
            )
        )
    changes = []
    for change in claims.changes:
        if change.is_changed[i]:
            radiance = change.radiance[i]
            value = shorten(float(luminance(radiance)))
            text = CHANGE_WORDS[change.kind].format(value=value)
            changes.append((text, tuple(radiance.tolist())))
    alternatives = {
        name: float(luminance(values[i])) for name, values in claims.alternatives.items()
    }
    return PixelExplanation(
        y=int(claims.y[i]),
        x=int(claims.x[i]),
        photos=tuple(photos),
        merge=record.method,
        mean=tuple(claims.mean[i].tolist()),
        changes=tuple(changes),
        radiance=tuple(claims.E[i].tolist()),
        deviation=tuple(claims.s[i].tolist()),
        luminance=float(luminance(claims.E[i])),
        luminance_deviation=float(luminance(claims.s[i])),
        quality=Quality(claims.quality[i]),
        alternatives=alternatives,
        sentence=describe_pixel(claims, i, record.method),
    )


def average_shares(shares: F64) -> F64:
    """Return the mean of shares (..., C) over the channels, by their weights in the luminance."""
    return np.asarray(luminance(shares), np.float64)


def describe_pixel(claims: PixelClaims, i: int, method: str) -> str:
    """Return the sentences about the pixel number i of some claims."""
    if (claims.roles[:, i] == Role.MASKED).all():
        return "No photo shows this pixel. The map has 0."
    text = "; ".join([*_describe_bounds(claims, i), *_describe_measurements(claims, i)])
    sentences = [f"{text[0].upper()}{text[1:]}."]
    for change in claims.changes:
        if change.is_changed[i]:
            value = shorten(float(luminance(change.radiance[i])))
            sentences.append(CHANGE_WORDS[change.kind].format(value=value))
    L = float(luminance(claims.E[i]))
    value = describe_value(L, float(luminance(claims.s[i])))
    sentences.append(f"The map has {value}.")
    sentences += _describe_others(claims, i, method)
    return " ".join(sentences)


def _describe_bounds(claims: PixelClaims, i: int) -> list[str]:
    """Return a clause for each group of photos that do not measure the pixel."""
    roles = claims.roles[:, i]
    values = luminance(claims.claims[:, i])
    clauses = []
    count = int((roles == Role.FLOOR).sum())
    if count:
        verb = "show" if count > 1 else "shows"
        values_text = _describe_values(count, values[roles == Role.FLOOR])
        clauses.append(f"{_count_photos(count)} {verb} only the black floor and {values_text}")
    count = int((roles == Role.BLACK).sum())
    if count:
        # the longest one has the tightest upper bound
        values_text = _describe_values(count, values[roles == Role.BLACK][-1:], "at most ")
        clauses.append(
            f"{_count_photos(count)} {'are' if count > 1 else 'is'} black and {values_text}"
        )
    count = int((roles == Role.CLIPPED).sum())
    if count:
        # the shortest one has the tightest lower bound
        values_text = _describe_values(count, values[roles == Role.CLIPPED][:1], "at least ")
        clauses.append(
            f"{_count_photos(count)} {'are' if count > 1 else 'is'} clipped and {values_text}"
        )
    count = int((roles == Role.MOVED).sum())
    if count:
        was = "were" if count > 1 else "was"
        clauses.append(f"{_count_photos(count)} {was} left out because something moved")
    return clauses


def _describe_measurements(claims: PixelClaims, i: int) -> list[str]:
    """Return a clause for the photos that agree with the map, and one for those that contradict it."""
    values = luminance(claims.claims[:, i])
    is_counting = average_shares(claims.shares[:, i]) >= MIN_COUNTING_SHARE
    is_measured = claims.roles[:, i] == Role.MEASURED
    is_contrary = is_measured & claims.contradicts[:, i]
    is_agreeing = is_measured & ~is_contrary
    clauses = []
    if is_agreeing.any():
        count = int(is_agreeing.sum())
        believed = is_agreeing & is_counting
        if not believed.any():
            believed = is_agreeing
        values_text = _describe_values(count, values[believed])
        clauses.append(f"the {_count_photos(count)} that measured this pixel {values_text}")
    if is_contrary.any():
        count = int(is_contrary.sum())
        subject = f"the {_count_photos(count)} that measured this pixel"
        if is_agreeing.any():
            subject = f"{_number(count)} {'others' if count > 1 else 'other'}"
        contradict = "contradict" if count > 1 else "contradicts"
        clauses.append(
            f"{subject} {contradict} the map and {_describe_values(count, values[is_contrary])}"
        )
    if not is_measured.any() and not (claims.roles[:, i] == Role.FLOOR).any():
        clauses.append("no photo measured this pixel")
    return clauses


def _describe_others(claims: PixelClaims, i: int, method: str) -> list[str]:
    """Return a sentence with the other merges that differ much, or none."""
    own = float(luminance(claims.alternatives[method][i]))
    texts = []
    for name, radiance in claims.alternatives.items():
        other = float(luminance(radiance[i]))
        if min(own, other) <= 0 or abs(np.log2(other / own)) <= MIN_DIFFERENT_STOPS:
            continue
        texts.append(f"{name} {shorten(other)}")
    return [f"Other merges would give: {', '.join(texts)}."] if texts else []


def describe_claim(value: float, role: Role | int) -> str:
    """Return the luminance of a claim, and whether it is a bound."""
    if role == Role.MASKED:
        return "–"
    if role == Role.CLIPPED:
        return f"at least {shorten(value)}"
    if role == Role.BLACK:
        return f"at most {shorten(value)}"
    return shorten(value)


def describe_verdict(role: Role | int, contradicts: bool, share: float) -> str:
    """Return the role of a photo in words, and whether it agrees with the map."""
    words = ROLE_WORDS[Role(role)]
    if contradicts:
        return f"{words}, contradicts the map"
    if role == Role.MEASURED:
        return "agrees" if share >= MIN_COUNTING_SHARE else "agrees, counts below 1 %"
    return words


def describe_share(share: float) -> str:
    """Return a part of the mean in percent; 0 and 100 stand for none and all."""
    percent = 100 * share
    if share in (0, 1):
        return f"{percent:.0f} %"
    if percent < 0.1:
        return "< 0.1 %"
    return f"{min(percent, 99.9):.1f} %"


def describe_value(value: float, deviation: float) -> str:
    """Return a radiance and its standard deviation, which is left out if it is infinite."""
    if not np.isfinite(deviation):
        return shorten(value)
    return f"{shorten(value)} ± {shorten(deviation, digits=2)}"


def shorten(value: float, digits: int = 3) -> str:
    """Return a number with at most three digits, without an exponent where it is short.

    Examples
    --------
    >>> [shorten(value) for value in (0.0, 0.012345, 3.14159, 1234.5, 2e-6)]
    ['0', '0.0123', '3.14', '1230', '2e-06']
    """
    if value == 0:
        return "0"
    rounded = float(f"{value:.{digits - 1}e}")
    return f"{rounded:.10g}"


def _number(count: int) -> str:
    return NUMBER_WORDS[count] if count < len(NUMBER_WORDS) else str(count)


def _count_photos(count: int) -> str:
    return f"{_number(count)} {'photo' if count == 1 else 'photos'}"


def _describe_values(count: int, values: Array, limit: str = "") -> str:
    """Return the radiance that a group of photos gives: one value, or the smallest and the largest."""
    verb = "give" if count > 1 else "gives"
    low = float(np.min(values))
    high = float(np.max(values))
    if high <= MAX_SINGLE_RATIO * low:
        middle = float(np.sqrt(low) * np.sqrt(high))
        return f"{verb} {limit}{shorten(middle)}"
    return f"{verb} {limit}{shorten(low)} to {shorten(high)}"
