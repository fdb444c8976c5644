"""The body that `judge_motion.py` judges: tapered limbs, shoes against each other, and segment masses by Winter.

Masses and centres: D. A. Winter, Biomechanics and Motor Control of Human Movement, 4th edition (2009), table 4.1. The
package bakes with de Leva's female ones (`rig/body.py`), so a body by Winter is a second opinion: its trunk is
heavier, its centre of mass lies elsewhere by about a centimetre.
"""

from __future__ import annotations

from itertools import pairwise, product

import numpy as np
from judge_files import SIDES, Array, Dance

GRAVITY = 9.81
LEG = (("hip", 0.068), ("knee", 0.048), ("talocrural", 0.035))  # joints and radii, metres
ARM = (("shoulder", 0.045), ("elbow", 0.036), ("radiocarpal", 0.026), ("metacarpophalangeal_3", 0.020))
SAMPLES = 33  # places along a limb that are tried against the whole of another one
SLICE = 0.07  # metres above the higher of two soles in which shoes can be in each other
DIRECTIONS = 72  # in the plane of the pad

# of each side: from joint, to joint, part of the body's mass, where between them the centre lies
LIMBS = (
    ("hip", "knee", 0.100, 0.433),
    ("knee", "talocrural", 0.0465, 0.433),
    ("talocrural", "metatarsal", 0.0145, 0.50),
    ("shoulder", "elbow", 0.028, 0.436),
    ("elbow", "radiocarpal", 0.016, 0.430),
    ("radiocarpal", "metacarpophalangeal_3", 0.006, 0.506),
)
PELVIS, ABDOMEN, THORAX, HEAD = 0.142, 0.139, 0.216, 0.081
HEAD_UP = 0.075  # metres over the skull's base, along the neck, where the head's centre lies


def middle(dance: Dance, name: str) -> Array:
    """Half-way (f, 3) between a joint of the left and of the right side."""
    return np.asarray((dance.places[f"l_{name}"] + dance.places[f"r_{name}"]) / 2)


def centre_of_mass(dance: Dance) -> Array:
    """(f, 3), metres."""
    parts = []
    for side in SIDES:
        for first, second, mass, along in LIMBS:
            a, b = (dance.places.get(f"{side}_{name}") for name in (first, second))
            if a is not None and b is not None:
                parts.append((mass, a + along * (b - a)))
    hips, shoulders, neck = middle(dance, "hip"), middle(dance, "shoulder"), dance.places["vc4"]
    skull = dance.places["skullbase"]
    parts += [
        (PELVIS, (hips + dance.places["vl5"]) / 2),
        (ABDOMEN, (dance.places["vl5"] + dance.places["vt10"]) / 2),
        (THORAX, (dance.places["vt10"] + (shoulders + neck) / 2) / 2),
        (HEAD, skull + HEAD_UP * unit(skull - neck)),
    ]
    whole = sum(mass for mass, _ in parts)
    return np.asarray(sum(mass / whole * place for mass, place in parts))


def unit(vectors: Array) -> Array:
    """Vectors (..., 3) of length 1."""
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def limb_depths(dance: Dance) -> dict[str, Array]:
    """How deep (f,) limbs are in each other, metres; negative apart."""
    legs, arms = ([_limb(dance, side, chain) for side in SIDES] for chain in (LEG, ARM))
    return {
        "leg in leg": _deepest(legs[0], legs[1]),
        "arm in arm": _deepest(arms[0], arms[1]),
        "arm in leg": np.maximum.reduce([_deepest(arm[1:], leg) for arm, leg in product(arms, legs)]),
    }


_Cone = tuple[Array, Array, float, float]


def _limb(dance: Dance, side: str, chain: tuple[tuple[str, float], ...]) -> list[_Cone]:
    ends = [(dance.places[f"{side}_{name}"], radius) for name, radius in chain if f"{side}_{name}" in dance.places]
    return [(a, b, thick, thin) for (a, thick), (b, thin) in pairwise(ends)]


def _deepest(first: list[_Cone], second: list[_Cone]) -> Array:
    return np.maximum.reduce([_cone_depth(a, b) for a, b in product(first, second)])


def _cone_depth(first: _Cone, second: _Cone) -> Array:
    """By brute force: balls along the first cone, each against the nearest place of the second one's axis."""
    a, b, thick, thin = first
    out = np.full(len(a), -np.inf)
    for part in np.linspace(0.0, 1.0, SAMPLES):
        ball, radius = a + part * (b - a), thick + part * (thin - thick)
        out = np.maximum(out, radius + ball_depth(ball, second))
    return out


def ball_depth(points: Array, cone: _Cone) -> Array:
    """How deep points (f, ..., 3) are in a cone of ends (f, 3), metres."""
    a, b, thick, thin = cone
    more = (slice(None), *(None,) * (points.ndim - 2))
    along, away = (b - a)[more], points - a[more]
    on = np.clip(np.sum(away * along, axis=-1) / np.sum(along * along, axis=-1), 0.0, 1.0)
    return np.asarray(thick + on * (thin - thick) - np.linalg.norm(away - on[..., None] * along, axis=-1))


def shoe_in_shin(dance: Dance) -> Array:
    """How deep (f,) a vertex of one shoe is in the other shank, metres."""
    depths = []
    for side, other in (("l", "r"), ("r", "l")):
        shank = _limb(dance, other, LEG)[1]
        depths.append(ball_depth(dance.shoes[side], shank).max(axis=1))
    return np.maximum(*depths)


def shoe_in_shoe(dance: Dance) -> Array:
    """How far (f,) one shoe would have to move aside to be out of the other one, metres; negative apart.

    Outlines seen from above, of the vertices within 7 cm over the higher of both soles; an outline is taken as convex,
    so that the hollow at a shoe's inner side counts as shoe.
    """
    left, right = dance.shoes["l"], dance.shoes["r"]
    floor = np.maximum(left[..., 1].min(axis=1), right[..., 1].min(axis=1))[:, None]
    ways = _directions()
    gaps = -_reach(left, left[..., 1] <= floor + SLICE, -ways) - _reach(right, right[..., 1] <= floor + SLICE, ways)
    depth = -gaps.max(axis=1)
    return np.where(np.isfinite(depth), depth, -1.0)


def hull_distance(points: Array, within: Array, place: Array) -> Array:
    """How far (f,) a place (f, 2) is outside the convex hull of those points (f, v, 3) that are `within` (f, v)."""
    ways = _directions()
    return np.asarray((place @ ways.T - _reach(points, within, ways)).max(axis=1))


def stillest_way(ways: Array, within: Array) -> Array:
    """The shortest vector (f, 2) over the ground in the convex hull of those of `ways` (f, v, 3) that are `within`.

    0 where 0 is inside of it, or without any.
    """
    towards = _directions()
    short = -_reach(ways, within, towards)
    best = short.argmax(axis=1)
    length = short[np.arange(len(short)), best]
    length = np.where(np.isfinite(length), np.maximum(length, 0.0), 0.0)
    return np.asarray(-length[:, None] * towards[best])


def _directions() -> Array:
    angle = np.arange(DIRECTIONS) * 2.0 * np.pi / DIRECTIONS
    return np.column_stack((np.cos(angle), np.sin(angle)))


def _reach(points: Array, within: Array, ways: Array) -> Array:
    """How far (f, d) the points that are `within` go over the ground in each direction; -inf without any."""
    out = np.full((len(points), len(ways)), -np.inf)
    for start in range(0, len(points), 500):
        piece = slice(start, start + 500)
        along = points[piece][..., [0, 2]] @ ways.T
        out[piece] = np.where(within[piece][..., None], along, -np.inf).max(axis=1)
    return out
