"""Skip tests of features that old releases of codecs lack; `nox -s lowest` installs such releases."""

import inspect

import imagecodecs
import PIL
import pytest
from PIL import Image

# the first release whose libultrahdr decodes gain maps with metadata for each channel
MIN_IMAGECODECS_FOR_CHANNEL_GAINS = (2025, 3, 30)


def require_avif():
    """Skip the test if Pillow itself cannot read AVIF, which it can from version 11.3 on."""
    Image.init()
    if "AVIF" not in Image.OPEN or not hasattr(PIL, "AvifImagePlugin"):
        pytest.skip("this Pillow does not read AVIF")


def require_avif_primaries():
    """Skip the test if imagecodecs cannot write the color primaries of an AVIF."""
    if "primaries" not in inspect.signature(imagecodecs.avif_encode).parameters:
        pytest.skip("this imagecodecs cannot write the primaries of an AVIF")


def require_channel_gains():
    """Skip the test if libultrahdr rejects gain maps with metadata for each channel."""
    release = tuple(int(number) for number in imagecodecs.__version__.split(".")[:3])
    if release < MIN_IMAGECODECS_FOR_CHANNEL_GAINS:
        pytest.skip("this libultrahdr rejects gain maps with metadata for each channel")
