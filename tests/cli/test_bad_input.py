"""Wrong input of a user ends a command with one line and exit code 2, without a traceback."""

import numpy as np
import pytest
from test_cli import hdrlab

from hdrlab.io import radiance
from hdrlab.io.photos import write_picture

COMMANDS = [
    "plan nan 1",
    "plan 1 inf",
    "plan 0 1",
    "plan 1 100 --aperture 1e308",
    "plan 1 100 --iso 0",
    "plan 1 100 --snr 1e308",
    "plan 1 100 --snr 10 --camera binary.txt",
    "plan 1 100 --snr 10 --camera empty",
    "plan --map empty.hdr",
    "plan --map damaged.png",
    "meter dark.png --at nan,0.5",
    "meter damaged.png",
    "noise empty empty",
    "noise nowhere empty",
    "noise dark.png empty",
    "noise . . -o out.json",
    "plan 1 100 --snr 10 --camera binary.json",
    "assemble dark.png dark.png -o out.hdr --uncertainty out.exr --noise binary.json",
    "assemble dark.png dark.png -o out.hdr --uncertainty out.exr --noise empty",
    "correct dark.png -o out.png --target nan",
    "tonemap map.hdr -o out.jpg --to ultrahdr --headroom inf",
    "tonemap map.hdr -o out.png --saturation nan",
    "tonemap map.hdr -o out.png --operator reinhard --set key=nan",
    "tonemap map.hdr -o out.png --operator fattal --set key=bright",
    "tonemap map.hdr -o out.png --set =1",
    "tonemap empty.hdr -o out.png",
    "compare map.hdr -o out.png --operators ,",
    "convert map.hdr out.foo",
    "info damaged.png",
    "info empty.hdr",
    "info empty",
    "info binary.txt",
    "assemble damaged.png -o out.hdr",
    "assemble dark.png --times binary.txt -o out.hdr",
    "assemble dark.png --times binary.txt --stops 2 -o out.hdr",
    "assemble dark.png --response binary.csv -o out.hdr",
    "video empty --times 1,2 -o out.gif",
    "video damaged.mp4 --times 1,2 -o out.gif",
    "video dark.png --times nan,1 -o out.gif",
    "check nowhere.py --homework hw2",
    "check hw2.py --plan binary.txt",
    "grade hw2.py --tier practice --secret-file binary.txt",
    "grade empty --homework hw2 --tier practice --roster binary.txt",
    "regrade damaged",
    "regrade empty",
    "gallery init new --closes tomorrow",
    "gallery add empty --roster binary.txt",
    "gallery close empty",
    "course export",
    "course new-task class",
    "submit nowhere",
    "report nowhere",
    "site --notebooks hw2.ipynb --out site",
    "site --notebooks binary.txt --out site",
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder with a good map and photo, and with damaged files of every kind."""
    folder = tmp_path_factory.mktemp("bad")
    write_picture(folder / "dark.png", np.zeros((16, 24, 3), np.uint8))
    radiance.write_radiance(folder / "map.hdr", np.ones((4, 5, 3)))
    (folder / "empty").mkdir()
    (folder / "damaged").mkdir()
    (folder / "damaged" / "asked.json").write_text("[1")
    (folder / "empty.hdr").write_bytes(b"")
    (folder / "damaged.png").write_bytes(b"\x89PNG\r\n\x1a\njunk")
    (folder / "damaged.mp4").write_bytes(b"junk")
    (folder / "hw2.py").write_text("def hat(: pass\n")
    (folder / "hw2.ipynb").write_text("{}")
    for name in ("binary.txt", "binary.csv", "binary.json"):
        (folder / name).write_bytes(b"\xff\xfe\x00,\n")
    return folder


@pytest.mark.parametrize("words", COMMANDS)
def test_bad_input_is_one_line_and_not_a_bug(words, folder, monkeypatch, capsys):
    monkeypatch.chdir(folder)
    code, _, complaint = hdrlab(*words.split(), capsys=capsys)
    assert code == 2, complaint
    assert "Traceback" not in complaint
    assert complaint.splitlines()[-1].startswith("hdrlab: ")
