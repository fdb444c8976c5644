"""The content of a page as plain data: chart, feet, findings and passages, and the dancer in few bytes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.mesh import partner_of
from dancetutor_cli.dance.keys import joint_groups, reaches
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import palm_points
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.feet.limbs import Limb, hex_colour, limb_colours
from dancetutor_cli.feet.solver.techniques import moves_and_turns
from dancetutor_cli.film.overlay.sprites import callout_words, highway_style
from dancetutor_cli.film.scene.geometry import ABOVE, PackedMeshes, pack
from dancetutor_cli.film.scene.props import JOINT, bar_matrix, with_bar
from dancetutor_cli.film.scene.scene import PANEL, SOLE_RADIUS, TOE_AHEAD, Scene
from dancetutor_cli.film.scene.shared import RING_SHARE, SHADOW_FADE
from dancetutor_cli.page.document import Blob
from dancetutor_cli.run.languages import load_language
from dancetutor_cli.run.pictures import picture_bytes

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.dance.motion import Bar, Motion
    from dancetutor_cli.feet.pads import Pad
    from dancetutor_cli.feet.play import Play
    from dancetutor_cli.film.notes import NoteTrack
    from dancetutor_cli.lint.findings import Finding


# The dancer for the page, in few bytes: her mesh as in a .glb, her motion on even clocks.

FAST, MEDIUM, SLOW = 120, 60, 30  # keys a second of legs and root, of arms, and of head and hair
FINEST, COARSEST, HAIR, GRIPPING = 0.001, 0.002, 0.005, 0.0003  # error of a joint: legs, others, hair, hands, metres
ROOT = 1e-4  # step of the root's rounded coordinates, metres
LEAST_W = 0.3  # smallest w of a rotation that is stored without w, which follows from x, y and z
SHORTEST = 0.05  # smallest reach of a joint that is assumed, metres
QUALITY = 86  # quality of the texture as WebP
STILL = -2  # "parent" of the bar's joint, which no bone carries


def pack_body(blob: Blob, character: Character, bar: Bar | None, floor: float, pair: bool = False) -> dict[str, Any]:
    """Add a character's mesh to the blob and return its description for the page.

    Positions are rounded to 1/65535 of the mesh's extent, normals to 1/127.

    bar : the bar beside the dancer, down to the height `floor`, metres
    pair : whether the skins of a second dancer are added after the first dancer's
    """
    whole = with_bar(character, bar, floor)
    mesh = pack(whole)
    ranges = _add_vertices(blob, mesh)
    triangles, side = _by_side(mesh, whole.skeleton)
    blob.add("mesh.triangles", triangles.T, "u4", 1)
    skins = [mesh.skins, *([pack(with_bar(partner_of(character), bar, floor)).skins] if pair else [])]
    images = [pyramid[0][..., :3] for one in skins for pyramid in one.pyramids]
    for number, image in enumerate(images):
        blob.add_bytes(f"skin.{number}", _webp(image.shape, image.tobytes()))
    material = mesh.material[triangles[:, 0]]
    skeleton = whole.skeleton
    parents, offsets = skeleton.parents.copy(), skeleton.offsets.copy()
    if bar is not None:
        parents[skeleton.index(JOINT)], offsets[skeleton.index(JOINT)] = STILL, bar_matrix(bar)[:3, 3]
    return {
        **ranges,
        "vertices": len(mesh.positions),
        "above": ABOVE,
        "skins": len(images),
        "parts": [
            {
                "first": first,
                "count": count,
                "feet": first < mesh.feet,
                "side": int(side[first]),
                "limb": bool(mesh.skins.limb[material[first]]),
                # Skins of the dancer and of a second dancer.
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


def _add_vertices(blob: Blob, mesh: PackedMeshes) -> dict[str, Any]:
    """Add the vertices of a mesh to the blob and return the ranges of positions and texture coordinates."""
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    size = np.maximum(high - low, 1e-6)
    place = np.rint((mesh.positions - low) / size * 65535)
    blob.add("mesh.position", place.T, "u2", 1)
    for name, values in (("normal", mesh.normals), ("hull", mesh.hull)):
        blob.add(f"mesh.{name}", np.rint(np.clip(values, -1, 1) * 127).T, "i1")
    span = np.array([mesh.uv.min(axis=0), np.maximum(np.ptp(mesh.uv, axis=0), 1e-6)])
    blob.add("mesh.uv", np.rint((mesh.uv - span[0]) / span[1] * 65535).T, "u2", 1)
    blob.add("mesh.joints", mesh.joints.T, "u1")
    blob.add("mesh.above", np.rint(mesh.above * (255 / ABOVE)), "u1")
    blob.add("mesh.weights", _bytes_that_sum(mesh.weights).T, "u1")
    return {"low": low.tolist(), "size": size.tolist(), "uv": span.tolist()}


def marks(skeleton: Skeleton) -> list[dict[str, Any] | None]:
    """Return the lines on the ground of left foot, right foot, left palm and right palm.

    Each line has two joints, and its ends in their axes.
    """
    rest, out = skeleton.rest, list[dict[str, Any] | None]()
    for side in "lr":
        if f"{side}_talocrural" not in skeleton.names or f"{side}_metatarsal" not in skeleton.names:
            out.append(None)
            continue
        ankle, ball = skeleton.index(f"{side}_talocrural"), skeleton.index(f"{side}_metatarsal")
        ends = [[0.0, -float(rest[j, 1]), dz] for j, dz in ((ankle, -TOE_AHEAD), (ball, TOE_AHEAD))]
        out.append({"joints": [ankle, ball], "at": ends})
    needed = [f"{side}_{part}" for side in "lr" for part in ("shoulder", "elbow", "radiocarpal")]
    if not set(needed) <= set(skeleton.names):
        return [*out, None, None]
    palms = [{"joints": [p.joint] * 2, "at": [p.offset.tolist()] * 2} for p in palm_points(skeleton)]
    return [*out, *palms]


def pack_motion(blob: Blob, motion: Motion, name: str) -> dict[str, Any]:
    """Add a motion to the blob and return its description for the page.

    Each group of joints has an even clock: fast for legs and root, slow for hair and head. Rotations are whole numbers
    of a step. One step moves the bones behind the joint by less than the error of its group, such as FINEST. For a
    joint that never turns far, w is left out, because it follows from x, y and z.
    """
    groups, every = [], joint_groups(motion.skeleton)
    touching = bool(motion.grips) or any(contact.limb >= Limb.LEFT_HAND for contact in motion.contacts)
    clocks = ((FAST, FINEST), (FAST, GRIPPING) if touching else (MEDIUM, COARSEST), (SLOW, HAIR), (SLOW, COARSEST))
    for number, (joints, (rate, off)) in enumerate(zip(every, clocks, strict=True)):
        if not joints:
            continue
        first, last = np.floor(motion.times[0] * rate), np.ceil(motion.times[-1] * rate)
        at = np.arange(first, last + 1) / rate
        rows, steps, full = [], [], []
        for joint, reach in zip(joints, reaches(motion.skeleton)[list(joints)].tolist(), strict=True):
            turned = quat.normalize(_at(motion.times, quat.continuous(motion.rotations[:, joint]), at))
            full.append(bool(turned[:, 0].min() < LEAST_W))
            steps.append(round(off / (2.0 * max(reach, SHORTEST)), 7))
            rows.append(np.rint((turned if full[-1] else turned[:, 1:]) / steps[-1]).T)
        blob.add(f"{name}.turn{number}", np.concatenate(rows), "i2", 2)
        group = {"number": number, "joints": list(joints), "rate": rate, "first": int(first)}
        groups.append({**group, "steps": steps, "full": full})
        if number == 0:
            blob.add(f"{name}.root", np.rint(_at(motion.times, motion.root, at).T / ROOT), "i4", 2)
    return {"name": name, "groups": groups, "start": float(motion.times[0]), "end": float(motion.times[-1])}


def _at(times: NDArray[np.float64], values: NDArray[np.float64], at: NDArray[np.float64]) -> NDArray[np.float64]:
    """Interpolate values (f, n) with keys `times` linearly at other times."""
    after = np.clip(np.searchsorted(times, at, side="right"), 1, len(times) - 1)
    share = np.clip((at - times[after - 1]) / (times[after] - times[after - 1]), 0.0, 1.0)[:, None]
    return (1.0 - share) * values[after - 1] + share * values[after]


def _bytes_that_sum(weights: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Return weights (v, 4) as bytes whose rows sum to 255; the largest weight absorbs the error of the rounding."""
    out = np.rint(weights * 255).astype(np.int64)
    rows = np.arange(len(out))
    out[rows, out.argmax(axis=1)] += 255 - out.sum(axis=1)
    return out.astype(np.uint8)


def _by_side(mesh: PackedMeshes, skeleton: Skeleton) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Return triangles (t, 3) sorted by side, and the side of each: 0 left foot, 1 right foot, 2 no foot."""
    right = np.array([name.startswith("r_") for name in skeleton.names])
    mostly = (mesh.weights * right[mesh.joints]).sum(axis=1) > 0.5
    side = np.where(np.arange(len(mesh.triangles)) < mesh.feet, mostly[mesh.triangles[:, 0]], 2)
    order = np.argsort(side, kind="stable")
    return mesh.triangles[order], side[order].astype(np.int64)


def _runs(material: NDArray[np.int32], side: NDArray[np.int64]) -> list[tuple[int, int]]:
    """Return the first triangle and the length of each run of triangles of one material and one side."""
    changes = np.flatnonzero((np.diff(material) != 0) | (np.diff(side) != 0)) + 1
    cuts = [0, *changes.tolist(), len(material)]
    return list(zip(cuts[:-1], np.diff(cuts).tolist(), strict=True))


@lru_cache(maxsize=4)  # the pages of a folder have one dancer
def _webp(shape: tuple[int, ...], pixels: bytes) -> bytes:
    image = np.frombuffer(pixels, dtype=np.uint8).reshape(shape)
    return picture_bytes(image, ".webp", quality=QUALITY, method=6)


# The content of a page as plain data: chart, feet, findings and passages, the dancer and the look of the films.

SCHEMA = 2  # version of the page's data, raised when an old page's script could not read them


@dataclass(frozen=True, slots=True)
class Content:
    """The content of one page.

    words : title, artist, badge, detail, credit, file, label, preset (text written by people, never markup)
    notes : the notes as the films draw them; ticks : int64 (n,), 1/48 beats, ticks of the notes
    beats : seconds of beats 0, 1, 2, ...
    motions : the motions of the dancer and of a second dancer if there is one, both for `character`'s joints
    second_name : the name of the second dancer's play; second_rows : the rows that she steps with other limbs
    pair : whether the dancers are the players of a chart for two, in one picture, the second in other colours
    language : the language in which the page begins, "" for the browser's
    passages : the hardest parts, ready for the page; flips : the changes by other feet in a row, for each row
    """

    words: Mapping[str, str]
    play: Play
    pad: Pad
    notes: NoteTrack
    ticks: Sequence[int]
    beats: Sequence[float]
    findings: Sequence[Finding]
    character: Character
    motions: Sequence[Motion]
    directions: Sequence[float | None]
    second_name: str = ""
    second_rows: Sequence[int] = ()
    passages: Sequence[Mapping[str, Any]] = ()
    flips: Sequence[Mapping[str, Any]] = ()
    pair: bool = False
    language: str = ""
    music: tuple[str, bytes] | None = field(default=None, repr=False)  # media type ("audio/ogg") and bytes of the file


def pack_content(content: Content) -> tuple[dict[str, Any], Blob]:
    """Return the page's data: an object for JSON, and the arrays that it names."""
    blob = Blob()
    scene = Scene(content.character, content.pad)
    bar = content.motions[0].bar if content.motions else None
    doc: dict[str, Any] = {
        "schema": SCHEMA,
        "language": content.language,
        "words": dict(content.words),
        "pad": {
            "names": list(content.pad.names),
            "panels": content.pad.panels.tolist(),
            "arrows": content.pad.arrows.tolist(),
            "centre": list(content.pad.centre),
            "directions": list(content.directions),
            "width": PANEL,
        },
        "style": _style(),
        "look": asdict(scene.look),
        "stage": pack_stage(scene),
        "body": pack_body(blob, content.character, bar, -scene.look.stage.pad_height, content.pair),
        "pair": content.pair,
        "motions": [pack_motion(blob, motion, f"motion{k}") for k, motion in enumerate(content.motions)],
        "second": {"name": content.second_name, "rows": list(content.second_rows)},
        "beats": [round(second, 6) for second in content.beats],
        "findings": [_finding(one) for one in content.findings],
        "passages": [dict(one) for one in content.passages],
        "flips": [dict(one) for one in content.flips],
    }
    doc["play"] = _pack_play(blob, content.play)
    _pack_notes(blob, content)
    if content.music is not None:
        doc["music"] = {"type": content.music[0], "bytes": len(content.music[1])}
    doc["arrays"] = blob.index
    return doc, blob


def pack_stage(scene: Scene) -> dict[str, Any]:
    """Return the faces of a scene's stage, and the box that is always in the picture."""
    low, high = scene.extent
    tiles = scene.stage.tiles
    return {
        "corners": scene.stage.corners.round(5).tolist(),
        "uv": scene.stage.uv.tolist(),
        "kinds": scene.stage.kinds.tolist(),
        "low": low.tolist(),
        "high": high.tolist(),
        "corner": list(tiles.corner),
        "panel": tiles.panel.tolist(),
        "arrow": tiles.arrow.tolist(),
        "tall": scene.dancer_height,
        "sole": SOLE_RADIUS,
        "shadow_fade": list(SHADOW_FADE),
        "ring_share": RING_SHARE,
    }


def _style() -> dict[str, Any]:
    style = highway_style()
    colours = {name: hex_colour(getattr(style, name)) for name in
               ("hold", "roll", "mine", "fake", "receptor", "background", "lane_line", "accent")}  # fmt: skip
    return {
        **colours,
        "players": [hex_colour(colour) for colour in style.players],
        "quantisation": [hex_colour(colour) for colour in style.quantisation.values()],
        "difficulty": {name: hex_colour(colour) for name, colour in style.difficulty.items()},
        "callout": {name: hex_colour(colour) for name, colour in style.callout.items()},
        # Words beside the notes, whose markers show the foot: the move's name if a film's words name the limb.
        "callouts": {
            name: name.replace("-", " ") if "{" in words else words
            for name, words in callout_words(load_language()).items()
        },
        "limbs": [hex_colour(colour) for colour in limb_colours().by_limb],
        "limbs_rgb": [list(colour) for colour in limb_colours().by_limb],
        # The mark on an arrow's tail, in sizes of an arrow: distance from its middle, straight and diagonal, and size.
        "mark": {"aside": [round(far / style.arrow, 4) for far in style.mark_aside], "size": style.mark_tail / 2},
        "flash": style.flash_seconds,
        "panel": style.panel_seconds,
    }


def _pack_play(blob: Blob, play: Play) -> dict[str, Any]:
    rows, columns = play.rows, play.rows.steps.shape[1]
    blob.add("row.second", rows.second, "f8")
    blob.add("row.tick", rows.tick, "i4", 1)
    blob.add("row.steps", rows.steps.reshape(-1), "u1")
    blob.add("row.mines", rows.mines.reshape(-1), "u1")
    blob.add("row.limb", play.limb.reshape(-1), "i1")
    blob.add("row.part", play.part.reshape(-1), "u1")
    blob.add("row.feet", play.feet.reshape(-1), "i1")
    blob.add("row.facing", play.facing, "f4")
    blob.add("row.cost", play.cost.sum(axis=1), "i4")
    margin = np.full(len(rows), -1) if play.margin is None else play.margin
    blob.add("row.margin", np.minimum(margin, 2**31 - 1), "i4")
    told = moves_and_turns(play)
    names = sorted({name for moves in told for name in moves})
    return {
        "columns": columns,
        "preset": play.preset,
        "total": play.total,
        "names": names,
        "moves": [[names.index(name) for name in moves] for moves in told],
    }


def _pack_notes(blob: Blob, content: Content) -> None:
    notes = content.notes
    for name, values, kind in (
        ("second", notes.second, "f8"),
        ("end", notes.end_second, "f8"),
        ("tick", np.asarray(content.ticks), "i4"),
        ("column", notes.column, "u1"),
        ("kind", notes.kind, "u1"),
        ("limb", notes.limb, "i1"),
        ("quant", notes.quantisation, "u1"),
        ("judged", notes.judged, "u1"),
        ("player", notes.player, "u1"),
    ):
        blob.add(f"note.{name}", values, kind)


def _finding(one: Finding) -> dict[str, Any]:
    return {
        "rule": one.rule,
        "name": one.name,
        "severity": one.severity,
        "message": one.message,
        "beat": one.beat,
        "second": one.second,
        "column": one.note_column,
    }
