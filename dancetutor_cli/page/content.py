"""What a page holds: chart, feet, findings and passages, the dancer and the look of the films, as plain data."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from dancetutor_cli.colours import hex_colour, limb_colours
from dancetutor_cli.page.blob import Blob
from dancetutor_cli.page.packing import pack_body, pack_motion
from dancetutor_cli.play.turned import moves_and_turns
from dancetutor_cli.video.overlay.sprites import callout_words, highway_style
from dancetutor_cli.video.scene.scene import SOLE_RADIUS, Scene
from dancetutor_cli.video.scene.stage import PANEL

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.lint.finding import Finding
    from dancetutor_cli.motion.baked import Motion
    from dancetutor_cli.pads import Pad
    from dancetutor_cli.play.played import Play
    from dancetutor_cli.video.notes import NoteTrack

SCHEMA = 1  # of the page's data; grows when an old page's script could not read it


@dataclass(frozen=True, slots=True)
class Content:
    """Everything that one page is made of.

    words : title, artist, badge, detail, credit, file, label, preset (all text of people, never markup)
    notes : as the films draw them; ticks : int64 (n,), 1/48 beats, of the notes
    beats : seconds of beats 0, 1, 2, ...
    motions : the dancer's, and that of who dances beside her if there is one, both of `character`'s joints
    beside : what she plays; beside_rows : the rows that she steps with other limbs
    pair : the two are the players of a chart for two, in one picture, the second one in other colours
    passages : the hardest parts, ready for the page; flips : what other feet in a row would change, by row
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
    beside: str = ""
    beside_rows: Sequence[int] = ()
    passages: Sequence[Mapping[str, Any]] = ()
    flips: Sequence[Mapping[str, Any]] = ()
    pair: bool = False
    music: tuple[str, bytes] | None = field(default=None, repr=False)  # its type ("audio/ogg"), and its file


def pack_content(content: Content) -> tuple[dict[str, Any], Blob]:
    """The page's data: what is read as JSON, and the arrays it names."""
    blob = Blob()
    scene = Scene(content.character, content.pad)
    low, high = scene.extent
    tiles = scene.stage.tiles
    bar = content.motions[0].bar if content.motions else None
    doc: dict[str, Any] = {
        "schema": SCHEMA,
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
        "stage": {
            "corners": scene.stage.corners.round(5).tolist(),
            "uv": scene.stage.uv.tolist(),
            "kinds": scene.stage.kinds.tolist(),
            "low": low.tolist(),
            "high": high.tolist(),
            "corner": list(tiles.corner),
            "panel": tiles.panel.tolist(),
            "arrow": tiles.arrow.tolist(),
            "tall": scene.tall,
            "sole": SOLE_RADIUS,
        },
        "body": pack_body(blob, content.character, bar, -scene.look.stage.pad_height, content.pair),
        "pair": content.pair,
        "motions": [pack_motion(blob, motion, f"motion{k}") for k, motion in enumerate(content.motions)],
        "beside": {"name": content.beside, "rows": list(content.beside_rows)},
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
        # beside the notes, whose markers say which foot it is: the move's name where a film says who does it
        "callouts": {name: name.replace("-", " ") if "{" in said else said for name, said in callout_words().items()},
        "limbs": [hex_colour(colour) for colour in limb_colours().by_limb],
        "limbs_rgb": [list(colour) for colour in limb_colours().by_limb],
        # on an arrow's tail, in sizes of an arrow: how far from its middle, straight and diagonal, and how large
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
