"""Plots of skin colors."""

import numpy as np
import pytest
from support import synthetic_skin

from hdrlab.enhance import skin
from hdrlab.show.plots.lectures import skins

TRAINING = synthetic_skin.sample_skin(3000)


def test_ellipse_has_the_given_mahalanobis_distance_from_the_mean():
    known = skin.DEFAULT
    edge = (
        np.column_stack(skins.chrominance(TRAINING, known, reach=2.0).lines[1].get_data())
        - known.mu
    )
    distance = np.sqrt(np.einsum("ni,ij,nj->n", edge, np.linalg.inv(known.S), edge))
    assert np.allclose(distance, 2.0)


def test_dots_are_a_limited_number_of_the_pixels():
    ax = skins.chrominance(TRAINING, skin.DEFAULT)
    dots = np.column_stack(ax.lines[0].get_data())
    assert 1000 < len(dots) <= skins.MAX_DOTS
    assert np.allclose(dots[1], skin.chrominance(TRAINING[2]))


def test_drawn_parabolas_enclose_the_pixels_of_the_skin_locus():
    ax = skins.locus(TRAINING)
    r, g = ax.lines[0].get_data()
    upper = np.interp(r, *ax.lines[1].get_data())
    lower = np.interp(r, *ax.lines[2].get_data())
    inside = (lower < g) & (g < upper)
    assert np.mean(inside == skin.find_by_locus(TRAINING[::2])) > 0.97


@pytest.mark.parametrize("bad", [np.zeros((4, 4)), np.zeros((0, 3))])
def test_locus_rejects_arrays_without_rgb_pixels(bad):
    with pytest.raises(ValueError, match="pixels"):
        skins.locus(bad)
