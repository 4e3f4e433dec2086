"""The errors that hdrlab raises on purpose.

`HdrlabError` and its children say that an input, a file or a calibration is at fault, and what to do
about it. The command line prints them as one line. Every other exception is a bug in hdrlab, and the
command line shows its traceback.

HdrlabError
    InputError            an argument, an option or a set of photos that hdrlab cannot use
        FileFormatError   a file that is damaged or in a format that hdrlab does not read
        CalibrationError  photos from which no response, no exposure times or no alignment follows

Each is also a ``ValueError``, so that code that catches ``ValueError`` keeps working.
"""


class HdrlabError(Exception):
    """Base class of the errors that hdrlab raises on purpose."""


class InputError(HdrlabError, ValueError):
    """An argument, an option or a set of photos that hdrlab cannot use."""


class FileFormatError(InputError):
    """A file that is damaged, or in a format that hdrlab does not read.

    Its message is one line, also where a codec's message, which it quotes, has several.
    """

    def __init__(self, message: str = "") -> None:
        super().__init__(" ".join(message.split()))


class CalibrationError(InputError):
    """Photos from which no response curve, no exposure times or no alignment can be computed."""
