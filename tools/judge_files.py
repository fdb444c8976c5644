"""Read a dance from a written .glb or .bvh file as any other program would: joints and shoes in the world, over time.

For `judge_motion.py`. Nothing of the package is imported, so that a fault of its readers, its forward kinematics or
its skin cannot hide itself. Of glTF 2.0 (Khronos Group) it knows what a humanoid's file has: one binary chunk, linear
keys, one skin. A .bvh file has no shoes: a flat box under each foot takes their place (`BOX`).
"""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

Array = NDArray[np.float64]
SIDES = {"l": 1.0, "r": -1.0}  # the left of the body is at positive x
_NUMBERS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
LOW, MOST = 0.02, 100  # metres over its lowest vertex that are a shoe's sole; vertices kept of what is above it
# a sole where there is no mesh: half its width; metres from the ankle back, from the ball ahead, and below the ball
BOX = (0.036, 0.052, 0.070, 0.028)


@dataclass(frozen=True, slots=True)
class Dance:
    """f frames at `rate` per second; places (f, 3) in metres and turns (f, 3, 3) of each joint in the world.

    shoes : "l", "r" -> (f, v, 3) places of the vertices that can touch something
    """

    rate: float
    times: Array
    places: dict[str, Array]
    turns: dict[str, Array]
    shoes: dict[str, Array]


@dataclass(frozen=True, slots=True)
class _Node:
    """A joint. shift : (3,) or (f, 3) from its parent; turn : (f, 3, 3)"""

    name: str
    parent: int
    shift: Array
    turn: Array


def read_dance(path: Path, rate: float = 120.0, section: tuple[float, float] = (-np.inf, np.inf)) -> Dance:
    """The dance in a file, at even times; section : seconds of the file that are wanted.

    Raises ValueError for a file that is neither or that has no animation.
    """
    read = {".glb": _read_glb, ".bvh": _read_bvh}.get(path.suffix.lower())
    if read is None:
        raise ValueError(f"{path}: only .glb and .bvh files can be judged")
    return read(path, rate, section)


def _times(first: float, last: float, rate: float, section: tuple[float, float]) -> Array:
    first, last = max(first, section[0]), min(last, section[1])
    return np.arange(np.ceil(first * rate - 1e-6), np.floor(last * rate + 1e-6) + 1) / rate


def _in_world(nodes: list[_Node], frames: int) -> list[tuple[Array, Array]]:
    """Place (f, 3) and turn (f, 3, 3) of each node; parents may stand behind their children."""
    done: dict[int, tuple[Array, Array]] = {}

    def world(k: int) -> tuple[Array, Array]:
        if k not in done:
            node = nodes[k]
            shift = np.broadcast_to(node.shift, (frames, 3))
            if node.parent < 0:
                done[k] = (np.array(shift), node.turn)
            else:
                place, turn = world(node.parent)
                done[k] = (place + np.einsum("fab,fb->fa", turn, shift), turn @ node.turn)
        return done[k]

    return [world(k) for k in range(len(nodes))]


# ---- glTF


class _Glb:
    def __init__(self, path: Path) -> None:
        data = path.read_bytes()
        if data[:4] != b"glTF":
            raise ValueError(f"{path}: is no GLB file")
        (length,) = struct.unpack("<I", data[12:16])
        self.doc: dict[str, Any] = json.loads(data[20 : 20 + length])
        self.binary = data[20 + length + 8 :]
        if not self.doc.get("animations"):
            raise ValueError(f"{path}: has no animation")

    def accessor(self, index: int) -> Array:
        """(n, width) numbers; normalised integers as parts of 1."""
        item = self.doc["accessors"][index]
        view = self.doc["bufferViews"][item["bufferView"]]
        kind, width = np.dtype(_NUMBERS[item["componentType"]]), _WIDTHS[item["type"]]
        start = view.get("byteOffset", 0) + item.get("byteOffset", 0)
        stride = view.get("byteStride", 0) or kind.itemsize * width
        raw = np.ndarray((item["count"], width), kind, self.binary, start, (stride, kind.itemsize))
        whole = raw.astype(np.float64)
        return whole / np.iinfo(kind).max if item.get("normalized") else whole


def _read_glb(path: Path, rate: float, section: tuple[float, float]) -> Dance:
    file = _Glb(path)
    animation, keys = file.doc["animations"][0], {}
    for channel in animation["channels"]:
        sampler, target = animation["samplers"][channel["sampler"]], channel["target"]
        keys[target.get("node"), target["path"]] = (
            file.accessor(sampler["input"])[:, 0],
            file.accessor(sampler["output"]),
        )
    late = float(animation.get("extras", {}).get("start_second", 0.0))  # glTF cannot begin before 0
    first = min(float(times[0]) for times, _ in keys.values()) + late
    last = max(float(times[-1]) for times, _ in keys.values()) + late
    times = _times(first, last, rate, section)
    parents = {child: k for k, node in enumerate(file.doc["nodes"]) for child in node.get("children", ())}
    nodes = []
    for k, node in enumerate(file.doc["nodes"]):
        turn = np.array([node.get("rotation", (0.0, 0.0, 0.0, 1.0))], dtype=np.float64)
        shift = np.array(node.get("translation", (0.0, 0.0, 0.0)), dtype=np.float64)
        if (k, "rotation") in keys:
            turn = _slerp(*keys[k, "rotation"], times - late)
        if (k, "translation") in keys:
            at, values = keys[k, "translation"]
            shift = np.column_stack([np.interp(times - late, at, values[:, axis]) for axis in range(3)])
        matrices = np.broadcast_to(_matrices(turn), (len(times), 3, 3))
        nodes.append(_Node(node.get("name", str(k)), parents.get(k, -1), shift, matrices))
    world = _in_world(nodes, len(times))
    places, turns = ({node.name: world[k][which] for k, node in enumerate(nodes)} for which in (0, 1))
    return Dance(rate, times, places, turns, {side: _shoe(file, side, world) for side in SIDES})


def _matrices(turns: Array) -> Array:
    """(n, 3, 3) of quaternions (n, 4) in glTF's order x, y, z, w."""
    x, y, z, w = (turns / np.linalg.norm(turns, axis=1, keepdims=True)).T
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    return np.moveaxis(np.array(rows), -1, 0)


def _slerp(at: Array, turns: Array, times: Array) -> Array:
    """Quaternions (f, 4) at times between keys (k, 4), the shorter way around."""
    if len(at) == 1:
        return turns
    k = np.clip(np.searchsorted(at, times, "right") - 1, 0, len(at) - 2)
    part = np.clip((times - at[k]) / (at[k + 1] - at[k]), 0.0, 1.0)[:, None]
    a, b = turns[k], turns[k + 1]
    cosine = np.sum(a * b, axis=1, keepdims=True)
    b, angle = np.where(cosine < 0, -b, b), np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
    small = angle < 1e-6
    sine = np.where(small, 1.0, np.sin(angle))
    first = np.where(small, 1.0 - part, np.sin((1.0 - part) * angle) / sine)
    return np.asarray(first * a + np.where(small, part, np.sin(part * angle) / sine) * b)


def _shoe(file: _Glb, side: str, world: list[tuple[Array, Array]]) -> Array:
    """Places (f, v, 3) of outer vertices of a shod foot, skinned: those that ankle or ball moves more than others."""
    names = [node.get("name", "") for node in file.doc["nodes"]]
    skin = file.doc["skins"][0]
    feet = [k for k, j in enumerate(skin["joints"]) if names[j] in (f"{side}_talocrural", f"{side}_metatarsal")]
    found: list[tuple[Array, Array, Array]] = []
    for mesh in file.doc["meshes"]:
        for part in mesh["primitives"]:
            place, joints, weights = (
                file.accessor(part["attributes"][name]) for name in ("POSITION", "JOINTS_0", "WEIGHTS_0")
            )
            mine = np.isin(joints[np.arange(len(joints)), weights.argmax(axis=1)], feet)
            if mine.any():
                found.append((place[mine], joints[mine].astype(int), weights[mine]))
    place, joints, weights = (np.concatenate([one[k] for one in found]) for k in range(3))
    keep = _outside(place)
    place, joints, weights = place[keep], joints[keep], weights[keep]
    bind = file.accessor(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
    out = np.zeros((len(world[0][0]), len(place), 3))
    for slot in range(4):
        for joint in np.unique(joints[weights[:, slot] > 0, slot]):
            rows = (joints[:, slot] == joint) & (weights[:, slot] > 0)
            local = place[rows] @ bind[joint, :3, :3].T + bind[joint, :3, 3]
            where, turn = world[skin["joints"][joint]]
            out[:, rows] += weights[rows, slot, None] * (np.einsum("fab,vb->fva", turn, local) + where[:, None])
    return out


def _outside(points: Array) -> NDArray[np.int64]:
    """Those of points (v, 3) that can touch something: the sole's edge and the hull of the whole."""
    sole = np.flatnonzero(points[:, 1] < points[:, 1].min() + LOW)
    sole = sole[ConvexHull(points[sole][:, [0, 2]]).vertices]
    rest = np.setdiff1d(ConvexHull(points).vertices, sole)
    return np.sort(np.concatenate((sole, rest[:: max(1, -(-len(rest) // MOST))])))


# ---- BVH


def _read_bvh(path: Path, rate: float, section: tuple[float, float]) -> Dance:
    """Centimetres, as the command writes them; the file's own frames, turned to `rate` by taking the nearest."""
    names: list[str] = []
    parents: list[int] = []
    shifts: list[list[float]] = []
    channels: list[list[str]] = []
    stack: list[int] = []
    lines = iter(path.read_text("utf-8").splitlines())
    for words in (line.split() for line in lines):
        if words[:1] == ["MOTION"]:
            break
        if words[0] in ("ROOT", "JOINT"):
            names.append(words[1])
            parents.append(stack[-1] if stack else -1)
            stack.append(len(names) - 1)
        elif words[0] == "End":
            stack.append(-1)
        elif words[0] == "OFFSET" and stack[-1] >= 0:
            shifts.append([float(word) / 100.0 for word in words[1:]])
        elif words[0] == "CHANNELS":
            channels.append(words[2:])
        elif words[0] == "}":
            stack.pop()
    next(lines)
    step = float(next(lines).split()[-1])
    numbers = np.array([[float(word) for word in line.split()] for line in lines])
    times = _times(0.0, (len(numbers) - 1) * step, min(rate, round(1.0 / step)), section)
    numbers = numbers[np.clip(np.rint(times / step).astype(int), 0, len(numbers) - 1)]
    nodes, column = [], 0
    for k, own in enumerate(channels):
        values, column = numbers[:, column : column + len(own)], column + len(own)
        nodes.append(_Node(names[k], parents[k], *_moved(own, values, np.array(shifts[k]))))
    still = [_Node(n.name, n.parent, np.array(shifts[k]), np.eye(3)[None]) for k, n in enumerate(nodes)]
    rest = {names[k]: place[0] for k, (place, _) in enumerate(_in_world(still, 1))}
    world = _in_world(nodes, len(times))
    places, turns = ({name: world[k][which] for k, name in enumerate(names)} for which in (0, 1))
    shoes = {side: _box(side, rest, lambda name: (places[name], turns[name])) for side in SIDES}
    return Dance(min(rate, round(1.0 / step)), times, places, turns, shoes)


def _moved(channels: list[str], values: Array, shift: Array) -> tuple[Array, Array]:
    """Shift (f, 3) and turn (f, 3, 3) of a joint whose channels have these values (f, c), degrees and centimetres."""
    moved, turn = np.tile(shift, (len(values), 1)), np.tile(np.eye(3), (len(values), 1, 1))
    for name, value in zip(channels, values.T, strict=True):
        axis = "XYZ".index(name[0])
        if name.endswith("position"):
            moved[:, axis] = value / 100.0
            continue
        half = np.radians(value) / 2.0
        turns = np.zeros((len(values), 4))
        turns[:, axis], turns[:, 3] = np.sin(half), np.cos(half)
        turn = turn @ _matrices(turns)
    return moved, turn


def _box(side: str, rest: dict[str, Array], world: Callable[[str], tuple[Array, Array]]) -> Array:
    """Eight points (f, 8, 3) of a sole: under the heel, at the ball on both joints that meet there, and at the toes."""
    width, back, ahead, below = BOX
    ankle, ball = rest[f"{side}_talocrural"], rest[f"{side}_metatarsal"]
    points = []
    for joint, middle, along in (
        ("talocrural", ankle, -back), ("talocrural", ball, 0.0), ("metatarsal", ball, 0.0), ("metatarsal", ball, ahead),
    ):  # fmt: skip
        place, turn = world(f"{side}_{joint}")
        for across in (-width, width):
            point = np.array([middle[0] + across, ball[1] - below, middle[2] + along]) - rest[f"{side}_{joint}"]
            points.append(place + turn @ point)
    return np.stack(points, axis=1)
