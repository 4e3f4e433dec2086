"""A tethered camera: libgphoto2's virtual one, which delivers the photos of a folder."""

import io
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from unittest import mock

import numpy as np
import pytest
from PIL import Image

from hdrlab.capture import exposure
from hdrlab.cli import common, run
from hdrlab.core.colour import encode_srgb
from hdrlab.io import radiance, tethered

pytestmark = pytest.mark.papers

gphoto2 = pytest.importorskip("gphoto2", reason="the extra `camera` is not installed")
# bytes of each file: the virtual camera believes that the file in its folder stays as it is
SIZE = 60_000
TRUTH = np.geomspace(0.2, 2000, 96 * 64, dtype=np.float32).reshape(64, 96)
SLOW = """
import sys, time
from hdrlab.cli import common, run
from hdrlab.io import tethered
take = tethered.Camera.photograph
def photograph(*given):
    time.sleep(.5)
    return take(*given)
tethered.Camera.photograph = photograph
run(sys.argv[1:])
"""

PULLED = """
import os, shutil, sys
from hdrlab.cli import run
from hdrlab.io import tethered
take = tethered.Camera.photograph
def photograph(self, time, path):
    if path.name == "03":
        shutil.rmtree(os.environ["VCAMERADIR"])
    return take(self, time, path)
tethered.Camera.photograph = photograph
run(sys.argv[1:])
"""


def jpeg(seconds):
    """Return a photograph of TRUTH as a file, with bytes behind its end up to SIZE."""
    Z = np.rint(255 * encode_srgb(np.clip(TRUTH * seconds, 0, 1))).astype(np.uint8)
    file = io.BytesIO()
    Image.fromarray(np.dstack([Z] * 3)).save(file, "JPEG", quality=95)
    return file.getvalue().ljust(SIZE, b"\0")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The folder of photos that the virtual camera delivers."""
    made = tmp_path / "camera"
    made.mkdir()
    (made / "scene.jpg").write_bytes(jpeg(0.01))
    monkeypatch.setenv("VCAMERADIR", str(made))
    monkeypatch.setenv("HOME", str(tmp_path))  # where it keeps its settings
    monkeypatch.setenv("IOLIBS", str(Path(gphoto2.__file__).parent / "libgphoto2/vusb"))
    return made


@pytest.fixture
def lens(folder, monkeypatch):
    """Let the virtual camera photograph the scene with its current exposure time; return the times
    used.
    """
    seen = []
    take = tethered.Camera.photograph

    def photograph(self, time, path):
        seen.append(exposure.seconds(time))
        (folder / "new").write_bytes(jpeg(exposure.seconds(time)))
        os.replace(folder / "new", folder / "scene.jpg")
        return take(self, time, path)

    monkeypatch.setattr(tethered.Camera, "photograph", photograph)
    return seen


def shoot(*arguments):
    """Run `hdrlab shoot`, and return its exit code."""
    with pytest.raises(SystemExit) as ended:
        run(["shoot", *map(str, arguments)])
    return ended.value.code or 0


def names(path):
    return sorted(file.name for file in path.iterdir())


def test_shoot_takes_a_bracket_around_the_metered_time_and_assembles_it(lens, tmp_path, capsys):
    room = tmp_path / "room"
    E = tmp_path / "room.hdr"
    assert shoot("-o", room, "--frames", 5, "--stops", 2.5, "--assemble", E) == 0
    assert lens == [0.0001, 0.0025, 0.01, 0.05, 1.0]
    assert names(room) == [*(f"{j:02d}.jpg" for j in range(1, 6)), "exposures.csv"]
    radiance_found = radiance.read_radiance(E)[..., 1]
    held = (TRUTH * min(lens) < 0.9) & (TRUTH * max(lens) > 0.02)
    off = np.log2(radiance_found / TRUTH)[held]
    assert held.mean() > 0.5 and np.percentile(abs(off - np.median(off)), 95) < 0.2
    output = capsys.readouterr()
    assert "room.hdr (96 x 64" in output.out
    assert "autofocus is Off until the end, it was On" in output.err


def test_list_of_times_has_the_exact_shutter_times(lens, tmp_path):
    assert shoot("-o", tmp_path / "room", "--frames", 3) == 0
    rows = (tmp_path / "room/exposures.csv").read_text().split("\n")
    assert rows[0] == "file,exposure_time_s" and rows[-1] == "" and len(rows) == 5
    for row, nominal in zip(rows[1:-1], lens, strict=True):
        assert float(row.split(",")[1]) == pytest.approx(exposure.true_time(nominal), rel=1e-5)


def test_camera_settings_are_restored_at_the_end(folder, tmp_path):
    def settings(camera):
        return [
            camera._find_setting(name).get_value()
            for name in ("autofocus", "shutterspeed", "f-number")
        ]

    restore = tethered.Camera.restore
    states = []

    def noted(camera):
        states.append(settings(camera))
        restore(camera)
        states.append(settings(camera))

    with mock.patch.object(tethered.Camera, "restore", noted), tethered.connected() as camera:
        before = settings(camera)
        assert camera.fix("light") == ["autofocus is Off until the end, it was On"]
        assert camera.fix("light") == []
        camera.photograph("0.1000s", tmp_path / "a")
    assert states == [["Off", "0.1000s", "f/2.8"], before]


def test_note_names_settings_that_must_be_fixed_on_the_camera(folder):
    refusing = mock.Mock(side_effect=gphoto2.GPhoto2Error(-1))
    with tethered.connected() as camera:
        camera._device = mock.Mock(wraps=camera._device, set_single_config=refusing)
        assert camera.fix("light") == [
            "autofocus is On: fix it on the camera, or the photographs will differ"
        ]


class Automatic:
    """A camera in mode A with automatic ISO.

    Its meter reads 1/60 then, and 1/4 at ISO 100. It writes two files per photo, and its events
    never stop.
    """

    SETTINGS = {
        "expprogram": ("A", "M"),
        "iso": ("Auto", "100"),
        "shutterspeed": ("1/60", "1", "1/4", "1/15"),
    }

    def __init__(self):
        self.now = {name: choices[0] for name, choices in self.SETTINGS.items()}
        self.taken = []
        self.exit = mock.Mock()
        self.init = mock.Mock()

    def get_single_config(self, name):
        if name not in self.now:
            raise gphoto2.GPhoto2Error(-2)
        metered = (
            name == "shutterspeed" and self.now["expprogram"] == "A" and self.now["iso"] == "100"
        )
        setting = mock.Mock()
        choices = self.SETTINGS[name]
        setting.get_name.return_value = name
        setting.count_choices.return_value = len(choices)
        setting.get_choice = choices.__getitem__
        setting.get_value.return_value = "1/4" if metered else self.now[name]
        setting.set_value = lambda value: setattr(setting.get_value, "return_value", value)
        return setting

    def set_single_config(self, name, setting):
        self.now[name] = setting.get_value()

    def capture(self, kind):
        self.taken.append(dict(self.now))
        self.raw = iter([(gphoto2.GP_EVENT_FILE_ADDED, place("IMG_1.NEF"))])
        return place("IMG_1.JPG")

    def wait_for_event(self, patience):
        return next(self.raw, (gphoto2.GP_EVENT_UNKNOWN, None))

    def file_get(self, folder, name, kind):
        return mock.Mock(save=lambda path: Path(path).write_text(name))


def place(name):
    file = mock.Mock(folder="/")
    file.name = name
    return file


def test_meter_is_read_at_the_iso_of_the_photos_and_settings_are_restored(
    tmp_path, monkeypatch, capsys
):
    camera = Automatic()
    monkeypatch.setattr(gphoto2, "Camera", lambda: camera)
    assert shoot("-o", tmp_path / "room", "--frames", 3) == 0
    assert [photo["shutterspeed"] for photo in camera.taken] == ["1/15", "1/4", "1"]
    assert {(photo["expprogram"], photo["iso"]) for photo in camera.taken} == {("M", "100")}
    assert (camera.now["expprogram"], camera.now["iso"]) == ("A", "Auto")
    message = capsys.readouterr().err
    assert "iso is 100 until the end, it was Auto" in message
    assert "expprogram is M until the end" in message


def test_all_files_of_a_photo_are_saved_although_events_never_stop(tmp_path, monkeypatch):
    monkeypatch.setattr(gphoto2, "Camera", Automatic)
    with tethered.connected() as camera:
        files = camera.photograph("1/4", tmp_path / "01")
    assert [(file.name, file.read_text()) for file in files] == [
        ("01.jpg", "IMG_1.JPG"),
        ("01.nef", "IMG_1.NEF"),
    ]


def test_disconnected_cable_keeps_the_photos_taken_so_far(folder, tmp_path):
    words = ["shoot", "-o", "room", "--frames", "4", "--assemble", "room.hdr"]
    # of its own: a process keeps what a camera has shown
    command = [
        sys.executable,
        "-c",
        PULLED,
        *words,
    ]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 2
    assert names(tmp_path / "room") == ["01.jpg", "02.jpg", "exposures.csv"]
    assert (tmp_path / "room/exposures.csv").read_text().count("\n") == 3
    assert not (tmp_path / "room.hdr").exists()
    errors = [line for line in run.stderr.splitlines() if line.startswith("hdrlab: ")]
    assert len(errors) == 1
    assert "no camera found; it may be asleep, its card full, or the cable out" in errors[0]


@pytest.mark.parametrize(
    ("code", "meaning"),
    [
        (-105, "connect one by USB"),
        (-115, "card is full"),
        (-53, "another program"),
        (-7, "asleep"),
    ],
)
def test_camera_errors_say_what_to_check(folder, tmp_path, code, meaning):
    with tethered.connected() as camera:
        broken = mock.Mock(wraps=camera._device)
        broken.capture.side_effect = gphoto2.GPhoto2Error(code)
        camera._device = broken
        with pytest.raises(ValueError, match=f"no camera found; .*{meaning}"):
            camera.photograph("0.1000s", tmp_path / "a")
    assert names(tmp_path) == ["camera"]


def test_shoot_without_a_camera_is_a_one_line_error(tmp_path, monkeypatch, capsys):
    missing = mock.Mock(init=mock.Mock(side_effect=gphoto2.GPhoto2Error(-105)))
    monkeypatch.setattr(gphoto2, "Camera", lambda: missing)
    assert shoot("-o", tmp_path / "room") == 2
    assert "connect one by USB" in capsys.readouterr().err and not (tmp_path / "room").exists()


def test_shoot_without_gphoto2_names_the_extra(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(common, "find_spec", lambda name: None)
    assert shoot("-o", tmp_path / "room") == 2
    assert 'pip install "hdrlab[camera]"' in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (["--frames", "9", "--stops", "1"], "9 times 1 stops apart"),
        (["--assemble", "map.txt"], "expected a radiance file"),
    ],
)
def test_bad_options_are_rejected_before_the_first_photo(
    folder, lens, tmp_path, capsys, arguments, why
):
    assert shoot("-o", tmp_path / "room", *arguments) == 2
    assert why in capsys.readouterr().err and lens == [] and not (tmp_path / "room").exists()


def test_shoot_rejects_a_folder_that_is_not_empty(folder, lens, tmp_path, capsys):
    assert shoot("-o", folder) == 2
    assert "new or empty" in capsys.readouterr().err
    assert lens == []
    assert names(folder) == ["scene.jpg"]


@pytest.mark.parametrize(
    ("sent", "code"), [(signal.SIGINT, 130), (signal.SIGKILL, -signal.SIGKILL)]
)
def test_interrupted_shoot_keeps_complete_photos_and_their_times(folder, tmp_path, sent, code):
    room = tmp_path / "room"
    process = subprocess.Popen(
        [sys.executable, "-c", SLOW, "shoot", "-o", str(room), "--frames", "6"]
    )
    until = time.monotonic() + 120
    while not (room / "02.jpg").exists() and time.monotonic() < until:
        time.sleep(0.02)
    process.send_signal(sent)
    assert process.wait(timeout=120) == code
    taken = [name for name in names(room) if name.endswith(".jpg") and not name.startswith(".")]
    assert 2 <= len(taken) < 6 and all((room / name).stat().st_size == SIZE for name in taken)
    listed = (room / "exposures.csv").read_text().splitlines()[1:]
    assert [row.split(",")[0] for row in listed] == taken[: len(listed)]
    assert len(listed) >= len(taken) - 1
