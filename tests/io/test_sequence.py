"""Reading and writing films, and the command that makes an HDR film."""

import os
import select
import signal
import subprocess
import sys
import time
from importlib.util import find_spec

import numpy as np
import pytest
from PIL import Image, ImageSequence

from hdrlab.cli import run
from hdrlab.errors import InputError
from hdrlab.io import radiance, sequence
from hdrlab.io.photos import write_picture

pytestmark = pytest.mark.papers

WITH_FILMS = pytest.mark.skipif(not find_spec("av"), reason="films need the extra `video`")
PATIENCE = 600  # seconds: what hangs ends


def moving(count=6, shape=(48, 64)):
    """Frames (count, H, W, 3) uint8: gray waves that move a pixel to the right each time."""
    y, x = np.indices(shape)
    waves = [128 + 50 * np.sin((x - j) / 6) * np.cos(y / 7) for j in range(count)]
    return np.stack([np.repeat(np.uint8(wave)[..., None], 3, axis=-1) for wave in waves])


def shown(animation):
    """The frames of a .gif as Pillow shows them, (count, H, W, 3) uint8."""
    with Image.open(animation) as image:
        return np.stack(
            [np.asarray(frame.convert("RGB")) for frame in ImageSequence.Iterator(image)]
        )


@pytest.fixture
def folder(tmp_path):
    """A folder of frames of a linear camera that alternates between 4 s and 1 s."""
    place = tmp_path / "frames"
    place.mkdir()
    for j, frame in enumerate(moving()):
        light = (frame / 255.0) ** 2 * (1 if j % 2 else 4)
        write_picture(place / f"{j:02d}.png", np.uint8(np.round(255 * np.minimum(light, 1))))
    return place


@WITH_FILMS
def test_film_survives_a_round_trip(tmp_path):
    frames = moving()
    assert sequence.write(tmp_path / "film.mp4", iter(frames), rate=12) == 6
    back = np.stack(list(sequence.read(tmp_path / "film.mp4")))
    assert back.shape == frames.shape and back.dtype == np.uint8
    assert np.abs(back.astype(int) - frames).mean() < 3
    assert [path.name for path in tmp_path.iterdir()] == ["film.mp4"]


def test_gif_contains_the_frames(tmp_path):
    frames = moving()
    assert sequence.write(tmp_path / "film.gif", iter(frames), rate=12) == 6
    assert np.abs(shown(tmp_path / "film.gif").astype(int) - frames).mean() < 3
    assert [path.name for path in tmp_path.iterdir()] == ["film.gif"]


@WITH_FILMS
def test_gray_frames_with_odd_sides_can_be_written(tmp_path):
    for suffix in (".gif", ".mp4"):
        sequence.write(tmp_path / f"film{suffix}", moving(3, (31, 45))[..., 0])
    (height, width, _) = next(sequence.read(tmp_path / "film.mp4")).shape
    assert 30 <= height <= 31 and 44 <= width <= 45
    assert shown(tmp_path / "film.gif").shape == (3, 31, 45, 3)


def test_folder_is_read_frame_by_frame_in_the_order_of_names(folder):
    frames = sequence.read(folder)
    first = next(frames)
    (folder / "05.png").unlink()  # what has not been reached is not yet read
    assert first.shape == (48, 64, 3) and sequence.count(folder) == 5
    with pytest.raises(FileNotFoundError):
        list(frames)


def test_error_for_frames_of_different_sizes_names_the_frame(folder):
    write_picture(folder / "03.png", np.zeros((10, 10, 3), np.uint8))
    with pytest.raises(ValueError, match="one size and depth.*frame 4"):
        list(sequence.read(folder))


@WITH_FILMS
@pytest.mark.parametrize("content", [b"", b"no film at all", b"GIF89a", None])
def test_damaged_films_are_rejected(content, tmp_path):
    file = tmp_path / "film.mp4"
    if content is None:
        sequence.write(file, moving())
        content = file.read_bytes()[: file.stat().st_size // 3]
    file.write_bytes(content)
    try:
        # a film that is cut short may hold whole frames
        assert 0 < len(list(sequence.read(file))) < 6
    except ValueError as error:
        assert file.name in str(error)


@pytest.mark.parametrize(
    "call",
    [
        lambda folder: sequence.read(folder / "none.txt"),
        lambda folder: sequence.read(folder / "film.gif"),
        lambda folder: sequence.write(folder / "film.txt", moving()),
        lambda folder: sequence.write(folder / "film", moving()),
        lambda folder: sequence.write(folder / "film.gif", []),
        lambda folder: sequence.write(folder / "film.gif", [np.zeros((4, 4))]),
        lambda folder: sequence.write(folder / "film.gif", moving(), rate=0),
        lambda folder: sequence.write(folder / "film.gif", [*moving(2), *moving(2, (8, 8))]),
        lambda folder: sequence.write_maps(folder / "maps", []),
        lambda folder: sequence.write_maps(folder, [np.ones((4, 4), np.float32)]),
    ],
)
def test_bad_arguments_are_rejected_and_nothing_is_written(call, folder):
    before = sorted(path.name for path in folder.iterdir())
    with pytest.raises(InputError):
        call(folder)
    assert sorted(path.name for path in folder.iterdir()) == before


def test_missing_film_raises_file_not_found_error(tmp_path):
    with pytest.raises(FileNotFoundError, match="no such file"):
        sequence.read(tmp_path / "film.mp4")


def test_error_without_pyav_names_the_extra(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "av", None)
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(ValueError, match=r"hdrlab\[video\]"):
        sequence.write(tmp_path / "film.mp4", moving())


def test_write_maps_writes_all_maps_or_none(tmp_path):
    maps = [np.full((4, 5), level, np.float32) for level in (1, 2)]
    assert sequence.write_maps(tmp_path / "maps", maps) == 2
    assert [path.name for path in sorted((tmp_path / "maps").iterdir())] == ["0001.exr", "0002.exr"]
    assert np.array_equal(radiance.read_radiance(tmp_path / "maps" / "0002.exr"), maps[1])

    def failing():
        yield maps[0]
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sequence.write_maps(tmp_path / "others", failing())
    assert [path.name for path in tmp_path.iterdir()] == ["maps"]


def run_command(capsys, *arguments):
    """Return the exit code of the command, its output and its error messages."""
    with pytest.raises(SystemExit) as end:
        run([str(argument) for argument in arguments])
    return end.value.code or 0, *capsys.readouterr()


def test_video_makes_a_film_from_a_folder(folder, tmp_path, capsys):
    out = tmp_path / "out.gif"
    code, output, _ = run_command(
        capsys, "video", folder, "-o", out, "--times", "4,1", "--response", "linear", "--rate", 10
    )
    assert code == 0 and output == f"{out}: 6 frames, 64 x 48\n"
    assert len(shown(out)) == 6


def test_video_makes_a_folder_of_radiance_maps(folder, tmp_path, capsys):
    out = tmp_path / "maps"
    code, output, _ = run_command(
        capsys, "video", folder, "-o", out, "--times", "4,1", "--response", "linear"
    )
    assert code == 0 and "6 frames" in output
    first = radiance.read_radiance(out / "0001.exr")
    second = radiance.read_radiance(out / "0002.exr")
    light = [(frame / 255.0) ** 2 for frame in moving()[:2, :, :, 1]]
    for E, truth in ((first[..., 1], light[0]), (second[..., 1], light[1])):
        ratio = E[8:-8, 8:-8] / truth[8:-8, 8:-8]
        assert np.abs(ratio / np.median(ratio) - 1).max() < 0.1


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["-o", "out.gif", "--times", "1"], "at least two different times"),
        (["-o", "out.gif", "--times", "1,x"], "expected seconds"),
        (["-o", "out.gif", "--times", "1,1/0"], "expected seconds"),
        (["-o", "out.txt", "--times", "1,4"], "expected a video (.gif, .mp4)"),
        (["-o", "frames", "--times", "1,4"], "overwrite the input frames"),
        (["-o", "out.gif", "--times", "1,2,3,4,5,6,7"], "each of the 7 times"),
        (
            ["-o", "out.gif", "--times", "1,4", "--rate", "0", "--response", "linear"],
            "expected a rate",
        ),
        (
            ["-o", "out.gif", "--times", "1,4", "--key", "-1", "--response", "linear"],
            "expected a positive key",
        ),
    ],
)
def test_video_reports_bad_input_in_one_line(
    arguments, says, folder, tmp_path, capsys, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    code, _, complaint = run_command(capsys, "video", "frames", *arguments)
    assert code == 2 and says in complaint and complaint.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["frames"]


def test_video_does_not_write_maps_into_a_folder_that_is_not_empty(folder, tmp_path, capsys):
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "mine.txt").write_text("mine")
    code, _, complaint = run_command(
        capsys, "video", folder, "-o", tmp_path / "full", "--times", "1,4"
    )
    assert code == 2 and "new or empty" in complaint and complaint.count("\n") == 1
    assert [path.name for path in (tmp_path / "full").iterdir()] == ["mine.txt"]


def test_video_shows_progress_and_keeps_the_old_file_on_ctrl_c(tmp_path):
    pty = pytest.importorskip("pty", reason="there are no such terminals here")
    place = tmp_path / "frames"
    out = tmp_path / "out.gif"
    place.mkdir()
    for j, frame in enumerate(moving(60, (120, 160))):
        write_picture(place / f"{j:02d}.png", frame)
    out.write_bytes(b"precious")
    terminal, its_end = pty.openpty()
    # in one without columns there is no bar
    pytest.importorskip("termios").tcsetwinsize(its_end, (24, 80))
    command = [
        sys.executable,
        "-m",
        "hdrlab",
        "video",
        place,
        "-o",
        out,
        "--times",
        "4,1",
        "--response",
        "linear",
    ]
    process = subprocess.Popen(
        list(map(str, command)), stdout=its_end, stderr=its_end, stdin=subprocess.DEVNULL
    )
    os.close(its_end)
    try:
        output = ""
        deadline = time.monotonic() + PATIENCE
        while "merging" not in output and time.monotonic() < deadline:
            if select.select([terminal], [], [], 1)[0]:
                output += os.read(terminal, 4096).decode()
        assert "merging" in output
        process.send_signal(signal.SIGINT)
        assert process.wait(PATIENCE) == 130
    finally:
        process.kill()
        process.wait()
        os.close(terminal)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["frames", "out.gif"]
    assert out.read_bytes() == b"precious"
