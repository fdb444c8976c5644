"""A film of a passage ends with her standing: what follows the passage is neither danced nor shown."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from dance_requests import film_request

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.film.clock import REST, Practice
from dancetutor_cli.film.film import BACKGROUND, Film
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.work.film_dance import quiet_times
from dancetutor_cli.film.work.planning import PreparedFilm, prepare
from dancetutor_cli.film.work.request import FilmRequest, look_up

STREAM = "1000\n0100\n0010\n0001\n0100\n1000\n0010\n0001\n"
RATES = (0.5, 1.25)


@pytest.fixture(scope="module")
def song(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Four steps a second for 16 seconds."""
    path = tmp_path_factory.mktemp("rest") / "stream.sm"
    notes = ",\n".join([STREAM] * 8)
    path.write_text(f"#TITLE:x;\n#OFFSET:0;\n#BPMS:0=120;\n#NOTES:\n dance-single:\n :\n Hard:\n 8:\n :\n{notes};\n")
    return path


def asked(song: Path, section: str | None, practice: Practice, *rates: float) -> FilmRequest:
    look = FilmLook(load_layout("dancer"), (320, 180), "draft", "cpu")
    how = {"rates": rates or (1.0,), "practice": practice}
    return film_request(song, Selection(), look, fps=30, section=section, mute=True, **how)


@pytest.fixture(scope="module")
def prepared(song: Path) -> PreparedFilm:
    wanted = asked(song, "6:8", Practice(rest=REST), *RATES)
    return prepare(wanted, look_up(wanted))


def test_the_last_run_alone_lasts_longer(prepared: PreparedFilm) -> None:
    first, last = prepared.plan.clock.passes
    assert (first.end, first.rest) == (8.0, 0.0)
    assert last.end == pytest.approx(8.0 + 1.25 * REST) and last.until == pytest.approx(8.0)
    assert prepared.plan.clock.seconds == pytest.approx(2 / 0.5 + 2 / 1.25 + REST)


def test_what_follows_the_passage_is_neither_danced_nor_shown(prepared: PreparedFilm) -> None:
    plan = prepared.plan
    for seconds in (plan.notes.second, plan.presses.start):
        assert (seconds == 7.75).any() and not (seconds >= 8.0).any()
    assert (plan.song.steps > 8.0).any(), "the strip shows the whole song"
    for rate, (motion,) in plan.motions.items():
        starts = np.array([contact.start for contact in motion.contacts]) * rate
        assert (np.abs(starts - 7.75) < 0.02).any() and not (starts > 7.99).any()


def test_she_stands_at_the_end_and_smiles(prepared: PreparedFilm) -> None:
    (motion,) = prepared.plan.motions[1.25]
    places, _ = world_transforms(motion.skeleton, motion.rotations, motion.root)
    end = prepared.plan.clock.passes[-1].end / 1.25
    late = (motion.times > end - 0.15) & (motion.times <= end)  # she is home by then
    feet = places[late][:, [motion.skeleton.index(f"{side}_metatarsal") for side in "lr"]]
    assert np.ptp(feet, axis=0).max() < 0.003, "no foot moves"
    hips = places[late][:, 0]
    assert np.linalg.norm(np.diff(hips, axis=0), axis=1).max() * 60 < 0.25
    jaw = motion.rotations[late][-1, motion.skeleton.index("temporomandibular"), 0]
    assert np.degrees(2 * np.arccos(jaw)) > 5.0


def test_at_the_end_of_a_song_she_stays_on_the_pad(song: Path) -> None:
    wanted = asked(song, "14:19", Practice(rest=REST))
    (motion,) = prepare(wanted, look_up(wanted)).plan.motions[1.0]
    assert motion.times[-1] > 18.5
    after = motion.root[motion.times > 16.5][:, [0, 2]]
    assert np.ptp(after, axis=0).max() < 0.2


@pytest.mark.parametrize(("section", "rest"), [(None, REST), ("6:19", REST), ("6:8", 0.0)])
def test_no_rest_is_added_behind_a_song_nor_where_none_is_asked_for(
    song: Path, section: str | None, rest: float
) -> None:
    clock = look_up(asked(song, section, Practice(rest=rest))).clock
    assert clock.passes[-1].rest == 0.0 and quiet_times(clock.passes) == []


def test_the_picture_goes_dark_at_the_end_of_a_film_and_not_of_poses(song: Path, prepared: PreparedFilm) -> None:
    plan = prepared.plan
    assert plan.fade > 0
    last = plan.clock.frames - 1
    light = [plan.light(k) for k in range(plan.clock.frames)]
    assert light[-1] == 0 and (np.diff(light) <= 0).all()
    assert light[last - round(plan.fade * 30) - 1] == 1.0 == light[0]
    film, whole = Film(plan), Film(replace(plan, fade=0.0))
    assert (film.frame(last) == BACKGROUND).all() and not (whole.frame(last) == BACKGROUND).all()
    assert (film.frame(last // 2) == whole.frame(last // 2)).all()
    half = film.frame(last - round(plan.fade * 15)).astype(int) - np.array(BACKGROUND)
    np.testing.assert_allclose(half, (whole.frame(last - round(plan.fade * 15)).astype(int) - BACKGROUND) / 2, atol=1.5)
    alone = asked(song, "6:8", Practice())
    assert prepare(alone, look_up(alone)).plan.fade == 0.0
