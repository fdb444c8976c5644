"""Reading of captured motions of any skeleton: .bvh, an animation of a .glb or .vrm, .npz."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from dancetutor_cli.character.container import Container, Nodes, as_dict, read_container, read_nodes
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.physics.captured import CapturedMotion
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.dance.units import Array
from dancetutor_cli.formats.bvh import read_bvh
from dancetutor_cli.formats.npz import read_npz
from dancetutor_cli.run.errors import FileError, choose_text
from dancetutor_cli.run.files import one_of

SUFFIXES = (".bvh", ".glb", ".vrm", ".npz")
LEAST, MOST = 10.0, 240.0  # frames per second, limits for files without a frame rate
LONGEST = 3600.0  # seconds of an animation
_SAME_TIME = 1e-6  # seconds; keys are 32-bit numbers, and a frame at a key has its value


def read_source(path: Path, animation: str | None = None) -> Motion | CapturedMotion:
    """Read the motion in a file, by its suffix: as a Motion if it is an .npz with the rig's joints (from `animate` or
    `retarget`), else as captured.

    Parameters
    ----------
    animation : name of the animation in a .glb or .vrm; None: the first

    Raises
    ------
    FileError, one line, for another suffix and for a file that cannot be used.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise FileError(path, f"the name of a motion must end in {one_of(SUFFIXES)}")
    if suffix in (".glb", ".vrm"):
        return _captured_from_container(read_container(path), animation)
    motion = read_bvh(path, ends=True) if suffix == ".bvh" else read_npz(path)
    captured = captured_from_motion(path, motion)
    is_on_rig = suffix == ".npz" and set(dancer_skeleton().names) <= set(motion.skeleton.names)
    return motion if is_on_rig else captured


def captured_from_motion(path: Path, motion: Motion) -> CapturedMotion:
    """Return a motion as captured, with a rest pose without rotations. FileError if it has one frame."""
    skeleton = motion.skeleton
    if len(motion.times) < 2:
        raise FileError(path, "has one frame; a motion needs at least two")
    places, turns = world_transforms(skeleton, motion.rotations, motion.root)
    rest_turns = np.tile(quat.IDENTITY, (len(skeleton.names), 1))
    return CapturedMotion(
        path,
        skeleton.names,
        skeleton.parents,
        skeleton.rest,
        rest_turns,
        motion.fps,
        motion.times,
        places,
        turns,
        motion.notes,
    )


def _captured_from_container(container: Container, wanted: str | None) -> CapturedMotion:
    nodes = read_nodes(container)
    channels = _channels(container, _find_animation(container, wanted))
    times = _times(container, channels)
    local = _node_transforms(container, nodes, channels, times)
    places, turns = _world_transforms(nodes, *local)
    rest_places, rest_turns = _world_transforms(nodes, *_node_transforms(container, nodes, [], times[:1]))
    order = list(nodes.order)
    place = np.argsort(order)
    parents = np.array([-1 if nodes.parents[n] < 0 else place[nodes.parents[n]] for n in order], dtype=np.int32)
    rate = (len(times) - 1) / float(times[-1] - times[0])
    items = container.items("nodes")  # a node with a skin may be called Head, but it is not a joint
    names = tuple("" if "skin" in items[n] else nodes.names[n] for n in order)
    rest = (rest_places[0, order], rest_turns[0, order])
    return CapturedMotion(container.path, names, parents, *rest, rate, times, places[:, order], turns[:, order])


def _find_animation(container: Container, wanted: str | None) -> dict[str, Any]:
    animations = container.items("animations")
    if not animations:
        raise container.fail("holds no animation; export the character with one")
    if wanted is None:
        return animations[0]
    for animation in animations:
        if animation.get("name") == wanted:
            return animation
    names = [str(animation.get("name", ""))[:40] for animation in animations[:40]]
    raise FileError(container.path, f"there is no animation {wanted!r}{choose_text(wanted, names)}")


class _Channel(NamedTuple):
    """What moves a node: one of "translation", "rotation" and "scale" by its keys.

    times : (n,) seconds, ascending; values : (n, 3), or quaternions x, y, z, w (n, 4)
    is_held : whether each value stays until the next key, else it goes there in a line
    """

    node: int
    path: str
    times: Array
    values: Array
    is_held: bool

    def sample(self, times: Array, values: Array) -> Array:
        """Return the channel's values (f, w) at times (f,). values : those of the keys, (n, w)"""
        if len(self.times) == 1:
            return np.tile(values[0], (len(times), 1))
        if self.is_held:
            held: Array = values[np.maximum(np.searchsorted(self.times, times + _SAME_TIME, side="right") - 1, 0)]
            return held
        return np.column_stack([np.interp(times, self.times, column) for column in values.T])


def _channels(container: Container, animation: dict[str, Any]) -> list[_Channel]:
    """Return each channel that moves a node. Of a spline, only the values at its keys are read."""
    channels, samplers = animation.get("channels"), animation.get("samplers")
    if not isinstance(channels, list) or not isinstance(samplers, list):
        raise container.fail("an animation has no channels; the file is broken")
    out = []
    for channel in channels:
        target = as_dict(as_dict(channel).get("target"))
        path = target.get("path")
        width = {"rotation": 4, "translation": 3, "scale": 3}.get(str(path))
        if width is None or "node" not in target:
            continue
        node = container.integer(target["node"], 0, len(container.items("nodes")) - 1, "node of a channel")
        index = container.integer(as_dict(channel).get("sampler"), 0, len(samplers) - 1, "sampler of a channel")
        sampler = as_dict(samplers[index])
        times = np.asarray(container.accessor(sampler.get("input")), dtype=np.float64)
        values = np.asarray(container.accessor(sampler.get("output")), dtype=np.float64)
        if sampler.get("interpolation") == "CUBICSPLINE":
            values = values[1::3]
        if times.ndim != 1 or values.shape != (len(times), width) or (np.diff(times) < 0).any():
            raise container.fail("an animation's keys do not fit together; the file is broken")
        if times[-1] - times[0] > LONGEST or abs(times).max() > 1e6:
            raise container.fail(f"an animation is longer than {LONGEST / 60:.0f} minutes")
        out.append(_Channel(node, str(path), times, values, sampler.get("interpolation") == "STEP"))
    if not out:
        raise container.fail("its animation moves no nodes")
    return out


def _times(container: Container, channels: list[_Channel]) -> Array:
    """Return evenly spaced times from the first key to the last, at the rate of the densest channel."""
    start, end = min(one.times[0] for one in channels), max(one.times[-1] for one in channels)
    if end - start < 1e-3:
        raise container.fail("its animation lasts no time; a motion needs at least two moments")
    steps = [float(np.median(np.diff(one.times))) for one in channels if len(one.times) > 2]
    rate = min(max(1.0 / max(min(steps, default=1.0 / LEAST), 1e-6), LEAST), MOST)
    count = max(2, round((end - start) * rate) + 1)
    return np.asarray(np.linspace(start, end, count))


def _node_transforms(
    container: Container, nodes: Nodes, channels: list[_Channel], times: Array
) -> tuple[Array, Array, Array]:
    """Return translations (f, n, 3), rotations (f, n, 4) and scales (f, n, 3) of all nodes at the times."""
    items = container.items("nodes")
    moved, turned, scaled = np.zeros((len(items), 3)), np.tile(quat.IDENTITY, (len(items), 1)), np.ones((len(items), 3))
    for k in range(len(items)):
        parent = int(nodes.parents[k])
        matrix = nodes.world[k] if parent < 0 else np.linalg.pinv(nodes.world[parent]) @ nodes.world[k]
        moved[k], scaled[k] = matrix[:3, 3], np.maximum(np.linalg.norm(matrix[:3, :3], axis=0), 1e-9)
        turned[k] = _quaternion(matrix[:3, :3] / scaled[k])
    out = [np.tile(x, (len(times), 1, 1)) for x in (moved, turned, scaled)]
    for one in channels:
        if one.path == "rotation":
            turns = quat.continuous(quat.normalize(one.values[:, [3, 0, 1, 2]]))
            out[1][:, one.node] = quat.normalize(one.sample(times, turns))
        else:
            out[0 if one.path == "translation" else 2][:, one.node] = one.sample(times, one.values)
    return out[0], out[1], out[2]


def _quaternion(matrix: Array) -> Array:
    """Return the quaternion (4,) of a rotation matrix."""
    if np.linalg.det(matrix) < 0.5:  # a mirrored or flat matrix has no rotation
        return quat.IDENTITY
    return quat.from_matrix(matrix)


def _world_transforms(nodes: Nodes, moved: Array, turned: Array, scaled: Array) -> tuple[Array, Array]:
    """Return world places (f, n, 3) and rotations (f, n, 4); scales change only the lengths of bones."""
    places, turns, scales = moved.copy(), turned.copy(), scaled.copy()
    for k in nodes.order:
        parent = int(nodes.parents[k])
        if parent >= 0:
            places[:, k] = places[:, parent] + quat.rotate(turns[:, parent], scales[:, parent] * moved[:, k])
            turns[:, k] = quat.multiply(turns[:, parent], turned[:, k])
            scales[:, k] = scales[:, parent] * scaled[:, k]
    return places, turns
