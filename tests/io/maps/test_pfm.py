"""Portable float maps: their bytes, then a comparison with OpenCV."""

import os

import cv2
import numpy as np
import pytest

from hdrlab.errors import FileFormatError
from hdrlab.io.maps import pfm

RGB = np.random.default_rng(0).random((37, 21, 3)).astype(np.float32)
GRAY = RGB[..., 0].copy()


@pytest.mark.parametrize("E", [RGB, GRAY])
def test_pfm_files_can_be_exchanged_with_opencv_bit_for_bit(tmp_path, E):
    pfm.write(tmp_path / "ours.pfm", E)
    cv2.imwrite(
        str(tmp_path / "theirs.pfm"), np.ascontiguousarray(E[..., ::-1]) if E.ndim == 3 else E
    )
    theirs = cv2.imread(str(tmp_path / "ours.pfm"), cv2.IMREAD_UNCHANGED)
    assert np.array_equal(theirs[..., ::-1] if E.ndim == 3 else theirs, E)
    assert np.array_equal(pfm.read(tmp_path / "ours.pfm"), E)
    assert np.array_equal(pfm.read(tmp_path / "theirs.pfm"), E)


def test_rows_are_written_bottom_up_in_little_endian(tmp_path):
    pfm.write(tmp_path / "x.pfm", [[1.0, 2.0], [3.0, 4.0]])
    expected = b"Pf\n2 2\n-1.0\n" + np.array([3, 4, 1, 2], "<f4").tobytes()
    assert (tmp_path / "x.pfm").read_bytes() == expected


def test_flip_false_reads_and_writes_rows_top_down(tmp_path):
    pfm.write(tmp_path / "x.pfm", RGB, flip=False)
    assert np.array_equal(pfm.read(tmp_path / "x.pfm", flip=False), RGB)
    assert np.array_equal(pfm.read(tmp_path / "x.pfm"), RGB[::-1])


@pytest.mark.parametrize(
    ("scale", "dtype"), [("-1", "<f4"), ("-2.5e0", "<f4"), ("1.0", ">f4"), ("+0.5", ">f4")]
)
def test_sign_of_the_scale_is_the_byte_order_and_its_magnitude_is_ignored(tmp_path, scale, dtype):
    data = np.arange(6, dtype=dtype)
    (tmp_path / "x.pfm").write_bytes(f"PF\n2 1\n{scale}\n".encode() + data.tobytes())
    E = pfm.read(tmp_path / "x.pfm")
    assert E.dtype == np.float32 and np.array_equal(E, np.arange(6).reshape(1, 2, 3))
    assert pfm.read_header(tmp_path / "x.pfm").scale == float(scale)


def test_first_value_that_looks_like_white_space_is_read(tmp_path):
    data = np.array([0x20200A0A], "<u4").view("<f4")
    (tmp_path / "x.pfm").write_bytes(b"Pf 1 1 -1\n" + data.tobytes())
    assert np.array_equal(pfm.read(tmp_path / "x.pfm"), data[None])


def test_write_rejects_invalid_radiance(tmp_path):
    for value, says in (np.nan, "1 NaN"), (np.inf, "1 infinite"), (-1, "1 negative"):
        with pytest.raises(ValueError, match=says):
            pfm.write(tmp_path / "x.pfm", [[1.0, value]])
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "head",
    [
        b"",
        b"P6\n2 2\n255\n",
        b"PF\n2 2\n",
        b"PF\n2 2\n0\n",
        b"PF\n2 2\n-\n",
        b"PF\n2 2\nnan\n",
        b"PF\n-2 2\n1\n",
    ],
)
def test_other_files_are_rejected_as_pfm_by_name(tmp_path, head):
    (tmp_path / "x.pfm").write_bytes(head + b"x" * 48 * bool(head))
    with pytest.raises(ValueError, match="x.pfm: .*PFM file"):
        pfm.read(tmp_path / "x.pfm")


@pytest.mark.parametrize("size", ["2147483648 1", "65536 32768", "0 4", "9999 9999", "3 2"])
def test_header_with_an_absurd_size_allocates_no_memory(tmp_path, size):
    (tmp_path / "x.pfm").write_bytes(f"PF\n{size}\n-1.0\n".encode() + bytes(71))
    with pytest.raises(ValueError, match="x.pfm: its header claims"):
        pfm.read(tmp_path / "x.pfm")


def test_file_that_is_truncated_while_it_is_read_is_rejected(tmp_path, monkeypatch):
    pfm.write(tmp_path / "x.pfm", RGB)
    header = pfm.read_header(tmp_path / "x.pfm")
    os.truncate(tmp_path / "x.pfm", header.start + RGB.nbytes - 1)
    monkeypatch.setattr(pfm, "read_header", lambda path: header)
    with pytest.raises(
        ValueError, match=r"x\.pfm: .*9324 bytes of values, but the file became shorter"
    ):
        pfm.read(tmp_path / "x.pfm")


def test_reading_without_readv_gives_the_same_values(tmp_path, monkeypatch):
    monkeypatch.delattr(os, "readv", raising=False)
    tall = np.random.default_rng(1).random((1100, 2)).astype(np.float32)
    pfm.write(tmp_path / "x.pfm", tall)
    assert np.array_equal(pfm.read(tmp_path / "x.pfm"), tall)


@pytest.mark.parametrize("E", [RGB, GRAY])
@pytest.mark.parametrize(("scale", "dtype"), [("-1.0", "<f4"), ("1.0", ">f4")])
def test_header_lines_may_end_in_cr_lf(tmp_path, E, scale, dtype):
    kind = "PF" if E.ndim == 3 else "Pf"
    header = f"{kind}\r\n{E.shape[1]} {E.shape[0]}\r\n{scale}\r\n".encode()
    (tmp_path / "x.pfm").write_bytes(header + E[::-1].astype(dtype).tobytes())
    assert np.array_equal(pfm.read(tmp_path / "x.pfm"), E)


def test_line_feed_behind_a_single_cr_belongs_to_the_values(tmp_path):
    data = np.array([0x3F80000A, 0x3F800000], "<u4").view("<f4")
    (tmp_path / "x.pfm").write_bytes(b"Pf 2 1 -1\r" + data.tobytes())
    assert np.array_equal(pfm.read(tmp_path / "x.pfm"), data[None])


def test_error_for_a_pfm_copied_as_text_says_so(tmp_path):
    values = np.array([0x3F800A0A, 0x3F80000A], "<u4").tobytes()
    data = b"Pf\n2 1\n-1.0\n" + values
    (tmp_path / "x.pfm").write_bytes(data.replace(b"\n", b"\r\n"))
    with pytest.raises(FileFormatError, match=r"x\.pfm: .*CR LF.*text"):
        pfm.read(tmp_path / "x.pfm")
