"""The class list, its teams, and tables whose cells spreadsheets do not execute."""

import pytest
from hypothesis import given, settings, strategies as st

from hdrlab.course.sanitize import sanitize_line
from hdrlab.course.students import csv_tables, roster
from hdrlab.errors import InputError


@pytest.fixture
def listed(tmp_path):
    def read(text):
        (tmp_path / "roster.csv").write_text(text, encoding="utf-8-sig")
        return roster.read(tmp_path / "roster.csv")

    return read


def test_a_roster_has_students_and_teams(listed):
    roster_read = listed("Student,Name,Team\nb1,Ada,7\nb2,Bo,7\n\nb3,Cy,\n")
    assert {
        team: [member.id for member in members] for team, members in roster_read.teams().items()
    } == {
        "7": ["b1", "b2"],
        "b3": ["b3"],
    }
    assert roster_read.find(" B2 ").name == "Bo" and roster_read.find_team("b2") == "7"


def test_a_team_may_have_as_many_students_as_the_plan_says(tmp_path):
    path = tmp_path / "roster.csv"
    path.write_text("student,team\nb1,7\nb2,7\nb3,7\n")
    (members,) = roster.read(path, team_size=3).teams().values()
    assert len(members) == 3


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("name\nAda\n", "column student"),
        ("student\nb1\nB1\n", "lines 2 and 3: "),
        ("student,team\nb1,7\nb2,7\nb3,7\n", "teams of at most 2"),
        ("student\n../b1\n", "line 2"),
        ("student,team\nb1,7\nb2,../7\n", "line 3: expected a team's name"),
        ("student,name\nb1,Ada\n,Bo\n", "line 3"),
        ("student\nb1,Ada\n", "1 cells"),
        ("", "empty"),
    ],
)
def test_a_wrong_roster_is_refused_with_its_line(listed, text, message):
    with pytest.raises(ValueError, match=message):
        listed(text)


CONFUSED = {
    "a team that is another's id": "student,team\nb01,b02\nb02,\n",
    "a team that is another's id, in capitals": "student,team\nb01,B02\nb02,\n",
    "a team that is another's file": "student,team\nb01,\nb02,b01_hw2\n",
    "a team that begins another's file, by a blank": "student,team\nb01,\nb02,b01 hw2\n",
    "an id that begins another id": "student\nb01\nb01-a\n",
    "an id that begins another's team": "student,team\nt,\nb02,t.7\n",
    "a team that begins another team": "student,team\nb01,t\nb02,t_1\n",
    "an id in wide letters": "student\nb01\n\uff42\uff10\uff11\n",
    "an id with a composed letter": "student\nb\u00e9\nbe\u0301\n",
    "an id with a ligature": "student\nsta\ufb03\nstaffi\n",
    "an id with a sharp s": "student\nwei\u00df\nWEISS\n",
    "an id with a mark that is not seen": "student\nb01\nb0\u200b1\n",
    "a team in two ways of writing": "student,team\nb01,T\nb02,t\n",
    "a team that is another's id, who is in a third": "student,team\nb01,b02\nb02,t\n",
}


@pytest.mark.parametrize("text", CONFUSED.values(), ids=CONFUSED)
def test_names_that_share_a_file_name_are_refused_with_both_lines(listed, text):
    with pytest.raises(ValueError, match=r"lines 2 and 3: "):
        listed(text)


@pytest.mark.parametrize(
    "text",
    [
        "student,team\nb01,b01\nb02,b01\n",  # a team named after one of its own
        "student,team\nb01,b01-b02\nb02,b01-b02\n",  # or after both
        "student\nb1\nb12\nb123\n",  # no sign between
        "student,team\nb01,t1\nb02,t1\nb03,t10\n",
    ],
)
def test_names_with_different_file_names_are_accepted(listed, text):
    assert listed(text).students


@settings(max_examples=30)
@given(
    st.lists(
        st.text("ab1_-", min_size=1, max_size=4).filter(lambda id: id[0] != "-"),
        unique=True,
        min_size=1,
    )
)
def test_every_file_name_belongs_to_one_owner_of_the_roster(tmp_path_factory, ids):
    path = tmp_path_factory.mktemp("class") / "roster.csv"
    path.write_text("\n".join(["student", *ids]))
    try:
        roster_read = roster.read(path)
    except ValueError:
        return
    for id in ids:
        for name in (id, f"{id}_hw2.ipynb", f"{id}.zip", f"{id.upper()}-b.py"):
            assert roster_read.owner(name) == id


def test_a_stranger_is_reported(listed):
    roster_read = listed("student,team\nb1,7\nb2,8\n")
    with pytest.raises(ValueError, match="student .*roster"):
        roster_read.find("b9")


def test_a_team_is_found_by_its_name_or_a_member_in_any_case():
    roster_read = roster.Roster(
        (roster.Student("b1", "Ada", "t1"), roster.Student("b2", "Bo", "t1"))
    )
    for name in ("t1", "T1", "b1", " B2 "):
        assert roster_read.find_team(name) == "t1"
    with pytest.raises(InputError, match="t9"):
        roster_read.find_team("t9")


def test_a_name_that_could_mean_two_teams_is_refused():
    roster_read = roster.Roster(
        (roster.Student("b1", "Ada", "t1"), roster.Student("b2", "Bo", "T1"))
    )
    with pytest.raises(InputError, match="T1, t1"):
        roster_read.find_team("t1")


@pytest.mark.parametrize(
    "cell",
    [
        "=1+1",
        "+1+1",
        "-1+1",
        "@SUM(A1)",
        "\t=1",
        "\r\n=cmd|' /C calc'!A0",
        "|calc",
        "%x",
        "\uff1d1+1",
    ],
)
def test_a_spreadsheet_does_not_take_a_cell_for_a_formula(cell):
    assert csv_tables.escape_cell(cell).startswith("'")
    assert "\n" not in csv_tables.escape_cell(cell) and "\r" not in csv_tables.escape_cell(cell)


@given(st.text(max_size=40))
def test_a_name_with_any_characters_is_one_cell_of_a_table(text):
    import csv
    import io

    rows = list(csv.reader(io.StringIO(csv_tables.csv_text(["name", "points"], [[text, -3]]))))
    assert len(rows) == 2 and len(rows[1]) == 2 and rows[1][1] == "-3"


def test_a_private_table_is_for_its_owner_alone(tmp_path):
    path = csv_tables.write_csv(tmp_path / "links.csv", ["a"], [["b"]], private=True)
    assert path.stat().st_mode & 0o077 == 0
    assert csv_tables.read_csv(path) == [{"a": "b"}]


@given(st.text(max_size=200), st.integers(2, 40))
def test_a_shown_name_is_one_line_without_direction_marks(text, most):
    shown = sanitize_line(text, most)
    assert len(shown) <= most and shown == shown.strip()
    assert all(letter.isprintable() for letter in shown)
    assert sanitize_line(shown, most) == shown


def test_stacked_accents_are_limited():
    assert len(sanitize_line("a" + "\u0301" * 100, 50)) <= 3
    assert sanitize_line("Nguy\u1ec5n \u05d0\u05d1 \u5f35", 40) == "Nguy\u1ec5n \u05d0\u05d1 \u5f35"
