"""Our technique counts beside the game's: a small cache written by hand, as ITGmania writes one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from dancetutor_cli.chart.reader import load
from dancetutor_cli.commands.analyze import command
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.lint.figures import tech_counts, tech_rows
from dancetutor_cli.lint.subject import solved_chart
from dancetutor_cli.lint.techniques import TEN, read_game_counts
from dancetutor_cli.run.errors import FileError, UsageError
from dancetutor_cli.run.reading import charts_path

pytestmark = pytest.mark.usefixtures("own_records")

DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"
# Left, down, right: the left foot crosses over; in 8ths at 180 BPM, then a jack.
SONG = """\
#TITLE:Two;
#BPMS:0=180;
#NOTES:dance-single:me:Hard:9::
1000
0100
0001
0100
1000
0100
0001
0001
;
#NOTES:dance-single:me:Easy:3::
1000
0001
;
"""
# As NotesWriterSSC.cpp of ITGmania 1.0 writes it: no notes, six decimals, both players, the file's name last. The steps
# type that it has no pad for gets zeros; the last chart is of the version before half and full crossovers.
CACHE = """\
#VERSION:0.83;
#TITLE:Two;
#BPMS:0.000=180.000;
#BGCHANGES:;
#KEYSOUNDS:;
#ATTACKS:
;
// cache tags:
#FIRSTSECOND:0.000000;
#LASTSECOND:2.333333;
#SONGFILENAME:/Songs/Pack/Two/two.sm;
#HASMUSIC:0;
#HASBANNER:0;
#MUSICLENGTH:100.000000;
// end cache tags

//---------------dance-single - me----------------
#NOTEDATA:;
#CHARTNAME:;
#STEPSTYPE:dance-single;
#DESCRIPTION:me;
#CHARTSTYLE:;
#DIFFICULTY:Hard;
#METER:9;
#RADARVALUES:0.1,0.2,0.0,0.0,0.0;
#CREDIT:me;
// step cache tags:
#TECHCOUNTS:5.000000,4.000000,1.000000,2.000000,1.000000,1.000000,0.000000,3.000000,0.000000,7.000000,{second};
#MEASUREINFO:6.000000,8|6.000000,8;
#GROOVESTATSHASH:0123456789abcdef;
#STEPFILENAME:/Songs/Pack/Two/two.sm;
// end step cache tags

//---------------pump-single - me----------------
#NOTEDATA:;
#STEPSTYPE:pump-single;
#DESCRIPTION:me;
#DIFFICULTY:Hard;
#METER:9;
// step cache tags:
#TECHCOUNTS:{zeros};
#MEASUREINFO:|;
#STEPFILENAME:/Songs/Pack/Two/two.sm;
// end step cache tags

//---------------dance-single - me----------------
#NOTEDATA:;
#STEPSTYPE:dance-single;
#DESCRIPTION:me;
#DIFFICULTY:Challenge;
#TECHCOUNTS:1.000000,1.000000,1.000000,1.000000,1.000000,1.000000,9.000000,9.000000,9.000000,9.000000,9.000000,9.000000;
#STEPFILENAME:/Songs/Pack/Two/two.sm;
// end step cache tags
"""


@pytest.fixture
def places(tmp_path: Path) -> tuple[Path, Path]:
    """A folder with a song, and the game's cache."""
    songs, cache = tmp_path / "My Songs" / "Pack" / "Two", tmp_path / "Cache" / "Songs"
    songs.mkdir(parents=True)
    cache.mkdir(parents=True)
    (songs / "two.sm").write_text(SONG, encoding="utf-8")
    second, zeros = ",".join(["9.000000"] * 10), ",".join(["0.000000"] * 20)
    text = CACHE.replace("{second}", second).replace("{zeros}", zeros)
    (cache / "Songs_Pack_Two").write_text(text, encoding="utf-8", newline="\r\n")
    (cache / "index.cache").write_bytes(b"\0\1\2 no song")
    return songs.parent.parent, cache


def printed(*words: str | Path) -> str:
    result = CliRunner().invoke(command, list(map(str, words)))
    assert result.exit_code == 0, result.output
    return result.stdout


def test_the_first_players_numbers_are_read_by_name(places: tuple[Path, Path]) -> None:
    theirs = read_game_counts(places[1])
    by_difficulty = {key.difficulty: counts for key, counts in theirs.items()}
    assert by_difficulty["Hard"] == dict(zip(TEN, (5, 4, 1, 2, 1, 1, 0, 3, 0, 7), strict=True))
    assert by_difficulty["Challenge"]["Doublesteps"] == 1 and "HalfCrossovers" not in by_difficulty["Challenge"]
    assert {key.song for key in theirs} == {("two", "two.sm")}
    assert {key.steps_type for key in theirs} == {"dance-single"}  # the zeros of Pump say nothing


@pytest.mark.parametrize(
    ("numbers", "first"),
    [("1,2,3,4,5,6,7,8,9,10", {"Crossovers": 1, "Footswitches": 2, "Sideswitches": 3, "Jacks": 4, "Brackets": 5}),
     (",".join(["-1.000000"] * 20), None), ("1,2,3,4,5,6", None), (",".join("1" * 22), None)],
)  # fmt: skip
def test_only_lists_that_the_game_writes_are_read(tmp_path: Path, numbers: str, first: dict[str, int] | None) -> None:
    text = f"#NOTEDATA:;#STEPSTYPE:dance-double;#DIFFICULTY:Hard;#TECHCOUNTS:{numbers};#STEPFILENAME:/Songs/P/T/t.sm;"
    (tmp_path / "Songs_P_T").write_text(text)
    if first is None:
        with pytest.raises(UsageError, match="TECHCOUNTS"):
            read_game_counts(tmp_path)
    else:
        assert list(read_game_counts(tmp_path).values()) == [first]


def test_the_table_has_ours_theirs_and_both(places: tuple[Path, Path]) -> None:
    lines = printed(places[0], "--tech-counts", places[1]).splitlines()
    song = load(places[0] / "Pack" / "Two" / "two.sm")
    ours = tech_counts(solved_chart(song, song.charts[0], load_preset("itg")))
    assert [cell.strip() for cell in lines[0].split("|")] == [
        "", "technique", "charts", "ours", "theirs", "both", "charts alike", "",
    ]  # fmt: skip
    assert len({len(line) for line in lines[:12]}) == 1  # Markdown that a terminal shows as a table, too
    cells = {line.split("|")[1].strip(): [cell.strip() for cell in line.split("|")[2:-1]] for line in lines[2:12]}
    assert list(cells) == list(TEN)
    for name, theirs in zip(TEN, (5, 4, 1, 2, 1, 1, 0, 3, 0, 7), strict=True):
        alike = ours[name] == theirs
        both = min(ours[name], theirs)
        assert cells[name] == ["1", str(ours[name]), str(theirs), str(both), "1 (100 %)" if alike else "0 (0 %)"]
    assert lines[-1] == "1 chart of both; only ours: 1; only theirs: 1"


def test_every_difference_can_be_looked_at(places: tuple[Path, Path]) -> None:
    lines = printed(places[0], "--tech-counts", places[1], "--full").splitlines()
    told = [line for line in lines if "two.sm [dance-single Hard 9]" in line]
    assert any("Doublesteps: ours 0, theirs 7" in line for line in told)
    assert any("Jacks: ours 1 (measures 0), theirs 3" in line for line in told)


def test_a_table_of_another_program_does_as_well(places: tuple[Path, Path], tmp_path: Path) -> None:
    table = tmp_path / "theirs.csv"
    table.write_text("file,steps_type,difficulty,description,Jacks,Brackets\nTwo/two.sm,dance-single,hard,me,1,0\n")
    lines = printed(places[0], "--tech-counts", table).splitlines()
    assert [line.split("|")[1].strip() for line in lines[2:4]] == ["Jacks", "Brackets"]
    assert [cell.strip() for cell in lines[2].split("|")[2:-1]] == ["1", "1", "1", "1", "1 (100 %)"]


TIMES = """\
file,steps_type,difficulty,description,technique,beat
Two/two.sm,dance-single,hard,me,,
Two/two.sm,dance-single,hard,me,Jacks,3.5
Two/two.sm,dance-single,hard,me,Crossovers,1.000000
Two/two.sm,dance-single,hard,me,Crossovers,2.5
Two/two.sm,dance-single,easy,me,,
"""


def test_where_beats_are_known_both_are_the_same_rows(places: tuple[Path, Path], tmp_path: Path) -> None:
    """The left foot crosses on the third row (beat 1) and, back again, on the seventh; theirs stood elsewhere."""
    table = tmp_path / "times.csv"
    table.write_text(TIMES, encoding="utf-8")
    lines = printed(places[0], "--tech-counts", table, "--full").splitlines()
    cells = {line.split("|")[1].strip(): [cell.strip() for cell in line.split("|")[2:-1]] for line in lines[2:4]}
    assert cells["Jacks"] == ["2", "1", "1", "1", "2 (100 %)"]
    assert cells["Crossovers"] == ["2", "2", "2", "1", "1 (50 %)"]  # as often, not in the same rows
    assert lines[4:6] == ["", "2 charts of both; only ours: 0; only theirs: 0"]
    told = [line for line in lines if "[dance-single Hard 9]" in line]
    assert [line.split("] ")[1] for line in told] == [
        "Crossovers: ours 2 (only ours: beats 3), theirs 2 (only theirs: beats 2.5)"
    ]


def test_a_beat_that_is_none_names_the_line(tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text(TIMES.replace("3.5", "nan"))
    with pytest.raises(FileError) as error:
        read_game_counts(tmp_path / "t.csv")
    assert error.value.line == 3


def test_our_own_csv_is_equal_to_ourselves(tmp_path: Path) -> None:
    table = tmp_path / "ours.csv"
    result = CliRunner().invoke(command, [str(DEMO), "--format", "csv", "--no-cache", "--jobs", "1", "--exit-zero"])
    table.write_text(result.stdout, encoding="utf-8")
    lines = printed(DEMO, "--tech-counts", table).splitlines()
    assert all("6 (100 %)" in line for line in lines[2:12])


@pytest.mark.parametrize("text", ["", "#TECHCOUNTS:1,2,x;#NOTEDATA:;", "#NOTEDATA:;#TECHCOUNTS:1,2,3;", "\0" * 50])
def test_a_file_without_counts_is_reported(tmp_path: Path, text: str) -> None:
    (tmp_path / "Songs_A").write_text(text)
    with pytest.raises(UsageError, match="TECHCOUNTS"):
        read_game_counts(tmp_path)


@pytest.mark.parametrize("number", ["x", "nan", "inf", "-"])
def test_a_table_with_a_word_for_a_number_names_the_line(tmp_path: Path, number: str) -> None:
    (tmp_path / "t.csv").write_text(
        f"file,steps_type,difficulty,description,Jacks\na/b.sm,dance-single,Hard,,{number}\n"
    )
    with pytest.raises(FileError) as error:
        read_game_counts(tmp_path / "t.csv")
    assert error.value.line == 2


def test_charts_of_other_songs_are_said_to_be_none(places: tuple[Path, Path]) -> None:
    result = CliRunner().invoke(command, [str(DEMO), "--tech-counts", str(places[1])])
    assert isinstance(result.exception, UsageError)


def test_counts_are_the_lengths_of_their_rows() -> None:
    song = load(DEMO)
    for chart in song.charts:
        subject = solved_chart(song, chart, load_preset("itg"))
        rows, counts = tech_rows(subject), tech_counts(subject)
        assert {name: len(found) for name, found in rows.items()} == counts
        assert subject.play is not None
        assert all(np.isin(found, subject.step_rows).all() for found in rows.values())
