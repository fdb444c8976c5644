"""Build the dancer, her heels and the mannequin of the package (`make character`): meshes, weights, paint, GLB.

Needs the development extra `character` (scikit-image); the program itself only reads the result. The same sources and
library versions give the same bytes.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path

import build_character_body as body
import build_character_head as head
import numpy as np
from build_character_bake import Atlas
from build_character_loft import Lofted
from build_character_mesh import Triangles, even, gradient, surface
from build_character_parts import Part, heel_parts, mannequin_parts, parts
from build_character_sdf import Array, blend, both
from build_character_skin import ORDER, Skin, four, with_elbows
from build_character_socks import Cut, cut_level, on_side

from dancetutor_cli.character.mesh import Character, Material, Mesh
from dancetutor_cli.dance.rig.skeleton import FINGERS, KNUCKLES
from dancetutor_cli.feet.limbs import limb_colours
from dancetutor_cli.formats.glb import write_glb

DATA = Path(__file__).resolve().parent.parent / "dancetutor_cli" / "character" / "data"
MIRROR = np.array([-1.0, 1.0, 1.0])
AO_STEPS = (0.008, 0.020, 0.040, 0.070)


def reference() -> Skin:
    """Heat weights on the whole body as one closed skin."""
    feet = both(body.shoe_upper())
    shape = blend(0.02, body.torso(), both(body.leg()), both(body.arm()), body.chest_skin(), head.head(), feet)
    return Skin(*surface(shape, (-0.68, -0.02, -0.18), (0.68, 1.76, 0.22), 0.009, even(0.013)))


def weights_of(part: Part, made: Lofted, skin: Skin) -> Array:
    """Weights (v, joints) of a part as modelled: for mirrored parts, of the left one."""
    points, normals, _ = made
    out = np.zeros((len(points), len(ORDER)))
    if part.skin == "heat":
        normals = gradient(part.on, points) if part.on else normals
        out = with_elbows(skin.at(points, normals), points)
        return _with_fingers(_with_ankles(out, points) if part.ankles else out, points)
    if part.skin == "foot":
        toes = _smooth((points[:, 2] - 0.078) / 0.040)
        shin = _smooth((points[:, 1] - 0.072) / 0.090)
        out[:, ORDER["l_knee"]] = shin
        out[:, ORDER["l_metatarsal"]] = toes * (1 - shin)
        out[:, ORDER["l_talocrural"]] = (1 - toes) * (1 - shin)
    elif part.skin == "jaw":
        jaw = head.below_the_lip(points)
        out[:, ORDER["temporomandibular"]], out[:, ORDER["skullbase"]] = jaw, 1 - jaw
    elif part.skin == "braid":
        at = np.interp(-points[:, 1], [-p[1] for p in head.BRAID], np.arange(4.0)) - 0.5
        at = np.where(points[:, 1] < head.BRAID[3][1], 2.5 + (head.BRAID[3][1] - points[:, 1]) / 0.1, at)
        for k in range(4):
            spread = np.clip(1 - np.abs(np.clip(at, 0, 3) - k), 0, 1)
            out[:, ORDER[f"braid{k + 1}"]] = _smooth(spread)
        out /= out.sum(1, keepdims=True)
    else:
        out[:, ORDER[part.skin if part.skin in ORDER else f"l_{part.skin}"]] = 1
    return out


def _smooth(t: Array) -> Array:
    t = np.clip(t, 0, 1)
    return np.asarray(t * t * (3 - 2 * t))


def _with_ankles(weights: Array, points: Array) -> Array:
    """Near the ankle the leggings move exactly as the shoe around them does."""
    for side, sign in (("l", 1), ("r", -1)):
        here = (points[:, 1] < 0.19) & (points[:, 0] * sign > 0)
        knee, ankle = ORDER[f"{side}_knee"], ORDER[f"{side}_talocrural"]
        shin = _smooth((points[here, 1] - 0.072) / 0.090)
        weights[here] = 0
        weights[here, knee], weights[here, ankle] = shin, 1 - shin
    return weights


def _with_fingers(weights: Array, points: Array) -> Array:
    """Fingers, all but thumbs, bend at the knuckles and at their middle joints."""
    across = [row[1] for row in body.HAND[::-1]]
    for side, sign in (("l", 1.0), ("r", -1.0)):
        hand, first, second = (ORDER[f"{side}_{name}"] for name in ("radiocarpal", KNUCKLES, FINGERS))
        here = np.flatnonzero(weights[:, hand] > 0.0)
        on_left = points[here] * [sign, 1.0, 1.0]
        away = on_left - body.SHOULDER
        along, aside = away @ body.ARM - body.WRIST_ALONG, away @ body.FRONT - body.WRIST_AHEAD
        knuckle, middle = (np.interp(aside, across, at) for at in body.finger_joints())
        no_thumb = _smooth(0.5 + (body.thumb()(on_left) - body.fingers()(on_left)) / 0.005)
        finger = _smooth((along - knuckle + 0.010) / 0.020) * no_thumb
        tip = _smooth((along - middle + 0.009) / 0.018)
        whole = weights[here, hand].copy()
        weights[here, hand] = whole * (1 - finger)
        weights[here, first], weights[here, second] = whole * finger * (1 - tip), whole * finger * tip
    return weights


def mirrored_weights(weights: Array) -> Array:
    """Left joints' weights moved to the right ones and back."""
    swap = [ORDER.get({"l": "r", "r": "l"}[n[0]] + n[1:], j) if n[:2] in ("l_", "r_") else j for n, j in ORDER.items()]
    return weights[:, swap]


def occlusion(points: Array, normals: Array, strength: float) -> Array:
    """How open each place is, 1 to about 0.6, from the distance function along its normal."""
    arm_side = both(blend(0.0, body.arm()))
    shapes = [
        body.torso(),
        both(body.leg()),
        arm_side,
        body.chest_skin(),
        head.head(),
        head.hair(),
        both(body.shoe_upper()),
    ]
    dark = np.zeros(len(points))
    for k, step in enumerate(AO_STEPS):
        p = points + step * normals
        d = np.min([s(p) for s in shapes], axis=0)
        dark += np.clip(1 - d / step, 0, 1.2) * 0.5**k
    return np.round(np.clip(1.04 - strength * dark, 0.62, 1.0), 5)


@dataclass(frozen=True)
class Piece:
    """A part made and skinned: slot is its place in the atlas, -1 for a part in a limb's colour; side : whose it is."""

    part: Part
    points: Array
    normals: Array
    triangles: Triangles
    weights: Array
    slot: int
    sides: tuple[str, ...] = ("left",)


def assemble(name: str, parts_: list[Part], skin: Skin, atlas: Atlas) -> Character:
    """Make all parts, skin them, paint their atlas and join what is drawn together."""
    pieces = [piece for part in parts_ for piece in _pieces(part, skin, atlas)]
    uv = atlas.pack()
    material = Material(name, (1.0, 1.0, 1.0, 1.0), atlas.paint(uv))
    meshes: dict[str, list[Mesh]] = {}
    for piece in pieces:
        for side in piece.sides:
            tint = f"{side}_{piece.part.tint}" if piece.part.tint else ""
            place = uv[piece.slot] if not tint else np.zeros((len(piece.points), 2))
            mesh = _mesh(piece, piece.part.mirror and side == "right", place, tinted(tint) if tint else material)
            meshes.setdefault(f"{side} {piece.part.name}" if tint else piece.part.mesh, []).append(mesh)
    print(f"{name}: atlas at {atlas.scale:.2f} of the wanted density, {len(atlas.charts)} charts")
    return character(name, [merged(mesh, group) for mesh, group in meshes.items()])


def _pieces(part: Part, skin: Skin, atlas: Atlas) -> list[Piece]:
    """The part and its socks: what is between two heights wears the feet's colours, what is below is in the shoes."""
    made = part.make()
    weights = weights_of(part, made, skin)
    if part.socks is None:
        return [_piece(part, made, weights, atlas)]
    bottom, top = part.socks
    above, below = cut_level(Cut(*made, (weights,)), top)
    socks, _ = cut_level(below, bottom)
    worn = replace(part, name="long sock", tint="foot", socks=None)
    sides = [(name, on_side(socks, sign)) for name, sign in (("left", 1), ("right", -1))]
    return [
        _piece(part, above[:3], above.others[0], atlas),
        *(Piece(worn, s.points, s.normals, s.triangles, s.others[0], -1, (name,)) for name, s in sides),
    ]


def _piece(part: Part, made: Lofted, weights: Array, atlas: Atlas) -> Piece:
    points, normals, triangles = made
    sides = ("left", "right") if part.mirror else ("left",)
    if part.tint:
        return Piece(part, points, normals, triangles, weights, -1, sides)
    shade = occlusion(points, normals, part.shade) if part.shade else np.ones(len(points))
    source, triangles = atlas.add(made, part.density, part.paint, shade)
    return Piece(part, points[source], normals[source], triangles, weights[source], len(atlas.parts) - 1, sides)


def _mesh(piece: Piece, mirror: bool, uv: Array, material: Material) -> Mesh:
    flip = MIRROR if mirror else np.ones(3)
    triangles = piece.triangles[:, ::-1] if mirror else piece.triangles
    joints, weights = four(mirrored_weights(piece.weights) if mirror else piece.weights)
    points, normals = (piece.points * flip).astype(np.float32), (piece.normals * flip).astype(np.float32)
    uv, triangles = uv.astype(np.float32), triangles.astype(np.int32)
    return Mesh(piece.part.name, points, normals, uv, triangles, joints, weights, material)


def tinted(limb: str) -> Material:
    """The colour of a limb, from configs/colours.yaml; loading sets it anew."""
    r, g, b = (c / 255 for c in getattr(limb_colours(), limb))
    return Material(limb, (r, g, b, 1.0))


def merged(name: str, group: list[Mesh]) -> Mesh:
    """Several meshes of one material as one."""
    at = np.cumsum([0, *(len(m.positions) for m in group)])
    triangles = np.concatenate([m.triangles + k for m, k in zip(group, at, strict=False)])
    columns = [
        np.concatenate([getattr(m, f) for m in group]) for f in ("positions", "normals", "uv", "joints", "weights")
    ]
    positions, normals, uv, joints, weights = columns
    return Mesh(name, positions, normals, uv, triangles.astype(np.int32), joints, weights, group[0].material)


def character(name: str, meshes: list[Mesh]) -> Character:
    """Meshes bound to the dancer's skeleton at rest."""
    inverse_bind = np.tile(np.eye(4), (len(ORDER), 1, 1))
    inverse_bind[:, :3, 3] = -body.SKELETON.rest
    return Character(name, body.SKELETON, tuple(meshes), inverse_bind)


def main(folder: Path = DATA) -> None:
    """Write dancer.glb, mannequin.glb and heels.glb into the package, or into the folder given."""
    folder.mkdir(parents=True, exist_ok=True)
    skin = reference()
    for made in (
        assemble("dancer", parts(), skin, Atlas(2048, 1024)),
        assemble("mannequin", mannequin_parts(), skin, Atlas(1024, 512)),
        assemble("heels", heel_parts(), skin, Atlas(256, 256)),
    ):
        path = folder / f"{made.name}.glb"
        write_glb(path, made)
        for mesh in made.meshes:
            print(f"  {mesh.name}: {len(mesh.positions)} vertices, {len(mesh.triangles)} triangles")
        print(f"  {sum(len(m.triangles) for m in made.meshes)} triangles, {path.stat().st_size} bytes")


if __name__ == "__main__":
    main(*(Path(a) for a in sys.argv[1:2]))
