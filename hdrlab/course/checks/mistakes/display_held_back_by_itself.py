"""A wrong display: held back by itself."""

from hdrlab.tonemap import reinhard

TASK = "display"
MISCONCEPTION = (
    "You hold each pixel back by its own luminance; the second argument is what to hold it back by."
)


def display(Lm, adaptation, white=float("inf")):
    return reinhard.display(Lm, Lm, white)
