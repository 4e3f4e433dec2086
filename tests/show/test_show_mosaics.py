"""The figure of the neighbors that give a pixel of a mosaic its missing colors."""

import numpy as np
import pytest

from hdrlab.core.filters import malvar, mosaic
from hdrlab.errors import InputError
from hdrlab.show.plots.lectures import mosaics

METHODS = {"bilinear": mosaic.demosaic, "malvar": malvar.demosaic}
X = np.random.default_rng(0).random((11, 11))
C = mosaic.tile(mosaic.BAYER, X.shape)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("place", [(0.0, 0.0), (0.5, 0.5), (0.5, 0.4), (1.0, 1.0)])
def test_the_weights_give_the_color_that_demosaicing_gives(method, place):
    neighbors = mosaics.find_neighbors(X, C, METHODS[method], down=place[0], right=place[1])
    assert neighbors.color == pytest.approx(METHODS[method](X, C)[neighbors.y, neighbors.x])
    assert neighbors.weights.sum(axis=(1, 2)) == pytest.approx(1)


def test_each_neighbor_with_a_weight_is_named_once():
    neighbors = mosaics.find_neighbors(X, C, mosaic.demosaic, down=0.5, right=0.4)
    assert C[neighbors.y, neighbors.x] == 1
    texts = [text.get_text() for text in mosaics.draw_neighbors(neighbors).texts]
    halves = [text for text in texts if text.endswith("+1/2")]
    assert sorted(halves) == ["B +1/2", "B +1/2", "R +1/2", "R +1/2"]


def test_a_mosaic_without_a_middle_or_a_place_outside_is_rejected():
    for mosaic_of, place in ((X[:4], 0.5), (X, 1.5)):
        with pytest.raises(InputError):
            mosaics.find_neighbors(
                mosaic_of, C[: len(mosaic_of)], mosaic.demosaic, down=place, right=0.5
            )
