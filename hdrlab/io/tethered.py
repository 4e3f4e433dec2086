"""A camera on a cable, through libgphoto2: its settings, and photographs that arrive as they are taken.

    with tethered.connected() as camera:
        camera.fix("light")
        name, names = camera.shutter()
        camera.fix("mode")
        camera.photograph(names[3], Path("room/1"))

What is automatic differs between the photographs of a bracket, so it is fixed first; when the block
ends, whatever was changed is put back. Makers name and spell settings differently: what a camera
has is taken.
"""

import tomllib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from hdrlab.core.optional import gphoto2
from hdrlab.errors import InputError
from hdrlab.io.files import replacing

SPELLINGS = tomllib.loads(Path(__file__).with_name("tethered.toml").read_text("utf8"))
SHUTTER, CHOSEN, ERRORS = SPELLINGS["shutter"], SPELLINGS["chosen"], SPELLINGS["errors"]
# milliseconds in which a second file of a photograph, such as RAW beside JPEG, begins to arrive
LATER = 300


@contextmanager
def connected() -> Iterator["Camera"]:
    """Yield the Camera that is connected, and put its settings back when the block ends.

    Raises
    ------
    ValueError
        Where there is none, or where it stops answering: what to look at, in one line.
    """
    device = gphoto2.Camera()
    with _told():
        device.init()
    camera = Camera(device)
    try:
        yield camera
    finally:
        camera.restore()
        with suppress(gphoto2.GPhoto2Error):
            device.exit()


class Camera:
    """A camera that is connected."""

    def __init__(self, device: Any) -> None:
        self._device, self._before = device, dict[str, str]()

    def shutter(self) -> tuple[str, list[str]]:
        """Return the shutter time that is set, and all that can be, as the camera spells them.

        In a mode in which the camera chooses the time, the first is what its meter says.
        """
        setting = self._setting(*SHUTTER)
        if setting is None:
            raise InputError("the camera does not tell its shutter times: set it to M or A (Av)")
        return setting.get_value(), _choices(setting)

    def fix(self, part: str) -> list[str]:
        """Fix what is automatic, and return in words what was changed, or has to be by hand.

        First "light", which is ISO, focus and white balance: the meter's time depends on ISO. Then,
        when the shutter has been read, the "mode".
        """
        notes = []
        for name, fixed in SPELLINGS[part].items():
            if (setting := self._setting(name)) is None:
                continue
            value = setting.get_value()
            if value in fixed or (name in CHOSEN and "auto" not in value.lower()):
                continue
            wanted = next((one for one in fixed if one in _choices(setting)), "")
            note = f"{name} is {value}: fix it on the camera, or the photographs will differ"
            with suppress(ValueError):  # some only take it from their own dials
                if wanted and self._set(name, wanted) == wanted:
                    note = f"{name} is {wanted} until the end, it was {value}"
            notes.append(note)
        return notes

    def photograph(self, time: str, path: Path) -> list[Path]:
        """Take a photograph, and return its files: `path` with the suffixes that the camera gives.

        Raises
        ------
        ValueError
            Where the time cannot be set, or the camera stops answering; no file is left half.
        """
        if self._set(self._setting(*SHUTTER).get_name(), time) != time:
            raise InputError(
                f"the camera does not take the shutter time {time}: turn its dial to M"
            )
        with _told():
            places = [self._device.capture(gphoto2.GP_CAPTURE_IMAGE)]
            for _ in range(100):  # some cameras never fall silent
                kind, what = self._device.wait_for_event(LATER)
                if kind == gphoto2.GP_EVENT_TIMEOUT:
                    break
                places += [what] * (kind == gphoto2.GP_EVENT_FILE_ADDED)
            return [self._download(place, path) for place in places]

    def restore(self) -> None:
        """Set everything as it was before, as far as the camera still answers."""
        for name, value in reversed(self._before.items()):
            with suppress(ValueError):
                self._set(name, value)

    def _download(self, place: Any, path: Path) -> Path:
        file = self._device.file_get(place.folder, place.name, gphoto2.GP_FILE_TYPE_NORMAL)
        target = path.with_suffix(Path(place.name).suffix.lower())
        with replacing(target) as temporary:
            file.save(str(temporary))
        return target

    def _setting(self, *names: str) -> Any:
        """Return the first setting of these names that the camera has, or None."""
        for name in names:
            with suppress(gphoto2.GPhoto2Error):
                return self._device.get_single_config(name)
        return None

    def _set(self, name: str, value: str) -> str:
        """Set a value, and return what the camera says it is."""
        with _told():
            setting = self._device.get_single_config(name)
            self._before.setdefault(name, setting.get_value())
            setting.set_value(value)
            self._device.set_single_config(name, setting)
            return self._device.get_single_config(name).get_value()


def _choices(setting: Any) -> list[str]:
    return [setting.get_choice(j) for j in range(setting.count_choices())]


@contextmanager
def _told() -> Iterator[None]:
    """Say in plain words what an error of libgphoto2 means."""
    try:
        yield
    except gphoto2.GPhoto2Error as error:
        meaning = ERRORS.get(str(error.code), ERRORS["other"])
        raise InputError(f"no camera answers: {meaning} ({error})") from None
