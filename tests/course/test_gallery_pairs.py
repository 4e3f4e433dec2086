"""The vote by pairs: strengths of artifacts with intervals, and the class against metrics."""

import asyncio
import csv
from collections import Counter
from contextlib import closing
from importlib.util import find_spec
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.special import expit
from support import small_gallery as small

from hdrlab import cli
from hdrlab.core.colour import encode_srgb
from hdrlab.course.gallery import agreement, ballots, bradley_terry, collect, pairs, store
from hdrlab.course.gallery.agreement import MetricScores
from hdrlab.errors import InputError
from hdrlab.io import photos, radiance

TEAMS = {f"team{k}": (f"ann{k}", f"ben{k}") for k in range(10)}
# Wins of seven baseball teams against each other in 1987, and their strengths over that of the
# last: Agresti, Categorical Data Analysis, section 10.6, without a prior.
BASEBALL_WINS = [
    [0, 7, 9, 7, 7, 9, 11],
    [6, 0, 7, 5, 11, 9, 9],
    [4, 6, 0, 7, 7, 8, 12],
    [6, 8, 6, 0, 6, 7, 10],
    [6, 2, 6, 7, 0, 7, 12],
    [4, 4, 5, 6, 6, 0, 6],
    [2, 4, 1, 3, 1, 7, 0],
]
BASEBALL_STRENGTHS = [1.581, 1.436, 1.294, 1.248, 1.108, 0.684, 0]


def minorize_maximize(wins, steps=20_000):
    """Return strengths by the algorithm of Hunter, Annals of Statistics 32, 2004."""
    count = len(wins)
    games = np.zeros((count + 1, count + 1))
    games[:count, :count] = wins
    games[count, :count] = games[:count, count] = bradley_terry.PRIOR_WINS
    worth = np.ones(count + 1)
    for _ in range(steps):
        votes = games + games.T
        worth = games.sum(axis=1) / np.sum(votes / (worth[:, None] + worth[None, :]), axis=1)
        worth /= worth[count]
    theta = np.log(worth[:count])
    return theta - theta.mean()


def simulate_wins(theta, voters, questions, rng):
    """Return the votes of simulated voters, each of whom judges some pairs of a cyclic design."""
    wins = np.zeros((len(theta), len(theta)))
    for _ in range(voters):
        order = rng.permutation(len(theta)).tolist()
        for i, j in list(pairs.cyclic_pairs(order))[:questions]:
            if rng.random() < expit(theta[i] - theta[j]):
                wins[i, j] += 1
            else:
                wins[j, i] += 1
    return wins


def draw_strengths(count, rng):
    theta = rng.normal(0, 1, count)
    return theta - theta.mean()


@pytest.mark.parametrize("wins", [BASEBALL_WINS, [[0, 5, 3], [0, 0, 4], [0, 0, 0]]])
def test_strengths_equal_those_of_another_algorithm(wins):
    theta = bradley_terry.fit(wins).theta
    np.testing.assert_allclose(theta, minorize_maximize(np.array(wins, float)), atol=1e-4)


def test_strengths_of_published_games_are_those_of_the_textbook():
    strengths = bradley_terry.fit(BASEBALL_WINS)
    # the prior of one game of 79 draws all strengths a little together
    np.testing.assert_allclose(strengths.theta - strengths.theta[-1], BASEBALL_STRENGTHS, atol=0.1)


def test_many_votes_on_one_pair_give_the_logarithm_of_their_ratio():
    strengths = bradley_terry.fit([[0, 3e6], [1e6, 0]])
    assert strengths.theta[0] - strengths.theta[1] == pytest.approx(np.log(3), abs=1e-4)
    assert strengths.chance[0] == pytest.approx(expit(np.log(3) / 2), abs=1e-4)


def test_an_artifact_that_wins_or_loses_all_pairs_has_a_finite_interval():
    strengths = bradley_terry.fit([[0, 9, 9], [0, 0, 5], [0, 4, 0]])
    low, high = strengths.interval
    assert strengths.theta[0] > strengths.theta[1:].max()
    assert np.all((low > 0) & (low < strengths.chance) & (strengths.chance < high) & (high < 1))


@given(st.integers(2, 7), st.integers(0, 2**32 - 1))
def test_strengths_do_not_depend_on_the_order_of_the_artifacts(count, seed):
    rng = np.random.default_rng(seed)
    wins = rng.integers(0, 6, (count, count)).astype(float)
    np.fill_diagonal(wins, 0)
    order = rng.permutation(count)
    fitted = bradley_terry.fit(wins)
    reordered = bradley_terry.fit(wins[np.ix_(order, order)])
    np.testing.assert_allclose(reordered.theta, fitted.theta[order], atol=1e-5)
    np.testing.assert_allclose(reordered.standard_error, fitted.standard_error[order], atol=1e-5)


def test_without_votes_all_artifacts_are_equal_and_nothing_is_known():
    strengths = bradley_terry.fit(np.zeros((4, 4)))
    assert np.all(strengths.theta == 0)
    low, high = strengths.interval
    assert np.all(high - low > 0.9)
    assert len(bradley_terry.fit(np.zeros((0, 0))).theta) == 0
    with pytest.raises(InputError, match="square"):
        bradley_terry.fit(np.zeros((2, 3)))


@pytest.mark.parametrize(("count", "voters", "questions"), [(8, 12, 10), (20, 30, 20)])
def test_intervals_hold_the_strengths_of_simulated_voters_in_95_percent(count, voters, questions):
    rng = np.random.default_rng(4)
    is_inside = []
    for _ in range(100):
        theta = draw_strengths(count, rng)
        low, high = bradley_terry.fit(simulate_wins(theta, voters, questions, rng)).interval
        is_inside.append((low <= expit(theta)) & (expit(theta) <= high))
    # of 800 or 2000 intervals, the share is within 0.02 of what it would be for many more
    assert 0.92 <= np.mean(is_inside) <= 0.985


@given(st.integers(0, 25))
def test_each_pair_is_asked_once_and_each_artifact_equally_often(count):
    asked = [frozenset(pair) for pair in pairs.cyclic_pairs(range(count))]
    assert sorted(map(sorted, asked)) == sorted(map(list, combinations(range(count), 2)))
    if count > 2:
        times = Counter(artifact for pair in asked[:count] for artifact in pair)
        assert set(times.values()) <= {2, 3} and len(times) == count


def judge(db, voter, prefers):
    """Answer all questions of a voter, and return their pairs; `prefers` returns a winner."""
    asked = []
    while (question := pairs.next_question(db, voter)) is not None:
        assert question.judged == len(asked)
        asked.append(question.pair)
        pairs.cast(db, voter, question.pair, prefers(*question.pair), now=small.START.timestamp())
    return asked


def test_simulated_voters_of_known_taste_are_recovered_from_a_gallery(tmp_path):
    room = small.make_gallery(tmp_path, TEAMS, pairs=25)
    rng = np.random.default_rng(5)
    theta = dict(zip(room.artifacts.values(), draw_strengths(len(TEAMS), rng), strict=True))

    def prefers(first, second):
        return first if rng.random() < expit(theta[first] - theta[second]) else second

    with store.writing(room.folder) as db:
        asked = {voter.id: judge(db, voter, prefers) for voter in store.voters(db)}
        rows = pairs.standings(*pairs.count_wins(db))
    own = {student: room.artifacts[team] for team, members in TEAMS.items() for student in members}
    for voter, questions in asked.items():
        assert len({frozenset(pair) for pair in questions}) == 25
        assert not any(own[voter] in pair for pair in questions)
    assert len({tuple(questions) for questions in asked.values()}) == len(asked)
    assert sum(row.won for row in rows) == 20 * 25
    assert [row.chance for row in rows] == sorted((row.chance for row in rows), reverse=True)
    inside = [row.low <= expit(theta[row.artifact]) <= row.high for row in rows]
    assert sum(inside) >= 8  # of 10; fewer have a probability of 1 in 90


def test_answers_about_a_replaced_artifact_do_not_count(tmp_path):
    room = small.make_gallery(tmp_path, pairs=3)
    eve = store.Voter("eve", "Eve", "eve")
    with store.writing(room.folder) as db:
        assert len(judge(db, eve, lambda first, second: first)) == 3
    with closing(store.connect(room.folder)) as db:
        picture = small.write_photo(tmp_path / "new.png", 9)
        entry = collect.Entry("fay", "New", "", picture)
        assert collect.hang(db, room.folder, entry) == 2
        _, wins = pairs.count_wins(db)
        assert wins.sum() == 1 and pairs.next_question(db, eve).judged == 1
    with store.writing(room.folder) as db:
        while (question := pairs.next_question(db, eve)) is not None:
            pairs.cast(db, eve, question.pair, question.pair[0], now=room.clock())
        assert pairs.count_wins(db)[1].sum() == 3


def test_a_gallery_has_ballots_or_pairs(tmp_path, capsys):
    for marks, asked in ((0, 0), (3, 3), (-1, 0)):
        with pytest.raises(InputError, match="at least 1"):
            store.create(tmp_path / "wrong", "", small.CLOSES, marks, pairs=asked)
    room = small.make_gallery(tmp_path)
    with store.writing(room.folder) as db:
        voter = store.voters(db)[0]
        assert pairs.next_question(db, voter) is None
        pair = list(room.artifacts.values())[2:]
        with pytest.raises(ballots.NotAccepted):
            pairs.cast(db, voter, pair, pair[0], now=room.clock())
    with pytest.raises(SystemExit) as ended:
        cli.run(
            ["gallery", "init", str(tmp_path / "g"), "--closes", "2030-01-01T00:00+01:00"]
            + ["--pairs", "5", "--marks", "2"]
        )
    assert ended.value.code == 2 and "--pairs" in capsys.readouterr().err


def all_prefer(order):
    """Return the wins of a class in which everybody prefers the artifacts in this order."""
    count = len(order)
    wins = np.zeros((count, count))
    for better, worse in combinations(order, 2):
        wins[better, worse] = 3
    return wins


def test_agreement_counts_the_pairs_on_which_two_judges_prefer_the_same():
    ids = ["a", "b", "c", "d", "without a map"]
    scores_of = {
        "a": MetricScores(0.9, 0.1),
        "b": MetricScores(0.8, 0.2),
        "c": MetricScores(0.7, 0.3),
        "d": MetricScores(0.6, 0.4),
    }
    rows = {
        (row.first, row.second): row
        for row in agreement.agreements(ids, all_prefer([4, 0, 1, 3, 2]), scores_of)
    }
    assert {judges: (row.share, row.pairs) for judges, row in rows.items()} == {
        (agreement.CLASS, "TMQI"): (pytest.approx(5 / 6), 6),  # all but c and d
        (agreement.CLASS, "PU-SSIM"): (pytest.approx(1 / 6), 6),
        ("TMQI", "PU-SSIM"): (0, 6),
    }
    for row in rows.values():
        assert 0 <= row.low <= row.share <= row.high <= 1 and row.high - row.low > 0.3
    tied = np.ones((5, 5))
    assert [row.first for row in agreement.agreements(ids, tied, scores_of)] == ["TMQI"]
    assert agreement.agreements(ids, tied, {"a": MetricScores(1, 1)}) == []


@pytest.mark.parametrize("count", [6, 20])
@pytest.mark.parametrize("correlation", [0.0, 0.7])
def test_intervals_of_the_agreement_hold_its_true_value(count, correlation):
    rng = np.random.default_rng(6)
    # for two normal variables, pairs agree with probability 1/2 + arcsin(correlation) / pi
    true = 0.5 + np.arcsin(correlation) / np.pi
    is_inside = []
    for _ in range(400):
        quality = rng.normal(size=count)
        metric = correlation * quality + np.sqrt(1 - correlation**2) * rng.normal(size=count)
        agree = [
            (quality[i] > quality[j]) == (metric[i] > metric[j])
            for i, j in combinations(range(count), 2)
        ]
        low, high = agreement.share_interval(np.mean(agree), len(agree), count)
        is_inside.append(low <= true <= high)
    assert np.mean(is_inside) >= 0.92


def write_scene(folder):
    """Write a map that a display can show without compression, and return it and its picture."""
    ramp = np.linspace(0.02, 1, 64 * 96).reshape(64, 96, 1)
    stripes = 1 + 0.3 * np.sin(np.arange(96) / 2)[None, :, None]
    E = (ramp * stripes / 1.3 * np.array([1, 0.9, 0.8])).astype(np.float32)
    radiance.write_radiance(folder / "scene.exr", 50 * E)
    return folder / "scene.exr", np.round(255 * encode_srgb(E)).astype(np.uint8)


def test_metrics_prefer_the_picture_that_shows_the_scene(tmp_path):
    radiance_map, picture = write_scene(tmp_path)
    photos.write_picture(tmp_path / "faithful.png", picture)
    photos.write_picture(tmp_path / "inverted.png", 255 - picture)
    faithful = agreement.score(tmp_path / "faithful.png", radiance_map)
    inverted = agreement.score(tmp_path / "inverted.png", radiance_map)
    assert faithful.pu_ssim > 0.99 and faithful.pu_ssim > inverted.pu_ssim + 0.2
    assert faithful.tmqi > inverted.tmqi + 0.1
    # a picture of half the size shows the same scene
    photos.write_picture(tmp_path / "half.png", picture[::2, ::2].copy())
    assert agreement.score(tmp_path / "half.png", radiance_map).pu_ssim > 0.9
    photos.write_picture(tmp_path / "cropped.png", picture[:, :64])
    with pytest.raises(InputError, match="aspect ratio"):
        agreement.score(tmp_path / "cropped.png", radiance_map)


def test_the_commands_score_artifacts_and_write_strengths(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)

    def run(*words):
        with pytest.raises(SystemExit) as ended:
            cli.run(["gallery", *words])
        assert not ended.value.code
        return "".join(capsys.readouterr())

    radiance_map, picture = write_scene(tmp_path)
    (tmp_path / "art").mkdir()
    photos.write_picture(tmp_path / "art/ann.png", picture)
    photos.write_picture(tmp_path / "art/ben.png", picture[:, :64])
    (tmp_path / "roster.csv").write_text("student\nann\nben\ncy\n")
    assert "up to 4 pairs" in run("init", "g", "--closes", "2030-01-01T00:00+01:00", "--pairs", "4")
    output = run("add", "g", "--roster", "roster.csv", "--map", radiance_map.name, "art")
    assert "2 artifacts added, 1 of them with TMQI and PU-SSIM" in output
    assert "ben.png: no TMQI and PU-SSIM" in output
    with store.writing(tmp_path / "g") as db:
        ids = {artifact.team: id for id, artifact in store.artifacts(db).items()}
        assert list(agreement.read_scores(db)) == [ids["ann"]]
        judge(db, store.Voter("cy", "cy", "cy"), lambda first, second: ids["ann"])
    run("close", "g")
    assert "Bradley and Terry" in run("results", "g", "-o", "results.csv")
    with open("results.csv", encoding="utf-8-sig") as file:
        rows = {row["student"]: row for row in csv.DictReader(file)}
    assert [rows[who]["pairs judged"] for who in ("ann", "ben", "cy")] == ["0", "0", "1"]
    assert (rows["ann"]["votes for it"], rows["ann"]["votes on it"]) == ("1", "1")
    percents = [int(rows["ann"][name]) for name in ("percent from", "percent", "percent to")]
    assert percents == sorted(percents) and percents[1] > 50 > int(rows["ben"]["percent"])


@pytest.mark.skipif(find_spec("starlette") is None, reason='needs pip install ".[class]"')
def test_a_voter_judges_pair_after_pair_and_sees_strengths_after_the_end(tmp_path):
    from hdrlab.course.gallery.web import app

    room = small.make_gallery(tmp_path, pairs=5, title="<b>{team}</b>")
    with store.writing(room.folder) as db:
        for k, id in enumerate(room.artifacts.values()):
            db.execute("INSERT INTO scores VALUES (?, ?, ?)", (id, k / 10, -k / 10))
    gallery = app.Gallery(room.folder, small.ADDRESS, room.clock)
    client = small.Browser(app.application(gallery), small.ADDRESS)
    origin = {"origin": small.ADDRESS}
    client.post(f"/enter/{room.links['ann']}", headers=origin)
    for number in range(1, 4):  # three pairs of the three other teams
        room.clock.now += 1
        page = client.get("/").text
        assert f"Pair {number} of 3" in page and "<b>team" not in page
        pair = [id for id in room.artifacts.values() if f'name="of" value="{id}"' in page]
        form = {"key": small.form_key(page), "of": pair, "winner": pair[0]}
        assert client.post("/pair", form, headers=origin).status == 303
    page = client.get("/").text
    assert "You have judged 3 pairs" in page and 'name="mark"' not in page
    again = client.get("/?again").text  # the last pair, to correct a wrong press
    assert "Pair 3 of 3" in again and all(f'value="{id}"' in again for id in pair)
    form |= {"winner": pair[1]}
    assert client.post("/pair", form, headers=origin).status == 303
    with closing(store.connect(room.folder)) as db:
        query = "SELECT winner FROM comparisons WHERE (first, second) = (?, ?)"
        assert db.execute(query, sorted(pair)).fetchall() == [(pair[1],)]
    assert client.get("/results").status == 403
    room.clock.now = small.CLOSES.timestamp()
    page = client.get("/results").text
    assert "3 answers about pairs" in page and "The class against the metrics" in page
    assert "TMQI and PU-SSIM prefer the same artifact" in page and "<b>team" not in page
    asyncio.run(gallery.close())
