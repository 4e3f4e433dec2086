"""Damaged files for every reader: the fuzzer's own code, and a short run of it."""

import os
import signal
import sys
import warnings

import pytest

pytest.importorskip("benchmarks", reason="the benchmarks are no part of the installed package")

from benchmarks import __main__ as command, fuzz
from benchmarks.fuzz import minimise, mutations, process, readers, worker

SEEDS = [b"width 12\nheight 7\n" + bytes(40), b"another 3.5"]
# those that take much memory or time are left to `python -m benchmarks fuzz`
DEAR = {"exr", "tiff", "dng", "film"}
FILES = 30


def test_a_file_is_the_same_whenever_its_seed_and_number_are():
    def files(seed):
        return [mutations.mutated(SEEDS, mutations.generator(seed, "rgbe", k)) for k in range(200)]

    assert files(1) == files(1) != files(2)
    assert len(set(files(1))) > 150 and all(len(data) <= mutations.LARGEST for data in files(1))


@pytest.mark.parametrize("change", mutations.CHANGES, ids=lambda mutation: mutation.__name__)
def test_every_mutation_works_on_any_file_and_changes_most(change):
    rng = mutations.generator(0, change.__name__, 0)
    changed = 0
    for _ in range(40):
        for seed in (*SEEDS, b"", b"1"):
            data = bytearray(seed)
            change(data, rng)
            changed += data != seed
    assert changed > 10


def test_a_failing_file_is_minimized_while_it_still_fails():
    data = bytes(3000) + b"bad" + bytes(700) + b"!" + bytes(90)
    assert (
        minimise.minimised(data, lambda candidate: b"bad" in candidate and b"!" in candidate)
        == b"bad!"
    )
    assert len(minimise.minimised(data, lambda candidate: b"bad" in candidate, tries=3)) >= 3


def raises(error):
    def read(path):
        raise error

    return read


def leave_filters(path):
    warnings.filters.append(("ignore", None, Warning, None, 77))


WRONG = {
    "KeyError": raises(KeyError("B")),
    "a message too long": raises(ValueError("fuzzed" + "x" * 5000)),
    "no file named": raises(ValueError("it is damaged")),
    "memory": raises(ValueError("fuzzed: it is damaged (MemoryError)")),
    "UnicodeEncodeError": raises(UnicodeEncodeError("utf-8", "\ud800", 0, 1, "surrogates")),
    "changed files": lambda path: path.with_name("left").write_text("behind"),
    "changed filters": leave_filters,
    "SystemExit": raises(SystemExit(2)),
}


@pytest.mark.papers
@pytest.mark.parametrize("kind", WRONG)
def test_anything_but_a_result_or_a_clear_error_is_a_finding(kind, tmp_path, monkeypatch):
    monkeypatch.setattr(warnings, "filters", [*warnings.filters])
    path = tmp_path / "fuzzed.txt"
    path.write_bytes(b"")
    reader = readers.Reader("mine", ".txt", lambda folder: None, WRONG[kind])
    assert worker.judged(reader, path, lambda: "")[0].startswith(kind)


@pytest.mark.papers
def test_output_that_bypasses_python_is_a_finding_and_a_clear_error_is_not(tmp_path):
    path = tmp_path / "fuzzed.txt"
    path.write_bytes(b"")
    reader = readers.Reader(
        "mine", ".txt", lambda folder: None, raises(ValueError("fuzzed.txt: no"))
    )
    assert worker.judged(reader, path, lambda: "")[0] == worker.CLEAN
    assert worker.judged(reader, path, lambda: "libfoo: bad marker")[0].startswith("printed libfoo")


@pytest.mark.papers
@pytest.mark.skipif(sys.platform != "linux", reason="the limits are those of Linux")
@pytest.mark.parametrize(("sent", "kind"), [(signal.SIGSTOP, "hang"), (signal.SIGKILL, "crash")])
def test_a_reader_that_waits_or_dies_is_a_finding_and_is_started_again(sent, kind, monkeypatch):
    with process.Process(readers.READERS["token"]) as reader_process:
        assert reader_process.judge(b"x").kind == worker.READ
        monkeypatch.setattr(process, "PATIENCE", 0.3 if kind == "hang" else 60)
        os.kill(reader_process.child.pid, sent)
        assert reader_process.judge(b"x").kind == kind
        assert reader_process.child is None


@pytest.mark.parametrize("name", [name for name in readers.READERS if name not in DEAR])
def test_a_damaged_file_is_read_or_refused_in_a_clear_sentence(name, tmp_path, monkeypatch):
    monkeypatch.setattr(readers, "DAMAGED", tmp_path / "none")
    reader = readers.READERS[name]
    (tmp_path / "seeds").mkdir()
    seeds = reader.seeds(tmp_path / "seeds")
    assert seeds
    path = tmp_path / f"fuzzed{reader.suffix}"
    for data in seeds:
        path.write_bytes(data)
        assert worker.outcome(reader, path)[0] == worker.READ
    for number in range(FILES):
        path.write_bytes(mutations.mutated(seeds, mutations.generator(fuzz.SEED, name, number)))
        kind, message = worker.outcome(reader, path)
        assert kind in (worker.READ, worker.CLEAN), (number, kind, message[:300])


@pytest.mark.parametrize(
    ("findings", "code"), [((), 0), ((fuzz.Finding(3, "KeyError: B", b"ab"),), 1)]
)
def test_the_command_prints_a_table_keeps_what_it_finds_and_ends_with_1(
    findings, code, tmp_path, monkeypatch, capsys
):
    def fuzzed(reader, numbers, *, seed, seconds):
        return fuzz.Tally(reader.name, 1000, 600, 400 - len(findings), findings, 2.0, 7)

    monkeypatch.setattr(fuzz, "fuzz", fuzzed)
    assert command.main(["fuzz", "--reader", "rgbe", "--keep", str(tmp_path)]) == code
    output = capsys.readouterr().out
    assert ["rgbe", "1,000", "600", "7", str(400 - code), str(code), "500"] in [
        line.split() for line in output.splitlines()
    ]
    assert f"1,000 files, {code} findings" in output and ("KeyError" in output) is bool(code)
    kept = sorted(line.name for line in tmp_path.iterdir())
    assert kept == ([f"rgbe-{fuzz.SEED}-3.hdr", f"rgbe-{fuzz.SEED}-3.hdr.txt"] if code else [])
