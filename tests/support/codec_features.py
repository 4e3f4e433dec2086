"""Skip tests of what old releases of other packages cannot do; `nox -s lowest` installs such releases."""

import inspect

import imagecodecs
import PIL
import pytest
from PIL import Image

# The first release whose libultrahdr decodes gain maps with metadata of their own for each channel.
GAINS_OF_CHANNELS = (2025, 3, 30)


def require_avif():
    """Skip the test if Pillow itself does not read AVIF, which came with 11.3."""
    Image.init()
    if "AVIF" not in Image.OPEN or not hasattr(PIL, "AvifImagePlugin"):
        pytest.skip("this Pillow does not read AVIF")


def require_colors_of_avif():
    """Skip the test if imagecodecs cannot state the primaries of an AVIF."""
    if "primaries" not in inspect.signature(imagecodecs.avif_encode).parameters:
        pytest.skip("this imagecodecs cannot state the primaries of an AVIF")


def require_gains_of_channels():
    """Skip the test if libultrahdr refuses gain maps with metadata of their own for each channel."""
    release = tuple(int(number) for number in imagecodecs.__version__.split(".")[:3])
    if release < GAINS_OF_CHANNELS:
        pytest.skip("this libultrahdr refuses gain maps with metadata for each channel")
