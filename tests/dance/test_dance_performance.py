"""One performance of a chart: every section of it, and every film, shows the same dance."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from dance_requests import film_request

from dancetutor_cli.__main__ import main
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance import pieces
from dancetutor_cli.dance.motion import Cut, Motion
from dancetutor_cli.dance.performance import Performance, perform, solve
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.work.film_dance import FilmDance, bake_film_dance
from dancetutor_cli.film.work.request import FilmRequest, look_up
from dancetutor_cli.formats.npz import read_npz
from dancetutor_cli.run.errors import UsageError
from dancetutor_cli.run.reading import charts_path

DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"
HEAD = "#TITLE:x;\n#OFFSET:0;\n#BPMS:0=120;\n"
COUPLE = HEAD + "#NOTES:dance-couple::Hard:9::\n10000001\n01000010\n00010100\n00101000\n;\n"


@pytest.fixture
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pieces of some 6 seconds, so that a short song has several."""
    monkeypatch.setattr(pieces, "LENGTH", 6.0)
    monkeypatch.setattr(pieces, "LONGEST", 9.0)
    monkeypatch.setattr(pieces, "WITHIN", 2.0)


def of_a_stream(folder: Path, **how: object) -> Performance:
    """Three steps in four beats of 120 a minute, for 16 seconds."""
    path = folder / "stream.sm"
    path.write_text(HEAD + "#NOTES:dance-single::Hard:8::\n" + ",\n".join(["1000\n0100\n0001\n0000\n"] * 8) + ";\n")
    request = DanceRequest(path, Selection(), fps=30.0, **how)  # type: ignore[arg-type]
    return perform(solve(request), request)


def same_keys(part: Motion, whole: Motion, start: float, end: float) -> None:
    """A part has the keys of the whole between two seconds, and its own nowhere."""
    keep = (whole.times >= start - 1e-9) & (whole.times <= end + 1e-9)
    np.testing.assert_array_equal(part.times, whole.times[keep])
    np.testing.assert_array_equal(part.root, whole.root[keep])
    np.testing.assert_array_equal(np.abs(part.rotations), np.abs(whole.rotations[keep]))
    assert part.contacts == tuple(one for one in whole.contacts if start <= one.start <= end)


@pytest.mark.parametrize("how", [{}, {"bar": True}, {"style": "lazy"}], ids=["alone", "bar", "style"])
def test_every_cut_shows_the_whole_dance(short: None, tmp_path: Path, how: dict[str, object]) -> None:
    performance = of_a_stream(tmp_path, **how)
    (whole,), (start, end) = performance.bake(), performance.span
    ends = pieces.piece_ends(performance.dancers[0].plan, start, end)
    assert len(ends) > 3
    for first, last in ((4.3, 5.7), (ends[1] - 1.0, ends[1] + 1.0), (ends[2] - 0.4, ends[2] - 0.1), (end - 2.0, end)):
        (part,) = performance.bake(Cut(first, last))
        same_keys(part.motion, whole.motion, first, last)


def test_a_cut_beyond_the_dance_has_no_keys_there(short: None, tmp_path: Path) -> None:
    performance = of_a_stream(tmp_path)
    _, end = performance.span
    (part,) = performance.bake(Cut(end - 2.0, end + 60.0))
    assert end - 1 / 30 <= part.motion.times[-1] <= end and part.motion.times[0] >= end - 2.0


def animate(folder: Path, song: Path, *options: str) -> Path:
    path = folder / "dance.npz"
    with pytest.raises(SystemExit) as stop:
        main(["animate", str(song), "-o", str(path), *options])
    assert stop.value.code == 0
    return path


def film(song: Path, *motions: Path, **more: object) -> FilmRequest:
    look = FilmLook(load_layout("dancer"), (64, 64), "draft", "cpu")
    return film_request(song, more.pop("selection", Selection()), look, mute=True, motions=motions, **more)  # type: ignore[arg-type]


def danced(wanted: FilmRequest) -> FilmDance:
    return bake_film_dance(wanted, look_up(wanted))


def assert_equal(one: Motion, other: Motion) -> None:
    for name in ("times", "rotations", "root"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    assert one.contacts == other.contacts and one.skeleton.names == other.skeleton.names


def test_a_film_draws_what_animate_has_baked(tmp_path: Path) -> None:
    """And not what it would bake itself: the file's dancer walks on heels."""
    path = animate(tmp_path, DEMO, "--index", "3", "--section", "0:6", "--gait", "heels")
    dance = danced(film(DEMO, path, selection=Selection(index=3), section="1:5"))
    (motion,) = dance.motions[1.0]
    assert_equal(motion, read_npz(path))
    (own,) = danced(film(DEMO, selection=Selection(index=3), section="1:5")).motions[1.0]
    assert len(own.times) != len(motion.times)


def test_of_two_it_draws_both_where_their_files_have_them(tmp_path: Path) -> None:
    song = tmp_path / "two.sm"
    song.write_text(COUPLE)
    animate(tmp_path, song)
    paths = [tmp_path / f"dance-p{player}.npz" for player in (1, 2)]
    dance = danced(film(song, *paths))
    for motion, path in zip(dance.motions[1.0], paths, strict=True):
        assert_equal(motion, read_npz(path))
    with pytest.raises(UsageError, match="for 2 dancers, so give --dance 2 times"):
        danced(film(song, paths[0]))


def test_a_file_is_of_music_at_its_own_speed(tmp_path: Path) -> None:
    song = tmp_path / "two.sm"
    song.write_text(COUPLE)
    with pytest.raises(UsageError, match="at normal speed"):
        danced(film(song, tmp_path / "x.npz", rates=(0.5,), selection=Selection(player=1)))


@pytest.mark.parametrize("whose", [1, 2])
def test_mines_under_feet_are_seen_in_files_of_two_as_in_the_dance(tmp_path: Path, whose: int) -> None:
    mined = ["0001", *["0000"] * 23, "0002", *["0000"] * 23, "1000", "M0M0", *["0000"] * 38, "0003", *["0000"] * 7]
    clear = [row.replace("M", "0") for row in mined]
    rows = "\n".join(map("".join, zip(*((mined, clear) if whose == 1 else (clear, mined)), strict=True)))
    song = tmp_path / "two.sm"
    song.write_text(f"#TITLE:T;\n#OFFSET:0;\n#BPMS:0=200;\n#NOTES:dance-couple::Hard:9::\n{rows}\n;\n")
    animate(tmp_path, song)
    own, given = (danced(film(song, *(tmp_path / f"dance-p{n}.npz" for n in files))) for files in ((), (1, 2)))
    assert len(own.on_mines) == 1 and given.on_mines == own.on_mines


def test_a_push_beside_a_seam_is_reported_once(short: None, tmp_path: Path) -> None:
    """Both pieces have it, and see not as much of what follows."""
    performance = of_a_stream(tmp_path)
    seam = pieces.piece_ends(performance.dancers[0].plan, *performance.span)[2]
    pushed = of_a_stream(tmp_path, style="neutral", push=(f"{seam - 0.275}:300:left",))
    (part,) = pushed.bake(Cut(seam - 2.0, seam + 2.0))
    assert len(part.motion.notes) == 1, part.motion.notes
