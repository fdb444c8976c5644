"""Two who dance: a character with a second one beside it, the same but for the colour of the clothes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.mesh import Character, Mesh
from dancetutor_cli.colours import LIMBS, PartnerColours, partner_colours

_SEEN = 0.01  # part of the textures that has to change for two to be told apart
PREFIX = "partner_"  # of the names of the second one's joints: who asks for a joint by name gets the first one's


def with_partner(character: Character) -> Character:
    """Both as one character of twice as many joints, the second one's behind the first one's.

    Their joints' matrices come from two motions: the joint tree of both only says where everything is at rest.
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
    """The second one alone: the same in clothes of other colours."""
    paint = _Paint.of(character, partner_colours())
    return replace(character, meshes=tuple(_other(mesh, 0, paint) for mesh in character.meshes))


@dataclass(frozen=True, slots=True)
class _Paint:
    """The second one's textures, by the `id` of the first one's (meshes share them); tint : where no hue is turned"""

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
    """Colours, uint8 (h, w, 3), those of some hues turned on the colour circle; others and greys stay."""
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
