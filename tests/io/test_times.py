"""Exposure times from lists and from EXIF, and which of them a bracket uses."""

import math

import pytest
from hypothesis import given, strategies as st
from PIL import Image
from PIL.TiffImagePlugin import IFDRational

from hdrlab.errors import FileFormatError, InputError
from hdrlab.io.exif_exposure import Exposure, equivalent_seconds, read_exposure
from hdrlab.io.times import are_inverse, bracket_times, read_times

NAMES = ["a.jpg", "b.jpg"]
TIME = 33434
NUMBER = 33437
SPEED = 34855
TV = 37377
AV = 37378
BIAS = 37380


def exif(**tags):
    image = Image.Exif()
    image.get_ifd(0x8769).update({globals()[name]: value for name, value in tags.items()})
    return image


def wrote(tmp_path, text, name="times.txt"):
    path = tmp_path / name
    path.write_text(text)
    return path


def test_rational_exif_values_are_read():
    exposure = read_exposure(exif(TIME=IFDRational(1, 60), NUMBER=IFDRational(28, 10), SPEED=200))
    assert exposure == Exposure(pytest.approx(1 / 60), pytest.approx(2.8), 200)


def test_apex_values_are_used_if_plain_ones_are_missing():
    exposure = read_exposure(exif(TV=IFDRational(6, 1), AV=IFDRational(3, 1)))
    assert exposure == Exposure(1 / 64, pytest.approx(2**1.5), None)
    assert read_exposure(exif(TIME=IFDRational(0, 1), TV=IFDRational(-2, 1))).seconds == 4
    assert read_exposure(exif(TV=IFDRational(0, 1))).seconds == 1


def test_plain_values_take_precedence_over_apex_values():
    exposure = read_exposure(exif(TIME=IFDRational(1, 50), TV=IFDRational(6, 1)))
    assert exposure.seconds == pytest.approx(1 / 50)


def test_exposure_bias_is_not_used_as_a_time():
    assert read_exposure(exif(BIAS=IFDRational(-2, 1))) == Exposure(None, None, None)


def test_iso_speed_beyond_16_bits_is_read_from_the_newer_tag():
    image = exif(SPEED=65535)
    assert read_exposure(image).iso is None
    image.get_ifd(0x8769)[34866] = 102400
    assert read_exposure(image).iso == 102400


@pytest.mark.parametrize(
    "nothing", [IFDRational(0, 1), IFDRational(1, 0), IFDRational(0, 0), "", (), b"x"]
)
def test_exif_values_of_zero_and_infinity_are_ignored(nothing):
    exposure = read_exposure(exif(TIME=nothing, NUMBER=nothing, SPEED=nothing))
    assert exposure == Exposure(None, None, None)


@given(st.lists(st.tuples(*[st.floats(1e-4, 1e4)] * 3), min_size=2, max_size=5))
def test_equivalent_exposure_is_t_S_over_N_squared_relative_to_the_first(values):
    exposures = [Exposure(*value) for value in values]
    _, N0, S0 = values[0]
    expected = [t * S / S0 * N0**2 / N**2 for t, N, S in values]
    got = equivalent_seconds([str(j) for j in range(len(values))], exposures)
    assert got == pytest.approx(expected) and got[0] == pytest.approx(values[0][0])


@pytest.mark.parametrize("f_number", [None, 8.0])
@pytest.mark.parametrize("iso", [None, 100.0])
def test_f_number_or_iso_that_no_photo_states_is_assumed_constant(f_number, iso):
    assert equivalent_seconds(
        NAMES, [Exposure(1.0, f_number, iso), Exposure(2.0, f_number, iso)]
    ) == [1, 2]


def test_f_number_or_iso_that_only_some_photos_state_is_an_error():
    with pytest.raises(ValueError, match="b.jpg.*f-number.*--times"):
        equivalent_seconds(NAMES, [Exposure(1.0, 8.0, 100), Exposure(2.0, None, 100)])
    with pytest.raises(ValueError, match="a.jpg.*ISO speed"):
        equivalent_seconds(NAMES, [Exposure(1.0, 8.0, None), Exposure(2.0, 8.0, 100)])


def test_error_names_a_photo_without_time_and_what_to_do():
    with pytest.raises(ValueError, match="b.jpg.*EXIF.*--times"):
        equivalent_seconds(NAMES, [Exposure(1.0), Exposure(None, 8.0, 100)])


def test_a_csv_list_gives_equivalent_exposures(tmp_path):
    text = "file,exposure_time_s,f_number,iso\na.jpg,0.5,8,100\nb.jpg,0.5,4,200\n"
    assert read_times(wrote(tmp_path, text)).seconds == {"a.jpg": 0.5, "b.jpg": pytest.approx(4.0)}


def test_a_csv_list_may_leave_f_number_and_iso_empty_or_out(tmp_path):
    text = "file,exposure_time_s,f_number,iso\na.jpg,0.5,,\n\nb.jpg,2,,\n"
    assert read_times(wrote(tmp_path, text)).seconds == {"a.jpg": 0.5, "b.jpg": 2}
    text = '\ufeffexposure_time_s, file\n0.5,"a, the first.jpg"\n'
    assert read_times(wrote(tmp_path, text)).seconds == {"a, the first.jpg": 0.5}


def test_bare_numbers_are_seconds_or_one_over_seconds(tmp_path):
    text = "# OpenCV's tutorial\nmemorial00.png 0.03125\nmemorial 01.png\t1024  # darkest\n"
    seconds, inverse = read_times(wrote(tmp_path, text))
    assert seconds == {"memorial00.png": 1 / 32, "memorial 01.png": 1024}
    assert inverse == {"memorial00.png": 32, "memorial 01.png": 1 / 1024}


@pytest.mark.parametrize(
    "text",
    [
        "a.jpg 1/60\nb 1.jpg 1/2",
        "a.jpg 1/60 s\nb 1.jpg 0.5 s",
        "a.jpg\t1 / 60 sec\nb 1.jpg\t1/2",
        "a.jpg, 1/60\nb 1.jpg, 0.5",
        "a.jpg;1/60\nb 1.jpg;0,5",
        "a.jpg 1/60 60\nb 1.jpg 1/2 2",
        "a.jpg 1/60 8\nb 1.jpg 1/2 8",
        "a.jpg 1/60 100\nb 1.jpg 1/2 100",
        "a.jpg,1/60,8,100\nb 1.jpg,1/2,8,100",
        "Filename\tTime (s)\na.jpg\t0.016666666666666666\nb 1.jpg\t0.5",
        "image;1/s;ISO\na.jpg;60;200\nb 1.jpg;2;200",
        "# by hand\n\nname, shutter speed\na.jpg, 1/60\n\nb 1.jpg, 1/2",
    ],
)
def test_lists_of_times_are_read_in_many_notations(tmp_path, text):
    seconds, inverse = read_times(wrote(tmp_path, text))
    assert seconds == {"a.jpg": pytest.approx(1 / 60), "b 1.jpg": 0.5} and inverse is None


def test_third_column_is_f_number_or_iso(tmp_path):
    assert read_times(wrote(tmp_path, "a 1/60 8\nb 1/60 4")).seconds["b"] == pytest.approx(4 / 60)
    assert read_times(wrote(tmp_path, "a 1/60 100\nb 1/60 400")).seconds["b"] == pytest.approx(
        4 / 60
    )


def test_names_in_a_list_may_lack_suffix_folder_and_case(tmp_path):
    assert bracket_times(NAMES, [], wrote(tmp_path, "photos/A.JPG 1/2\nb 1/4"))[0] == [0.5, 0.25]


def test_exif_decides_between_seconds_and_1_over_seconds(tmp_path):
    path = wrote(tmp_path, "a.jpg 60\nb.jpg 15")
    stated = [Exposure(1 / 50), Exposure(1 / 13)]
    assert bracket_times(NAMES, stated, path) == (
        [pytest.approx(1 / 60), pytest.approx(1 / 15)],
        None,
    )
    assert bracket_times(NAMES, stated[::-1], path) == ([60, 15], None)
    assert bracket_times(NAMES, [Exposure(), Exposure()], path)[1] == [1 / 60, 1 / 15]


def test_ambiguous_numbers_that_do_not_follow_the_brightness_are_rejected():
    with pytest.raises(ValueError, match="write them as 1/60 or as 0.5 s"):
        are_inverse([1, 2, 4, 8], [30, 90, 20, 60])


def test_debevecs_list_has_inverse_times_and_f_stops(tmp_path):
    text = "# Filename exposure 1/shutter f/stop gain ND\na.png 4 0.25 8 0 0\nb.png 1 0.25 16 0 0\n"
    assert read_times(wrote(tmp_path, text)).seconds == {"a.png": 4, "b.png": 1}


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("a.jpg 2\nb.jpg\n", "line 2.* b.jpg"),
        ("a.jpg 2\n\nb.jpg fast\n", "line 3.* fast"),
        ("a.jpg 2\nb.jpg 0\n", "line 2.* 0"),
        ("a.jpg -2\n", "line 1.* -2"),
        ("a.jpg nan\n", "line 1.* nan"),
        ("a.jpg 2\na.jpg 4\n", "line 2.* a.jpg"),
        ("a.png 1 1 8 6 0\n", "line 1.*ND filter"),
        ("file,exposure_time_s\na.jpg\n", "line 2.*2 columns.* a.jpg"),
        ("file,exposure_time_s\na.jpg,\n", "line 2.* nothing"),
        ("file,exposure_time_s\na.jpg,1/0\n", "line 2.* 1/0"),
        ("1/60\n1/30\n", "line 1.* 1/60"),
        ("file,exposure_time_s,iso\na.jpg,1,0\n", "line 2.* 0"),
        ("file,exposure_time_s,iso\na.jpg,1,100\nb.jpg,1,\n", "b.jpg.*ISO"),
    ],
)
def test_error_for_a_list_of_times_names_file_line_and_value(tmp_path, text, says):
    with pytest.raises(InputError, match=f"times.txt.*{says}"):
        read_times(wrote(tmp_path, text))


@pytest.mark.parametrize("text", ["", "# only a comment\n", "file,exposure_time_s\n"])
def test_empty_list_of_times_is_rejected_by_name(tmp_path, text):
    with pytest.raises(FileFormatError, match="times.txt.*empty"):
        read_times(wrote(tmp_path, text))


def test_binary_list_of_times_is_rejected(tmp_path):
    path = tmp_path / "times.txt"
    path.write_bytes(b"\xff\xd8\xff\xe0")
    with pytest.raises(ValueError, match="text file"):
        read_times(path)


@pytest.mark.papers
@given(st.text(max_size=200))
def test_any_text_is_read_as_a_list_or_raises_value_error(tmp_path_factory, text):
    path = tmp_path_factory.mktemp("lists") / "times.txt"
    path.write_text(text, encoding="utf-8", errors="replace")
    try:
        times = read_times(path).seconds
    except ValueError as error:
        assert str(path) in str(error)
    else:
        assert times and all(t > 0 and math.isfinite(t) for t in times.values())


def test_explicit_times_take_precedence_over_exif(tmp_path):
    stated = [Exposure(1.0, 8.0, 100), Exposure(2.0, 4.0, 100)]
    assert bracket_times(NAMES, stated, None)[0] == [1, pytest.approx(8)]
    assert bracket_times(NAMES, stated, [3, 4])[0] == [3, 4]
    assert bracket_times(NAMES, stated, {"b.jpg": 5, "a.jpg": 6, "c.jpg": 7})[0] == [6, 5]
    assert bracket_times(NAMES, stated, wrote(tmp_path, "b.jpg 1/4\na.jpg 1/2\n"))[0] == [0.5, 0.25]


def test_error_names_a_photo_that_is_missing_in_the_list(tmp_path):
    with pytest.raises(ValueError, match="times.txt: .*no exposure time for b.jpg"):
        bracket_times(NAMES, [], wrote(tmp_path, "a.jpg 2\n"))


@pytest.mark.parametrize("wrong", [0, -1, math.nan, math.inf])
def test_times_that_are_not_positive_are_rejected_by_name(wrong):
    with pytest.raises(ValueError, match="b.jpg: .*positive exposure time.*--times FILE"):
        bracket_times(NAMES, [], [1, wrong])


def test_wrong_number_of_times_is_rejected():
    with pytest.raises(ValueError, match="2 exposure times, one per photograph.*3"):
        bracket_times(NAMES, [], [1, 2, 3])


def test_the_lists_of_the_memorial_bracket_agree(shared):
    folder = shared("memorial")
    times = read_times(folder / "memorial.hdr_image_list.txt").seconds
    assert times == read_times(folder / "exposures.csv").seconds
    assert len(times) == 16
    assert times["memorial0061.png"] == 32
    assert times["memorial0076.png"] == 1 / 1024
