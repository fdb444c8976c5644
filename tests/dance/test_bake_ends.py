"""The ends of a film's cut: she stands until the first step that is counted, and comes to rest after the last one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from dance_requests import apart

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.ends import CROSSING
from dancetutor_cli.dance.footwork.footfalls import stand_at
from dancetutor_cli.dance.motion import Cut, Motion
from dancetutor_cli.dance.performance import Performance, perform, solve
from dancetutor_cli.dance.quality.figures import body_of
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.film.clock import REST
from dancetutor_cli.run.reading import charts_path

HEAD = "#TITLE:x;\n#OFFSET:0;\n#BPMS:0=120;\n#NOTES:\n dance-single:\n :\n Hard:\n 8:\n :\n"
# A measure lasts two seconds, so its first row is at an even one.
MEASURES = {
    "a stream": "1000\n0100\n0010\n0001\n0100\n1000\n0010\n0001\n",
    "jumps": "1001\n0000\n0110\n0000\n1001\n0000\n0110\n0000\n",
    "holds over both ends": "0100\n0010\n0001\n2000\n0001\n0010\n3100\n0001\n",
}
START, END = 4.0, 8.0  # of the passage
COUNTED = Cut(START - 2.0, END, steps_from=START)
RESTS = Cut(START, END + REST, steps_until=END)
FILM = Cut(START - 2.0, END + REST, START, END)
WHOLE = Cut(-np.inf, np.inf)


@pytest.fixture(scope="module", params=list(MEASURES))
def performance(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Performance:
    path = tmp_path_factory.mktemp("ends") / "x.sm"
    path.write_text(HEAD + ",\n".join([MEASURES[request.param]] * 6) + ";\n")
    wanted = DanceRequest(path, Selection())
    return perform(solve(wanted), wanted)


@pytest.fixture(scope="module")
def shown(performance: Performance) -> dict[Cut, Motion]:
    """Each cut, and the whole dance."""
    cuts = {cut: performance.bake(replace(cut, walks_off=False))[0].motion for cut in (COUNTED, RESTS, FILM)}
    return {**cuts, WHOLE: performance.bake()[0].motion}


def steps(motion: Motion) -> list[tuple[float, int, int]]:
    return [(contact.start, contact.limb, contact.column) for contact in motion.contacts]


def feet_moved(motion: Motion, start: float, end: float) -> float:
    """How far any point of the soles is from where it was in these seconds, metres."""
    body = body_of(motion)
    return float(np.ptp(body.soles[(body.times > start) & (body.times < end)], axis=0).max())


@pytest.mark.parametrize("cut", [COUNTED, RESTS, FILM])
def test_it_has_the_steps_of_the_passage_and_no_other(shown: dict[Cut, Motion], cut: Cut) -> None:
    motion = shown[cut]
    last = END - 1e-6 if cut.end > END else END  # a cut that does not rest has all to its end
    assert steps(motion) == [one for one in steps(shown[WHOLE]) if START - 1e-6 <= one[0] <= last]
    assert abs(motion.times[0] - cut.start) < 0.02 and abs(motion.times[-1] - cut.end) < 0.02
    assert (np.diff(motion.times) > 0).all()
    assert (np.sum(motion.rotations[1:] * motion.rotations[:-1], axis=2) > 0).all(), "no turn jumps to its negative"


@pytest.mark.parametrize("cut", [COUNTED, RESTS, FILM])
def test_its_contacts_are_exact(shown: dict[Cut, Motion], cut: Cut) -> None:
    measured = report(shown[cut])
    assert len(measured.contact_errors) > 5 and np.abs(measured.contact_errors).max() < 1.0  # millimetres
    assert measured["contacts missed"].value == 0.0


def test_no_foot_moves_before_it_lifts_for_the_first_step(performance: Performance, shown: dict[Cut, Motion]) -> None:
    tracks = performance.dancers[0].plan.feet
    lifts = min(move.lift for track in tracks for move in track.moves if move.land >= START - 1e-6)
    assert lifts > START - 1.2
    until = min(lifts, START) - 0.3  # heels may rise for it
    assert feet_moved(shown[COUNTED], COUNTED.start, until) < 0.003 < feet_moved(shown[WHOLE], COUNTED.start, until)


@pytest.mark.parametrize("cut", [RESTS, FILM])
def test_in_the_end_she_stands_at_home(shown: dict[Cut, Motion], cut: Cut) -> None:
    """On the pad's middle, feet side by side, both on the ground, and no limb has met another one on the way."""
    motion = shown[cut]
    body, skeleton = body_of(motion), motion.skeleton
    assert body.is_standing[-1].all()
    assert feet_moved(motion, cut.end - 0.15, cut.end) < 0.003
    assert feet_moved(shown[WHOLE], cut.end - 0.3, cut.end) > 0.01
    home = stand_at(np.zeros(2), 0.0, default_settings())
    balls = body.joints[-1][[skeleton.index(f"{side}_metatarsal") for side in "lr"]][:, [0, 2]]
    np.testing.assert_allclose(balls, home.balls, atol=0.004)
    across = body.joints[-1, skeleton.index("l_hip")] - body.joints[-1, skeleton.index("r_hip")]
    assert abs(np.degrees(np.arctan2(across[2], across[0]))) < 12.0, "facing the screen"
    measured = report(motion)
    for name in ("plant slide", "penetration", "limb in torso", "leg in leg", "frames past joint limits", "balance"):
        assert measured[name].is_met is not False, f"{name}: {measured[name].value}"


def test_where_there_is_no_time_she_stays(performance: Performance, shown: dict[Cut, Motion]) -> None:
    (one,) = performance.bake(Cut(START, END + 0.9, steps_until=END, walks_off=False))
    assert feet_moved(one.motion, END + 0.35, END + 0.9) < 0.003


def test_a_second_from_its_ends_it_is_the_whole_dance(shown: dict[Cut, Motion]) -> None:
    assert apart(shown[FILM], shown[WHOLE], START + CROSSING, END - CROSSING) == 0.0
    assert apart(shown[FILM], shown[WHOLE], START - 1.5, START - 0.5) > 0.01, "and before it is not"


def test_where_nobody_has_stepped_yet_the_dance_itself_begins(
    performance: Performance, shown: dict[Cut, Motion]
) -> None:
    whole = shown[WHOLE]
    assert whole.contacts[0].start == 0.0
    early = Cut(float(whole.times[0]), END, steps_from=0.0)
    (one,) = performance.bake(replace(early, walks_off=False))
    assert apart(one.motion, whole, early.start, END) == 0.0


@pytest.mark.parametrize("end", [17.81, 27.54])
def test_a_foot_that_was_on_its_way_does_not_slide_back(end: float) -> None:
    wanted = DanceRequest(charts_path() / "two_left_feet" / "two_left_feet.ssc", Selection(index=2))
    (one,) = perform(solve(wanted), wanted).bake(Cut(end - 4.0, end + 1.5, steps_until=end, walks_off=False))
    assert report(one.motion)["plant slide"].is_met, report(one.motion)["plant slide"]


@pytest.mark.parametrize(("offset", "end"), [("0", 0.7), ("2", 0.5)])
def test_a_film_that_ends_before_the_first_step_or_begins_before_the_music(
    tmp_path: Path, offset: str, end: float
) -> None:
    """No foot has moved yet at the end of the first one; the first note of the second one is at -2 s."""
    path = tmp_path / "early.sm"
    path.write_text(f"#TITLE:T;#OFFSET:{offset};#BPMS:0=120;#NOTES:dance-single::Easy:3::0000\n0000\n1000\n0001,1000;")
    wanted = DanceRequest(path, Selection())
    performance = perform(solve(wanted), wanted)
    (film,) = performance.bake(Cut(0.0, end + 1.5, steps_until=end, walks_off=False))
    (whole,) = performance.bake()
    assert np.isfinite(film.motion.rotations).all() and np.isfinite(whole.motion.rotations).all()
    assert len(whole.motion.contacts) == 3


def test_where_nobody_is_seen_to_walk_the_dance_is_the_same(tmp_path: Path) -> None:
    """As in a page: the dancer stands on the pad before the first step and after the last, and dances as always."""
    path = tmp_path / "x.sm"
    path.write_text(HEAD + ",\n".join(["0000\n"] * 5 + [MEASURES["a stream"]] * 4 + ["0000\n"] * 4) + ";\n")
    wanted = DanceRequest(path, Selection())
    performance = perform(solve(wanted), wanted)
    (whole,), (first, last) = performance.bake(), (10.0, 17.75)
    assert max(walk.end for walk in performance.dancers[0].plan.walks if walk.end <= first) > 0.0, "she walks on"
    (stays,) = performance.bake(Cut(*performance.span, walks_on=False, walks_off=False))
    far = np.abs(stays.motion.root[:, [0, 2]]).max(axis=1)
    assert far.max() < 0.45 < np.abs(whole.motion.root[:, [0, 2]]).max()
    walks = performance.dancers[0].plan.walks
    begin = max(walk.end for walk in walks if walk.end <= first)
    end = min(walk.start for walk in walks if walk.start >= last)
    assert apart(stays.motion, whole.motion, begin + CROSSING + 0.01, end - CROSSING) == 0.0
