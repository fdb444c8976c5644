"""The node tree of a glTF file: parents, names and rest matrices, refused where it is no tree."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.container import Container


@dataclass(frozen=True, slots=True)
class Nodes:
    """n nodes. names : of each node ("" if it has none); parents : int32 (n,), -1 for a root

    order : node indices, parents before children; world : float64 (n, 4, 4), node to world at rest
    """

    names: tuple[str, ...]
    parents: NDArray[np.int32]
    order: tuple[int, ...]
    world: NDArray[np.float64]


def read_nodes(container: Container) -> Nodes:
    """Read all nodes; FileError where a node has two parents, is its own ancestor or has a broken transform."""
    items = container.items("nodes")
    if not items:
        raise container.fail("holds no nodes; export the character with its skeleton")
    parents = np.full(len(items), -1, dtype=np.int32)
    for i, node in enumerate(items):
        children = node.get("children", [])
        if not isinstance(children, list):
            raise container.fail(f"children of node {i} are not a list; the file is broken")
        for child in children:
            c = container.integer(child, 0, len(items) - 1, "child of a node")
            if parents[c] >= 0 or c == i:
                raise container.fail(f"node {c} has two parents or is its own; the file is broken")
            parents[c] = i
    order = _order(parents)
    if len(order) != len(items):
        raise container.fail("its nodes form a circle; the file is broken")
    world = np.empty((len(items), 4, 4))
    for i in order:
        local = _local(container, items[i])
        world[i] = local if parents[i] < 0 else world[parents[i]] @ local
    if not np.isfinite(world).all() or (np.abs(world) > 1e9).any():
        raise container.fail("a node's transform is out of range; the file is broken")
    return Nodes(tuple(str(node.get("name", ""))[:200] for node in items), parents, order, world)


def _order(parents: NDArray[np.int32]) -> tuple[int, ...]:
    children: dict[int, list[int]] = {}
    for i, p in enumerate(parents.tolist()):
        children.setdefault(p, []).append(i)
    order = list(children.get(-1, []))
    for i in order:  # grows while it is walked: breadth first
        order.extend(children.get(i, []))
    return tuple(order)


def _local(container: Container, node: dict[str, Any]) -> NDArray[np.float64]:
    if "matrix" in node:
        return container.numbers(node["matrix"], 16, "a node's matrix").reshape(4, 4).T
    local = np.eye(4)
    x, y, z, w = container.numbers(node.get("rotation", [0, 0, 0, 1]), 4, "a node's rotation")
    norm = x * x + y * y + z * z + w * w
    if norm < 1e-12:
        raise container.fail("a node's rotation is zero; the file is broken")
    s = 2.0 / norm
    local[:3, :3] = [
        [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
        [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
        [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)],
    ]
    local[:3, :3] *= container.numbers(node.get("scale", [1, 1, 1]), 3, "a node's scale")
    local[:3, 3] = container.numbers(node.get("translation", [0, 0, 0]), 3, "a node's translation")
    return local
