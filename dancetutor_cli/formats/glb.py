"""Writing of GLB: a character with its skin, and a motion as an animation that any glTF viewer plays.

Source: glTF 2.0 specification, Khronos Group.
"""

from __future__ import annotations

import json
import struct
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.materials import linear_from_srgb
from dancetutor_cli.character.mesh import Character, Mesh
from dancetutor_cli.dance.keys import key_times_of, reaches
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.run.files import write_atomic
from dancetutor_cli.run.pictures import picture_bytes

_BYTE, _SHORT, _USHORT, _UINT, _FLOAT = 5121, 5122, 5123, 5125, 5126
_COMPONENTS = {"|u1": _BYTE, "<i2": _SHORT, "<u2": _USHORT, "<u4": _UINT, "<f4": _FLOAT}
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
_VERTICES, _INDICES = 34962, 34963
SHORT = 0.3  # metres; with 16 bits, a joint with a shorter reach has an error of less than 0.01 mm
MOST_PER_SECOND = 29_760  # bytes of an animation with exact legs: two minutes and the dancer's mesh stay below 5 MB


def write_glb(path: Path, character: Character, motion: Motion | None = None) -> None:
    """Write a character, and the motion as its animation, atomically.

    The motion must be of the character's skeleton. Joints that never move have no channel, the others have the keys
    that they need (`key_times`), as normalised 16-bit quaternions; legs are exact 32-bit ones, unless the steps are so
    many that the file would get too large (then feet are off by 0.03 mm). glTF counts time from 0: the animation's
    first key is at `motion.times[0]` or 0, whichever is later, and a negative start is kept in the animation's extras
    as `start_second`.

    Raises FileError when the file cannot be written, ValueError when motion and character differ in joints.
    """
    if motion is not None and motion.skeleton.names != character.skeleton.names:
        raise ValueError("motion and character have different joints; retarget the motion first")
    writer = _Writer()
    writer.character(character)
    if motion is not None:
        writer.animation(motion)
    write_atomic(path, writer.to_bytes())


class _Writer:
    """A builder of the JSON and the binary chunk."""

    def __init__(self) -> None:
        self.binary = bytearray()
        self.doc: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "dancetutor"},
            "scene": 0,
            "scenes": [{"nodes": []}],
            "nodes": [],
            "meshes": [],
            "skins": [],
            "materials": [],
            "accessors": [],
            "bufferViews": [],
        }
        self.textures: dict[int, int] = {}

    def to_bytes(self) -> bytes:
        """Return the whole file."""
        self.doc["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.doc, separators=(",", ":"), ensure_ascii=False).encode("utf-8")
        text += b" " * (-len(text) % 4)
        body = bytes(self.binary) + bytes(-len(self.binary) % 4)
        head = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(body))
        chunk = struct.Struct("<I4s")
        return head + chunk.pack(len(text), b"JSON") + text + chunk.pack(len(body), b"BIN\0") + body

    def view(self, data: bytes, target: int | None = None) -> int:
        self.binary += bytes(-len(self.binary) % 4)
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)}
        if target is not None:
            view["target"] = target
        self.binary += data
        self.doc["bufferViews"].append(view)
        return len(self.doc["bufferViews"]) - 1

    def accessor(self, values: NDArray[Any], target: int | None = None, **more: Any) -> int:
        """Add an accessor of (n,) or (n, width) values; `more` goes into its JSON."""
        values = np.ascontiguousarray(values)
        width = 1 if values.ndim == 1 else values.shape[1]
        item = {
            "bufferView": self.view(values.tobytes(), target),
            "componentType": _COMPONENTS[values.dtype.str],
            "count": len(values),
            "type": _TYPES[width],
            **more,
        }
        self.doc["accessors"].append(item)
        return len(self.doc["accessors"]) - 1

    def character(self, character: Character) -> None:
        skeleton = character.skeleton
        nodes = self.doc["nodes"]
        for name, offset in zip(skeleton.names, skeleton.offsets, strict=True):
            nodes.append({"name": name, "translation": [float(np.float32(x)) for x in offset]})
        for child, parent in enumerate(skeleton.parents.tolist()):
            if parent >= 0:
                nodes[parent].setdefault("children", []).append(child)
            else:
                self.doc["scenes"][0]["nodes"].append(child)
        matrices = np.asarray(character.inverse_bind.transpose(0, 2, 1).reshape(-1, 16), dtype="<f4").copy()
        matrices[:, [3, 7, 11]], matrices[:, 15] = 0.0, 1.0
        joints = list(range(len(skeleton.names)))
        self.doc["skins"].append(
            {"name": character.name, "inverseBindMatrices": self.accessor(matrices), "joints": joints, "skeleton": 0}
        )
        for mesh in character.meshes:
            self.mesh(mesh)

    def mesh(self, mesh: Mesh) -> None:
        positions = np.asarray(mesh.positions, dtype="<f4")
        small = len(positions) < 65535
        bounds = {"min": positions.min(axis=0).tolist(), "max": positions.max(axis=0).tolist()}
        joints, weights = _four_joints(mesh)
        attributes = {
            "POSITION": self.accessor(positions, _VERTICES, **bounds),
            "NORMAL": self.accessor(np.asarray(mesh.normals, dtype="<f4"), _VERTICES),
            "JOINTS_0": self.accessor(joints, _VERTICES),
            "WEIGHTS_0": self.accessor(weights, _VERTICES),
        }
        if mesh.material.texture is not None:
            attributes["TEXCOORD_0"] = self.accessor(np.asarray(mesh.uv, dtype="<f4"), _VERTICES)
        indices = mesh.triangles.reshape(-1).astype("<u2" if small else "<u4")
        primitive = {
            "attributes": attributes,
            "indices": self.accessor(indices, _INDICES),
            "material": self.material(mesh),
            "mode": 4,
        }
        self.doc["meshes"].append({"name": mesh.name, "primitives": [primitive]})
        self.doc["scenes"][0]["nodes"].append(len(self.doc["nodes"]))
        self.doc["nodes"].append({"name": mesh.name, "mesh": len(self.doc["meshes"]) - 1, "skin": 0})

    def material(self, mesh: Mesh) -> int:
        material = mesh.material
        rgb = linear_from_srgb(np.array(material.base_color[:3]))
        pbr: dict[str, Any] = {
            "baseColorFactor": [*(round(float(x), 7) for x in rgb), float(material.base_color[3])],
            "metallicFactor": 0.0,
            "roughnessFactor": 0.85,
        }
        if material.texture is not None:
            pbr["baseColorTexture"] = {"index": self.texture(material.texture)}
        item: dict[str, Any] = {"name": material.name, "pbrMetallicRoughness": pbr}
        if material.base_color[3] < 1:
            item["alphaMode"] = "BLEND"
        if item in self.doc["materials"]:
            return int(self.doc["materials"].index(item))
        self.doc["materials"].append(item)
        return len(self.doc["materials"]) - 1

    def texture(self, pixels: NDArray[np.uint8]) -> int:
        if id(pixels) not in self.textures:
            for name in ("images", "textures", "samplers"):
                self.doc.setdefault(name, [])
            image = {"mimeType": "image/png", "bufferView": self.view(_png(pixels))}
            self.doc["images"].append(image)
            self.doc["samplers"] = [{"magFilter": 9729, "minFilter": 9987}]
            self.doc["textures"].append({"sampler": 0, "source": len(self.doc["images"]) - 1})
            self.textures[id(pixels)] = len(self.doc["textures"]) - 1
        return self.textures[id(pixels)]

    def animation(self, motion: Motion) -> None:
        start = min(0.0, float(motion.times[0]))
        times = np.asarray(motion.times - start, dtype="<f4")
        apart = np.concatenate([[True], np.diff(times) > 0])  # two keys may have the same time in 32 bits
        channels, before = _Channels(self), len(self.binary)
        legs, *groups = key_times_of(motion)
        for clock in groups:
            channels.turns(motion.rotations, clock.joints, times, apart & clock.keep, exact=False)
        keep = apart & legs.keep
        room = MOST_PER_SECOND * (times[-1] - times[0]) - (len(self.binary) - before)
        lever = reaches(motion.skeleton)
        carrying = tuple(j for j in legs.joints if lever[j] > SHORT)
        feet = tuple(j for j in legs.joints if lever[j] <= SHORT)
        exact = keep.sum() * 16 * (len(carrying) + 1) + keep.sum() * 8 * len(feet) <= room
        channels.turns(motion.rotations, carrying, times, keep, exact)
        channels.turns(motion.rotations, feet, times, keep, exact=False)
        channels.add(0, "translation", times[keep], np.asarray(motion.root[keep], dtype="<f4"))
        animation: dict[str, Any] = {"name": "dance", "samplers": channels.samplers, "channels": channels.channels}
        extras: dict[str, Any] = {} if start == 0 else {"start_second": start}
        if motion.bar is not None:
            bar, grips = asdict(motion.bar), [asdict(grip) for grip in motion.grips]
            extras["bar"] = {**bar, "grips": grips}
        if extras:
            animation["extras"] = extras
        self.doc["animations"] = [animation]


class _Channels:
    """The samplers and channels of an animation; channels with the same times share them."""

    def __init__(self, writer: _Writer) -> None:
        self.writer = writer
        self.inputs: dict[bytes, int] = {}
        self.samplers: list[dict[str, Any]] = []
        self.channels: list[dict[str, Any]] = []

    def turns(
        self, rotations: NDArray[np.float64], joints: tuple[int, ...], times: NDArray[Any], keep: NDArray[np.bool_],
        exact: bool,
    ) -> None:  # fmt: skip
        """Add the channels of joints that turn, with the keys `keep` of rotations (f, j, 4) at times (f,).

        exact : whether to use 32 bits per number instead of 16
        """
        for j in joints:
            turned = quat.continuous(rotations[keep, j])[:, [1, 2, 3, 0]]
            short = np.rint(turned * 32767).astype("<i2")
            still = not (short != short[0]).any()
            if still and abs(int(short[0, 3])) == 32767:
                continue
            if exact and not still:
                self.add(j, "rotation", times[keep], turned.astype("<f4"))
            else:
                self.add(j, "rotation", times[keep], short, normalized=True)

    def add(self, node: int, path: str, times: NDArray[Any], values: NDArray[Any], **more: Any) -> None:
        """Add a channel. If this makes the file smaller, only the first and last of equal values are written."""
        changes = (values[1:] != values[:-1]).any(axis=1)
        keep = np.concatenate([[True], changes]) | np.concatenate([changes, [changes.any()]])
        own = keep.sum() * (times.itemsize + values[0].nbytes)
        if own < len(times) * values[0].nbytes:
            times, values = times[keep], values[keep]
        sampler = {
            "input": self.input(times),
            "output": self.writer.accessor(values, **more),
            "interpolation": "LINEAR",
        }
        self.samplers.append(sampler)
        self.channels.append({"sampler": len(self.samplers) - 1, "target": {"node": node, "path": path}})

    def input(self, times: NDArray[Any]) -> int:
        name = times.tobytes()
        if name not in self.inputs:
            self.inputs[name] = self.writer.accessor(times, min=[float(times[0])], max=[float(times[-1])])
        return self.inputs[name]


def _four_joints(mesh: Mesh) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return joints and weights in glTF's form: joint 0 for each weight of 0."""
    weights = np.asarray(mesh.weights, dtype="<f4")
    joints = np.where(weights > 0, mesh.joints, 0)
    return joints.astype("|u1" if joints.max(initial=0) < 256 else "<u2"), weights


def _png(pixels: NDArray[np.uint8]) -> bytes:
    opaque = bool((pixels[..., 3] == 255).all())
    return picture_bytes(pixels[..., :3] if opaque else pixels, compress_level=7)
