"""Reading and writing of BVH, the motion capture format of many animation programs.

Source: Biovision BVH as described by J. Lander, Game Developer, January 1998. Where a joint has position channels, they
take the place of its OFFSET, as Blender and MotionBuilder have it: adding both would lift captured dancers off the
floor.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO

import numpy as np

from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.units import Array
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.files import write_atomic
from dancetutor_cli.run.reading import read_bytes

MAX_FILE = 100_000_000  # bytes
MAX_JOINTS = 1024
PIECE = 4000  # frames written at once
UNITS = (1.0, 0.01, 0.0254, 0.001, 0.0254 / 0.45)  # metres: metre, centimetre, inch, millimetre, CMU's unit
_HUMAN = 1.65  # metres from toe to crown joint, by which the unit is found
_CHANNELS = {f"{axis}{kind}": (kind, "XYZ".index(axis)) for axis in "XYZ" for kind in ("position", "rotation")}
_LEAF = 0.05  # metres: the length given to a leaf's End Site


@dataclass(slots=True)
class _Joint:
    name: str
    parent: int
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    channels: list[str] = field(default_factory=list)
    end: tuple[float, float, float] | None = None


@dataclass(frozen=True, slots=True)
class _Tree:
    """The joints of a file over f frames, parents first.

    rotations : local, (f, j, 4); moved : places relative to the parents in the file's unit, (f, j, 3)
    """

    joints: list[_Joint]
    rotations: Array
    moved: Array

    @staticmethod
    def of(joints: list[_Joint], values: Array) -> _Tree:
        rotations = np.empty((len(values), len(joints), 4))
        moved = np.empty((len(values), len(joints), 3))
        column = 0
        for j, joint in enumerate(joints):
            own = values[:, column : column + len(joint.channels)]
            column += len(joint.channels)
            rotations[:, j], moved[:, j] = _turns(joint.channels, own), _places(joint, own)
        return _Tree(joints, rotations, moved)

    def moves(self, j: int) -> bool:
        """Whether a joint moves relative to its parent."""
        size = max(1.0, max(float(np.abs(joint.offset).max()) for joint in self.joints))
        return float(np.ptp(self.moved[:, j], axis=0).max()) > 1e-3 * size

    def below(self, base: int) -> list[int]:
        """Return a joint and its descendants, parents first."""
        out = {base}
        for j in range(base + 1, len(self.joints)):
            if self.joints[j].parent in out:
                out.add(j)
        return sorted(out)

    def moving_base(self) -> int:
        """Return the lowest joint that moves relative to its parent and carries most of the skeleton (hips under a
        root), else 0.
        """
        count = len(self.joints)
        carries = [j for j in range(count) if 2 * len(self.below(j)) > count]
        return max((j for j in carries if self.moves(j)), default=0)

    def in_world(self, base: int) -> tuple[Array, Array]:
        """Return the place (f, 3) and the rotation (f, 4) of a joint in the world."""
        place, turn = self.moved[:, base], self.rotations[:, base]
        above = self.joints[base].parent
        while above >= 0:
            place = self.moved[:, above] + quat.rotate(self.rotations[:, above], place)
            turn = quat.multiply(self.rotations[:, above], turn)
            above = self.joints[above].parent
        return place, turn

    def kept_still(self, below: list[int], scale: float) -> tuple[str, ...]:
        """Return a note about joints that move relative to their parents, which are kept at their median place."""
        names = [self.joints[j].name for j in below if self.moves(j)]
        if not names:
            return ()
        most = 100.0 * scale * max(float(np.ptp(self.moved[:, j], axis=0).max()) for j in below)
        which = ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")
        return (f"bones that change their place are kept still: {which}, by up to {most:.1f} cm",)


def read_bvh(path: Path, ends: bool = False) -> Motion:
    """Read the motion in a BVH file, in the unit of `UNITS` that makes the skeleton most like a human.

    Parameters
    ----------
    path : the file
    ends : whether End Sites become joints, named as their joint and " end"

    Returns
    -------
    Motion with the file's own skeleton, time 0 at the first frame, no contacts. Where hips move
    under a root, they are joint 0, with all that the root does. Other bones keep their median place; a note says which

    Raises
    ------
    FileError with the line, if the file is not BVH, is cut off or is too large
    """
    lines = _lines(path)
    joints, at = _hierarchy(path, lines)
    values, frame_time = _frames(path, lines, at, sum(len(j.channels) for j in joints))
    scale = _scale(joints)
    if ends:
        joints += [_Joint(f"{one.name} end", j, one.end) for j, one in enumerate(joints) if one.end is not None]
    tree = _Tree.of(joints, values)
    base = tree.moving_base()
    below = tree.below(base)
    root, first = tree.in_world(base)
    turns = tree.rotations[:, below]
    turns[:, 0] = first
    offsets = np.stack([np.median(tree.moved[:, j], axis=0) for j in below]) * scale
    offsets[0] = np.array(joints[base].offset) * scale
    place = {j: k for k, j in enumerate(below)}
    parents = np.array([-1, *(place[joints[j].parent] for j in below[1:])], dtype=np.int32)
    skeleton = Skeleton(tuple(joints[j].name for j in below), parents, offsets)
    times = np.arange(len(values), dtype=np.float64) * frame_time
    notes = tree.kept_still(below[1:], scale)
    root = np.asarray(root * scale)
    return Motion(skeleton, 1.0 / frame_time, times, quat.continuous(turns), root, (), notes=notes)


def frame_count(motion: Motion) -> int:
    """Return the number of frames of a motion at its `fps`, from its first key on."""
    return max(1, math.floor(float(motion.times[-1] - motion.times[0]) * motion.fps + 1e-6) + 1)


def write_bvh(path: Path, motion: Motion, units_per_metre: float = 100.0) -> None:
    """Write a motion as BVH, in centimetres by default, atomically.

    BVH has one frame time, so the motion is sampled at its `fps`, from its first key on. Angles are given
    with 6 digits: a round trip is exact to a millionth of a degree at the frames.

    Raises FileError if the file cannot be written.
    """
    count = frame_count(motion)
    order = _depth_first(motion.skeleton)
    text = ["HIERARCHY", *_hierarchy_lines(motion.skeleton, order[0], 0, units_per_metre), "MOTION"]
    text += [f"Frames: {count}", f"Frame Time: {1 / motion.fps:.9f}"]

    def write(file: BinaryIO) -> None:
        file.write(("\n".join(text) + "\n").encode("utf-8"))
        for first in range(0, count, PIECE):  # the whole text of an hour would need gigabytes
            times = motion.times[0] + np.arange(first, min(first + PIECE, count)) / motion.fps
            file.write(_frame_lines(motion, times, order, units_per_metre))

    write_atomic(path, write)


def _frame_lines(motion: Motion, times: Array, order: list[int], units_per_metre: float) -> bytes:
    """Return the lines of the frames at `times`, seconds."""
    still = len(motion.times) == 1
    rotations, root = (motion.rotations, motion.root) if still else sample(motion, times)
    angles = _zxy(rotations[:, order])
    table = np.concatenate([root * units_per_metre, angles.reshape(len(times), -1)], axis=1)
    return "".join(" ".join(f"{x:.6f}" for x in row) + "\n" for row in (table + 0.0).tolist()).encode("utf-8")


def _lines(path: Path) -> list[str]:
    return read_bytes(path, MAX_FILE).decode("utf-8", errors="replace").splitlines()


def _hierarchy(path: Path, lines: list[str]) -> tuple[list[_Joint], int]:
    """Return the joints, parents first, and the index of the line after MOTION."""
    joints: list[_Joint] = []
    open_: list[int | None] = []  # joint of each open brace, None for an End Site
    coming: int | None = None
    for number, line in enumerate(lines):
        words = line.split()
        if not words:
            continue
        head = words[0].upper()
        try:
            if head == "MOTION":
                if not joints or open_:
                    raise FileError(path, "MOTION comes before the hierarchy is closed", number + 1)
                return joints, number + 1
            if head in ("ROOT", "JOINT"):
                parent = next((j for j in reversed(open_) if j is not None), -1)
                if (head == "ROOT") != (not joints) or len(joints) >= MAX_JOINTS:
                    raise FileError(path, f"{head} is not allowed here; one root, {MAX_JOINTS} joints", number + 1)
                joints.append(_Joint(" ".join(words[1:]) or f"joint{len(joints)}", parent))
                coming = len(joints) - 1
            elif head == "END":
                coming = None
            elif head == "{":
                open_.append(coming)
            elif head == "}":
                open_.pop()
            elif head == "OFFSET":
                _offset(joints, open_, words)
            elif head == "CHANNELS":
                joints[open_[-1] or 0].channels = _channels(words)
            elif head != "HIERARCHY":
                raise FileError(path, f"not a BVH file: {words[0][:40]!r} is no word of a HIERARCHY", number + 1)
        except (ValueError, IndexError, KeyError) as error:
            raise FileError(path, f"{line.strip()[:60]!r} cannot be read", number + 1) from error
    raise FileError(path, "has no MOTION section; it is not a BVH file, or it is cut off")


def _offset(joints: list[_Joint], open_: list[int | None], words: list[str]) -> None:
    x, y, z = (float(w) for w in words[1:4])
    if not all(math.isfinite(v) for v in (x, y, z)):
        raise ValueError
    here = open_[-1]
    if here is None:
        joints[next(j for j in reversed(open_) if j is not None)].end = (x, y, z)
    else:
        joints[here].offset = (x, y, z)


def _channels(words: list[str]) -> list[str]:
    names = [w[:1].upper() + w[1:].lower() for w in words[2:]]
    if int(words[1]) != len(names) or len(names) > 6 or not all(name in _CHANNELS for name in names):
        raise ValueError
    return names


def _frames(path: Path, lines: list[str], at: int, width: int) -> tuple[Array, float]:
    """Return the values (frames, channels) and the seconds between frames."""
    try:
        count = int(lines[at].split(":")[1])
        frame_time = float(lines[at + 1].split(":")[1])
    except (IndexError, ValueError) as error:
        raise FileError(path, "'Frames:' and 'Frame Time:' must follow MOTION", at + 1) from error
    if not 0 < frame_time < 60 or not 0 < count <= len(lines):
        raise FileError(path, "the number of frames or the frame time is out of range", at + 1)
    rows = [(n, line) for n, line in enumerate(lines[at + 2 :], at + 3) if line.strip()][:count]
    if len(rows) < count:
        raise FileError(path, f"has {len(rows)} of {count} frames; it is cut off", len(lines))
    out = np.empty((count, width))
    for i, (number, line) in enumerate(rows):
        try:
            out[i] = np.array(line.split(), dtype=np.float64)
        except ValueError as error:
            raise FileError(path, f"a frame does not have the {width} numbers of its channels", number) from error
    if not np.isfinite(out).all():
        raise FileError(path, "a frame holds values that are not numbers", at + 3)
    return out, frame_time


def _turns(channels: list[str], values: Array) -> Array:
    """Return local rotations (f, 4): the product of the rotations about the axes, in the order of the channels."""
    out = np.tile(quat.IDENTITY, (len(values), 1))
    for k, name in enumerate(channels):
        kind, axis = _CHANNELS[name]
        if kind == "rotation":
            out = quat.multiply(out, quat.from_axis_angle(np.eye(3)[axis], np.radians(values[:, k])))
    return out


def _places(joint: _Joint, values: Array) -> Array:
    """Return the place (f, 3) relative to the parent."""
    out = np.tile(np.array(joint.offset), (len(values), 1))
    for k, name in enumerate(joint.channels):
        kind, axis = _CHANNELS[name]
        if kind == "position":
            out[:, axis] = values[:, k]
    return out


def _scale(joints: list[_Joint]) -> float:
    """Return the unit with which the height of the skeleton at rest is most like a human's."""
    rest: list[Array] = []
    ends: list[Array] = []
    for joint in joints:
        above = rest[joint.parent] if joint.parent >= 0 else np.zeros(3)
        rest.append(above + joint.offset)
        ends.append(rest[-1] + (joint.end or (0.0, 0.0, 0.0)))
    height = float(np.ptp(np.array(rest + ends), axis=0).max())
    return min(UNITS, key=lambda unit: abs(math.log(max(height, 1e-9) * unit / _HUMAN)))


def _depth_first(skeleton: Skeleton) -> list[int]:
    """Return the joints in the order in which a BVH file lists them."""
    children: dict[int, list[int]] = {}
    for j, p in enumerate(skeleton.parents.tolist()):
        children.setdefault(p, []).append(j)
    order: list[int] = []
    waiting = [0]
    while waiting:
        j = waiting.pop()
        order.append(j)
        waiting += reversed(children.get(j, []))
    return order


def _hierarchy_lines(skeleton: Skeleton, joint: int, depth: int, units: float) -> list[str]:
    tab, inner = "\t" * depth, "\t" * (depth + 1)
    offset = np.zeros(3) if depth == 0 else skeleton.offsets[joint] * units
    turns = "Zrotation Xrotation Yrotation"
    place = f"6 Xposition Yposition Zposition {turns}" if depth == 0 else f"3 {turns}"
    name = "_".join(skeleton.names[joint].split()) or f"joint{joint}"
    out = [f"{tab}{'JOINT' if depth else 'ROOT'} {name}", f"{tab}{{", f"{inner}OFFSET {_numbers(offset)}"]
    out.append(f"{inner}CHANNELS {place}")
    children = np.flatnonzero(skeleton.parents == joint)
    for child in children.tolist():
        out += _hierarchy_lines(skeleton, child, depth + 1, units)
    if not len(children):
        way = skeleton.offsets[joint] / max(float(np.linalg.norm(skeleton.offsets[joint])), 1e-9)
        out += [f"{inner}End Site", f"{inner}{{", f"{inner}\tOFFSET {_numbers(way * _LEAF * units)}", f"{inner}}}"]
    return [*out, f"{tab}}}"]


def _numbers(values: Array) -> str:
    return " ".join(f"{x:.6f}" for x in (values + 0.0).tolist())


def _zxy(q: Array) -> Array:
    """Angles (..., 3) in degrees of the turns about z, x, y whose product in this order is q (..., 4)."""
    m = quat.to_matrix(q)
    x = np.arcsin(np.clip(m[..., 2, 1], -1.0, 1.0))
    flat = np.abs(m[..., 2, 1]) < 1.0 - 1e-12
    z = np.where(flat, np.arctan2(-m[..., 0, 1], m[..., 1, 1]), np.arctan2(m[..., 1, 0], m[..., 0, 0]))
    y = np.where(flat, np.arctan2(-m[..., 2, 0], m[..., 2, 2]), 0.0)
    return np.asarray(np.degrees(np.stack([z, x, y], axis=-1)))
