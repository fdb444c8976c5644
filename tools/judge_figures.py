"""The figures that `judge_motion.py` measures in a file: limbs, knees, posture, speeds, ground, balance, stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from judge_body import (
    GRAVITY,
    centre_of_mass,
    hull_distance,
    limb_depths,
    middle,
    shoe_in_shin,
    shoe_in_shoe,
    stillest_way,
    unit,
)
from judge_files import Array, Dance
from numpy.typing import NDArray
from scipy.signal import butter, filtfilt

DEEP = 0.01  # metres that limbs and shoes may be in each other: clothes and skin give way
TOUCH, OVER = 0.0015, 0.012  # metres over the pad: a foot touches; what of its sole carries
FLIGHT, REST, CROUCH = 0.15, 0.35, 0.6  # seconds: of a jump in the air; before it; that leave time to crouch
TOGETHER = 0.025  # seconds within which both feet leave
FOLD, GIVE = 0.5, 0.16  # the middle part of a flight; seconds after landing
ARC = 0.12  # seconds of a flight whose fall can be told
EVERY = 60.0  # per second: of forces and balance
GROWN = 0.02  # metres by which the hull under her is grown
CUT = 10.0  # Hz
PLANT, ENDS = 0.07, 2  # seconds of the shortest plant; frames at both of its ends in which a foot rolls
DOWN, STAYS = 0.008, 0.003  # metres over the pad: a point of a planted sole; the lowest of a foot that stays
STAND, EDGE = 1.9, 0.7  # seconds with both feet down that are a stand; at its ends, in which she comes and goes


@dataclass(frozen=True, slots=True)
class Row:
    """One figure. asked : least and most that is good, as the project's page on motion has it; None: not asked

    same : the name of the row of `animate --report` that means the same, or ""; at : second of the file of the worst
    """

    name: str
    value: float
    unit: str
    asked: tuple[float, float] | None = None
    same: str = ""
    at: float = np.nan

    @property
    def is_met(self) -> bool | None:
        """None where nothing is asked or there was nothing to measure."""
        if self.asked is None or np.isnan(self.value):
            return None
        return bool(self.asked[0] <= self.value <= self.asked[1])


def figures(dance: Dance) -> list[Row]:
    """All rows of a dance."""
    mass, low = centre_of_mass(dance), np.column_stack([dance.shoes[s][..., 1].min(axis=1) for s in "lr"])
    standing = low <= TOUCH
    return [
        *_limbs(dance),
        *_knees(dance, standing),
        *_posture(dance),
        *_speeds(dance),
        *_ground(dance, standing, mass),
        Row("below the pad", -1000.0 * float(low.min()), "mm", (-np.inf, 1.0), "penetration"),
        *_stands(dance, low),
    ]


def runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and one past the last index of each run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], flags.astype(int), [0]))))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def _limbs(dance: Dance) -> list[Row]:
    rows = []
    depths = {**limb_depths(dance), "shoe in shoe": shoe_in_shoe(dance), "shoe in shin": shoe_in_shin(dance)}
    for name, depth in depths.items():
        deep, same = depth > DEEP, name if name.split()[0] != "shoe" else ""
        rows.append(Row(f"{name} over 1 cm", 1000.0 * float(deep.sum()) / dance.rate, "ms", (0.0, 0.0), same))
        worst = float(dance.times[depth.argmax()])
        rows.append(Row(f"{name}, deepest", 100.0 * float(depth.max()), "cm", at=worst))
    return rows


def flexion(dance: Dance) -> Array:
    """Bend (f, 2) of the left and right knee, degrees; 0 is straight."""
    out = []
    for side in "lr":
        hip, knee, ankle = (dance.places[f"{side}_{name}"] for name in ("hip", "knee", "talocrural"))
        cosine = np.sum(unit(knee - hip) * unit(ankle - knee), axis=1)
        out.append(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
    return np.column_stack(out)


def _knees(dance: Dance, standing: NDArray[np.bool_]) -> list[Row]:
    knees = flexion(dance)
    both, flights, landed = knees.mean(axis=1), runs(~standing.any(axis=1)), 0
    jumps, crouched = [], []
    for first, end in flights:
        rested, landed = first - landed, end
        if first == 0 or end == len(both) or (end - first) / dance.rate < FLIGHT or rested / dance.rate < REST:
            continue
        quarter, give = int((end - first) * (1.0 - FOLD) / 2), int(GIVE * dance.rate)
        off = float(both[first - 1 : first + 1].min())
        jumps.append((off, both[first + quarter : end - quarter].max(), both[end : end + give].max()))
        last = [np.flatnonzero(standing[:first, side])[-1:] for side in (0, 1)]
        if rested / dance.rate >= CROUCH and all(
            first - int(k[0]) <= TOGETHER * dance.rate if len(k) else False for k in last
        ):
            crouched.append(off)
    off, fold, give = np.median(np.array(jumps).reshape(-1, 3), axis=0) if jumps else (np.nan,) * 3
    return [
        Row("flights", float(len(flights)), ""),
        Row("knees at toe-off", float(off), "degrees", None, "knee flexion at take-off"),
        Row(
            "  off both feet, with time to crouch",
            float(np.median(crouched)) if crouched else np.nan,
            "degrees",
            (15.0, 25.0),
        ),
        Row("knees in the air", float(fold), "degrees", None, "knee flexion in the air"),
        Row("knees after landing", float(give), "degrees", None, "knee flexion after landing"),
        Row("knee flexion, median", float(np.median(knees)), "degrees", (20.0, 35.0), "knee flexion, median"),
        Row("  of the straighter knee", float(np.median(knees.min(axis=1))), "degrees"),
    ]


def _facing(dance: Dance) -> Array:
    """Unit vectors (f, 3) over the ground, square to the line between the hips."""
    across = (dance.places["l_hip"] - dance.places["r_hip"]) * [1.0, 0.0, 1.0]
    return np.cross(unit(across), [0.0, 1.0, 0.0])


def _posture(dance: Dance) -> list[Row]:
    trunk = unit(middle(dance, "shoulder") - middle(dance, "hip"))
    lean = np.degrees(np.arccos(np.clip(trunk[:, 1], -1.0, 1.0)))
    ahead = np.degrees(np.arctan2(np.sum(trunk * _facing(dance), axis=1), trunk[:, 1]))
    return [
        Row("trunk lean, median", float(np.median(lean)), "degrees", None, "trunk lean, median"),
        Row("  ahead", float(np.median(ahead)), "degrees"),
    ]


def _speeds(dance: Dance) -> list[Row]:
    ways = [np.linalg.norm(np.diff(dance.places[f"{s}_radiocarpal"], axis=0), axis=1) for s in "lr"]
    wrists = np.maximum(*ways) * dance.rate
    facing = _facing(dance)
    yaw = np.unwrap(np.arctan2(facing[:, 0], facing[:, 2]))
    turn = np.degrees(np.abs(np.diff(yaw))) * dance.rate
    root = _below(dance.places["HumanoidRoot"], dance.rate)
    jerk = np.linalg.norm(np.diff(root, n=3, axis=0), axis=1) * dance.rate**3
    whip, spin = (float(dance.times[path.argmax()]) for path in (wrists, turn))
    return [
        Row("wrist speed", float(wrists.max()), "m/s", (0.0, 4.0), "wrist speed", whip),
        Row("pelvis turns at", float(turn.max()), "degrees/s", (0.0, 650.0), "pelvis turns at", spin),
        *_head(dance),
        Row("jerk of the root, mean", float(jerk.mean()), "m/s^3", (0.0, 200.0), "jerk of the root"),
    ]


def _head(dance: Dance) -> list[Row]:
    """How far the face is turned from where the chest faces, and how fast it turns on it; at rest both face +Z."""
    face = np.einsum("fji,fj->fi", dance.turns["vt4"], dance.turns["skullbase"][..., 2])
    neck = np.unwrap(np.arctan2(face[:, 0], face[:, 2]))
    far, quick = np.degrees(np.abs((neck + np.pi) % (2.0 * np.pi) - np.pi)), np.degrees(np.abs(np.diff(neck)))
    wrung, whipped = (float(dance.times[path.argmax()]) for path in (far, quick))
    speed = float(quick.max()) * dance.rate
    return [
        Row("head from the chest", float(far.max()), "degrees", (0.0, 80.0), "head from the chest", wrung),
        Row("head turns on the chest at", speed, "degrees/s", None, "head turns on the chest at", whipped),
    ]


def _below(path: Array, rate: float) -> Array:
    """A path (f, 3) without what is quicker than 10 Hz: a second-order Butterworth filter forth and back."""
    return np.asarray(filtfilt(*butter(2, CUT / (rate / 2)), path, axis=0))


def _ground(dance: Dance, standing: NDArray[np.bool_], mass: Array) -> list[Row]:
    fall = []
    for first, end in runs(~standing.any(axis=1)):
        if (end - first) / dance.rate >= ARC and first > 0 and end < len(mass):
            fall.append(-2.0 * np.polyfit(dance.times[first:end] - dance.times[first], mass[first:end, 1], 2)[0])
    slides = plant_slides(dance, standing)
    step = max(1, round(dance.rate / EVERY))
    return [
        Row(
            "gravity in flights, median",
            float(np.median(fall)) if fall else np.nan,
            "m/s^2",
            (0.95 * GRAVITY, 1.05 * GRAVITY),
        ),
        Row("plant slide, longest", 1000.0 * max(slides, default=np.nan), "mm", (0.0, 1.0), "plant slide"),
        *_forces(dance, standing, mass, step),
    ]


def plant_slides(dance: Dance, standing: NDArray[np.bool_]) -> list[float]:
    """How far, in metres, each planted foot moved over the pad, from moment to moment by the stillest place of its
    sole.

    So a foot may roll from heel to toes and turn on any place of its sole, but not all of it go aside. Where places go
    is linear over a sole, so the stillest is in the hull of where those of its points go that are down. Ways are summed
    as vectors: a file's 16-bit turns tremble by some hundredths of a millimetre.
    """
    out = []
    for side, name in enumerate("lr"):
        for first, end in runs(standing[:, side]):
            if (end - first) / dance.rate < PLANT or end - first <= 2 * ENDS + 1:
                continue
            sole = dance.shoes[name][first + ENDS : end - ENDS]
            down = (sole[1:, :, 1] <= DOWN) & (sole[:-1, :, 1] <= DOWN)
            got = np.cumsum(stillest_way(np.diff(sole, axis=0), down), axis=0)
            out.append(float(np.linalg.norm(got, axis=1).max()))
    return out


def _forces(dance: Dance, standing: NDArray[np.bool_], mass: Array, step: int) -> list[Row]:
    """Force on the ground, and where it acts against where she stands, from every `step`-th frame."""
    ground = standing.any(axis=1)[::step]
    firm = ground[1:-1] & ground[2:] & ground[:-2]
    sole = np.concatenate([dance.shoes[s][::step] for s in "lr"], axis=1)[1:-1][firm]
    down = np.repeat(standing[::step][1:-1][firm], [dance.shoes[s].shape[1] for s in "lr"], axis=1)
    shares, push = [], np.zeros(0)
    for path in (mass, _below(mass, dance.rate)):
        some = path[::step]
        pull = np.diff(some, n=2, axis=0)[firm] * (dance.rate / step) ** 2
        lever = some[1:-1][firm, 1] / np.maximum(pull[:, 1] + GRAVITY, 0.3 * GRAVITY)
        point = some[1:-1][firm][:, [0, 2]] - lever[:, None] * pull[:, [0, 2]]
        outside = hull_distance(sole, down & (sole[..., 1] <= OVER), point)
        shares.append(100.0 * float((outside <= GROWN).mean()) if len(outside) else np.nan)
        push = push if len(push) else pull[:, 1] / GRAVITY + 1.0
    return [
        Row("ground force, largest", float(push.max(initial=1.0)), "body weights", (0.0, 3.0), "ground force, largest"),
        Row("ground force, least", float(push.min(initial=1.0)), "body weights", (0.0, 3.0), "ground force, least"),
        Row("balance", shares[0], "%", (98.0, 100.0), "balance"),
        Row("  below 10 Hz", shares[1], "%", None, "balance below 10 Hz"),
    ]


def _stands(dance: Dance, low: Array) -> list[Row]:
    """How far the pelvis goes to and fro where both feet stay down for long, for a file knows no notes."""
    shifts, hips = [], middle(dance, "hip")
    edge = int(EDGE * dance.rate)
    for first, end in runs((low <= STAYS).all(axis=1)):
        if (end - first) / dance.rate >= STAND:
            place = hips[first + edge : end - edge][:, [0, 2]]
            place = place - place.mean(axis=0)
            shifts.append(float(np.ptp(place @ np.linalg.svd(place, full_matrices=False)[2][0])))
    return [
        Row("stands of 1.9 s and more", float(len(shifts)), ""),
        Row(
            "  shift of the weight in them, median",
            100.0 * float(np.median(shifts)) if shifts else np.nan,
            "cm",
            (3.0, np.inf),
        ),
    ]
