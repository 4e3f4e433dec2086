"""Control a camera on a USB cable through libgphoto2: its settings, and its photos.

    with tethered.connected() as camera:
        camera.fix("light")
        time, times = camera.shutter()
        camera.fix("mode")
        camera.photograph(times[3], Path("room/1"))

Automatic settings would differ between the photos of a bracket, so they are fixed first. When the
block ends, every changed setting is restored. Makers name and spell settings differently; hdrlab
uses those that the camera has.
"""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Literal

from hdrlab.core.optional import gphoto2
from hdrlab.errors import InputError
from hdrlab.io.files import replacing

SHUTTER_SETTINGS = ("shutterspeed", "shutterspeed2")
# Settings by name, and the values at which nothing is automatic, the best first.
LIGHT_SETTINGS = {
    "autofocus": ["Off"],
    "focusmode": ["Manual", "MF"],
    "isoauto": ["Off"],
    "autoiso": ["Off"],
    "iso": ["100", "200", "125", "160"],
    "whitebalance": ["Daylight", "Sunny", "Direct sunlight"],
}
MODE_SETTINGS = {
    "expprogram": ["M", "Manual"],
    "autoexposuremode": ["Manual"],
}
# The user's own value of these settings is kept, unless it is an automatic one.
SETTINGS_WITH_USER_VALUES = ("iso", "whitebalance")
# What the errors of libgphoto2 mean for the user.
ERROR_ADVICE = {
    -105: "connect one by USB, and switch it on",
    -115: "its card is full",
    -110: "it is busy; wait until its lamp is off",
    -53: "another program uses it; close that program, or eject the camera in the file manager",
    -52: "see whether the cable is in, and the camera on",
}
OTHER_ERROR_ADVICE = "it may be asleep, its card full, or the cable out"
# A second file of a photo, such as RAW beside JPEG, begins to arrive within this time.
SECOND_FILE_TIMEOUT_MS = 300
# Some cameras send events without end.
MAX_EVENTS = 100


@contextmanager
def connected() -> Iterator["Camera"]:
    """Yield the connected camera, and restore its settings when the block ends.

    Raises
    ------
    InputError
        If there is no camera, or if it stops answering; the message says what to check.
    """
    device = gphoto2.Camera()
    with _explain_errors():
        device.init()
    camera = Camera(device)
    try:
        yield camera
    finally:
        camera.restore()
        with suppress(gphoto2.GPhoto2Error):
            device.exit()


class Camera:
    """A connected camera."""

    def __init__(self, device: Any) -> None:
        self._device = device
        self._original_values: dict[str, str] = {}

    def shutter(self) -> tuple[str, list[str]]:
        """Return the shutter time that is set, and all times that can be set.

        Times are spelled as the camera spells them. In a mode in which the camera chooses the time,
        the first is what its meter measures.
        """
        setting = self._shutter_setting()
        return setting.get_value(), _list_choices(setting)

    def fix(self, part: Literal["light", "mode"]) -> list[str]:
        """Fix automatic settings, and return a note on each that hdrlab or the user has to change.

        Call it with "light" first, for ISO, focus and white balance, because the metered time
        depends on ISO; with "mode" when the shutter time has been read.
        """
        settings = LIGHT_SETTINGS if part == "light" else MODE_SETTINGS
        notes = []
        for name, fixed_values in settings.items():
            setting = self._find_setting(name)
            if setting is None:
                continue
            value = setting.get_value()
            is_users_choice = name in SETTINGS_WITH_USER_VALUES and "auto" not in value.lower()
            if value in fixed_values or is_users_choice:
                continue
            choices = _list_choices(setting)
            available = [choice for choice in fixed_values if choice in choices]
            if available and self._try_set_value(name, available[0]):
                notes.append(f"{name} is {available[0]} until the end, it was {value}")
            else:
                notes.append(
                    f"{name} is {value}: fix it on the camera, or the photographs will differ"
                )
        return notes

    def photograph(self, time: str, path: Path) -> list[Path]:
        """Take a photo and save its files: `path` with the suffixes that the camera gives.

        Parameters
        ----------
        time
            The shutter time, as the camera spells it.
        path
            Where to save the photo, without a suffix.

        Returns
        -------
        list of Path
            The files of the photo, such as a JPEG and a RAW file.

        Raises
        ------
        InputError
            If the time cannot be set, or the camera stops answering; no incomplete file is left.
        """
        if self._set_value(self._shutter_setting().get_name(), time) != time:
            raise InputError(
                f"the camera does not accept the shutter time {time}; set it to mode M"
            )
        with _explain_errors():
            camera_paths = [self._device.capture(gphoto2.GP_CAPTURE_IMAGE)]
            for _ in range(MAX_EVENTS):
                event, data = self._device.wait_for_event(SECOND_FILE_TIMEOUT_MS)
                if event == gphoto2.GP_EVENT_TIMEOUT:
                    break
                if event == gphoto2.GP_EVENT_FILE_ADDED:
                    camera_paths.append(data)
            return [self._download(camera_path, path) for camera_path in camera_paths]

    def restore(self) -> None:
        """Restore every changed setting, as far as the camera still answers."""
        for name, value in reversed(self._original_values.items()):
            self._try_set_value(name, value)

    def _download(self, camera_path: Any, path: Path) -> Path:
        """Copy a file from the camera, and return where it is."""
        file = self._device.file_get(
            camera_path.folder, camera_path.name, gphoto2.GP_FILE_TYPE_NORMAL
        )
        target = path.with_suffix(Path(camera_path.name).suffix.lower())
        with replacing(target) as temporary:
            file.save(str(temporary))
        return target

    def _shutter_setting(self) -> Any:
        for name in SHUTTER_SETTINGS:
            setting = self._find_setting(name)
            if setting is not None:
                return setting
        raise InputError("the camera does not report its shutter times; set it to mode M or A (Av)")

    def _find_setting(self, name: str) -> Any:
        """Return a setting, or None if the camera does not have it."""
        try:
            return self._device.get_single_config(name)
        except gphoto2.GPhoto2Error:
            return None

    def _try_set_value(self, name: str, value: str) -> bool:
        """Set a value, and return whether the camera accepts it; some accept only their own dials."""
        try:
            return self._set_value(name, value) == value
        except InputError:
            return False

    def _set_value(self, name: str, value: str) -> str:
        """Set a value, and return the value that the camera then reports."""
        with _explain_errors():
            setting = self._device.get_single_config(name)
            self._original_values.setdefault(name, setting.get_value())
            setting.set_value(value)
            self._device.set_single_config(name, setting)
            return self._device.get_single_config(name).get_value()


def _list_choices(setting: Any) -> list[str]:
    return [setting.get_choice(index) for index in range(setting.count_choices())]


@contextmanager
def _explain_errors() -> Iterator[None]:
    """Turn an error of libgphoto2 into an InputError that says what to check."""
    try:
        yield
    except gphoto2.GPhoto2Error as error:
        advice = ERROR_ADVICE.get(error.code, OTHER_ERROR_ADVICE)
        raise InputError(f"no camera found; {advice} ({error})") from None
