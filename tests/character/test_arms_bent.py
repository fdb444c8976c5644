"""Arms as the bar asks for them: elbows with a point, and no volume lost, behind her back."""

from __future__ import annotations

import numpy as np
import pytest

from dancetutor_cli.character.characters import load_character
from dancetutor_cli.character.mesh import Character, Mesh
from dancetutor_cli.dance.rig import quaternion as quat

Array = np.ndarray
FLEXES = (2**-0.5, 2**-0.5, 0.0)  # the left elbow's axis: forearms bend to the front
BEHIND = (-0.32, -0.26, -0.91)  # where a left arm points that holds the bar, farthest back


@pytest.fixture(scope="module", params=["dancer", "mannequin"])
def character(request: pytest.FixtureRequest) -> Character:
    return load_character(request.param)


def body(character: Character) -> Mesh:
    return next(mesh for mesh in character.meshes if mesh.name == "body")


def posed(character: Character, turns: dict[str, Array]) -> tuple[Array, dict[str, Array]]:
    """Vertices (v, 3) of the body with some joints turned, and where the joints are then."""
    skeleton, mesh = character.skeleton, body(character)
    world: list[Array] = []
    for name, offset, parent in zip(skeleton.names, skeleton.offsets, skeleton.parents, strict=True):
        local = np.eye(4)
        local[:3, 3] = offset
        if name in turns:
            local[:3, :3] = quat.to_matrix(turns[name])
        world.append(local if parent < 0 else world[parent] @ local)
    moves = np.einsum("vk,vkij->vij", mesh.weights, (np.array(world) @ character.inverse_bind)[mesh.joints])
    places = np.einsum("vij,vj->vi", moves[:, :3, :3], mesh.positions) + moves[:, :3, 3]
    return places, {name: m[:3, 3] for name, m in zip(skeleton.names, world, strict=True)}


def flexed(side: str, degrees: float) -> dict[str, Array]:
    """The elbow bent, forearm to the front."""
    way = np.array(FLEXES) if side == "l" else np.array(FLEXES) * [1.0, -1.0, 1.0]
    return {f"{side}_elbow": quat.from_axis_angle(way, np.asarray(-np.radians(degrees)))}


@pytest.mark.parametrize("side", ["l", "r"])
@pytest.mark.parametrize(("degrees", "share"), [(60, 0.85), (90, 0.78), (120, 0.58)])
def test_a_bent_elbow_has_a_point(character: Character, side: str, degrees: float, share: float) -> None:
    """It stands out by a part of the arm's thickness there; of a bent tube's 0.80, 0.65 and 0.46 was left."""
    rest = character.skeleton.rest[character.skeleton.index(f"{side}_elbow")]
    near = np.linalg.norm(body(character).positions - rest, axis=1) < 0.08
    places, joints = posed(character, flexed(side, degrees))
    elbow = joints[f"{side}_elbow"]
    upper, fore = (joints[f"{side}_{end}"] - elbow for end in ("shoulder", "radiocarpal"))
    out = -(upper / np.linalg.norm(upper) + fore / np.linalg.norm(fore))
    out /= np.linalg.norm(out)
    thick = (body(character).positions[near] - rest)[:, 2].min()
    assert ((places[near] - elbow) @ out).max() > -share * thick


def volume(places: Array, triangles: Array) -> float:
    a, b, c = (places[triangles[:, k]] for k in range(3))
    return float(np.einsum("ti,ti->", np.cross(a, b), c)) / 6.0


@pytest.mark.parametrize("side", ["l", "r"])
def test_an_arm_on_the_bar_keeps_its_volume(side: str) -> None:
    dancer = load_character("dancer")
    mesh, skeleton = body(dancer), dancer.skeleton
    shoulder, elbow = (skeleton.rest[skeleton.index(f"{side}_{name}")] for name in ("shoulder", "elbow"))
    goal = np.array(BEHIND) * (1.0 if side == "l" else [-1.0, 1.0, 1.0])
    turns = {f"{side}_shoulder": quat.between(elbow - shoulder, goal), **flexed(side, 80)}
    # the arm with its hand is one closed piece: all that hangs on these joints, and is not cloth
    label = np.unique(np.round(mesh.positions, 6), axis=0, return_inverse=True)[1].reshape(-1)
    triangles = label[mesh.triangles]
    piece = np.arange(label.max() + 1)
    for _ in range(200):
        before = piece.copy()
        for k in range(3):
            np.minimum.at(piece, triangles[:, k], piece[triangles].min(axis=1))
        piece = piece[piece]
        if (piece == before).all():
            break
    ours = piece[label[np.linalg.norm(mesh.positions - elbow, axis=1).argmin()]]
    arm = mesh.triangles[piece[triangles[:, 0]] == ours]
    rest, places = mesh.positions.astype(float), posed(dancer, turns)[0]
    assert 0.94 < volume(places, arm) / volume(rest, arm) < 1.05
