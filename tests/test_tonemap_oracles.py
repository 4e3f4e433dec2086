"""The operators beside those of pfstools, on the same luminance, with the knobs that both have set alike.

Likeness is measured on the displays' sRGB values, as the eye compares them: mean structural similarity (SSIM,
windows of 7 x 7 pixels) and correlation. The bounds below are what must hold in every scene, next to what was
measured on the room and on the memorial church with pfstools 2.1:

operator                 SSIM at least, measured     correlation at least, measured
reinhard, global         0.99      1.000  1.000      0.999     1.000  1.000
reinhard, local          0.95      0.971  0.983      0.99      0.997  0.997
durand                   0.94      0.972  0.989      0.97      0.992  0.993
fattal                   0.90      0.936  0.976      0.96      0.978  0.991
"""

import shutil
import subprocess
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest
from skimage.metrics import structural_similarity

from hdrlab.capture import scenes
from hdrlab.core.colour import encode_srgb, luminance
from hdrlab.io.radiance import read_radiance

WHITE = np.float32([0.9505, 1, 1.089])  # XYZ of a gray of luminance 1, so that pfstools sees no colour


class Likeness(NamedTuple):
    """How much two displays are alike."""

    ssim: float
    correlation: float


def pfstmo(tool, L, *options):
    """Return the luminance (H, W) that an operator of pfstools answers, cut to [0, 1]."""
    if not shutil.which(tool):
        pytest.skip(f"{tool} of pfstools is not installed")
    head = f"PFS1\n{L.shape[1]} {L.shape[0]}\n3\n0\n" + "".join(f"{c}\n0\n" for c in "XYZ") + "ENDH"
    given = head.encode() + (WHITE[:, None, None] * L).astype("<f4").tobytes()
    ran = subprocess.run([tool, *options], input=given, capture_output=True, timeout=120)
    if ran.returncode < 0:
        pytest.skip(
            f"{tool} dies of signal {-ran.returncode}, as that of Debian 12 is known to on some machines"
        )
    assert ran.returncode == 0, ran.stderr.decode()
    body = ran.stdout[ran.stdout.index(b"ENDH") + 4 :]
    return np.clip(np.frombuffer(body, "<f4").reshape(3, *L.shape)[1], 0, 1)


def likeness(ours, theirs):
    a, b = encode_srgb(ours), encode_srgb(theirs)
    ssim = structural_similarity(a, b, data_range=1)
    return Likeness(float(ssim), float(np.corrcoef(a.ravel(), b.ravel())[0, 1]))


@pytest.fixture(params=["room", "memorial", "lobby"])
def L(request):
    """The luminance of a scene: the simulated room everywhere, real places where they are at hand."""
    if request.param == "room":
        return room()
    folder, file, step = {"memorial": ("memorial", "memorial.hdr", 1), "lobby": ("hdri_cc0", "lobby.hdr", 2)}[
        request.param
    ]
    E = read_radiance(request.getfixturevalue("shared")(folder) / file)
    return np.ascontiguousarray(luminance(E)[::step, ::step])


@cache
def room():
    return luminance(scenes.room((240, 360)))


def operator(name):
    return pytest.importorskip(f"hdrlab.tonemap.{name}")


def test_the_measure_tells_a_picture_from_a_flat_one_and_from_its_mirror():
    """So that the bounds below mean something: SSIM and correlation of what is not alike are far below."""
    Ld = operator("reinhard").tonemap(room())
    assert likeness(Ld, Ld) == pytest.approx((1, 1))
    assert max(likeness(Ld, Ld[:, ::-1])) < 0.7
    assert likeness(Ld, np.full_like(Ld, 0.2) + 1e-3 * Ld).ssim < 0.6
    assert likeness(Ld, np.minimum(8 * Ld, 1)).ssim < 0.9


def test_reinhards_curve_is_pfstools_own(L):
    """Both are equation 4. Theirs takes the brightest pixel for white; ours leaves out one in ten thousand,
    unless told, as it is here. What remains is their log average: its floor for black is another.
    """
    reinhard = operator("reinhard")
    white = float(reinhard.scaled(L).max())
    found = likeness(reinhard.tonemap(L, white=white), pfstmo("pfstmo_reinhard02", L))
    assert found.ssim > 0.99 and found.correlation > 0.999, found


def test_reinhards_dodge_and_burn_is_like_pfstools(L):
    """Theirs has no white in the local mode, so ours gets an infinite one.

    Their eight widths run from 1 to 43 in other steps, so some pixels get another neighbourhood.
    """
    ours = operator("reinhard").tonemap(L, local=True, white=np.inf)
    found = likeness(ours, pfstmo("pfstmo_reinhard02", L, "--scales"))
    assert found.ssim > 0.95 and found.correlation > 0.99, found


def test_durands_compression_is_like_pfstools(L):
    """With one width in space, and ours in range and contrast brought from decades to nats, which are theirs.

    Theirs anchors the base so that other pixels burn: gammas of 1.08 to 1.19 lie between the two. It also
    leaves a lone pixel's base as it is, where ours follows the paper and takes that of the neighbourhood.
    """
    sigma_s, nats = 0.02 * max(L.shape), np.log(10)
    ours = operator("durand").tonemap(L, sigma_s=sigma_s, sigma_r=0.4, contrast=50)
    options = ("--sigma-s", f"{sigma_s}", "--sigma-r", f"{0.4 * nats}", "--base-contrast", f"{np.log(50)}")
    found = likeness(ours, pfstmo("pfstmo_durand02", L, *options, "--original", "--quiet"))
    assert found.ssim > 0.94 and found.correlation > 0.97, found


def test_fattals_compression_is_like_pfstools(L):
    """With the paper's alpha = 0.1, attenuation at every level (--detail-level 0), and without their gamma.

    What remains is mostly a gamma, 0.93 to 1.32 by the scene: every level of the pyramid multiplies the
    contrast, and theirs ends at a size of its own. Their noise floor is in nats, ours in mean slopes.
    """
    options = ("--alpha", "0.1", "--beta", "0.9", "--detail-level", "0", "--gamma", "1")
    found = likeness(operator("fattal").tonemap(L), pfstmo("pfstmo_fattal02", L, *options))
    assert found.ssim > 0.90 and found.correlation > 0.96, found
