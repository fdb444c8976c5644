"""The characters of the program, and those of users, which are fitted to the rig, ready to be moved and drawn."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.container import Container, Nodes, read_container, read_nodes
from dancetutor_cli.character.gltf import character_with_nodes, read_character
from dancetutor_cli.character.humanoid import find_humanoid
from dancetutor_cli.character.mesh import Character, Material, Mesh, rest_vertices
from dancetutor_cli.character.surfaces import drawable
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import Skeleton, dancer_skeleton
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import LIMBS, limb_colours
from dancetutor_cli.run.errors import FileError, UsageError, choose_text
from dancetutor_cli.run.reading import PACKAGE

# A user's character fitted to the rig: bones, rest pose, size.
#
# The fitted character keeps its own bone lengths. Each joint's rest rotation is the identity and its rest pose our
# A pose, so the world rotation of a joint of our rig is the world rotation of the same joint of the character; only
# the binding pose, which may be a T pose, differs, and `inverse_bind` carries that.

HEIGHT = 1.70  # metres a user's character is scaled to
LEAST_LEG = 0.38  # metres; shorter legs do not reach panels 0.28 m from the centre: such a character is made taller
_ALIGNED = tuple(
    (f"{s}_{a}", f"{s}_{b}")
    for s in "lr"
    for a, b in (("shoulder", "elbow"), ("elbow", "radiocarpal"), ("hip", "knee"), ("knee", "talocrural"))
)


def fit_character(path: Path) -> Character:
    """Read a .glb or .vrm file and fit it to the rig.

    The joints that were found have H-Anim names, and joint 0 is HumanoidRoot; others keep their own names. The
    character stands on y = 0, looks to +Z and is scaled to `HEIGHT`. Objects in the hands are left out.

    Raises FileError, one line, for a file that cannot be used; it lists bones that are missing or in the wrong place.
    """
    container = read_container(path)
    nodes = read_nodes(container)
    humanoid = find_humanoid(container, nodes)
    named = humanoid.joints()
    held = _hand_items(container, nodes, {n for n, joint in named.items() if joint.endswith("_radiocarpal")})
    character, joint_of = character_with_nodes(container, nodes, named, held)
    names = {joint_of[node]: joint for node, joint in named.items()}
    character = _rooted(character, names)
    character = _upright(character, path)
    character = _in_rest_pose(character)
    return drawable(character, rest_vertices(character))


def _hand_items(container: Container, nodes: Nodes, hands: set[int]) -> set[int]:
    """Return the nodes of unskinned meshes below a hand: weapons and tools, often several at once to choose from."""
    below = set(hands)
    for i in nodes.order:
        if int(nodes.parents[i]) in below:
            below.add(i)
    return {i for i, node in enumerate(container.items("nodes")) if i in below - hands and "skin" not in node}


def _rooted(character: Character, names: dict[int, str]) -> Character:
    """Return the character with renamed joints and the hips as the root; nodes above the hips become children of the
    hips.
    """
    skeleton = character.skeleton
    taken = set(names.values())
    labels = [names.get(j, n + "_" if n in taken else n) for j, n in enumerate(skeleton.names)]
    root = labels.index("HumanoidRoot")
    parents = skeleton.parents.copy()
    above: set[int] = set()
    node = int(parents[root])
    while node >= 0:
        above.add(node)
        node = int(parents[node])
    order = [root, *(j for j in range(len(labels)) if j != root)]
    parents[[j for j in order if j in above or parents[j] in above]] = root
    parents[root] = -1
    order = _parents_first(order, parents)
    place = np.argsort(order)
    rest = skeleton.rest[order]
    new = np.array([-1 if parents[j] < 0 else place[parents[j]] for j in order], dtype=np.int32)
    meshes = tuple(replace(m, joints=place[m.joints].astype(np.uint16)) for m in character.meshes)
    return replace(
        character,
        skeleton=Skeleton.from_rest(tuple(labels[j] for j in order), new, rest),
        meshes=meshes,
        inverse_bind=character.inverse_bind[order],
    )


def _parents_first(order: list[int], parents: NDArray[np.int32]) -> list[int]:
    done: list[int] = [order[0]]
    seen = {order[0]}
    waiting = order[1:]
    while waiting:
        ready = [j for j in waiting if int(parents[j]) in seen]
        done += ready
        seen |= set(ready)
        waiting = [j for j in waiting if j not in seen]
    return done


def _upright(character: Character, path: Path) -> Character:
    """Turn the character to look to +Z, scale it, and stand it on the ground at the origin."""
    at = dict(zip(character.skeleton.names, character.skeleton.rest, strict=True))
    left = at["l_hip"] - at["r_hip"] + at["l_shoulder"] - at["r_shoulder"]
    up = at["skullbase"] - (at["l_talocrural"] + at["r_talocrural"]) / 2
    if min(np.linalg.norm(left), np.linalg.norm(up)) < 1e-6:
        raise FileError(path, "its bones are all at one point; export the character in its rest pose")
    axis = np.eye(3)[np.abs(up).argmax()] * np.sign(up[np.abs(up).argmax()])
    left = left - (left @ axis) * axis
    if np.linalg.norm(left) < 1e-6:
        raise FileError(path, "its left and right cannot be told apart; export the character standing upright")
    left /= np.linalg.norm(left)
    turn = np.stack([left, axis, np.cross(left, axis)])
    vertices = rest_vertices(character) @ turn.T
    leg = sum(float(np.linalg.norm(at[f"l_{a}"] - at[f"l_{b}"])) for a, b in (("hip", "knee"), ("knee", "talocrural")))
    height = float(np.ptp(vertices[:, 1]))
    if leg < 1e-6 or height < 1e-6:
        raise FileError(path, "it has no height or no legs; export the character in its rest pose")
    scale = max(HEIGHT / height, LEAST_LEG / leg)
    move = np.eye(4)
    move[:3, :3] = turn * scale
    middle = turn @ (at["l_talocrural"] + at["r_talocrural"]) / 2
    move[:3, 3] = -scale * np.array([middle[0], _ground(character, vertices), middle[2]])
    rest = character.skeleton.rest @ move[:3, :3].T + move[:3, 3]
    return _with_rest(character, rest, np.tile(move, (len(rest), 1, 1)))


def _ground(character: Character, vertices: Array) -> float:
    """Return the height of the soles: that of the lowest vertex that a foot moves."""
    feet = [j for j, n in enumerate(character.skeleton.names) if n.endswith(("_talocrural", "_metatarsal"))]
    at = 0
    low = []
    for mesh in character.meshes:
        share = (mesh.weights * np.isin(mesh.joints, feet)).sum(axis=1)
        part = vertices[at : at + len(share)]
        low += [float(part[share > 0.5, 1].min())] if (share > 0.5).any() else []
        at += len(share)
    return min(low, default=float(vertices[:, 1].min()))


def _with_rest(character: Character, rest: Array, moves: Array) -> Character:
    """Return the character with new rest positions (j, 3).

    moves : (j, 4, 4) takes what each joint carries from the old rest place to the new
    """
    old = character.inverse_bind.copy()
    old[:, :3, 3] += character.skeleton.rest  # from the mesh to the old rest place
    inverse_bind = moves @ old
    inverse_bind[:, :3, 3] -= rest
    skeleton = Skeleton.from_rest(character.skeleton.names, character.skeleton.parents, rest)
    return replace(character, skeleton=skeleton, inverse_bind=inverse_bind)


def _in_rest_pose(character: Character) -> Character:
    """Turn the limbs to the rig's rest pose, so that a T pose becomes an A pose."""
    skeleton, ours = character.skeleton, dancer_skeleton()
    rest, wanted = skeleton.rest, ours.rest
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(skeleton.names), 1))
    for joint, tip in _ALIGNED:
        a, b = skeleton.index(joint), skeleton.index(tip)
        turns[a] = quat.between(rest[b] - rest[a], wanted[ours.index(tip)] - wanted[ours.index(joint)])
    for side in "lr":
        turns[skeleton.index(f"{side}_talocrural")] = _foot_turn(skeleton, side)
    own = {skeleton.index(joint) for joint, _ in _ALIGNED}
    own |= {skeleton.index(f"{s}_talocrural") for s in "lr"}
    moves = np.tile(np.eye(4), (len(turns), 1, 1))
    placed = rest.copy()
    for j, p in enumerate(skeleton.parents):
        if p >= 0:
            if j not in own:
                turns[j] = turns[p]
            placed[j] = placed[p] + quat.rotate(turns[p], rest[j] - rest[p])
        moves[j, :3, :3] = quat.to_matrix(turns[j])
        moves[j, :3, 3] = placed[j] - moves[j, :3, :3] @ rest[j]
    posed = _with_rest(character, placed, moves)
    down = np.array([0.0, _ground(posed, rest_vertices(posed)), 0.0])
    moves[:, :3, 3] -= down
    return _with_rest(character, placed - down, moves)


def _foot_turn(skeleton: Skeleton, side: str) -> Array:
    """Return the rotation about the vertical that points the toes to +Z; the identity without a toe joint."""
    if f"{side}_metatarsal" not in skeleton.names:
        return np.array([1.0, 0.0, 0.0, 0.0])
    way = skeleton.rest[skeleton.index(f"{side}_metatarsal")] - skeleton.rest[skeleton.index(f"{side}_talocrural")]
    return quat.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.asarray(-np.arctan2(way[0], way[2])))


# The ragdoll's body of a character: the rig's joints in the proportions of the character.

_TRUNK = ("HumanoidRoot", "vl5", "vt10", "vt4", "vc4", "skullbase")


def body_of(skeleton: Skeleton) -> Skeleton:
    """Return the rig's joints at the places of a fitted character's joints; missing joints are placed in proportion.

    skeleton : of a character of `character.characters.load_character`; the project's own dancers come back as they are
    """
    ours = dancer_skeleton()
    if skeleton.names == ours.names and np.allclose(skeleton.offsets, ours.offsets, atol=1e-9):
        return ours
    own, rest = dict(zip(skeleton.names, skeleton.rest, strict=True)), ours.rest.copy()
    place = {name: rest[k] for k, name in enumerate(ours.names)}
    tall = own["skullbase"][1] / place["skullbase"][1]
    out: dict[str, np.ndarray[tuple[int], np.dtype[np.float64]]] = {}
    known = [name for name in _TRUNK if name in own]
    for k, name in enumerate(ours.names):
        above = ours.names[ours.parents[k]] if ours.parents[k] >= 0 else None
        if name in own:
            out[name] = own[name]
        elif name in _TRUNK:
            index = _TRUNK.index(name)
            low = max((n for n in known if _TRUNK.index(n) < index), key=_TRUNK.index)
            high = min((n for n in known if _TRUNK.index(n) > index), key=_TRUNK.index)
            share = (place[name][1] - place[low][1]) / (place[high][1] - place[low][1])
            out[name] = own[low] + share * (own[high] - own[low])
        elif name.endswith("_sternoclavicular"):
            shoulder, chest = own[f"{name[0]}_shoulder"], out["vt4"]
            out[name] = np.array([0.14 * shoulder[0], shoulder[1] + 0.05 * (shoulder[1] - chest[1]), shoulder[2]])
        else:  # toes, face, braid
            assert above is not None
            out[name] = out[above] + tall * (place[name] - place[above])
            if name.endswith("_metatarsal"):
                out[name][1] = min(0.33 * out[above][1], out[name][1])
    new = np.array([out[name] for name in ours.names])
    return Skeleton.from_rest(ours.names, ours.parents, new)


# The way in: a character by name, or of a file.

DATA = PACKAGE / "character" / "data"
DANCER = "dancer"  # the default character
IN_HEELS = "dancer-heels"  # the same dancer with the shoes of heels.glb
BUILT_IN = (DANCER, "mannequin", IN_HEELS)
_SHOES = ("left shoe", "right shoe", "shoes")  # meshes of the dancer that heels replace
SUFFIXES = (".glb", ".vrm")


@cache
def load_dancer() -> Character:
    """Return the project's own dancer, on the joints of `dance.rig.skeleton.dancer_skeleton`.

    The shoes have the configured colours.
    Every call returns the same object, because reading the textures takes 0.1 s.
    """
    return _built_in(DANCER)


def load_character(name_or_path: str) -> Character:
    """Return the character named `name_or_path` ("dancer", "mannequin"), or the one in that .glb or .vrm file.

    A user's character is fitted to the rig, see `fit_character`.

    Raises UsageError for an unknown name, FileError for a file that cannot be used; both are one line.
    """
    if name_or_path in BUILT_IN:
        return _built_in(name_or_path)
    path = Path(name_or_path)
    if path.suffix.lower() not in SUFFIXES:
        characters = choose_text(name_or_path, BUILT_IN, "a .glb or .vrm file")
        raise UsageError(f"there is no character {name_or_path!r}{characters}")
    return fit_character(path)


def check_character(name_or_path: str) -> str:
    """Check that `load_character` accepts a character; return its name, or the absolute path of its file.

    Raises the errors of `load_character`, before the slow work begins.
    """
    if name_or_path in BUILT_IN:
        return name_or_path
    load_character(name_or_path)
    return str(Path(name_or_path).absolute())


def name_in_gait(name: str, gait: str) -> str:
    """Return the name of the character to draw; the project's dancer wears heels if the gait is `heels`."""
    return IN_HEELS if name == DANCER and gait == "heels" else name


def _built_in(name: str) -> Character:
    character = read_character(DATA / f"{DANCER if name == IN_HEELS else name}.glb")
    if name == IN_HEELS:
        kept = (mesh for mesh in character.meshes if mesh.name not in _SHOES)
        character = replace(character, name=name, meshes=(*kept, *read_character(DATA / "heels.glb").meshes))
    return replace(character, meshes=tuple(_coloured(mesh) for mesh in character.meshes))


def _coloured(mesh: Mesh) -> Mesh:
    """Return the mesh with the limb's colour of configs/colours.yaml, if its material is named after a limb."""
    name = mesh.material.name
    if name not in LIMBS:
        return mesh
    r, g, b = (c / 255 for c in getattr(limb_colours(), name))
    return replace(mesh, material=Material(name, (r, g, b, 1.0)))
