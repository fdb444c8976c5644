"""A film's entry in #BGCHANGES: beside what is there, byte for byte out again, and where it begins."""

from __future__ import annotations

import difflib
import itertools
from pathlib import Path

import pytest
from markers_songs import SM_CHART, song_of

from dancetutor_cli.chart.edits import apply, unified_diff
from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.markers.background import check_film_name, entry, insert_entry, remove_entries
from dancetutor_cli.run.errors import FileError, UsageError

FILM = "song-hard.dancetutor.mp4"
ALONE = ",99999=-nosongbg-=1.000=0=0=0"
NOTES = SM_CHART + b"\n0000\n1000\n0100\n0010\n;\n"
VALUES = [
    None, b"", b" ", b"\n", b"0.000=a.avi=1.000=1=1=0", b"0.000=a.avi=1.000=1=1=0,", b"0=a.avi,\n4=b.png=1=0=0=1,\n",
    b"0=a.avi // the intro\n", b"0=a.avi,99999=-nosongbg-=1.000=0=0=0 // don't automatically add -songbackground-\n",
    b"2=caf\xe9\\,bar.mpg=1", b"0=not.dancetutor=1=0=0=0", b"0=dancetutor.mp4=1=0",
]  # fmt: skip


def sm(value: bytes | None, eol: bytes = b"\n", end: bytes = b";\n", offset: str = "0.000") -> Song:
    tag = b"" if value is None else b"#BGCHANGES:" + value + end
    head = f"#TITLE:T;\n#OFFSET:{offset};\n#BPMS:0=120;\n".encode()
    return song_of((head + tag + NOTES).replace(b"\n", eol))


@pytest.mark.parametrize(("value", "eol", "end"), list(itertools.product(VALUES, (b"\n", b"\r\n"), (b";\n", b"\n"))))
def test_it_stands_beside_what_is_there_and_comes_out_byte_for_byte(
    value: bytes | None, eol: bytes, end: bytes
) -> None:
    song = sm(value, eol, end)
    new = parse(apply(song.data, insert_entry(song, FILM).splices), song.path)
    old_value, new_value = song.tags.get("BGCHANGES", ""), new.tags["BGCHANGES"]
    alone = "" if old_value.strip() else ALONE  # others' entries say themselves what comes after the last note
    assert new_value.startswith(old_value.strip()) and new_value.endswith(entry(song, FILM).decode() + alone)
    assert {**new.tags, "BGCHANGES": ""} == {**song.tags, "BGCHANGES": ""}
    assert len(new.charts) == 1 and len(new.charts[0].notes) == 3
    assert apply(new.data, remove_entries(new)) == song.data
    assert remove_entries(song) == []


def test_it_comes_out_too_after_an_editor_has_put_more_behind_it() -> None:
    song = sm(b"0=a.avi=1")
    data = apply(song.data, insert_entry(song, FILM).splices).replace(b"NoLoop====", b"NoLoop====,8=b.avi=1")
    assert apply(data, remove_entries(song_of(data))) == sm(b"0=a.avi=1,8=b.avi=1").data
    song = sm(b"")
    data = apply(song.data, insert_entry(song, FILM).splices).replace(ALONE.encode(), ALONE.encode() + b",8=b.avi=1")
    assert apply(data, remove_entries(song_of(data))) == sm(b"8=b.avi=1").data


FILM_B = b"8=song-easy.dancetutor.mp4=1.000=0=0=0=StretchNoLoop===="


@pytest.mark.parametrize(
    ("before", "after"), [(b"", b""), (b"0=a.avi=1", b""), (b"", b"16=b.avi=1"), (b"0=a.avi=1", b"16=b.avi=1")]
)
def test_two_films_side_by_side_come_out_with_the_commas_between_them(before: bytes, after: bytes) -> None:
    """The user has copied an entry, and changed its beat and its file."""
    song = sm(None)
    films = entry(song, FILM) + b"," + FILM_B
    joined = sm(b",".join(part for part in (before, films, after) if part))
    assert apply(joined.data, remove_entries(joined)) == sm(b",".join(part for part in (before, after) if part)).data


def test_the_diff_of_lines_that_are_removed_from_the_middle_is_short() -> None:
    old = b"".join(b"line %d\n" % k for k in range(40))
    new = old.replace(b"line 10\nline 11\n", b"").replace(b"line 9\n", b"other\n")
    diff = list(unified_diff("a.sm", old, new))
    assert diff == list(
        difflib.unified_diff(old.decode().splitlines(), new.decode().splitlines(), "a.sm", "a.sm", lineterm="")
    )


@pytest.mark.parametrize(("offset", "beat"), [("0.000", "0.000"), ("-0.500", "-1.000"), ("0.250", "0.500")])
def test_the_film_begins_with_the_music(offset: str, beat: str) -> None:
    """#OFFSET:-0.5 has beat 0 at half a second: at 120 BPM the music begins a beat before it."""
    assert entry(sm(None, offset=offset), FILM) == f"{beat}={FILM}=1.000=0=0=0=StretchNoLoop====".encode()


def test_entries_after_it_are_reported() -> None:
    assert insert_entry(sm(b"-5=a.avi=1,12.5=b.avi=1,7=c.avi=1"), FILM).later == (12.5, 7.0)
    assert insert_entry(sm(b"-5=a.avi=1,\n99999=-nosongbg-=1.000=0=0=0"), FILM).later == ()


def test_of_several_tags_the_last_counts_and_charts_are_left_alone() -> None:
    first, last = b"#BGCHANGES:1=a.avi;\n", b"#BGCHANGES:2=b.avi;\n"
    song = song_of(b"#TITLE:T;\n#BPMS:0=120;\n" + first + last + NOTES)
    new = apply(song.data, insert_entry(song, FILM).splices)
    assert first in new and b"2=b.avi,0.000=" in new
    assert apply(new, remove_entries(song_of(new))) == song.data


def test_a_file_without_a_line_for_it_is_refused() -> None:
    with pytest.raises(FileError, match="put #BGCHANGES:; before it"):
        insert_entry(parse(b"#TITLE:T;#BPMS:0=120;" + NOTES.replace(b"\n", b""), Path("x.sm")), FILM)


@pytest.mark.parametrize(
    "name", ["film.mp4", "a,b.dancetutor.mp4", "a=b.dancetutor.mp4", "a\\b.dancetutor.mp4", "a;.dancetutor.mp4"]
)
def test_names_that_would_not_be_known_again_are_refused(name: str) -> None:
    with pytest.raises(UsageError, match="--into-file"):
        check_film_name(name)
    check_film_name("Größe (x) #1".replace("#", "") + ".dancetutor.mp4")
