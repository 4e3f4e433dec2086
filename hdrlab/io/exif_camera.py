"""Which camera took a photo, and when, as EXIF states it."""

from datetime import datetime

from PIL import Image
from PIL.ExifTags import IFD, Base

TIME_FORMAT = "%Y:%m:%d %H:%M:%S"
MAX_NAME_LENGTH = 60


def read_camera(exif: Image.Exif) -> str:
    """Return the camera's make and model, or "" if EXIF states none."""
    make = _read_text(exif.get(Base.Make))
    model = _read_text(exif.get(Base.Model))
    has_make = model.lower().startswith(make.lower())
    name = model if has_make else f"{make} {model}"
    return name.strip()[:MAX_NAME_LENGTH]


def read_time_taken(exif: Image.Exif) -> datetime | None:
    """Return when the photo was taken, by the camera's clock, or None if EXIF does not state it.

    The time of the last change to the file (the tag DateTime) is not used.
    """
    text = _read_text(exif.get_ifd(IFD.Exif).get(Base.DateTimeOriginal))
    try:
        return datetime.strptime(text, TIME_FORMAT)
    except ValueError:
        return None


def _read_text(value: object) -> str:
    if not isinstance(value, str):
        return ""
    return value.strip("\0 ")
