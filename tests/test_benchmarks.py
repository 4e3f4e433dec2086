"""The benchmarks' own arithmetic: what is measured, what must hold of it, and what the exit code says."""

import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("benchmarks", reason="the benchmarks are no part of the installed package")

from benchmarks import __main__ as command
from benchmarks import measure, peers, table
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

RESULTS = {OURS: Figures(0.1, 0.05, 20, 0.5), "slow": Figures(2, 2, 10, 1), "fast": Figures(0.4, 0.4, 50, 1)}


def row(*holds, name="work"):
    return Row(name, "some work", lambda folder, one: Case({}, {}), holds, "error")


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
    assert [line.split()[0] for line in text.splitlines()] == [
        "work:", "one", OURS, "slow", "fast", "other:", "MISSED", "ok",
    ]  # fmt: skip
    assert "100 ms" in text and "2.00 s" in text and "50 MB" in text
    assert "other: missing, not installed" in text
    assert "hold >= 10, goal 20" in text


def test_the_summary_counts_the_holds_and_names_what_is_not_met():
    text = table.summary(
        [(row(faster(3), faster(5)), RESULTS), (row(faster(1), name="alone"), {OURS: Figures(1, 1)})]
    )
    assert text.splitlines()[0] == "1 of 3 holds are met"
    assert "MISSED: work" in text and "not judged: alone" in text


@pytest.mark.parametrize(("limit", "code"), [(4, 0), (5, 1)])
def test_the_exit_code_is_1_where_a_hold_is_missed(limit, code, monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(command, "chosen", lambda subject, names: [row(faster(limit))])
    monkeypatch.setattr(command, "measured", lambda subject, row, folder: (RESULTS, {}))
    figures = tmp_path / "figures.json"
    assert command.main(["speed", "--json", str(figures)]) == code
    assert ("MISSED" in capsys.readouterr().out) == bool(code)
    assert json.loads(figures.read_text())["work"]["fast"]["megabytes"] == 50


def test_a_row_that_breaks_says_why_and_makes_the_exit_code_1(monkeypatch, capsys):
    def broken(subject, row, folder):
        raise RuntimeError("work, one: no such file")

    monkeypatch.setattr(command, "chosen", lambda subject, names: [row(faster(1))])
    monkeypatch.setattr(command, "measured", broken)
    assert command.main(["speed"]) == 1
    assert "no such file" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "known"), [(["nothing"], "speed"), (["speed", "--rows", "merge,nothing"], "gsolve70")]
)
def test_an_unknown_subject_or_row_is_refused_with_those_there_are(arguments, known, capsys):
    with pytest.raises(SystemExit) as ended:
        command.main(arguments)
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert "nothing" in said and known in said


def test_every_subject_has_rows_of_different_names():
    assert "speed" in command.subjects()
    for subject in command.subjects():
        names = [row.name for row in command.chosen(subject, None)]
        assert names and len(set(names)) == len(names)
        assert all(row.holds for row in command.chosen(subject, None))


def test_a_subject_is_found_by_having_rows(monkeypatch, tmp_path):
    (tmp_path / "papers.py").write_text('"""A subject."""\n\nROWS = ()\n')
    (tmp_path / "tools.py").write_text('"""Not one."""\n')
    monkeypatch.setattr(command, "HERE", tmp_path)
    assert command.subjects() == ["papers"]


def test_everyone_runs_once_to_warm_up_and_once_in_each_of_at_least_five_rounds(monkeypatch):
    monkeypatch.setattr(measure, "ENOUGH", 0)
    order = []
    case = Case({who: lambda who=who: order.append(who) for who in "ab"}, {}, lambda who, result: ord(who))
    found = measure.timed(case)
    assert order == ["a", "b"] * 6
    assert [len(seconds) for seconds in found["seconds"].values()] == [5, 5]
    assert found["errors"] == {"a": 97, "b": 98}


def test_a_run_of_processes_reports_its_own_time():
    assert measure.clocked(lambda: Usage(1234.5, 1)) == 1234.5
    assert 0.01 <= measure.clocked(lambda: time.sleep(0.01)) < 10
    assert Usage(3, 100).net(Usage(1, 40)) == (2, 60)


@pytest.mark.skipif(not Path("/proc/self/clear_refs").exists(), reason="the peak is read from /proc")
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
    usage = measure.process([sys.executable, "-S", "-c", "x = b'1' * 50_000_000"], one=False)
    assert 50 < usage.megabytes < 120 < held.nbytes / 1e6
    assert usage.seconds > 0


def test_a_command_that_fails_says_what_it_said():
    with pytest.raises(RuntimeError, match="out of film"):
        measure.process([sys.executable, "-S", "-c", "raise SystemExit('out of film')"], one=False)


def test_a_peer_that_is_missing_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "cv2", None)
    monkeypatch.setattr("shutil.which", lambda program: None)
    runs, missing = peers.present(
        {"there": lambda: print, "cv2": lambda: peers.opencv(True), "pfs": lambda: peers.pfstools("pfsin")}
    )
    assert list(runs) == ["there"]
    assert "pip install opencv-python-headless" in missing["cv2"]
    assert "no pfsin" in missing["pfs"]
