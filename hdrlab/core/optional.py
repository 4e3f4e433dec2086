"""Optional packages, imported when they are first used.

`from hdrlab.core.optional import skimage_transform` stands for the module skimage.transform.

    >>> from hdrlab.core.optional import scipy_fft, cooking
    >>> bool(scipy_fft), scipy_fft.next_fast_len(13), bool(cooking)
    (True, 14, False)
    >>> cooking.stir()
    Traceback (most recent call last):
    hdrlab.core.optional.MissingPackageError: this part of hdrlab needs cooking: pip install cooking
"""

from importlib import import_module
from importlib.util import find_spec
from typing import Any

from hdrlab.errors import InputError

# modules whose package has another name, or is an extra of hdrlab
PACKAGES = {"skimage": "scikit-image", "rawpy": '"hdrlab[raw]"', "pillow_heif": '"hdrlab[heic]"'}


class MissingPackageError(ModuleNotFoundError, InputError):
    """A file needs a package that is not installed; the message says what to install."""


class OptionalModule:
    """A module that is imported at its first use, or else raises a MissingPackageError."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._root = name.partition(".")[0]

    def __bool__(self) -> bool:
        return find_spec(self._root) is not None

    def __getattr__(self, attribute: str) -> Any:
        if not self:
            package = PACKAGES.get(self._root, self._root)
            message = f"this part of hdrlab needs {self._root}: pip install {package}"
            raise MissingPackageError(message, name=self._root)
        return getattr(import_module(self._name), attribute)

    def has_codec(self, name: str) -> bool:
        """Return whether imagecodecs is installed with a codec, such as "RGBE" or "AVIF".

        Builds of imagecodecs differ: the one for WebAssembly has neither of these two.

        >>> from hdrlab.core.optional import imagecodecs
        >>> imagecodecs.has_codec("PNG"), imagecodecs.has_codec("SEMAPHORE")
        (True, False)
        """
        if not self:
            return False
        try:
            codec = getattr(self, name)
        except (ImportError, AttributeError):
            return False
        return bool(codec.available)


def __getattr__(name: str) -> OptionalModule:
    if name.startswith("_"):
        raise AttributeError(name)
    return OptionalModule(name if name in PACKAGES else name.replace("_", "."))
