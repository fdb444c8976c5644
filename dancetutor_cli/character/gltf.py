"""A glTF file's skinned meshes as a Character, as they are stored: no joint is renamed or moved.

Every joint of the result has the identity as rest rotation (its axes are the world's); what the file's own rest
rotations and scales do to the mesh is kept in `inverse_bind`, so the picture at rest is the same.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.container import Container, Nodes, as_dict, read_container, read_nodes
from dancetutor_cli.character.materials import Materials
from dancetutor_cli.character.mesh import Character, Mesh
from dancetutor_cli.dance.rig.skeleton import Skeleton

MAX_JOINTS = 1024
MAX_SKINNED = 16 * MAX_JOINTS  # joints of all skins together
MAX_VERTICES = 500_000
MAX_TRIANGLES = 500_000
MAX_PRIMITIVES = 4096
_LONGEST_NORMAL = 1e15  # its square still is a number of 32 bits
_TRIANGLES, _STRIP, _FAN = 4, 5, 6  # glTF's primitive modes


def read_character(path: Path) -> Character:
    """Read the meshes and the skeleton of a .glb file. Raises FileError if they cannot be used."""
    container = read_container(path)
    return character_with_nodes(container, read_nodes(container), ())[0]


def character_with_nodes(
    container: Container, nodes: Nodes, keep: Iterable[int], skip: Collection[int] = ()
) -> tuple[Character, dict[int, int]]:
    """Return the character, and the joint index of each node that became a joint.

    keep : nodes that must become joints even without vertices; skip : nodes whose meshes are left out
    """
    reader = _Reader(container, nodes, keep)
    for index, node in enumerate(container.items("nodes")):
        if "mesh" in node and index not in skip:
            reader.add_mesh(index, node)
    if not reader.meshes:
        raise container.fail("holds no triangle meshes moved by a skeleton; export the character with its skin")
    character = Character(container.path.stem, reader.skeleton, tuple(reader.meshes), reader.inverse_bind)
    return character, reader.joint_of


class _Reader:
    """A reader that collects the joints and meshes of one file."""

    def __init__(self, container: Container, nodes: Nodes, keep: Iterable[int]) -> None:
        self.container = container
        self.nodes = nodes
        self.meshes: list[Mesh] = []
        self.materials = Materials(container)
        self.vertices = 0
        self.triangles = 0
        self.primitives = 0
        skins = container.items("skins")
        if sum(len(joints) for skin in skins if isinstance(joints := skin.get("joints"), list)) > MAX_SKINNED:
            raise container.fail(f"its skins have more than {MAX_SKINNED} joints; join its meshes")
        self.skins = [self._skin(skin) for skin in skins]
        self.joint_of = self._joints(keep)
        self.skeleton = self._skeleton()
        self.inverse_bind = np.tile(np.eye(4), (len(self.joint_of), 1, 1))
        self.inverse_bind[:, :3, 3] = -self.skeleton.rest
        self.tables = self._bind()

    def _bind(self) -> list[NDArray[np.uint16]]:
        """Return the joint indices of each skin, and set the inverse bind matrices.

        If a second skin binds a node differently, it gets another joint that moves with the first.
        """
        rest = self.inverse_bind
        known: dict[int, list[tuple[NDArray[np.float64], int]]] = {}
        extra: list[tuple[int, NDArray[np.float64]]] = []
        tables = []
        for joints, matrices in self.skins:
            table = []
            for node, matrix in zip(joints, matrices, strict=True):
                ways = known.setdefault(node, [])
                index = next((j for other, j in ways if np.allclose(other, matrix, atol=1e-5)), None)
                if index is None:
                    index = len(rest) + len(extra) if ways else self.joint_of[node]
                    if len(extra) > 4 * MAX_JOINTS:
                        raise self.container.fail(f"its skins need more than {4 * MAX_JOINTS} joints; join its meshes")
                    bound = rest[self.joint_of[node]] @ self.nodes.world[node] @ matrix
                    if ways:
                        extra.append((self.joint_of[node], bound))
                    else:
                        self.inverse_bind[index] = bound
                    ways.append((matrix, index))
                table.append(index)
            tables.append(np.array(table, dtype=np.uint16))
        if extra:
            self._add_joints(extra)
        return tables

    def _add_joints(self, extra: list[tuple[int, NDArray[np.float64]]]) -> None:
        """Add joints (parent, inverse bind matrix) at the places of their parents."""
        old = self.skeleton
        names = (*old.names, *(f"{old.names[p]}_skin{k}" for k, (p, _) in enumerate(extra)))
        parents = np.concatenate([old.parents, np.array([p for p, _ in extra], dtype=np.int32)])
        self.skeleton = Skeleton(names, parents, np.concatenate([old.offsets, np.zeros((len(extra), 3))]))
        self.inverse_bind = np.concatenate([self.inverse_bind, np.stack([m for _, m in extra])])

    def _skin(self, skin: dict[str, Any]) -> tuple[list[int], NDArray[np.float64]]:
        fail, items = self.container.fail, self.container.items("nodes")
        joints = skin.get("joints")
        if not isinstance(joints, list) or not 0 < len(joints) <= MAX_JOINTS:
            raise fail(f"a skin has no joints or more than {MAX_JOINTS}; the file is broken")
        joints = [self.container.integer(j, 0, len(items) - 1, "joint of a skin") for j in joints]
        if "inverseBindMatrices" not in skin:
            return joints, np.tile(np.eye(4), (len(joints), 1, 1))
        matrices = np.asarray(self.container.accessor(skin["inverseBindMatrices"]), dtype=np.float64)
        if matrices.ndim != 2 or matrices.shape[1] != 16 or len(matrices) < len(joints):
            raise fail("a skin has fewer inverse bind matrices than joints; the file is broken")
        return joints, matrices[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1)

    def _joints(self, keep: Iterable[int]) -> dict[int, int]:
        """Return the joint index of each node that is a joint of a skin, or an ancestor of one."""
        used: set[int] = set()
        for joints in (*(joints for joints, _ in self.skins), list(keep)):
            for node in joints:
                while node >= 0 and node not in used:
                    used.add(node)
                    node = int(self.nodes.parents[node])
        if len(used) > 2 * MAX_JOINTS:
            raise self.container.fail(f"its skeleton has more than {2 * MAX_JOINTS} nodes")
        if not used:
            raise self.container.fail("has no skeleton; export the character with its skin")
        order = sorted(used)  # as the file lists them, if there parents come first
        if any(self.nodes.parents[n] > n for n in order):
            order = [n for n in self.nodes.order if n in used]
        return {node: j for j, node in enumerate(order)}

    def _skeleton(self) -> Skeleton:
        order = list(self.joint_of)
        rest = self.nodes.world[order][:, :3, 3]
        parents = np.array([self.joint_of.get(int(self.nodes.parents[n]), -1) for n in order], dtype=np.int32)
        offsets = rest.copy()
        inner = parents >= 0
        offsets[inner] -= rest[parents[inner]]
        return Skeleton(tuple(self.nodes.names[n] for n in order), parents, offsets)

    def add_mesh(self, index: int, node: dict[str, Any]) -> None:
        mesh = self.container.item("meshes", node["mesh"])
        primitives = mesh.get("primitives", [])
        if not isinstance(primitives, list):
            raise self.container.fail("a mesh's primitives are not a list; the file is broken")
        if any("KHR_draco_mesh_compression" in as_dict(as_dict(p).get("extensions")) for p in primitives):
            raise self.container.fail("its meshes are compressed (Draco), not supported here; export it uncompressed")
        self.primitives += len(primitives)
        if self.primitives > MAX_PRIMITIVES:
            raise self.container.fail(f"has more than {MAX_PRIMITIVES} parts; join its meshes")
        for primitive in primitives:
            if not isinstance(primitive, dict) or primitive.get("mode", _TRIANGLES) not in (_TRIANGLES, _STRIP, _FAN):
                continue
            name = str(node.get("name") or mesh.get("name") or f"mesh{index}")[:200]
            self._primitive(name, index, node, primitive)

    def _primitive(self, name: str, index: int, node: dict[str, Any], primitive: dict[str, Any]) -> None:
        attributes = primitive.get("attributes")
        if not isinstance(attributes, dict) or "POSITION" not in attributes:
            return
        positions = self._attribute(attributes, "POSITION", 3).astype(np.float32)
        count = len(positions)
        triangles = self._triangles(primitive, count)
        self.vertices += count
        self.triangles += len(triangles)
        if self.vertices > MAX_VERTICES or self.triangles > MAX_TRIANGLES:
            raise self.container.fail(f"has more than {MAX_VERTICES} vertices or {MAX_TRIANGLES} triangles; reduce it")
        normals = self._attribute(attributes, "NORMAL", 3, count) if "NORMAL" in attributes else None
        if "skin" in node:
            joints, weights = self._weights(node, attributes, count)
        else:
            rigid = self._attach(index, positions, normals)
            if rigid is None:
                return  # scenery that hangs on no joint
            positions, normals, joint = rigid
            joints = np.full((count, 4), joint, dtype=np.uint16)
            weights = np.tile(np.array([1, 0, 0, 0], dtype=np.float32), (count, 1))
        if normals is None:
            normals = vertex_normals(positions, triangles)
        unit = unit_normals(normals)

        def optional(name: str, width: int) -> NDArray[Any] | None:
            return self._attribute(attributes, name, width, count) if name in attributes else None

        material, uv = self.materials.read(primitive, optional, count)
        colors = optional("COLOR_0", 3)
        colors = None if colors is None else np.clip(colors, 0, 1).astype(np.float32)
        self.meshes.append(Mesh(name, positions, unit, uv, triangles, joints, weights, material, colors))

    def _attribute(self, attributes: dict[str, Any], name: str, width: int, count: int | None = None) -> NDArray[Any]:
        values = self.container.accessor(attributes[name])
        if values.ndim != 2 or values.shape[1] < width or (count is not None and len(values) != count):
            raise self.container.fail(f"{name} of a mesh has the wrong shape; the file is broken")
        return values[:, :width]

    def _triangles(self, primitive: dict[str, Any], count: int) -> NDArray[np.int32]:
        if "indices" in primitive:
            indices = np.asarray(self.container.accessor(primitive["indices"]))
        else:
            indices = np.arange(count)
        if indices.ndim != 1 or indices.dtype.kind == "f" or (indices.size and int(indices.max()) >= count):
            raise self.container.fail("a mesh's indices point past its vertices; the file is broken")
        return _in_threes(indices.astype(np.int32), primitive.get("mode", _TRIANGLES))

    def _weights(
        self, node: dict[str, Any], attributes: dict[str, Any], count: int
    ) -> tuple[NDArray[np.uint16], NDArray[np.float32]]:
        skin = self.container.integer(node["skin"], 0, len(self.skins) - 1, "skin of a node")
        table = self.tables[skin]
        if "JOINTS_0" not in attributes or "WEIGHTS_0" not in attributes:
            raise self.container.fail("a skinned mesh has no joints or weights; the file is broken")
        local = self._attribute(attributes, "JOINTS_0", 4, count).astype(np.int64)
        weights = np.maximum(self._attribute(attributes, "WEIGHTS_0", 4, count).astype(np.float64), 0.0)
        if local.min() < 0 or local.max() >= len(table):
            raise self.container.fail("a mesh's joints are not in its skin; the file is broken")
        total = weights.sum(axis=1, keepdims=True)
        weights = np.where(total > 1e-6, weights / np.maximum(total, 1e-6), [1.0, 0.0, 0.0, 0.0])
        return table[local], weights.astype(np.float32)

    def _attach(
        self, node: int, positions: NDArray[np.float32], normals: NDArray[Any] | None
    ) -> tuple[NDArray[np.float32], NDArray[Any] | None, int] | None:
        """Return a mesh without skin, moved into the space of the nearest joint above it, or None."""
        above = node
        while above >= 0 and above not in self.joint_of:
            above = int(self.nodes.parents[above])
        if above < 0:
            return None
        joint = self.joint_of[above]
        world = np.eye(4)
        world[:3, 3] = self.skeleton.rest[joint]
        matrix = np.linalg.pinv(world @ self.inverse_bind[joint]) @ self.nodes.world[node]
        placed = positions @ matrix[:3, :3].T + matrix[:3, 3]
        turned = None if normals is None else normals @ np.linalg.pinv(matrix[:3, :3])
        return placed.astype(np.float32), turned, joint


def unit_normals(normals: NDArray[Any]) -> NDArray[np.float32]:
    """Return normals (n, 3) of length 1; very long ones are shortened first, so that squares do not overflow."""
    longest = np.abs(normals).max(axis=1, keepdims=True, initial=0)
    if (longest > _LONGEST_NORMAL).any():
        normals = normals / np.where(longest > _LONGEST_NORMAL, longest, 1)
    length = np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    return np.asarray(normals / length, dtype=np.float32)


def _in_threes(indices: NDArray[np.int32], mode: object) -> NDArray[np.int32]:
    """Return the triangles (t, 3) of a list of vertices, all with the same orientation."""
    if mode == _TRIANGLES:
        return indices[: len(indices) // 3 * 3].reshape(-1, 3)
    if mode == _FAN:
        return np.stack([indices[1:-1], indices[2:], np.broadcast_to(indices[0], len(indices[2:]))], axis=1)
    out = np.stack([indices[:-2], indices[1:-1], indices[2:]], axis=1)
    out[1::2] = out[1::2, [1, 0, 2]]
    return out


def vertex_normals(positions: NDArray[np.float32], triangles: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return area-weighted vertex normals, (v, 3), not of unit length."""
    a, b, c = (positions[triangles[:, k]].astype(np.float64) for k in range(3))
    face = np.cross(b - a, c - a)
    out = np.zeros((len(positions), 3))
    for k in range(3):
        np.add.at(out, triangles[:, k], face)
    return out
