"""A film at another rate: she dances to the music as it is heard, so she falls as fast as everybody falls."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from dance_requests import baked, film_request

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.motion import sample
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig.body import centre_of_mass, joint_matrices, world_transforms
from dancetutor_cli.film.film import Film
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.work.planning import PreparedFilm, prepare
from dancetutor_cli.film.work.request import look_up

RATES = (0.5, 1.0)
JUMPS = "1001\n0000\n0110\n0000\n1001\n0000\n0110\n0000\n"
FPS = 60


@pytest.fixture(scope="module")
def song(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two jumps each second."""
    path = tmp_path_factory.mktemp("rate") / "jumps.sm"
    notes = ",\n".join(["0000\n", *[JUMPS] * 4])
    path.write_text(f"#TITLE:x;\n#OFFSET:0;\n#BPMS:0=120;\n#NOTES:\n dance-single:\n :\n Hard:\n 8:\n :\n{notes};\n")
    return path


@pytest.fixture(scope="module")
def prepared(song: Path) -> PreparedFilm:
    look = FilmLook(load_layout("dancer"), (64, 64), "draft", "cpu")
    request = film_request(song, Selection(), look, fps=FPS, section="3:7", mute=True, rates=RATES)
    return prepare(request, look_up(request))


def test_each_run_is_baked_as_animate_bakes_it(song: Path, prepared: PreparedFilm) -> None:
    film, clock = Film(prepared.plan), prepared.plan.clock
    for run, rate in enumerate(RATES):
        motion = baked(DanceRequest(song, Selection(), "thesis", rates=(rate,)), "3:7", rate)
        frames = [k for k in range(clock.frames) if clock.at(k)[1] == run]
        heard = np.array([clock.at(k)[0] for k in frames]) / rate
        expected = joint_matrices(load_dancer().skeleton, *sample(motion, heard))
        shown = np.array([film._joints.at(k) for k in frames])
        np.testing.assert_allclose(shown, expected, atol=1e-9)


def test_she_falls_in_the_film_as_everybody_does(prepared: PreparedFilm) -> None:
    clock = prepared.plan.clock
    for run, rate in enumerate(RATES):
        (motion,) = prepared.plan.motions[rate]
        moments = [clock.moment(k) for k in range(clock.frames) if clock.at(k)[1] == run]
        heard = np.array([moment.heard_second for moment in moments])
        rotations, root = sample(motion, heard)
        mass = centre_of_mass(motion.skeleton, *world_transforms(motion.skeleton, rotations, root))
        falls = np.diff(mass[:, 1], n=2) * FPS**2  # in seconds of the film
        assert np.median(np.sort(falls)[:20]) == pytest.approx(-9.81, rel=0.03)


def test_a_push_comes_at_its_second_of_the_song_as_in_animate(song: Path) -> None:
    look = FilmLook(load_layout("dancer"), (64, 64), "draft", "cpu")
    how = {"rates": (0.5,), "style": "neutral", "push": ("5:300:left",)}
    request = film_request(song, Selection(), look, fps=FPS, section="4:6", mute=True, **how)
    film = prepare(request, look_up(request))
    assert any(note.startswith("at rate 0.5, pushed at 10.000 s with 300 N") for note in film.warnings)
    animated = baked(DanceRequest(song, Selection(), "thesis", **how), "4:6", 0.5)
    np.testing.assert_array_equal(film.plan.motions[0.5][0].root, animated.root)
