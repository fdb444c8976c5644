"""Lane-split charts: left foot on the left pad, nothing lost, loads, and danced as a double it never crosses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from markers_songs import chart_files, readable, sm, song_of

from dancetutor_cli.chart.edits import apply
from dancetutor_cli.chart.model import Chart, Kind, Song
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.markers import edit
from dancetutor_cli.markers.model import ChartFeet
from dancetutor_cli.markers.plan import solve_charts

THESIS = load_preset("thesis")
SONG = Path(__file__).resolve().parents[2] / "charts" / "two_left_feet"


def feet_of(song: Song) -> list[ChartFeet]:
    singles = [chart for chart in song.charts if chart.steps_type == "dance-single"]
    return solve_charts(song, singles, lambda chart: THESIS).charts


def added(song: Song) -> tuple[list[ChartFeet], list[Chart], bytes]:
    feet = feet_of(song)
    data = song.data + edit.added_charts(song, feet)
    return feet, [chart for chart in parse(data, song.path).charts if edit.is_ours(chart)], data


def test_feet_holds_rolls_and_mines_go_where_they_belong() -> None:
    # left, right (held) with a tap of the left foot meanwhile, a roll of the left, mines under both feet, a fake
    song = song_of(sm(b"\n1000\n0002\n0100\n0003\n,\n0004\n0003\n1000\nM00M\n,\n0F00\n0000\n1001\n0000\n;\n"))
    (one,) = feet_of(song)
    assert one.letters == ("L", "R", "L", "R", "L", "LR")
    assert edit.note_data(one.chart, one.play, b"\n").split() == [
        b"10000000", b"00000002", b"01000000", b"00000003", b",",
        b"00000004", b"00000003", b"10000000", b"M000000M", b",",
        b"0F000000", b"00000000", b"10000001", b"00000000",
    ]  # fmt: skip


def test_hands_go_to_the_pad_of_their_side() -> None:
    song = song_of(sm(b"\n2002\n0000\n0010\n3003\n;\n"))
    (one,) = feet_of(song)
    assert one.letters[1] in "<>"
    row = edit.note_data(one.chart, one.play, b"\n").split()[2]
    assert row == (b"00100000" if one.letters[1] == "<" else b"00000010")


@pytest.mark.parametrize("rows", [1, 3, 4, 5, 12, 48, 192, 384])
def test_any_number_of_rows_keeps_its_beats(rows: int) -> None:
    song = song_of(sm(b"\n" + b"".join(b"1000\n" if i % 2 else b"0001\n" for i in range(rows)) + b";\n"))
    _, (chart,), _ = added(song)
    assert chart.notes.tick.tolist() == song.charts[0].notes.tick.tolist()


@pytest.mark.parametrize("name", ["two_left_feet.sm", "two_left_feet.ssc"])
def test_the_demo_song_as_edit_files(name: str) -> None:
    song = parse((SONG / name).read_bytes(), SONG / name)
    feet = feet_of(song)
    files = list(edit.write(song, SONG, feet))
    assert [file.path.name for file in files] == [
        f"two_left_feet dancetutor feet {one.chart.difficulty} {one.chart.meter}.edit" for one in feet
    ]
    for file, one in zip(files, feet, strict=True):
        data = file.new
        assert data is not None and file.error is None
        assert len(data) <= 60 * 1024
        assert data.startswith(b"#SONG:charts/two_left_feet;\n#NOTES:\n     dance-double:\n")
        (chart,) = parse(data, Path("x.sm")).charts
        assert (chart.steps_type, chart.difficulty, chart.meter) == ("dance-double", "Edit", one.chart.meter)
        assert_split(one, chart)


def assert_split(one: ChartFeet, chart: Chart) -> None:
    """The same notes at the same beats, each on its panel or on the same one of the other pad, by the foot."""
    a, b = one.chart.notes, chart.notes
    order = np.lexsort((b.column % 4, b.tick))
    for name in ("tick", "kind", "end"):
        assert np.array_equal(getattr(a, name), getattr(b, name)[order]), name
    assert np.array_equal(a.column, b.column[order] % 4)
    right = b.column[order] >= 4
    tick = {int(t): i for i, t in enumerate(one.play.rows.tick)}
    for i in range(len(a)):
        if a.judged[i] and a.kind[i] != Kind.MINE:
            limb = one.play.limb[tick[int(a.tick[i])], a.column[i]]
            if limb >= 0:
                assert right[i] == (limb in (Limb.RIGHT_FOOT, Limb.RIGHT_HAND))


def test_added_charts_of_real_songs_never_cross_the_feet(corpus: Path) -> None:
    """Solved as doubles. Where hands help, two steps of a row lie on one pad, and a foot may go there."""
    checked = 0
    for path in chart_files(corpus)[::12]:
        song = readable(path)
        if song is None:
            continue
        try:
            feet, charts, _ = added(song)
        except edit.EditError:
            continue
        assert len(feet) == len(charts)
        for one, chart in zip(feet, charts, strict=True):
            assert chart.timing == one.chart.timing
            assert_split(one, chart)
            play = solve_chart(chart, THESIS)
            assert play is not None
            if not (one.play.limb >= Limb.LEFT_HAND).any():
                assert (np.abs(play.facing) <= 90 + 1e-6).all(), (path, chart.label)
                checked += 1
    assert checked > 50


def test_a_chart_that_is_too_long_for_edit_is_reported() -> None:
    measures = b",".join(b"\n" + b"1000\n0000\n" * 95 + b"0001\n0000\n" for _ in range(80))
    song = song_of(sm(measures + b";\n"))
    (file,) = edit.write(song, song.path.parent, feet_of(song))
    error = file.error
    assert isinstance(error, edit.EditError) and not file.is_change
    assert "--into-file" in str(error)
    assert "61,440" in str(error)
    assert len(added(song)[1]) == 1


SPLIT = (
    b"#TITLE:x;\r\n#BPMS:0=100;\r\n#NOTEDATA:;\r\n#STEPSTYPE:dance-single;\r\n#DESCRIPTION:;\r\n#DIFFICULTY:Hard;\r\n#METER:7;\r\n"
    b"#BPMS:0=120,\r\n8=240;\r\n#STOPS:4=0.5;\r\n#OFFSET:-0.25;\r\n#NOTES:\r\n1000\r\n0100\r\n0010\r\n0001\r\n;\r\n"
)


def test_split_timing_goes_along_into_the_file_but_not_into_an_edit() -> None:
    song = song_of(SPLIT, "song.ssc")
    (file,) = edit.write(song, song.path.parent, feet_of(song))
    error = file.error
    assert isinstance(error, edit.EditError) and not file.is_change
    assert "its own timing" in str(error)
    _, (chart,), data = added(song)
    assert chart.timing == song.charts[0].timing
    assert b"\n" not in data.replace(b"\r\n", b"")


def test_added_charts_come_out_again(tmp_path: Path) -> None:
    for data, name in ((SPLIT, "song.ssc"), (SPLIT.rstrip(), "song.ssc"), (SPLIT + b"// end", "song.ssc"),
                       (sm(b"\n1000\n;\n\n \n"), "song.sm")):  # fmt: skip
        song = song_of(data, name)
        _, _, more = added(song)
        again = song_of(more, name)
        assert apply(more, edit.without_added(again, again.charts)) == data
        behind = song_of(more + b"// by hand\n", name)
        assert apply(behind.data, edit.without_added(behind, behind.charts)) == data + b"// by hand\n"


def test_an_added_chart_is_known_without_its_comment() -> None:
    """As after an editor has saved the file."""
    song = song_of(SPLIT, "song.ssc")
    saved = song_of(added(song)[2].replace(edit.MARK + b"\r\n", b""), "song.ssc")
    assert len(saved.charts) == 2
    assert apply(saved.data, edit.without_added(saved, saved.charts)) == SPLIT


def test_charts_of_one_name_get_names_of_their_own() -> None:
    one = sm(b"\n1000\n;\n")
    song = song_of(one + one[one.index(b"#NOTES") :])
    names = [file.path.name for file in edit.write(song, song.path.parent, feet_of(song))]
    assert len(set(names)) == 2


@pytest.mark.parametrize("end", [b"", b"\n", b"\\"])
def test_nothing_is_added_behind_a_chart_without_an_end(end: bytes) -> None:
    song = song_of(sm(b"\n1000\n0001\n" + end))
    with pytest.raises(edit.EditError, match="';'"):
        edit.added_charts(song, feet_of(song))
