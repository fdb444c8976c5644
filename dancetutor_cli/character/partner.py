"""Two who dance: a character with a second one beside it, the same but for the colour of the clothes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.mesh import Character, Mesh
from dancetutor_cli.colours import PartnerColours, partner_colours

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
    painted: dict[int, NDArray[np.uint8]] = {}  # meshes share textures, and do so after it
    others = tuple(_other(mesh, count, painted) for mesh in character.meshes)
    return replace(
        character,
        name=f"two of {character.name}",
        skeleton=skeleton,
        meshes=(*character.meshes, *others),
        inverse_bind=np.concatenate((character.inverse_bind, character.inverse_bind)),
    )


def _other(mesh: Mesh, count: int, painted: dict[int, NDArray[np.uint8]]) -> Mesh:
    colours, material = partner_colours(), mesh.material
    texture = material.texture
    if texture is not None:
        if id(texture) not in painted:
            painted[id(texture)] = np.dstack((turned(texture[..., :3], colours), texture[..., 3]))
        texture = painted[id(texture)]
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
