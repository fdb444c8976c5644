"""Skin weights by heat diffusion over one closed body, carried over to every part.

Source: Baran and Popovic 2007, Automatic rigging and animation of 3D characters (Pinocchio), section 4: solve
(L + H) w = H p per bone, L the cotangent Laplacian, H = c / d^2 with d the distance to the nearest bone.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sparse
from build_character_body import ARM, FRONT, REST, SHOULDER, SKELETON
from build_character_mesh import Triangles
from build_character_sdf import Array
from numpy.typing import NDArray
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

ORDER = {name: j for j, name in enumerate(SKELETON.names)}
HEAT = 1.0  # c of the source: larger keeps the bend nearer to the joint
ROUND_SHOULDER = 0.022  # metres over which weights around the arm's joint are spread: heat alone makes a corner there
POINT = 0.021  # metres over the joint that the point begins, which goes with the forearm
ELBOW = float((REST["l_elbow"] - SHOULDER) @ ARM)  # from the shoulder along the arm
FOLD = (0.040, 0.012)  # half the width of the elbow's bend, metres, at its inner side and at its point


def bones() -> list[tuple[str, Array, Array]]:
    """Joint and the two ends of the bone it turns."""
    r = REST
    out = [
        ("HumanoidRoot", r["HumanoidRoot"] + (0, -0.02, 0), r["vl5"]),
        ("HumanoidRoot", r["l_hip"] + (-0.04, 0.03, 0), r["r_hip"] + (0.04, 0.03, 0)),
        ("vl5", r["vl5"], r["vt10"]), ("vt10", r["vt10"], r["vt4"]), ("vt4", r["vt4"], r["vc4"] + (0, -0.03, 0)),
        ("vc4", r["vc4"], r["skullbase"]), ("skullbase", r["skullbase"], np.array([0, 1.68, 0.0])),
    ]  # fmt: skip
    for s in "lr":
        hand = r[f"{s}_radiocarpal"] + (r[f"{s}_radiocarpal"] - r[f"{s}_elbow"]) / 0.23 * 0.17
        toe = r[f"{s}_metatarsal"] + (0, 0, 0.07)
        chain = ("sternoclavicular", "shoulder", "elbow", "radiocarpal"), ("hip", "knee", "talocrural", "metatarsal")
        for names, end in zip(chain, (hand, toe), strict=True):
            ends = [r[f"{s}_{n}"] for n in names] + [end]
            out += [(f"{s}_{n}", ends[k], ends[k + 1]) for k, n in enumerate(names)]
    return out


def heat_weights(points: Array, triangles: Triangles) -> Array:
    """Weights (v, joints) of a closed mesh; rows sum to 1."""
    segments = bones()
    distance = np.stack([_to_segment(points, a, b) for _, a, b in segments], axis=1)
    owner = np.round(distance, 9).argmin(1)
    laplacian, mass = _laplacian(points, triangles)
    heat = HEAT / np.maximum(distance.min(1), 0.008) ** 2
    system = splu((laplacian + sparse.diags(mass * heat)).tocsc())
    out = np.zeros((len(points), len(ORDER)))
    for joint in dict.fromkeys(name for name, _, _ in segments):
        here = np.array([segments[k][0] == joint for k in owner], dtype=float)
        out[:, ORDER[joint]] = system.solve(mass * heat * here)
    out = np.clip(out, 0, None)
    return _rounded(out / out.sum(1, keepdims=True), points, laplacian, mass)


def _rounded(weights: Array, points: Array, laplacian: sparse.csr_matrix, mass: Array) -> Array:
    """Weights spread over the skin around the arms' joints, by one step of diffusion."""
    spread = splu((sparse.diags(mass) + ROUND_SHOULDER**2 * laplacian).tocsc()).solve(mass[:, None] * weights)
    away = np.linalg.norm(np.column_stack([np.abs(points[:, 0]), points[:, 1:]]) - SHOULDER, axis=1)
    share = np.interp(away, [0.07, 0.13], [1.0, 0.0])[:, None]
    return np.asarray(weights + share * (spread / spread.sum(1, keepdims=True) - weights))


def with_elbows(weights: Array, points: Array) -> Array:
    """Elbows that fold: the bend is wide at the inner side and narrow at the point, which goes with the forearm.

    As wide all around it is a bent tube.
    """
    out = weights.copy()
    for side, sign in (("l", 1.0), ("r", -1.0)):
        upper, fore = ORDER[f"{side}_shoulder"], ORDER[f"{side}_elbow"]
        away = points * [sign, 1.0, 1.0] - SHOULDER
        along, ahead = away @ ARM - ELBOW, away @ FRONT
        inner = np.interp(ahead, [-0.022, 0.022], [0.0, 1.0])
        half = FOLD[1] + (FOLD[0] - FOLD[1]) * inner
        t = np.clip(0.5 + (along + POINT * (1.0 - inner)) / (2.0 * half), 0, 1)
        whole = weights[:, upper] + weights[:, fore]
        here = np.interp(np.abs(along), [0.06, 0.10], [1.0, 0.0]) * (points[:, 0] * sign > 0.2)
        bent = whole * t * t * (3.0 - 2.0 * t)
        out[:, fore] += here * (bent - weights[:, fore])
        out[:, upper] = whole - out[:, fore]
    return out


def _to_segment(p: Array, a: Array, b: Array) -> Array:
    axis = b - a
    t = np.clip((p - a) @ axis / (axis @ axis), 0, 1)
    return np.asarray(np.linalg.norm(p - a - t[:, None] * axis, axis=1))


def _laplacian(points: Array, triangles: Triangles) -> tuple[sparse.csr_matrix, Array]:
    """Cotangent stiffness (positive semidefinite) and lumped vertex areas."""
    n = len(points)
    rows, cols, values = [], [], []
    mass = np.zeros(n)
    for k in range(3):
        i, j, o = triangles[:, k], triangles[:, (k + 1) % 3], triangles[:, (k + 2) % 3]
        u, v = points[i] - points[o], points[j] - points[o]
        area2 = np.linalg.norm(np.cross(u, v), axis=1)
        cot = np.clip((u * v).sum(1) / np.maximum(area2, 1e-14), 0.02, 20) / 2
        rows += [i, j, i, j]
        cols += [j, i, i, j]
        values += [-cot, -cot, cot, cot]
        np.add.at(mass, i, area2 / 6)
    matrix = sparse.csr_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(cols))), shape=(n, n))
    return matrix, mass


class Skin:
    """Weights on a reference body, to be looked up for any point near it."""

    def __init__(self, points: Array, normals: Array, triangles: Triangles) -> None:
        self.points, self.normals = points, normals
        self.weights = heat_weights(points, triangles)
        self.tree = cKDTree(points)

    def at(self, points: Array, normals: Array) -> Array:
        """Weights (n, joints) from the nearest body vertices that look the same way."""
        distance, near = self.tree.query(points, k=12)
        agree = np.clip((normals[:, None] * self.normals[near]).sum(2), 0, 1) ** 2 + 0.02
        share = agree / (distance + 0.004) ** 2
        share /= share.sum(1, keepdims=True)
        return np.einsum("nk,nkj->nj", share, self.weights[near])


def four(weights: Array) -> tuple[NDArray[np.uint16], NDArray[np.float32]]:
    """The four largest of each row, in 1/255ths that add up to 1."""
    weights = np.round(weights, 6)
    order = np.argsort(-weights, axis=1, kind="stable")[:, :4]
    top = np.take_along_axis(weights, order, axis=1)
    top = top / top.sum(1, keepdims=True)
    units = np.floor(np.round(top * 255, 3) + 0.5)
    units[:, 0] += 255 - units.sum(1)
    return np.where(units > 0, order, order[:, :1]).astype(np.uint16), (units / 255).astype(np.float32)
