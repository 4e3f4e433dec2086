"""The benchmarks' own code: measurements, promises and exit codes."""

import json
import math
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("benchmarks", reason="the benchmarks are no part of the installed package")

from benchmarks import (
    __main__ as command,
    brackets,
    color_camera,
    experiments,
    measure,
    peers,
    table,
)
from benchmarks.align import brackets as align_brackets, who
from benchmarks.experiments import Experiment, Skipped, at_least, at_most, near
from benchmarks.rows import (
    OURS,
    Case,
    Figures,
    Row,
    Usage,
    best_peer,
    close,
    faster,
    grows,
    smaller,
    within,
)
from hdrlab.capture import camera
from hdrlab.core.filters import warp

RESULTS = {
    OURS: Figures(0.1, 0.05, 20, 0.5),
    "slow": Figures(2, 2, 10, 1),
    "fast": Figures(0.4, 0.4, 50, 1),
}


def row(*holds, name="work"):
    return Row(name, "some work", lambda folder, one_thread: Case({}, {}), holds, "error")


def test_the_best_peer_is_the_fastest_and_never_hdrlab():
    assert best_peer(RESULTS) == "fast"
    assert best_peer({OURS: Figures(1, 1)}) is None


@pytest.mark.parametrize(
    ("hold", "figure"),
    [
        (faster(4), 4),
        (smaller(0.4), 0.4),
        (close(0.5, "error"), 0.5),
        (within(OURS, 20), 20),
        (grows(OURS, "fast", 4, 1), 1),
    ],
)
def test_a_hold_computes_its_figure_and_is_met_at_its_very_limit(hold, figure):
    assert hold.figure(RESULTS) == pytest.approx(figure)
    assert hold.verdict(RESULTS) == "ok"


@pytest.mark.parametrize(
    "hold", [faster(4.1), smaller(0.39), close(0.49, "error"), grows(OURS, "fast", 4, 0.99)]
)
def test_a_hold_beyond_its_limit_is_missed(hold):
    assert hold.verdict(RESULTS) == "MISSED"


@pytest.mark.parametrize("hold", [faster(4), smaller(0.5)])
def test_a_hold_against_peers_that_are_missing_is_not_judged(hold):
    assert hold.verdict({OURS: RESULTS[OURS]}) == "not judged"


def test_a_block_names_everyone_the_missing_and_every_verdict():
    text = table.block(row(faster(10, 20), smaller(0.5)), RESULTS, {"other": "not installed"})
    # fmt: skip
    assert [line.split()[0] for line in text.splitlines()] == [
        "work:",
        "one",
        OURS,
        "slow",
        "fast",
        "other:",
        "MISSED",
        "ok",
    ]
    assert "100 ms" in text and "2.00 s" in text and "50 MB" in text
    assert "other: missing, not installed" in text
    assert "hold >= 10, goal 20" in text


def test_the_summary_counts_the_holds_and_names_what_is_not_met():
    text = table.summary(
        [
            (row(faster(3), faster(5)), RESULTS),
            (row(faster(1), name="alone"), {OURS: Figures(1, 1)}),
        ]
    )
    assert "1 of 3" in text.splitlines()[0]
    assert "MISSED: work" in text and "not judged: alone" in text


@pytest.mark.parametrize(("limit", "code"), [(4, 0), (5, 1)])
def test_the_exit_code_is_1_where_a_hold_is_missed(limit, code, monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(command, "chosen", lambda subject, names: [row(faster(limit))])
    monkeypatch.setattr(command, "measured", lambda subject, row, folder: (RESULTS, {}))
    figures = tmp_path / "figures.json"
    assert command.main(["speed", "--json", str(figures)]) == code
    assert ("MISSED" in capsys.readouterr().out) == bool(code)
    assert json.loads(figures.read_text())["work"]["fast"]["megabytes"] == 50


def test_a_row_that_raises_an_error_is_reported_and_makes_the_exit_code_1(monkeypatch, capsys):
    def broken(subject, row, folder):
        raise RuntimeError("work, one: no such file")

    monkeypatch.setattr(command, "chosen", lambda subject, names: [row(faster(1))])
    monkeypatch.setattr(command, "measured", broken)
    assert command.main(["speed"]) == 1
    assert "no such file" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "known"),
    [(["nothing"], "speed"), (["speed", "--rows", "merge,nothing"], "gsolve70")],
)
def test_an_unknown_subject_or_row_is_refused_with_a_list_of_known_ones(arguments, known, capsys):
    with pytest.raises(SystemExit) as ended:
        command.main(arguments)
    assert ended.value.code == 2
    errors = capsys.readouterr().err
    assert "nothing" in errors and known in errors


# each in a row of its own, as one may be missing
PEERS = (
    "opencv",
    "align_image_stack",
    "scikit-image",
)
BRACKET_PEERS = ("mtb", "cerman", "alignmtb", "ecc", "align_image_stack")
WITHOUT_HOLD = {
    "align": {
        "align-arch",
        *(f"align-{kind}-{peer}" for kind in ("shift", "turned") for peer in PEERS),
        *(f"align-brackets-{name}" for name in BRACKET_PEERS),
    },
    "mutation": {"lessons", "grader"},  # survivors are hints, and their share is no target
    "ghosts": {"ghosts-alone"},  # the slide's own way, printed beside ours
}


def test_every_subject_has_rows_of_different_names():
    assert {"papers", "speed"} <= set(command.subjects())
    for subject in command.subjects():
        names = [row.name for row in command.chosen(subject, None)]
        assert names and len(set(names)) == len(names)
        free = {row.name for row in command.chosen(subject, None) if not row.holds}
        assert free == WITHOUT_HOLD.get(subject, set())


def test_a_subject_is_found_by_having_rows(monkeypatch, tmp_path):
    (tmp_path / "papers.py").write_text('"""A subject."""\n\nROWS = ()\n')
    (tmp_path / "tools.py").write_text('"""Not one."""\n')
    monkeypatch.setattr(command, "HERE", tmp_path)
    assert command.subjects() == ["papers"]


def experiment(find, *holds, name="rerun"):
    return Experiment(name, "an old experiment", lambda folder: find(), holds)


def missing():
    raise Skipped("no curves in --data or ../shared/data")


def broken():
    raise ZeroDivisionError("no light")


@pytest.mark.parametrize(
    ("hold", "value", "verdict"),
    [
        (at_most("x", 1, 2), (1, 2), "ok"),
        (at_most("x", 1, 2), (1, 2.1), "MISSED"),
        (at_most("x", 1, np.inf), (1, 9e9), "ok"),
        (at_least("x", 3), (3,), "ok"),
        (at_least("x", 3), (2.9,), "MISSED"),
        (near("x", 4, by=0.05), (4.05,), "ok"),
        (near("x", 4, by=0.05), (3.9,), "MISSED"),
        (at_most("x", 1), (np.nan,), "MISSED"),
    ],
)
def test_a_hold_of_an_experiment_judges_number_by_number(hold, value, verdict):
    assert hold.verdict({"x": value}) == verdict
    assert hold.verdict({}) == "not judged"


@pytest.mark.parametrize(("limit", "code"), [(2, 0), (1, 1)])
def test_an_experiment_is_printed_next_to_the_published_result(
    limit, code, monkeypatch, tmp_path, capsys
):
    row = experiment(
        lambda: {"error, %": 1.5, "more": [1, 2]}, at_most("error, %", limit, published="2.7")
    )
    monkeypatch.setattr(command, "chosen", lambda subject, names: [row])
    figures = tmp_path / "figures.json"
    assert command.main(["papers", "--json", str(figures)]) == code
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["error,", "%", "2.7", "1.5", "<=", str(limit), ("ok", "MISSED")[code]] in rows
    assert ["more", "-", "1,", "2", "-"] in rows
    assert json.loads(figures.read_text())["rerun"] == {"error, %": [1.5], "more": [1, 2]}


@pytest.mark.parametrize(
    ("find", "code", "reason"),
    [(missing, 0, "skipped, no curves"), (broken, 1, "ZeroDivisionError, no light")],
)
def test_an_experiment_without_data_is_skipped_and_a_broken_one_is_missed(
    find, code, reason, monkeypatch, capsys
):
    rows = [
        experiment(find, at_most("x", 1)),
        experiment(lambda: {"x": 0}, at_most("x", 1), name="next"),
    ]
    monkeypatch.setattr(command, "chosen", lambda subject, names: rows)
    assert command.main(["papers"]) == code
    output = capsys.readouterr().out
    assert reason in output and "1 of 2 holds are met" in output


def test_ctrl_c_ends_with_what_is_known_so_far(monkeypatch, capsys):
    def interrupted():
        raise KeyboardInterrupt

    rows = [experiment(lambda: {"x": 0}, at_most("x", 1)), experiment(interrupted, at_most("x", 1))]
    monkeypatch.setattr(command, "chosen", lambda subject, names: rows)
    assert command.main(["papers"]) == 130
    output = capsys.readouterr()
    assert "1 of 1 holds are met" in output.out and "stopped" in output.err


def test_the_seed_reaches_the_rows_that_draw_at_random(monkeypatch, capsys):
    seeds = []

    def draw(folder, *, seed):
        seeds.append(seed)
        return {"x": seed}

    rows = [
        Experiment("random", "a draw", draw, (at_most("x", 9),), has_seed=True),
        experiment(lambda: {"x": 0}, at_most("x", 1)),
    ]
    monkeypatch.setattr(command, "chosen", lambda subject, names: rows)
    assert command.main(["papers", "--seed", "7"]) == 0
    assert seeds == [7]


def test_a_color_matrix_changes_no_color_that_the_camera_does_not_clip():
    rng = np.random.default_rng(0)
    E = rng.uniform(0.05, 0.6, (20, 30, 3)).astype(np.float32)
    model = camera.Camera(response="srgb")
    matrix = color_camera.CANON_5D_MARK_3
    with_matrix = color_camera.shoot(E, [0.5, 1.0], model, matrix).images.astype(int)
    without = camera.shoot(E, [0.5, 1.0], model).images
    assert np.abs(with_matrix - without).max() <= 1


def test_a_channel_that_the_camera_clips_makes_the_other_channels_wrong_too():
    """Only green is too bright for the camera, and red and blue of the photo change with it."""
    model = camera.Camera(response="linear")
    matrix = color_camera.CANON_5D_MARK_3
    E = np.array([[[0.3, 1.4, 0.3]]], np.float32)
    red, green, blue = color_camera.shoot(E, [1.0], model, matrix).images[0, 0, 0].astype(int)
    assert green == 255
    for channel in (red, blue):
        assert 0 < channel < 255
        assert abs(channel - 0.3 * 255) > 10


def test_half_of_the_brackets_have_a_color_matrix_with_each_scene_response_and_sensor():
    with_matrix = [one for one in brackets.BRACKETS if brackets.has_color_matrix(*one)]
    assert 2 * len(with_matrix) == len(brackets.BRACKETS)
    for place, choices in enumerate((brackets.SCENES, brackets.RESPONSES, brackets.SENSORS)):
        assert {one[place] for one in with_matrix} == set(choices)


@pytest.fixture
def simulated(tmp_path, monkeypatch):
    monkeypatch.setattr(brackets, "SHAPE", (48, 80))
    rng = np.random.default_rng(0)
    return brackets.simulate(tmp_path, "street", "srgb", (20_000.0, 5.0), rng)


def test_the_unit_and_the_white_balance_of_a_map_are_no_error(simulated):
    E = simulated.E * np.array([2.0, 3.0, 5.0])
    errors = brackets.measure_errors(E, simulated)
    assert max(errors.median, errors.p95, errors.dark, errors.color) < 1e-5


def test_a_compressed_map_has_errors_and_a_missing_pixel_counts_as_ten_stops(simulated):
    compressed = brackets.measure_errors(simulated.E.astype(float) ** 0.8, simulated)
    assert compressed.dark > compressed.median > 0.05
    E = simulated.E.astype(float)
    E[:, :10] = np.nan
    assert brackets.measure_errors(E, simulated).p95 == brackets.MISSING_STOPS


def test_noise_averages_out_of_the_tint_of_a_map_and_a_wrong_color_does_not(simulated):
    rng = np.random.default_rng(1)
    E = simulated.E.astype(float)
    noisy = E * 2 ** (0.3 * rng.standard_normal(E.shape))
    errors = brackets.measure_errors(noisy, simulated)
    assert errors.color > 0.6
    assert errors.tint < 0.2
    tinted = E.copy()
    tinted[:, :40, 0] *= 2**0.6
    assert brackets.measure_errors(tinted, simulated).tint > 0.25


def test_photos_of_a_simulated_bracket_state_their_times(simulated):
    read = [float(brackets.peer_maps.read_time(str(file))) for file in simulated.files]
    np.testing.assert_allclose(read, simulated.times, rtol=1e-4)


def test_each_bracket_is_printed_when_it_is_measured_and_ctrl_c_prints_their_medians(
    tmp_path, monkeypatch, capsys
):
    """Time limits and Ctrl-C end a long run; what it measured until then is not lost."""
    monkeypatch.setattr(brackets, "SHAPE", (48, 80))
    monkeypatch.setattr(
        brackets, "find_programs", lambda folder: ({OURS: None, "peer": None}, {"other": "absent"})
    )
    printed = []

    def measure(name, program, simulated, folder):
        printed.append(capsys.readouterr().out)
        if len(printed) == 4:
            raise KeyboardInterrupt
        return Usage(1, 50, 3), brackets.MapErrors(0.25, 0.5, 0.125, 1, 0.0625)

    monkeypatch.setattr(brackets, "run_program", measure)
    with pytest.raises(KeyboardInterrupt):
        brackets.compare(tmp_path, places=("street",))
    assert "street-film-20000" in printed[0] and "other" in printed[0]
    figures = "0.25, 0.5, 0.125, 1, 0.0625, 3, 50"
    assert [text.count(figures) for text in printed] == [0, 1, 1, 1]
    summary = capsys.readouterr().out
    assert "Complete brackets: 1" in summary and summary.count(figures) == 4
    assert brackets.AGAINST_BEST in summary


def test_a_row_that_repeats_a_part_of_another_runs_only_by_its_name():
    assert [row.name for row in command.chosen("brackets", None)] == ["brackets-peers"]
    assert [row.name for row in command.chosen("brackets", "brackets-room")] == ["brackets-room"]
    assert command.parse(["brackets", "--rows", "brackets-room"]).rows == "brackets-room"


@pytest.mark.parametrize("processes", [1, 2])
def test_work_along_many_items_keeps_their_order(processes, monkeypatch):
    monkeypatch.setattr(experiments, "PROCESSES", processes)
    before = {name: os.environ.get(name) for name in measure.THREADS}
    assert experiments.along(abs, range(-3, 3), "numbers") == [3, 2, 1, 0, 1, 2]
    assert {name: os.environ.get(name) for name in measure.THREADS} == before


def test_work_that_fails_in_another_process_fails_here(monkeypatch):
    monkeypatch.setattr(experiments, "PROCESSES", 2)
    with pytest.raises(ValueError, match="math domain|nonnegative"):
        experiments.along(math.sqrt, [1.0, -1.0, 4.0], "roots")


def test_data_are_read_from_the_folder_that_is_named_first(tmp_path):
    (tmp_path / "crf_curves").mkdir()
    assert experiments.real(tmp_path, "crf_curves") == tmp_path / "crf_curves"
    with pytest.raises(Skipped, match="no nothing"):
        experiments.real(tmp_path, "nothing")


def test_everyone_runs_once_to_warm_up_and_once_in_each_of_at_least_five_rounds(monkeypatch):
    monkeypatch.setattr(measure, "MIN_SECONDS", 0)
    order = []
    case = Case(
        {who: lambda who=who: order.append(who) for who in "ab"}, {}, lambda who, result: ord(who)
    )
    timings = measure.timed(case)
    assert order == ["a", "b"] * 6
    assert [len(seconds) for seconds in timings["seconds"].values()] == [5, 5]
    assert timings["errors"] == {"a": 97, "b": 98}


def test_long_runs_are_repeated_less_and_commands_tell_their_memory_while_they_are_timed(
    monkeypatch,
):
    monkeypatch.setattr(measure, "LONG_SECONDS", 0)
    order = []
    case = Case({"a": lambda: order.append("a") or Usage(20, 64), "b": lambda: 1}, {})
    timings = measure.timed(case)
    assert order == ["a"] * 3
    assert timings["seconds"]["a"] == [20, 20]
    assert timings["megabytes"] == {"a": 64, "b": None}


def test_the_floor_is_the_time_to_read_the_input_and_to_write_the_result(monkeypatch):
    monkeypatch.setattr(measure, "MIN_SECONDS", 0)
    monkeypatch.setattr(measure, "bandwidth", lambda: 1000.0)
    runs = {"a": lambda: np.zeros(25, np.float32), "b": lambda: (np.zeros(2), [np.zeros(3)])}
    assert measure.timed(Case(runs, {}, reads=400))["floors"] == {"a": 0.5, "b": 0.44}
    assert measure.timed(Case(runs, {}, reads={"a": 900, "b": 60}))["floors"] == {"a": 1, "b": 0.1}
    assert measure.timed(Case(runs, {}))["floors"] == {"a": None, "b": None}
    text = table.block(row(), {OURS: Figures(0.5, 0.5, None, None, floor=0.02)}, {})
    assert text.splitlines()[2].split()[-2:] == ["25", "-"]


def test_the_floor_of_a_file_is_one_call_by_turns_with_everyone(monkeypatch):
    monkeypatch.setattr(measure, "MIN_SECONDS", 0)
    monkeypatch.setattr(measure, "bandwidth", lambda: 1000.0)
    monkeypatch.setattr(measure, "clocked", lambda run: run())
    order = []
    least = iter([9, 2, 4, 3, 7])
    runs = {"a": lambda: order.append("a") or 1}
    case = Case(runs, {}, least=lambda: order.append("least") or next(least))
    assert measure.timed(case)["floors"] == {"a": 4}
    assert order == ["a", *["a", "least"] * 5]


@pytest.mark.parametrize(
    ("floor", "message"), [(0.09, "AT FLOOR"), (0.0800, "AT FLOOR"), (0.0799, "MISSED")]
)
def test_a_ratio_that_is_missed_within_a_quarter_of_the_floor_is_the_machines(floor, message):
    results = RESULTS | {OURS: RESULTS[OURS]._replace(floor=floor)}
    assert faster(5).verdict(results) == message
    assert faster(4).verdict(results) == "ok" and close(0.1, "error").verdict(results) == "MISSED"


def test_the_machine_copies_at_least_a_hundred_megabytes_a_second():
    assert measure.bandwidth() > 1e8


def test_a_run_of_processes_reports_its_own_time():
    assert measure.clocked(lambda: Usage(1234.5, 1)) == 1234.5
    assert 0.01 <= measure.clocked(lambda: time.sleep(0.01)) < 10
    assert Usage(3, 100, 5).net(Usage(1, 40, 2)) == Usage(2, 60, 3)


@pytest.mark.skipif(
    not Path("/proc/self/clear_refs").exists(), reason="the peak is read from /proc"
)
def test_the_peak_is_what_a_run_holds_at_once_beyond_what_the_process_held():
    code = (
        "import numpy as np; from benchmarks.measure import peak\n"
        "kept = np.ones(40_000_000, np.uint8)\n"
        "print(peak(lambda: np.ones(30_000_000, np.uint8).sum() + np.ones(20_000_000, np.uint8).sum()))"
    )
    ask = [sys.executable, "-c", code]
    done = subprocess.run(ask, cwd=measure.ROOT, capture_output=True, text=True, check=True)
    assert 28 < float(done.stdout) < 36


def test_a_command_is_charged_with_its_own_memory_and_not_with_that_of_its_parent():
    held = np.ones(200_000_000, np.uint8)
    usage = measure.process([sys.executable, "-S", "-c", "x = b'1' * 50_000_000"], one_thread=False)
    assert 50 < usage.megabytes < 120 < held.nbytes / 1e6
    assert usage.seconds > 0


def test_a_failed_command_is_reported_with_its_message():
    with pytest.raises(RuntimeError, match="out of film"):
        measure.process(
            [sys.executable, "-S", "-c", "raise SystemExit('out of film')"], one_thread=False
        )


def test_a_peer_that_is_missing_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "cv2", None)
    monkeypatch.setattr("shutil.which", lambda program: None)
    runs, missing = peers.present(
        {
            "there": lambda: print,
            "cv2": lambda: peers.opencv(True),
            "pfs": lambda: peers.pfstools("pfsin"),
        }
    )
    assert list(runs) == ["there"]
    assert "pip install opencv-contrib-python-headless" in missing["cv2"]
    assert "no pfsin" in missing["pfs"]


def test_hugin_finds_a_shift_and_a_rotation_about_the_middle_of_an_image():
    """Its default field of view would explain the shift by a turn that bends the image."""
    taken = align_brackets.shoot_bracket("street", 0.3)
    dark, bright = np.argsort(taken.taken.times)[1:3]
    try:
        homography, has_warning = who.by_hugin(
            taken.taken.images[[dark, bright]], taken.taken.times[[dark, bright]]
        )
    except peers.Missing as reason:
        pytest.skip(str(reason))
    truth = np.linalg.inv(taken.truth[bright]) @ taken.truth[dark]
    shape = taken.taken.images.shape[1:3]
    assert not has_warning
    assert warp.corner_distance(homography, truth, shape) < 0.5
