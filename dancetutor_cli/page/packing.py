"""The dancer for the page: her mesh and her motion as in a .glb, in fewer bytes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.partner import partner_of
from dancetutor_cli.formats.thinning import clocks
from dancetutor_cli.page.blob import Blob
from dancetutor_cli.pictures import picture_bytes
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.skeleton import Skeleton
from dancetutor_cli.rig.soles import palm_points
from dancetutor_cli.video.scene.geometry import Packed, pack
from dancetutor_cli.video.scene.props import JOINT, bar_matrix, with_bar

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.motion.baked import Bar, Motion

TICK = 1e-5  # seconds and metres of the smallest step of a time and of a place
QUALITY = 86  # of the texture as WebP
STILL = -2  # "parent" of a joint that no bone carries: the bar's
_HEEL, _TOE = (0.0, -0.022), (0.0, 0.022)  # beyond ankle and ball, as in `video.scene.scene`


def pack_body(blob: Blob, character: Character, bar: Bar | None, floor: float, pair: bool = False) -> dict[str, Any]:
    """Add a character's mesh to the blob; returns what the page must know about it.

    pair : the skins of the second of two are added, too, behind the first one's
    bar : stands beside her, down to the height `floor`. Places have 1/65535 of the mesh's extent, normals 1/127.
    """
    whole = with_bar(character, bar, floor)
    mesh = pack(whole)
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    size = np.maximum(high - low, 1e-6)
    place = np.rint((mesh.positions - low) / size * 65535)
    blob.add("mesh.position", place.T, "u2", 1)
    for name, values in (("normal", mesh.normals), ("hull", mesh.hull)):
        blob.add(f"mesh.{name}", np.rint(np.clip(values, -1, 1) * 127).T, "i1")
    span = np.array([mesh.uv.min(axis=0), np.maximum(np.ptp(mesh.uv, axis=0), 1e-6)])
    blob.add("mesh.uv", np.rint((mesh.uv - span[0]) / span[1] * 65535).T, "u2", 1)
    blob.add("mesh.joints", mesh.joints.T, "u1")
    blob.add("mesh.weights", _bytes_that_sum(mesh.weights).T, "u1")
    triangles, side = _by_side(mesh, whole.skeleton)
    blob.add("mesh.triangles", triangles.T, "u4", 1)
    skins = [mesh.skins, *([pack(with_bar(partner_of(character), bar, floor)).skins] if pair else [])]
    images = [pyramid[0] for one in skins for pyramid in one.pyramids]
    for number, image in enumerate(images):
        blob.add_bytes(f"skin.{number}", _webp(image))
    material = mesh.material[triangles[:, 0]]
    skeleton = whole.skeleton
    parents, offsets = skeleton.parents.copy(), skeleton.offsets.copy()
    if bar is not None:
        parents[skeleton.index(JOINT)], offsets[skeleton.index(JOINT)] = STILL, bar_matrix(bar)[:3, 3]
    return {
        "low": low.tolist(),
        "size": size.tolist(),
        "uv": span.tolist(),
        "vertices": len(mesh.positions),
        "skins": len(images),
        "parts": [
            {
                "first": first,
                "count": count,
                "feet": first < mesh.feet,
                "side": int(side[first]),
                "limb": bool(mesh.skins.limb[material[first]]),
                # of the dancer, and of a second one
                "skin": [int(one.of_mesh[material[first]]) + k * len(skins[0].pyramids) for k, one in enumerate(skins)],
                "tint": [one.tint[material[first]].tolist() for one in skins],
            }
            for first, count in _runs(material, side)
        ],
        "names": list(skeleton.names),
        "parents": parents.tolist(),
        "offsets": offsets.round(7).tolist(),
        "inverseBind": whole.inverse_bind[:, :3].reshape(len(parents), 12).round(7).tolist(),
        "marks": marks(character.skeleton),
    }


def marks(skeleton: Skeleton) -> list[dict[str, Any] | None]:
    """The lines on the ground of left foot, right foot, left palm, right palm: two joints and places beside them."""
    rest, out = skeleton.rest, list[dict[str, Any] | None]()
    for side in "lr":
        if f"{side}_talocrural" not in skeleton.names or f"{side}_metatarsal" not in skeleton.names:
            out.append(None)
            continue
        ankle, ball = skeleton.index(f"{side}_talocrural"), skeleton.index(f"{side}_metatarsal")
        ends = [[dx, -float(rest[j, 1]), dz] for j, (dx, dz) in ((ankle, _HEEL), (ball, _TOE))]
        out.append({"joints": [ankle, ball], "at": ends})
    needed = [f"{side}_{part}" for side in "lr" for part in ("shoulder", "elbow", "radiocarpal")]
    if not set(needed) <= set(skeleton.names):
        return [*out, None, None]
    palms = [{"joints": [p.joint] * 2, "at": [p.offset.tolist()] * 2} for p in palm_points(skeleton)]
    return [*out, *palms]


def pack_motion(blob: Blob, motion: Motion, name: str) -> dict[str, Any]:
    """Add a motion; joints that need the same keys share their times (`formats.thinning`), as in a .glb."""
    groups = []
    for number, clock in enumerate(clocks(motion)):
        times = motion.times[clock.keep]
        turned = np.stack([quat.continuous(motion.rotations[clock.keep, j]) for j in clock.joints])  # (j, k, 4)
        short = np.rint(turned * 32767).transpose(0, 2, 1)  # (j, 4, k)
        blob.add(f"{name}.time{number}", np.rint(times / TICK), "i4", 2)
        blob.add(f"{name}.turn{number}", short, "i2", 2)
        groups.append({"joints": list(clock.joints)})
        if number == 0:
            blob.add(f"{name}.root", np.rint(motion.root[clock.keep].T / TICK), "i4", 2)
    return {"name": name, "groups": groups, "start": float(motion.times[0]), "end": float(motion.times[-1])}


def _bytes_that_sum(weights: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Weights (v, 4) as bytes whose rows sum to 255: the largest takes what rounding leaves."""
    out = np.rint(weights * 255).astype(np.int64)
    rows = np.arange(len(out))
    out[rows, out.argmax(axis=1)] += 255 - out.sum(axis=1)
    return out.astype(np.uint8)


def _by_side(mesh: Packed, skeleton: Skeleton) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Triangles (t, 3), the feet's first, of these the left one's; and 0 left, 1 right, 2 no foot."""
    right = np.array([name.startswith("r_") for name in skeleton.names])
    mostly = (mesh.weights * right[mesh.joints]).sum(axis=1) > 0.5
    side = np.where(np.arange(len(mesh.triangles)) < mesh.feet, mostly[mesh.triangles[:, 0]], 2)
    order = np.argsort(side, kind="stable")
    return mesh.triangles[order], side[order].astype(np.int64)


def _runs(material: NDArray[np.int32], side: NDArray[np.int64]) -> list[tuple[int, int]]:
    """First triangle and how many of each run of triangles of one material and one side."""
    changes = np.flatnonzero((np.diff(material) != 0) | (np.diff(side) != 0)) + 1
    cuts = [0, *changes.tolist(), len(material)]
    return list(zip(cuts[:-1], np.diff(cuts).tolist(), strict=True))


def _webp(image: NDArray[np.uint8]) -> bytes:
    return picture_bytes(image[..., :3], ".webp", quality=QUALITY, method=6)
