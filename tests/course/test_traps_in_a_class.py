"""Archives with traps in what a class has handed in: each is refused in one line, the others are graded."""

import pytest
from hats import GOOD, PLAN
from traps import TRAPS, zipped

from hdrlab import cli
from hdrlab.course.reports import results, sheets

LISTED = ("link", "absolute", "drive", "climbs", "device", "pipe", "bomb", "share bytes", "larger than")
NAMES = [name for name in TRAPS if any(word in name for word in LISTED)]


def test_each_trap_is_refused_in_one_line_and_the_rest_of_the_class_is_graded(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in").mkdir()
    who = {f"s{k:02d}": name for k, name in enumerate(NAMES)} | {"first": "", "zip": "", "last": ""}
    (tmp_path / "roster.csv").write_text("student\n" + "\n".join(who))
    (tmp_path / "plan.toml").write_text(PLAN)
    for student, trap in who.items():
        if trap:
            TRAPS[trap](tmp_path / "in" / f"{student}.zip")
    for student in ("first", "last"):
        (tmp_path / "in" / f"{student}.py").write_text(GOOD)
    zipped(tmp_path / "in" / "zip.zip", {"mine/hat.py": GOOD.encode()})
    words = ["grade", "in", "--homework", "hw2", "--roster", "roster.csv", "--plan", "plan.toml"]
    with pytest.raises(SystemExit) as ended:  # nothing of an archive runs before it is judged
        cli.run([*words, "--tier", "practice", "-o", "out", "--jobs", "2"])
    assert not ended.value.code
    rows = {row["student"]: row for row in sheets.read_csv(tmp_path / "out" / "gradebook.csv")}
    assert {student for student, row in rows.items() if float(row["work"]) == 10} == {"first", "zip", "last"}
    assert {float(rows[student]["work"]) for student, trap in who.items() if trap} == {0}
    for student, trap in who.items():
        (file,) = (tmp_path / "out" / "results").glob(f"{student}.*")
        said = results.from_json(file.read_bytes()).problems
        assert len(said) == bool(trap), (trap, said)
        for line in said:
            assert line.startswith("The archive is refused: ") and line.isprintable() and len(line) < 250
    assert {file.name for file in tmp_path.iterdir()} == {"in", "roster.csv", "plan.toml", "out"}


def test_every_kind_of_the_list_is_there():
    assert len(NAMES) >= 20
    assert all(any(word in name for name in NAMES) for word in LISTED)
