"""The reader: tags, text, errors; nothing but ChartError for any bytes; time grows with the size."""

from __future__ import annotations

import pickle
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dancetutor_cli.chart import msd
from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.reader import load, parse
from dancetutor_cli.run.errors import ChartError, FileError

CHART = b"#BPMS:0=120;#NOTES:dance-single:d:Hard:9:0:\n1000\n0100\n0010\n0001\n;"
SSC = b"#VERSION:0.83;#TITLE:T;#BPMS:0=120;#NOTEDATA:;#STEPSTYPE:dance-single;#DIFFICULTY:Hard;#NOTES:\n1000\n;"


def read(data: bytes, name: str = "x.sm") -> Song:
    return parse(data, Path(name))


def tags(data: bytes) -> list[tuple[str, list[bytes]]]:
    return [(tag.name, [msd.plain(data[a:b]) for a, b in tag.spans]) for tag in msd.scan(data)]


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"#A:b;", [("A", [b"b"])]),
        (b"x#a: b : c;y;:#D ;", [("A", [b" b ", b" c"]), ("D ", [])]),
        (b"#A:b\n #C:d", [("A", [b"b\n "]), ("C", [b"d"])]),
        (b"#A:#B:c;", [("A", [b""]), ("B", [b"c"])]),
        (b"#A: \t#B:c;", [("A", [b" \t"]), ("B", [b"c"])]),
        (b"#A:b#c;", [("A", [b"b#c"])]),
        (b"#A:b\r#C:d;", [("A", [b"b\r"]), ("C", [b"d"])]),
        (b"#A:b\\;c\\:\\#d\\\\;", [("A", [b"b;c:#d\\"])]),
        (b"#A:b//;:#\nc;", [("A", [b"b\nc"])]),
        (b"#A:b////;\nc;", [("A", [b"b\nc"])]),
        (b"//#A:b;\n#C:d;", [("C", [b"d"])]),
        (b"#A:\\//b;", [("A", [b"//b"])]),
        (b"#A:x\\", [("A", [b"x"])]),
        (b"\\#A:b;#C:d;", [("C", [b"d"])]),
        (b"#A", [("A", [])]),
        (b"", []),
    ],
)
def test_tags(data: bytes, expected: list[tuple[str, list[bytes]]]) -> None:
    assert tags(data) == expected


@given(st.binary(max_size=400))
@settings(deadline=None, max_examples=300)
def test_any_bytes_give_a_song_or_a_chart_error(data: bytes) -> None:
    for name in ("x.sm", "x.ssc"):
        for whole in (data, CHART[:40] + data, CHART + data, SSC[:-10] + data):
            try:
                song = read(whole, name)
            except ChartError as error:
                assert "\n" not in str(error)
            else:
                assert song.charts


@given(st.lists(st.tuples(st.integers(0, len(SSC)), st.binary(max_size=3)), max_size=8), st.sampled_from([CHART, SSC]))
@settings(deadline=None, max_examples=300)
def test_damaged_charts_give_a_song_or_a_chart_error(edits: list[tuple[int, bytes]], data: bytes) -> None:
    for at, new in edits:
        data = data[:at] + new + data[at + len(new) :]
    for name in ("x.sm", "x.ssc"):
        try:
            read(data, name)
        except ChartError as error:
            assert "\n" not in str(error)


@pytest.mark.parametrize(
    ("data", "name", "part"),
    [
        (b"", "x.sm", "no charts"),
        (b"hello", "x.ssc", "no charts"),
        (b"#TITLE:a;", "x.sm", "no charts"),
        (CHART.decode().encode("utf-16"), "x.sm", "UTF-16"),
        (CHART.decode().encode("utf-16-le"), "x.sm", "UTF-16"),
        (CHART.decode().encode("utf-16-be"), "x.ssc", "UTF-16"),
        (CHART.decode().encode("utf-32"), "x.ssc", "UTF-32"),
        (SSC, "x.sm", "rename the file to .ssc"),
        (CHART, "x.ssc", "rename the file to .sm"),
        (b"#NOTES:dance-single:a;", "x.sm", "2 of 6 fields"),
        (CHART.replace(b"dance-single", b"lights-cabinet"), "x.sm", "lights"),
    ],
)
def test_errors_name_the_cause(data: bytes, name: str, part: str) -> None:
    with pytest.raises(ChartError, match=part) as caught:
        read(data, name)
    assert str(caught.value).startswith(f"{name}:")
    assert pickle.loads(pickle.dumps(caught.value)).message == caught.value.message


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="no such file"):
        load(tmp_path / "missing.sm")
    with pytest.raises(FileError, match=r"no \.sm, \.ssc or \.ucs file"):
        load(tmp_path)
    with pytest.raises(FileError):
        load(Path("nul\0.sm"))


def test_the_last_of_equal_tags_wins_and_names_have_no_case() -> None:
    song = read(b"#title:a;#TITLE:b;#Freezes:4=1;" + CHART)
    assert song.title == "b"
    assert song.tags["STOPS"] == "4=1"
    assert len(song.timing.stops) == 1


def test_tags_after_notes_are_the_songs_and_notedata_without_notes_merges() -> None:
    data = SSC.replace(b"#NOTEDATA:;", b"#NOTEDATA:;#METER:7;#NOTEDATA:;") + b"#ARTIST:late;#METER:3;"
    song = read(data, "x.ssc")
    assert song.artist == "late"
    assert song.charts[0].meter == 7


def test_sm_reads_timing_that_follows_the_notes() -> None:
    assert read(CHART + b"#BPMS:0=99;").timing.bpm_at(0) == 99


@pytest.mark.parametrize(
    ("encoding", "words"),
    [
        ("ascii", "plain"),
        ("utf-8", "Ünïcode 曲"),
        ("utf-8-sig", "曲"),
        ("cp932", "さくらの曲 ソナタ"),
        ("cp932", "桜花絢爛"),
        ("cp949", "노래방 한국어"),
        ("cp1252", "Déjà vu – Señorita’s café"),
        ("cp1252", "It’s été"),
    ],
)
def test_encodings(encoding: str, words: str) -> None:
    data = f"#TITLE:{words};".encode(encoding)
    assert msd.encoding_of(data + CHART) == encoding
    assert msd.decode_text(words.encode(encoding), encoding).lstrip("\ufeff") == words.replace(
        "ソ", words[words.find("ソ")]
    )


@pytest.mark.parametrize(
    ("raw", "expected"),
    [
        ("\x1b[2Jred\x1b[0m", "red"),
        ("\x1b]0;title\x07x", "x"),
        ("\x1b]0 unfinished", "0 unfinished"),
        ("a\x00b\x08c", "abc"),
        ("a\u202eb\u200bc", "abc"),
        ("曲　名", "曲 名"),
        ("two\nlines\tand", "two lines and"),
        ("[bold]x[/bold]", "[bold]x[/bold]"),
    ],
)
def test_titles_are_safe_to_print(raw: str, expected: str) -> None:
    song = read("#TITLE:{0};#ARTIST:{0};".format(raw.replace(";", "\\;")).encode() + CHART)
    assert song.title == song.artist == expected
    assert song.title.isprintable()


def test_messages_are_safe_to_print() -> None:
    song = read(b"#BPMS:0=\x1b[31m1,\x1b]0;#OFFSET:\x1b[0m;#MUSIC:../\x1b[2J\n;" + CHART[12:])
    assert song.warnings
    odd = b"#NOTES:\x1b[3mkind\nx:d:\x07what\n\x1b:7\n\x1b[m:0:\n1\x1b\x9b\n;"
    for warning in (*song.warnings, *song.charts[0].warnings, *read(odd).charts[0].warnings):
        assert warning.message.isprintable()


def test_duplicate_difficulties_keep_their_name() -> None:
    song = read(CHART + CHART[12:])
    assert [c.difficulty for c in song.charts] == ["Hard", "Hard"]
    assert any(w.code == "duplicate-difficulty" for w in song.warnings)
    assert [c.index for c in song.charts] == [0, 1]


@pytest.mark.parametrize(
    ("meter", "expected"), [(b"0", 0), (b"12", 12), (b"8.5", 8), (b"", 1), (b"-5", 1), (b"x", 1), (b"9" * 30, 1)]
)
def test_meters(meter: bytes, expected: int) -> None:
    song = read(CHART.replace(b":9:", b":%s:" % meter))
    assert song.charts[0].meter == expected


def test_songs_survive_pickling() -> None:
    song = read(CHART)
    again = pickle.loads(pickle.dumps(song))
    assert again.charts[0].label == song.charts[0].label
    assert again.charts[0].notes.tick.tolist() == song.charts[0].notes.tick.tolist()


@pytest.mark.parametrize("data", [CHART, SSC])
def test_edit_files_of_either_form(data: bytes) -> None:
    song = read(b"#SONG:pack/song;" + data, "x.edit")
    assert song.charts[0].difficulty == "Edit"
    assert song.format == ("ssc" if data is SSC else "sm")


def test_notes_outside_notedata_are_named() -> None:
    song = read(SSC + b"#NOTES:\n0100\n;", "x.ssc")
    assert len(song.charts) == 1
    assert any(w.code == "chart-skipped" for w in song.warnings)


def test_reading_imports_nothing_slow() -> None:
    code = (
        "import sys; from dancetutor_cli.chart import reader, selection; "
        "print(*sorted(m.split('.')[0] for m in sys.modules))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(run.stdout.split())
    assert "numpy" in loaded
    assert not loaded & {"numba", "scipy", "click", "rich", "yaml", "PIL"}
