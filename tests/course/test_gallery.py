"""The gallery: students vote on ballots that they can change, and see the results after the end."""

import csv
import re
from contextlib import closing
from importlib.util import find_spec
from pathlib import Path

import pytest
from hypothesis import given, strategies as st
from support import small_gallery as small

from hdrlab import cli
from hdrlab.course.gallery import ballots, collect, store, tokens

served = pytest.mark.skipif(
    any(find_spec(name) is None for name in ("starlette", "uvicorn")),
    reason='the gallery needs pip install ".[class]"',
)
IDS = [f"a{k}" for k in range(6)]
some_ballots = st.lists(st.frozensets(st.sampled_from(IDS), max_size=3), max_size=12)


@given(some_ballots)
def test_places_follow_votes_and_ties_share_a_place(cast):
    rows = ballots.standings(IDS, cast)
    assert sorted(row.artifact for row in rows) == IDS
    for row in rows:
        assert row.votes == sum(row.artifact in ballot for ballot in cast)
        assert row.place == 1 + sum(other.votes > row.votes for other in rows)
        assert row.shared == sum(other.votes == row.votes for other in rows) - 1


@given(some_ballots, st.randoms(use_true_random=False))
def test_the_order_of_ballots_and_artifacts_does_not_change_places(cast, random):
    shuffled = list(cast)
    ids = list(IDS)
    random.shuffle(shuffled)
    random.shuffle(ids)
    assert ballots.standings(ids, shuffled) == ballots.standings(IDS, cast)


@given(some_ballots, st.sampled_from(IDS))
def test_another_vote_never_lowers_a_place(cast, ballot):
    before = {row.artifact: row.place for row in ballots.standings(IDS, cast)}
    after = {row.artifact: row.place for row in ballots.standings(IDS, [*cast, {ballot}])}
    assert after[ballot] <= before[ballot]


def test_each_voter_sees_the_artifacts_in_a_different_order():
    orders = [tuple(tokens.shuffled(IDS, b"secret", f"voter {k}")) for k in range(200)]
    assert len(set(orders)) > 120  # of 720
    first = [sum(order[0] == artifact for order in orders) for artifact in IDS]
    assert min(first) > 15  # 33 each, were it even


def test_a_ballot_can_be_changed_and_withdrawn_until_the_end(tmp_path):
    room = small.make_gallery(tmp_path)
    eve = room.artifacts["eve"]
    fay = room.artifacts["fay"]
    for marked in ([eve], [eve, fay], [fay], []):
        with store.writing(room.folder) as db:
            assert ballots.cast(db, "ann", marked, now=room.clock()) == len(marked)
        with closing(store.connect(room.folder)) as db:
            assert ballots.read_ballot(db, "ann")[1] == set(marked)
    with pytest.raises(ballots.NotAccepted, match="closed"), store.writing(room.folder) as db:
        ballots.cast(db, "ann", [eve], now=small.CLOSES.timestamp())


def refuse_ballot(folder, marks_of):
    """Cast a ballot that must be refused, after one for eve, and return ann's ballot."""
    room = small.make_gallery(folder)
    with store.writing(room.folder) as db:
        ballots.cast(db, "ann", [room.artifacts["eve"]], now=room.clock())
        with pytest.raises(ballots.NotAccepted):
            ballots.cast(db, "ann", marks_of(room.artifacts), now=room.clock())
    with closing(store.connect(room.folder)) as db:
        return {
            name for name, key in room.artifacts.items() if key in ballots.read_ballot(db, "ann")[1]
        }


def test_nobody_can_vote_for_their_own_team(tmp_path):
    assert refuse_ballot(tmp_path, lambda artifacts: [artifacts["team1"]]) == {"eve"}


def test_nobody_can_vote_for_a_picture_that_does_not_exist(tmp_path):
    assert refuse_ballot(tmp_path, lambda artifacts: ["nothing"]) == {"eve"}


def test_nobody_has_more_votes_than_the_gallery_gives(tmp_path):
    assert refuse_ballot(tmp_path, lambda artifacts: list(artifacts.values())) == {"eve"}


def test_a_new_title_keeps_the_votes_and_a_new_image_starts_with_none(tmp_path):
    room = small.make_gallery(tmp_path)
    with store.writing(room.folder) as db:
        ballots.cast(db, "ann", [room.artifacts["eve"], room.artifacts["fay"]], now=room.clock())
    with closing(store.connect(room.folder)) as db:
        collect.hang(db, room.folder, collect.Entry("eve", "New", "", tmp_path / "eve.png"))
        assert store.artifacts(db)[room.artifacts["eve"]].title == "New"
        collect.hang(
            db,
            room.folder,
            collect.Entry("fay", "New", "", small.write_photo(tmp_path / "f.png", 9)),
        )
        assert ballots.read_ballot(db, "ann")[1] == {room.artifacts["eve"]}
        assert len(store.artifacts(db)) == 4


def test_the_gradebook_lists_who_voted_but_not_the_votes(tmp_path):
    room = small.make_gallery(tmp_path)
    with store.writing(room.folder) as db:
        ballots.cast(db, "ann", [room.artifacts["eve"]], now=room.clock())
        ballots.cast(db, "cy", [room.artifacts["eve"], room.artifacts["fay"]], now=room.clock())
        ballots.cast(db, "dee", [], now=room.clock())
    with closing(store.connect(room.folder)) as db:
        rows = {
            row[0]: dict(zip(ballots.GRADEBOOK_COLUMNS, row, strict=True))
            for row in ballots.gradebook(db)
        }
    assert [who for who, row in rows.items() if row["voted"] == "yes"] == ["ann", "cy"]
    assert [rows[who]["place"] for who in ("eve", "fay", "ann", "ben", "cy")] == [1, 2, 3, 3, 3]
    assert rows["ann"]["shared with"] == 1 and set(rows["ann"]) == set(ballots.GRADEBOOK_COLUMNS)


@pytest.fixture
def hdrlab(tmp_path, monkeypatch, capsys):
    """hdrlab(words) -> the exit code of `hdrlab gallery` and its output, in an empty folder."""
    monkeypatch.chdir(tmp_path)

    def command(*words):
        with pytest.raises(SystemExit) as ended:
            cli.run(["gallery", *words])
        return ended.value.code or 0, "".join(capsys.readouterr())

    return command


def test_a_gallery_is_made_at_the_command_line(tmp_path, hdrlab):
    (tmp_path / "roster.csv").write_text(
        "student,name,team\nann,Ann,team1\nben,Ben,team1\neve,Eve,\n"
    )
    art = tmp_path / "art"
    art.mkdir()
    small.write_photo(art / "team1.png")
    (art / "team1.txt").write_text("Dusk\nSeven frames.")
    (art / "eve.png").write_text("<svg/>")
    small.write_photo(art / "stranger\x1b[2J.png")
    output = [
        hdrlab("init", "g", "--closes", "2020-01-01T00:00+01:00", "--title", "Spring"),
        hdrlab("init", "g", "--closes", "2030-01-01T00:00+01:00"),
        hdrlab("add", "g", "--roster", "roster.csv", "art"),
        hdrlab("links", "g", "-o", "links.csv", "--address", "https://vote.test"),
        hdrlab("links", "g", "-o", "again.csv", "--address", "https://vote.test"),
        hdrlab("results", "g", "-o", "results.csv"),
        hdrlab("close", "g"),
    ]
    assert [code for code, _ in output] == [0, 2, 0, 0, 0, 0, 2]
    assert "3 voters, 1 artifacts added, 2 refused" in output[2][1] and "eve.png" in output[2][1]
    assert "\x1b" not in output[2][1]
    assert "stranger" in output[2][1] and "Traceback" not in "".join(text for _, text in output)
    with open(tmp_path / "links.csv", encoding="utf-8-sig") as file:
        links = [row["link"] for row in csv.DictReader(file)]
    assert len(set(links)) == 3
    assert all(re.fullmatch(r"https://vote.test/enter/[\w-]{55}", link) for link in links)
    assert "0 personal links" in output[4][1]  # asking twice does not revoke a link
    with open(tmp_path / "results.csv", encoding="utf-8-sig") as file:
        assert [row["artifact"] for row in csv.DictReader(file)] == ["Dusk", "Dusk", ""]


@pytest.mark.parametrize("version", [0, store.SCHEMA_VERSION - 1, store.SCHEMA_VERSION + 1])
def test_a_gallery_of_another_version_is_refused_with_a_remedy(tmp_path, hdrlab, version):
    hdrlab("init", "g", "--closes", "2030-01-01T00:00+01:00")
    with closing(store.connect(tmp_path / "g")) as db:
        db.execute(f"PRAGMA user_version = {version}")
    for words in (("close", "g"), ("results", "g", "-o", "r.csv")):
        code, output = hdrlab(*words)
        assert code == 2 and output.count("\n") <= 2, output
        assert f"expected a gallery of version {store.SCHEMA_VERSION}, got" in output
        assert "gallery init" in output
    (tmp_path / "g" / store.DATABASE).write_text("half a database")
    assert hdrlab("close", "g")[0] == 2 and "cannot be read" in hdrlab("close", "g")[1]


@pytest.mark.grading
@served
def test_concurrent_voters_lose_no_ballot_and_none_counts_twice(tmp_path):
    from benchmarks import gallery as bench

    load = bench.load(tmp_path, "apart", 24, within=1.0, changes=2)
    assert (load["ballots lost"], load["ballots double"], load["refused"]) == (0, 0, 0)
    assert load["voters"] == 24


def test_gallery_benchmark_rows_write_into_separate_folders(tmp_path, monkeypatch):
    benchmark = pytest.importorskip("benchmarks.gallery", reason="the benchmarks are not installed")
    folders = []
    monkeypatch.setattr(
        benchmark, "load", lambda folder, how, **_: folders.append(folder / how) or {}
    )
    for row in benchmark.ROWS[:3]:
        row.run(tmp_path)
    assert len(set(folders)) == 3


@pytest.mark.grading
@served
def test_a_server_that_is_killed_loses_no_acknowledged_ballot(tmp_path):
    from benchmarks import gallery as bench

    outcome = bench.killed(tmp_path, 40, 1, after=1.0)
    assert outcome["acknowledged ballots lost"] == 0
    assert outcome["acknowledged before the kill"] >= 10


@pytest.mark.grading
@served
@pytest.mark.skipif(
    not Path("/proc/self/fd").is_dir(), reason="counts the descriptors of a server in /proc"
)
def test_voters_are_served_while_incomplete_requests_hold_all_connections(tmp_path):
    from benchmarks import gallery as bench

    load = bench.load(tmp_path, "apart", 12, within=0.5, changes=1, slow=200, descriptors=400)
    assert (load["ballots lost"], load["refused"], load["voters"]) == (0, 0, 12)
    assert 0 < load["bytes of log"] < 1000
