"""How much each part of the body moves in a dance: lean, twist, tilt, arms, bounce, and legs that give under landings.

The goals come from captured dancers; the same definitions measure a capture and a bake alike (docs/motion.md).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.motion import Contact, Motion
from dancetutor_cli.dance.quality.figures import Body, Figure
from dancetutor_cli.dance.quality.posture import knee_angles, trunk_lean
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.units import Array

SHORTEST_DANCE = 20.0  # seconds of steps; a shorter dance has no figures
SLOWEST, FASTEST = 1.0, 8.0  # steps a second; slower or faster dances have no goal
HELD = 0.5  # part of the time with a hand on the bar, from which on the figures of trunk and arms have no goal
BOUNCE = (0.7, 5.0)  # Hz, of the height of the pelvis
NEAR, STILL, LIFTED = 0.03, 0.35, 0.03  # metres and metres per second of a ball that is down; metres of a raised ball
BEFORE, RESTS, GIVES = 0.2, 0.085, 0.25  # seconds: up before a landing; down after it; in which a knee gives
ROLL = (0.067, 0.1)  # seconds before and after a landing between which the foot's pitch is compared
FEWEST = 10  # landings; the median of fewer depends on which ones they are
UPPER = ("lean", "lean most", "twist", "wrists")  # figures of trunk and arms
HAND_TURN = 2000.0  # degrees per second that a hand turns on its forearm at most


def liveliness_figures(body: Body, motion: Motion) -> tuple[Figure, ...]:
    """Return figures of the frames from the first step to the last; nan, with no goal missed, if there are too few."""
    skeleton, contacts = motion.skeleton, motion.contacts
    stepping = _stepping(body.times, contacts)
    seconds = float(stepping.sum()) / body.rate
    pace = len({c.start for c in contacts}) / max(seconds, 1.0)
    paced, held = SLOWEST <= pace <= FASTEST, _held(body.times[stepping], motion) >= HELD
    values = _values(body, skeleton, stepping) if seconds >= SHORTEST_DANCE else {}
    rows = (
        ("lean of the trunk, deviation", "lean", "degrees", 2.5, True),
        ("lean of the trunk, 95 of 100", "lean most", "degrees", 25.0, False),
        ("twist of shoulders on hips, deviation", "twist", "degrees", 18.0, False),
        ("tilt of the hips, deviation", "tilt", "degrees", 3.0, True),
        ("wrists in the chest's frame, deviation", "wrists", "cm", 13.5, True),
        ("bounce of the pelvis, deviation", "bounce", "cm", 1.8, True),
        ("give of the knee at landings, median", "give", "degrees", 5.0, True),
        ("roll of the foot at landings, median", "roll", "degrees", 9.0, True),
    )
    live = [
        Figure(n, values.get(key, float("nan")), u, goal if paced and not (held and key in UPPER) else None, low)
        for n, key, u, goal, low in rows
    ]
    return (*live, Figure("hand turns at", hand_turn(motion), "degrees/s", HAND_TURN))


def _stepping(times: Array, contacts: tuple[Contact, ...]) -> NDArray[np.bool_]:
    """Return the times (n,) that are between the first contact and the last one."""
    if not contacts:
        return np.zeros(len(times), dtype=bool)
    first, last = min(c.start for c in contacts), max(c.end for c in contacts)
    return np.asarray((times > first) & (times < last))


def _held(times: Array, motion: Motion) -> float:
    """Return the part of the times at which a hand is on the bar."""
    on = np.zeros(len(times), dtype=bool)
    for grip in motion.grips:
        on |= (times >= grip.start) & (times <= grip.end)
    return float(on.mean()) if len(on) else 0.0


def _values(body: Body, skeleton: Skeleton, stepping: NDArray[np.bool_]) -> dict[str, float]:
    lean = trunk_lean(body, skeleton)[stepping]
    shoulders = _across(body, skeleton, "shoulder")[stepping]
    hips = _across(body, skeleton, "hip")[stepping]
    height = (_joint(body, skeleton, "l_hip") + _joint(body, skeleton, "r_hip"))[stepping, 1] / 2
    gives, rolls = landings(body, skeleton, stepping)
    return {
        "lean": float(lean.std()),
        "lean most": float(np.percentile(lean, 95)),
        "twist": float(np.degrees(_turned(shoulders, hips).std())),
        "tilt": float(np.degrees(np.arcsin(hips[:, 1] / np.linalg.norm(hips, axis=1)).std())),
        "wrists": 100.0
        * float(np.mean([np.linalg.norm(_ways(body, skeleton, s)[stepping].std(axis=0)) for s in "lr"])),
        "bounce": 100.0 * float(_band(height, body.rate).std()),
        "give": float(np.median(gives)) if len(gives) >= FEWEST else float("nan"),
        "roll": float(np.median(rolls)) if len(rolls) >= FEWEST else float("nan"),
    }


def _joint(body: Body, skeleton: Skeleton, name: str) -> Array:
    return body.joints[:, skeleton.index(name)]


def _across(body: Body, skeleton: Skeleton, name: str) -> Array:
    """Return the line from the right joint of a pair to the left one, (f, 3)."""
    return np.asarray(_joint(body, skeleton, f"l_{name}") - _joint(body, skeleton, f"r_{name}"))


def _turned(a: Array, b: Array) -> Array:
    """Return how far (f,) lines a are turned from lines b about the vertical, radians."""
    turn = np.arctan2(a[:, 2], a[:, 0]) - np.arctan2(b[:, 2], b[:, 0])
    return np.asarray((turn + np.pi) % (2 * np.pi) - np.pi)


def _ways(body: Body, skeleton: Skeleton, side: str) -> Array:
    """Return the place (f, 3) of a wrist from the shoulders' middle: to the left, ahead of them, and up; metres."""
    line = _across(body, skeleton, "shoulder")
    left = line / np.linalg.norm(line, axis=1, keepdims=True)
    ahead = np.cross(left, quat.UP)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    middle = (_joint(body, skeleton, "l_shoulder") + _joint(body, skeleton, "r_shoulder")) / 2
    way = _joint(body, skeleton, f"{side}_radiocarpal") - middle
    return np.column_stack(((way * left).sum(axis=1), (way * ahead).sum(axis=1), way[:, 1]))


def _band(x: Array, rate: float) -> Array:
    """Return the part of x (n,) between the two frequencies of `BOUNCE`."""
    spectrum, hertz = np.fft.rfft(x - x.mean()), np.fft.rfftfreq(len(x), 1.0 / rate)
    spectrum[(hertz < BOUNCE[0]) | (hertz > BOUNCE[1])] = 0.0
    return np.fft.irfft(spectrum, len(x))


def landings(body: Body, skeleton: Skeleton, stepping: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Return how far, degrees, the knee bends after each landing during the steps, and how far the foot rolls."""
    knees, gives, rolls = 180.0 - knee_angles(body, skeleton), [], []
    first, last = (int(i) for i in (np.argmax(stepping), len(stepping) - np.argmax(stepping[::-1])))
    before, rests, within, back, on = (round(s * body.rate) for s in (BEFORE, RESTS, GIVES, *ROLL))
    for side, name in enumerate("lr"):
        ball = _joint(body, skeleton, f"{name}_metatarsal")
        high = ball[:, 1] - np.percentile(ball[stepping, 1], 2)
        speed = np.linalg.norm(np.gradient(ball, axis=0), axis=1) * body.rate
        still = (high < NEAR) & (speed < STILL)
        along = ball - _joint(body, skeleton, f"{name}_talocrural")
        pitch = np.degrees(np.arcsin(along[:, 1] / np.linalg.norm(along, axis=1)))
        for k in np.flatnonzero(still[1:] & ~still[:-1]) + 1:
            if first + before < k < last - within - on and still[k : k + rests].all() and (
                high[k - before : k].max() > LIFTED
            ):  # fmt: skip
                gives.append(knees[k : k + within, side].max() - knees[k, side])
                rolls.append(abs(pitch[k + on] - pitch[k - back]))
    return np.array(gives), np.array(rolls)


def hand_turn(motion: Motion) -> float:
    """Return the fastest turn of a hand on its forearm, degrees per second; the times of keys are uneven."""
    steps, fastest = np.diff(motion.times), 0.0
    apart = steps > 1e-6
    for side in "lr":
        q = motion.rotations[:, motion.skeleton.index(f"{side}_radiocarpal")]
        turn = 2.0 * np.arccos(np.clip(np.abs((q[1:] * q[:-1]).sum(axis=1)), 0.0, 1.0))
        fastest = max(fastest, float((np.degrees(turn[apart]) / steps[apart]).max(initial=0.0)))
    return fastest
