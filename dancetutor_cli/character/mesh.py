"""A character: triangle meshes skinned to a skeleton, with coloured feet, and with a second dancer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.feet.limbs import LIMBS, PartnerColours, limb_colours, partner_colours


@dataclass(frozen=True, slots=True)
class Material:
    """Colour of a mesh: base_color times texture, as in glTF. base_color : sRGB (4,) in 0..1

    name : a limb of `feet.limbs.LimbColours` gives our own characters' meshes that limb's colour when they are loaded
    texture : uint8 (h, w, 4) sRGB, or None; meshes that share a texture share the array
    cutoff : least alpha that is drawn, None if alpha is ignored; double_sided : whether back faces are visible. The
    renderers support neither; `surfaces.drawable` converts both to meshes
    """

    name: str
    base_color: tuple[float, float, float, float]
    texture: NDArray[np.uint8] | None = None
    cutoff: float | None = None
    double_sided: bool = False


@dataclass(frozen=True, slots=True)
class Mesh:
    """v vertices, t triangles, in the binding pose.

    positions, normals : float32 (v, 3); uv : float32 (v, 2), (0, 0) the top left of the texture as in glTF
    triangles : int32 (t, 3), counter-clockwise seen from outside
    joints : uint16 (v, 4), indices into the character's skeleton; weights : float32 (v, 4), rows sum to 1
    colors : float32 (v, 3), linear 0..1, of a file whose vertices are coloured; `surfaces.drawable` makes paint of them
    """

    name: str
    positions: NDArray[np.float32]
    normals: NDArray[np.float32]
    uv: NDArray[np.float32]
    triangles: NDArray[np.int32]
    joints: NDArray[np.uint16]
    weights: NDArray[np.float32]
    material: Material
    colors: NDArray[np.float32] | None = None


@dataclass(frozen=True, slots=True)
class Character:
    """Meshes and their skeleton. inverse_bind : float64 (j, 4, 4), world to joint in the binding pose."""

    name: str
    skeleton: Skeleton
    meshes: tuple[Mesh, ...]
    inverse_bind: NDArray[np.float64]


def rest_vertices(character: Character) -> NDArray[np.float64]:
    """Return all vertices in the rest pose, (v, 3), mesh after mesh."""
    matrices = character.inverse_bind.copy()
    matrices[:, :3, 3] += character.skeleton.rest
    out = []
    for mesh in character.meshes:
        skin = np.einsum("vk,vkij->vij", mesh.weights.astype(np.float64), matrices[mesh.joints])
        out.append(np.einsum("vij,vj->vi", skin[:, :3, :3], mesh.positions) + skin[:, :3, 3])
    return np.concatenate(out)


# The feet of a character and their colours, which a user's character gets, too.

FOOT = ("talocrural", "metatarsal")  # joints of a foot, after l_ or r_
SIDES = {"l": "left_foot", "r": "right_foot"}  # of `LimbColours`


def on_foot(character: Character, mesh: Mesh, side: str) -> NDArray[np.bool_]:
    """Whether each vertex of a mesh, (v,), is moved mostly by the foot of a side, "l" or "r"."""
    names = character.skeleton.names
    joints = [names.index(name) for part in FOOT if (name := f"{side}_{part}") in names]
    return np.asarray((mesh.weights * np.isin(mesh.joints, joints)).sum(axis=1) > 0.5)


def with_foot_colours(character: Character) -> Character:
    """Return the character with feet in the colours of the notes' markers.

    A foot is the triangles that the ankle and the toes move; meshes are cut there. The program's characters have these
    colours already.
    """
    colours = limb_colours()
    if any(mesh.material.name in SIDES.values() for mesh in character.meshes):
        return character
    meshes: list[Mesh] = []
    for mesh in character.meshes:
        rest = np.ones(len(mesh.triangles), dtype=bool)
        for side, limb in SIDES.items():
            foot = np.asarray(on_foot(character, mesh, side)[mesh.triangles].all(axis=1))
            if foot.any():
                r, g, b = (c / 255 for c in getattr(colours, limb))
                meshes.append(_part(mesh, foot, limb, Material(limb, (r, g, b, 1.0))))
                rest &= ~foot
        if rest.all():
            meshes.append(mesh)
        elif rest.any():
            meshes.append(_part(mesh, rest, "", mesh.material))
    return replace(character, meshes=tuple(meshes))


def _part(mesh: Mesh, triangles: NDArray[np.bool_], name: str, material: Material) -> Mesh:
    """Return some triangles of a mesh, with only the vertices that they use."""
    kept, place = np.unique(mesh.triangles[triangles], return_inverse=True)
    part = take(mesh, kept, place.reshape(-1, 3))
    return replace(part, name=f"{mesh.name} {name}".strip(), material=material)


def take(mesh: Mesh, vertices: NDArray[np.integer[Any]], triangles: NDArray[np.int64]) -> Mesh:
    """Return the mesh with some of its vertices, in a new order and possibly repeated."""
    columns = {f: getattr(mesh, f)[vertices] for f in ("positions", "normals", "uv", "joints", "weights")}
    colors = None if mesh.colors is None else mesh.colors[vertices]
    return replace(mesh, **columns, triangles=triangles.astype(np.int32), colors=colors)


# Two dancers: a character and a second one, which differs only in the colour of the clothes.

_SEEN = 0.01  # least share of the textures that must change to distinguish two dancers
PREFIX = "partner_"  # prefix of the second dancer's joints, so that a search by name finds the first dancer's


def with_partner(character: Character) -> Character:
    """Return both dancers as one character with twice as many joints, the second dancer's after the first's.

    The matrices of joints come from two motions; the common joint tree is used only for the rest pose.
    """
    one, count = character.skeleton, len(character.skeleton.names)
    parents = np.where(one.parents < 0, 0, one.parents + count).astype(one.parents.dtype)
    offsets = one.offsets.copy()
    offsets[0] -= one.rest[0]
    skeleton = replace(
        one,
        names=(*one.names, *(PREFIX + name for name in one.names)),
        parents=np.concatenate((one.parents, parents)),
        offsets=np.vstack((one.offsets, offsets)),
    )
    paint = _Paint.of(character, partner_colours())
    others = tuple(_other(mesh, count, paint) for mesh in character.meshes)
    return replace(
        character,
        name=f"two of {character.name}",
        skeleton=skeleton,
        meshes=(*character.meshes, *others),
        inverse_bind=np.concatenate((character.inverse_bind, character.inverse_bind)),
    )


def partner_of(character: Character) -> Character:
    """Return the second dancer alone: the same character in clothes of other colours."""
    paint = _Paint.of(character, partner_colours())
    return replace(character, meshes=tuple(_other(mesh, 0, paint) for mesh in character.meshes))


@dataclass(frozen=True, slots=True)
class _Paint:
    """The second dancer's textures, by the `id` of the first's (meshes share them); tint : used if no hue is turned"""

    textures: Mapping[int, NDArray[np.uint8]]
    tint: tuple[float, float, float]

    @staticmethod
    def of(character: Character, colours: PartnerColours) -> _Paint:
        textures = {id(t): t for mesh in character.meshes if (t := mesh.material.texture) is not None}
        painted = {key: np.dstack((turned(t[..., :3], colours), t[..., 3])) for key, t in textures.items()}
        differs = sum(int((painted[key] != t).any(axis=2).sum()) for key, t in textures.items())
        plain = differs < _SEEN * sum(t.shape[0] * t.shape[1] for t in textures.values()) or not textures
        r, g, b = (level / 255 for level in colours.tint)
        return _Paint(painted, (r, g, b) if plain else (1.0, 1.0, 1.0))


def _other(mesh: Mesh, count: int, paint: _Paint) -> Mesh:
    material = mesh.material
    texture = None if material.texture is None else paint.textures[id(material.texture)]
    if material.name not in LIMBS:  # shoes and wristbands say whose limb it is
        r, g, b, alpha = material.base_color
        material = replace(material, base_color=(r * paint.tint[0], g * paint.tint[1], b * paint.tint[2], alpha))
    return replace(
        mesh,
        name=PREFIX + mesh.name,
        joints=(mesh.joints + count).astype(mesh.joints.dtype),
        material=replace(material, texture=texture),
    )


def turned(rgb: NDArray[np.uint8], colours: PartnerColours) -> NDArray[np.uint8]:
    """Return colours, uint8 (h, w, 3), with some hues turned on the colour circle; other colours and greys stay."""
    values = rgb.astype(np.float32) / 255
    high, low = values.max(axis=2), values.min(axis=2)
    span = high - low
    safe = np.where(span > 0, span, 1)
    r, g, b = (values[..., k] for k in range(3))
    hue = np.select([high == r, high == g], [(g - b) / safe % 6, (b - r) / safe + 2], (r - g) / safe + 4) * 60
    first, last = colours.hues
    ours = (span > colours.least * high) & (hue >= first) & (hue <= last)
    hue = np.where(ours, (hue + colours.turn) % 360, hue)
    sector, chroma = hue / 60, span
    second = chroma * (1 - np.abs(sector % 2 - 1))
    zero = np.zeros_like(second)
    place = sector.astype(np.int64) % 6
    table = [(chroma, second, zero), (second, chroma, zero), (zero, chroma, second)]
    table += [(zero, second, chroma), (second, zero, chroma), (chroma, zero, second)]
    out = np.stack([np.choose(place, [row[k] for row in table]) for k in range(3)], axis=2) + low[..., None]
    return np.where(ours[..., None], np.round(out * 255), rgb).astype(np.uint8)
