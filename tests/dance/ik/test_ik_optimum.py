"""The whole body against a general optimiser: the same targets, other mathematics, two dozen poses.

The optimiser knows nothing of FABRIK or closed forms: it turns all joints of the body until hands, feet and shoulders
are as near to their targets as they can be, with knees and elbows in the planes that the poles ask for.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation
from test_ik_full_body import REACH, random_targets

from dancetutor_cli.dance.ik.full_body import Targets, solve_poses
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton

SKELETON = dancer_skeleton()
POSES = 24
BALLS = ("vl5", "vt10", "vt4", "l_hip", "r_hip", "l_shoulder", "r_shoulder")  # turned freely: three numbers each
HINGES = ("l_knee", "r_knee", "l_elbow", "r_elbow")  # one number each
ENDS = ("talocrural", "radiocarpal", "shoulder")


def hinge_axis(name: str) -> np.ndarray:
    """A knee bends about +X; an elbow about the line square to the upper arm and to the front, so that it closes."""
    if name.endswith("knee"):
        return np.array([1.0, 0.0, 0.0])
    arm = SKELETON.offsets[SKELETON.index(name)]
    axis = np.cross(arm, [0.0, 0.0, 1.0])
    return axis / np.linalg.norm(axis)


def forward(x: np.ndarray, root: np.ndarray, turn: Rotation) -> dict[str, np.ndarray]:
    """World positions of all joints, by matrices; written apart from the package's forward kinematics."""
    local = {name: Rotation.from_rotvec(x[3 * k : 3 * k + 3]) for k, name in enumerate(BALLS)}
    for k, name in enumerate(HINGES):
        local[name] = Rotation.from_rotvec(x[3 * len(BALLS) + k] * hinge_axis(name))
    places, turns = {}, {}
    for j, name in enumerate(SKELETON.names):
        parent = SKELETON.names[SKELETON.parents[j]]
        if SKELETON.parents[j] < 0:
            places[name], turns[name] = root, turn
            continue
        places[name] = places[parent] + turns[parent].apply(SKELETON.offsets[j])
        turns[name] = turns[parent] * local[name] if name in local else turns[parent]
    return places


def reach_errors(places: dict[str, np.ndarray], targets: Targets, f: int) -> np.ndarray:
    """Distances (3, 2) of ankles, wrists and shoulders from their targets, metres."""
    goals = (targets.ankles[f], targets.wrists[f], targets.shoulders[f])
    return np.array(
        [
            [np.linalg.norm(places[f"{side}_{end}"] - goal[s]) for s, side in enumerate("lr")]
            for end, goal in zip(ENDS, goals, strict=True)
        ]
    )


def out_of_plane(places: dict[str, np.ndarray], targets: Targets, f: int) -> list[float]:
    """How far knees and elbows are from the planes of their poles, and how far on the wrong side, metres."""
    out = []
    chains = ((("hip", "knee", "talocrural"), targets.knees), (("shoulder", "elbow", "radiocarpal"), targets.elbows))
    for s, side in enumerate("lr"):
        for chain, pole in chains:
            first, middle, last = (places[f"{side}_{n}"] for n in chain)
            line = (last - first) / np.linalg.norm(last - first)
            square = np.cross(line, pole[f, s])
            out.append(float((middle - first) @ square / np.linalg.norm(square)))
            out.append(min(0.0, float((middle - (first + last) / 2) @ pole[f, s])))
    return out


def optimum(targets: Targets, f: int, root: np.ndarray, start: np.ndarray) -> dict[str, np.ndarray]:
    """The joints' places of the best pose that the optimiser finds."""
    turn = Rotation.from_quat(targets.pelvis_rotation[f, [1, 2, 3, 0]])
    goals = {"talocrural": targets.ankles[f], "radiocarpal": targets.wrists[f], "shoulder": targets.shoulders[f]}

    def misses(x: np.ndarray) -> np.ndarray:
        places = forward(x, root, turn)
        ends = [places[f"{side}_{end}"] - goal[s] for end, goal in goals.items() for s, side in enumerate("lr")]
        return np.concatenate([*ends, out_of_plane(places, targets, f), 1e-5 * x])

    return forward(least_squares(misses, start, method="trf", xtol=1e-12, ftol=1e-12, gtol=1e-12).x, root, turn)


@pytest.fixture(scope="module")
def both() -> tuple[Targets, list[dict[str, np.ndarray]], list[dict[str, np.ndarray]]]:
    targets = random_targets(POSES, 11)
    rotations, root = solve_poses(SKELETON, targets, REACH)
    positions, _ = world_transforms(SKELETON, rotations, root)
    ours = [dict(zip(SKELETON.names, p, strict=True)) for p in positions]
    start = np.zeros(3 * len(BALLS) + len(HINGES))
    start[9:15:3], start[3 * len(BALLS) :] = -0.5, (0.9, 0.9, 0.6, 0.6)
    return targets, ours, [optimum(targets, f, root[f], start) for f in range(POSES)]


def test_no_optimiser_gets_hands_and_feet_nearer(both) -> None:  # type: ignore[no-untyped-def]
    targets, ours, best = both
    for f in range(POSES):
        mine, other = reach_errors(ours[f], targets, f), reach_errors(best[f], targets, f)
        assert mine[:2].max() < 1e-4
        assert other[:2].max() < 1e-3, "the optimiser has found a pose as well"
        # The chest's middle line stays square to its shoulders, which the optimiser may bend as no back bends: ours are
        # near where they shall be, not there; the middle between them is nearer.
        assert mine[2].max() < other[2].max() + 0.03
        wanted = targets.shoulders[f].mean(axis=0)
        off = [np.linalg.norm((p["l_shoulder"] + p["r_shoulder"]) / 2 - wanted) for p in (ours[f], best[f])]
        assert off[0] < off[1] + 0.008


def test_knees_and_elbows_are_where_the_optimiser_puts_them(both) -> None:  # type: ignore[no-untyped-def]
    targets, ours, best = both
    for f in range(POSES):
        assert np.abs(out_of_plane(ours[f], targets, f)).max() < 1e-3
        for side in "lr":
            assert np.linalg.norm(ours[f][f"{side}_knee"] - best[f][f"{side}_knee"]) < 0.002
            moved = np.linalg.norm(ours[f][f"{side}_shoulder"] - best[f][f"{side}_shoulder"])
            assert np.linalg.norm(ours[f][f"{side}_elbow"] - best[f][f"{side}_elbow"]) < 0.002 + 1.5 * moved
