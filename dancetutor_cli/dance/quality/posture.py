"""Poses that are possible and look right: joint limits, limbs in limbs, smoothness, stance and jumps."""

from __future__ import annotations

from itertools import pairwise, product

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.motion import Contact
from dancetutor_cli.dance.quality.figures import Body, Figure
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.limbs import ANKLE, KNEE, THIGH, Capsule, arm_in_torso, depth, segment_distance
from dancetutor_cli.dance.rig.skeleton import Skeleton, excess
from dancetutor_cli.dance.smoothing import low_pass
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import StepKind, runs

# Possible poses: joints within their limits, parts of the body not inside each other.

PAST = 1.0  # degrees past a limit from which on a frame counts
FOOT_RADIUS = 0.038
HAIR_ALLOWED = 0.010
BACK_RADIUS = 0.105  # metres, of the dancer's back about her spine


def shape_figures(body: Body, skeleton: Skeleton) -> tuple[tuple[Figure, ...], tuple[str, ...]]:
    """Return figures, and notes on the joints that are past their limits, and how far."""
    past = excess(skeleton, body.rotations)
    beyond = {name: degrees for name, degrees in past.items() if (degrees > PAST).any()}
    frames = np.zeros(len(body.times), dtype=bool)
    for degrees in beyond.values():
        frames |= degrees > PAST
    notes = tuple(
        f"{_named(name)} is past its limit in {int((d > PAST).sum())} frames, by {d.max():.1f} degrees at most, "
        f"first at {body.times[np.argmax(d > PAST)]:.2f} s"
        for name, d in beyond.items()
    )
    figures = (
        Figure("frames past joint limits", float(frames.sum()), "", 0.0),
        Figure("limb in torso", 100.0 * float((limb_depth(body, skeleton) > 0.005).mean()), "% of frames", 0.1),
        Figure("foot in foot", float((feet_depth(body) > 0.0).sum()), "frames", 0.0),
        Figure("hair in back", float((hair_depth(body, skeleton) > HAIR_ALLOWED).sum()), "frames", 0.0),
    )
    return figures, notes


# Joints in plain words, those of a side without it.
_PLAIN = {
    "hip": "hip", "knee": "knee", "talocrural": "ankle", "metatarsal": "toe joint", "sternoclavicular": "collarbone",
    "shoulder": "shoulder", "elbow": "elbow", "radiocarpal": "wrist", "eyeball_joint": "eye", "vl5": "lower back",
    "vt10": "middle back", "vt4": "upper back", "vc4": "neck", "skullbase": "head",
}  # fmt: skip


def _named(joint: str) -> str:
    """Return a joint in plain words, with its H-Anim name: "right ankle (r_talocrural)"."""
    side = {"l_": "left ", "r_": "right "}.get(joint[:2], "")
    plain = _PLAIN.get(joint[2:] if side else joint)
    return f"{side}{plain} ({joint})" if plain else joint


def limb_depth(body: Body, skeleton: Skeleton) -> Array:
    """Return how deep (f,) a forearm or hand is inside the torso, metres; negative outside."""
    return np.maximum(*(arm_in_torso(skeleton, body.joints, side) for side in "lr"))


def feet_depth(body: Body) -> Array:
    """Return how deep (f,) one shoe, a capsule from heel to toes, is inside the other, metres; negative if apart."""
    ends = []
    for side in (0, 1):
        soles = body.soles[:, side]
        heel, toe = soles[:, :2].mean(axis=1), soles[:, 4:].mean(axis=1)
        along = (toe - heel) / np.linalg.norm(toe - heel, axis=1, keepdims=True)
        ends.append((heel + FOOT_RADIUS * along, toe - FOOT_RADIUS * along))
    return np.asarray(2 * FOOT_RADIUS - segment_distance(*ends[0], *ends[1]))


def hair_depth(body: Body, skeleton: Skeleton) -> Array:
    """Return how deep (f,) a joint of the braid is inside the back, metres; negative outside or without a braid."""
    out = np.full(len(body.times), -np.inf)
    low, high = (body.joints[:, skeleton.index(n)] for n in ("vt10", "vc4"))
    along = high - low
    for name in (n for n in skeleton.names if n in ("braid2", "braid3", "braid4")):
        p = body.joints[:, skeleton.index(name)]
        s = np.clip(np.sum((p - low) * along, axis=1) / np.sum(along * along, axis=1), 0.0, 1.0)
        out = np.maximum(out, BACK_RADIUS - np.linalg.norm(p - low - s[:, None] * along, axis=1))
    return out


# Limbs through limbs: legs and arms as tapered capsules, close to their visible shape.

DEEP = 0.01  # metres; up to this depth, clothes and skin give way
LEG = (("hip", THIGH), ("knee", KNEE), ("talocrural", ANKLE))  # joints and radii, metres
ARM = (("shoulder", 0.045), ("elbow", 0.036), ("radiocarpal", 0.026))
HAND = 0.10  # metres of the hand beyond the wrist


def capsule_figures(body: Body, skeleton: Skeleton) -> tuple[tuple[Figure, ...], tuple[str, ...]]:
    """Return the frames in which a limb is deeper than 1 cm in another one, and notes on the worst frames."""
    figures, notes = [], []
    for name, deep in limb_depths(body, skeleton).items():
        figures.append(Figure(name, float((deep > DEEP).sum()), "frames", 0.0))
        if (deep > DEEP).any():
            worst = int(np.argmax(deep))
            share = 100.0 * float((deep > DEEP).mean())
            notes.append(
                f"{name} deeper than {100 * DEEP:g} cm in {share:.2f} % of frames, {100 * deep[worst]:.1f} cm at "
                f"most, at {body.times[worst]:.2f} s"
            )
    return tuple(figures), tuple(notes)


def limb_depths(body: Body, skeleton: Skeleton) -> dict[str, Array]:
    """Return how deep (f,) both legs, both arms, and any arm and leg are in each other, metres; below 0 if apart."""
    legs, arms = ([_limb(body, skeleton, side, chain) for side in "lr"] for chain in (LEG, ARM))
    return {
        "leg in leg": depth(legs[0], legs[1]),
        "arm in arm": depth(arms[0], arms[1]),
        "arm in leg": np.maximum.reduce([depth(arm[1:], leg) for arm, leg in product(arms, legs)]),
    }


def _limb(body: Body, skeleton: Skeleton, side: str, chain: tuple[tuple[str, float], ...]) -> list[Capsule]:
    """Return the capsules of a limb from its root outward; the last one of an arm reaches to the hand's end."""
    places = [body.joints[:, skeleton.index(f"{side}_{name}")] for name, _ in chain]
    radii = [radius for _, radius in chain]
    if chain is ARM:
        along = places[-1] - places[-2]
        places[-1] = places[-1] + HAND * along / np.linalg.norm(along, axis=1, keepdims=True)
    return [(places[k], places[k + 1], radii[k], radii[k + 1]) for k in range(len(chain) - 1)]


# Smoothness: knees that do not snap, and bodies that do not jerk.

FAST_JUMPS = 4.0  # jumps per second; faster ones are exempt from the goal of the jerk
AROUND_JUMPS = 0.1  # seconds before and after a run of jumps that belong to it
STRAIGHT = 165.0  # degrees from which a knee may pop


def knee_angles(body: Body, skeleton: Skeleton) -> Array:
    """Return the inner angle (f, 2) of the left and right knee, degrees; 180 is straight."""
    out = []
    for side in "lr":
        hip, knee, ankle = (body.joints[:, skeleton.index(f"{side}_{n}")] for n in ("hip", "knee", "talocrural"))
        a, b = hip - knee, ankle - knee
        cosine = np.sum(a * b, axis=1) / (np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1))
        out.append(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
    return np.stack(out, axis=1)


def smoothness_figures(
    body: Body, skeleton: Skeleton, contacts: tuple[Contact, ...] = ()
) -> tuple[tuple[Figure, ...], tuple[str, ...]]:
    """Return the knee angle and its acceleration where nearly straight; the mean jerk of root, hands and head; notes.

    Runs of jumps faster than 4 per second are exempt from the jerk, with a note.
    """
    knees = knee_angles(body, skeleton)
    smooth = low_pass(knees, body.rate)
    acceleration = np.abs(np.diff(smooth, n=2, axis=0)) * body.rate**2
    straight = acceleration[smooth[1:-1] > STRAIGHT]
    pop = float(np.percentile(straight, 99)) if len(straight) else float("nan")
    parts = {
        "root": body.joints[:, 0],
        "left hand": body.joints[:, skeleton.index("l_radiocarpal")],
        "right hand": body.joints[:, skeleton.index("r_radiocarpal")],
        "head": body.head,
    }
    exempt = in_fast_jumps(body.times[:-3] + 1.5 / body.rate, contacts)
    sizes = {name: jerk(path, body.rate) for name, path in parts.items()}
    jerks = tuple(
        Figure(f"jerk of the {name}", float(size[~exempt].mean()) if not exempt.all() else float("nan"), "m/s³", 200.0)
        for name, size in sizes.items()
    )
    notes = (
        f"{exempt.sum() / body.rate:.1f} s of jumps faster than {FAST_JUMPS:g} per second are exempt from the jerk; "
        f"the root's is {sizes['root'][exempt].mean():.0f} m/s³ there",
    ) if exempt.any() else ()  # fmt: skip
    figures = (
        Figure("knee angle", float(knees.max()), "degrees", 176.0),
        Figure("knee acceleration near straight", pop, "degrees/s²", 10000.0),
        *jerks,
    )
    return figures, notes


def in_fast_jumps(times: Array, contacts: tuple[Contact, ...]) -> NDArray[np.bool_]:
    """Return the times (n,) in a run of jumps faster than `FAST_JUMPS`, or within `AROUND_JUMPS` of one."""
    feet: dict[float, set[int]] = {}
    for contact in contacts:
        if contact.limb < Limb.LEFT_HAND:
            feet.setdefault(contact.start, set()).add(contact.limb)
    jumps = sorted(t for t, sides in feet.items() if len(sides) == 2)
    out = np.zeros(len(times), dtype=bool)
    for first, second in pairwise(jumps):
        if second - first < 1.0 / FAST_JUMPS:
            out |= (times > first - AROUND_JUMPS) & (times < second + AROUND_JUMPS)
    return out


def jerk(path: Array, rate: float) -> Array:
    """Return the size of the third derivative (f - 3,) of a path (f, 3), low-passed at 10 Hz."""
    return np.asarray(np.linalg.norm(np.diff(low_pass(path, rate), n=3, axis=0), axis=1) * rate**3)


# How the dancer stands, jumps and waits, in figures that viewers judge by; most of them have no goal.

WRIST, TURN = 4.0, 650.0  # metres per second of a wrist at most; degrees per second of the pelvis at most
NECK = 80.0  # degrees between head and chest at most
JUMP, BEFORE = 0.15, 0.35  # seconds in the air, and on the ground before it, of a jump for which legs have enough time
FOLD, GIVE = 0.5, 0.16  # the middle half of a flight; seconds after landing in which knees give
WAIT = 4.5  # seconds without a note that are a wait
HOME, READY = 2.5, 1.0  # seconds at the beginning and at the end of a wait in which the dancer steps


def posture_figures(body: Body, skeleton: Skeleton, contacts: tuple[Contact, ...]) -> tuple[Figure, ...]:
    """Return knee flexion, trunk lean, knees in jumps, speeds of wrists, pelvis and head, and weight shift in waits."""
    knees = 180.0 - knee_angles(body, skeleton)
    off, fold, give = _medians(jump_knees(body, knees))
    shift = weight_shifts(body, contacts)
    wrists = np.maximum.reduce([speeds(body, skeleton.index(f"{s}_radiocarpal")) for s in "lr"])
    turning = np.abs(np.diff(hip_line_yaw(body, skeleton))) * body.rate
    neck = neck_yaw(body, skeleton)
    whipped = np.abs(np.diff(np.unwrap(neck))) * body.rate
    return (
        Figure("knee flexion, median", float(np.median(knees)), "degrees"),
        Figure("trunk lean, median", float(np.median(trunk_lean(body, skeleton))), "degrees"),
        Figure("knee flexion at take-off", off, "degrees"),
        Figure("knee flexion in the air", fold, "degrees"),
        Figure("knee flexion after landing", give, "degrees"),
        Figure("wrist speed", float(wrists.max(initial=0.0)), "m/s", WRIST),
        Figure("pelvis turns at", float(np.degrees(turning.max(initial=0.0))), "degrees/s", TURN),
        Figure("head from the chest", float(np.degrees(np.abs(neck).max(initial=0.0))), "degrees", NECK),
        Figure("head turns on the chest at", float(np.degrees(whipped.max(initial=0.0))), "degrees/s"),
        Figure("weight shift in waits", 100.0 * float(np.median(shift)) if len(shift) else float("nan"), "cm"),
    )


def _medians(jumps: Array) -> tuple[float, float, float]:
    if not len(jumps):
        return float("nan"), float("nan"), float("nan")
    off, fold, give = np.median(jumps, axis=0)
    return float(off), float(fold), float(give)


def jump_knees(body: Body, knees: Array) -> Array:
    """Return the flexion (k, 3) in degrees, mean of both knees, of jumps for which legs have enough time.

    The three values are the least as the toes leave, the most in the middle of the flight, and the most after the
    landing.
    """
    flying = runs(np.asarray(~body.is_standing.any(axis=1)))
    mean, frames, out, landed = knees.mean(axis=1), body.rate, [], 0
    for first, end in flying:
        rested, landed = first - landed, end
        if first == 0 or end == len(mean) or (end - first) / frames < JUMP or rested / frames < BEFORE:
            continue
        quarter = int((end - first) * (1.0 - FOLD) / 2)
        out.append(
            (
                mean[first - 1 : first + 1].min(),
                mean[first + quarter : end - quarter].max(),
                mean[end : end + int(GIVE * frames)].max(),
            )
        )
    return np.array(out).reshape(-1, 3)


def trunk_lean(body: Body, skeleton: Skeleton) -> Array:
    """Return the angle (f,) in degrees between upright and the line from the hips' middle to the shoulders' middle."""
    hips, shoulders = (
        (body.joints[:, skeleton.index(f"l_{n}")] + body.joints[:, skeleton.index(f"r_{n}")]) / 2
        for n in ("hip", "shoulder")
    )
    up = shoulders - hips
    return np.asarray(np.degrees(np.arctan2(np.hypot(up[:, 0], up[:, 2]), up[:, 1])))


def speeds(body: Body, joint: int) -> Array:
    """Return the speed (f - 1,) of a joint, metres per second."""
    return np.asarray(np.linalg.norm(np.diff(body.joints[:, joint], axis=0), axis=1) * body.rate)


def hip_line_yaw(body: Body, skeleton: Skeleton) -> Array:
    """Return the yaw (f,) of the pelvis, radians, unwrapped: square to the line between the hips."""
    across = body.joints[:, skeleton.index("l_hip")] - body.joints[:, skeleton.index("r_hip")]
    return np.unwrap(np.arctan2(-across[:, 2], across[:, 0]))


def neck_yaw(body: Body, skeleton: Skeleton) -> Array:
    """Return how far (f,) the face is turned from the direction of the chest, radians, positive left."""
    neck, skull = (body.rotations[:, skeleton.index(name)] for name in ("vc4", "skullbase"))
    face = quat.rotate(quat.multiply(neck, skull), np.array([0.0, 0.0, 1.0]))
    return np.asarray(np.arctan2(face[:, 0], face[:, 2]))


def weight_shifts(body: Body, contacts: tuple[Contact, ...]) -> Array:
    """Return how far (w,), metres, the pelvis moves to and fro in each wait between notes, without its ends."""
    ends = [c.end if c.kind == StepKind.HOLD else c.start for c in contacts]  # a foot may stay after a tap
    busy = sorted({(c.start, float(min(end, body.times[-1]))) for c, end in zip(contacts, ends, strict=True)})
    out, free = [], -np.inf
    for start, end in busy:
        if WAIT <= start - free < np.inf:  # before the first note the dancer walks on
            inner = (body.times > free + HOME) & (body.times < start - READY)
            if inner.any():
                place = body.joints[inner, 0][:, [0, 2]]
                out.append(float(np.ptp((place - place.mean(axis=0)) @ _main_way(place))))
        free = max(free, end)
    return np.array(out)


def _main_way(places: Array) -> Array:
    """Return the unit vector (2,) along which places (n, 2) differ most."""
    return np.asarray(np.linalg.svd(places - places.mean(axis=0), full_matrices=False)[2][0])
