"""Moves as JSON, with their times and places, for games and other tools with a dancer of their own.

One object, schema 1, UTF-8; metres, seconds of the music, degrees; places are [x, z] on the ground, the pad's centre
the origin, +z the screen, +x the dancer's left. Yaw is positive to the left.

    {"schema": 1, "title": "...", "chart": "dance-single Hard 8",
     "start": {"left_foot": {"at": [0.1, 0.05], "yaw": 9.0}, "right_foot": {...}, "body": {"yaw": 0.0}},
     "moves": [{"limb": "left_foot", "kind": "step", "start": 1.2, "end": 1.5, "from": [..], "to": [..], "yaw": 12.0,
                "height": 0.05}],
     "turns": [{"start": 1.2, "end": 1.5, "yaw": 20.0}],
     "contacts": [{"limb": "left_foot", "kind": "tap", "part": null, "column": 0, "start": 1.5, "end": 2.1,
                   "panel": [..]}],
     "let_go": [{"second": 31.2, "column": 3, "why": "leap"}]}

`start` is how she stands before the first of these moves. `from` and `to` are the ball of the foot, or for a hand its
palm; kind is step, jump, gallop, evade, pivot, aside (a side-step in a wait), shake (a leg shaken out) or
walk (on the floor beside the pad its
"level" is below 0); of a hand reach, on its way to a panel, `from` null where it hung free, and press, down on it.
Of one of two who dance on two pads "pad_at" says where her pad's middle, the origin, is from that of both: [x, z].
With a bar there is also "hold", a hand that rests on the rail from start to end, and its place has a "height".
`let_go` are notes that she does not play, because nobody does: why is limbs (more panels at once than limbs), leap (a
foot that has just stepped elsewhere) or hand (one that has just been down). A reader must survive added keys.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from dancetutor_cli.dance.motion import Bar, Contact, Grip
from dancetutor_cli.dance.plan import (
    FootTrack,
    Gallop,
    Hover,
    Jump,
    Move,
    Pivot,
    Plan,
    Press,
    Shake,
    Sidestep,
    Step,
    Swing,
    WalkStep,
)
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.play import StepKind
from dancetutor_cli.run.files import encode_json, write_atomic

SCHEMA = 1
_FEET = ("left_foot", "right_foot")


KINDS: dict[type[Move], str] = {  # names of moves in the file
    Step: "step", Jump: "jump", Gallop: "gallop", Hover: "evade", Pivot: "pivot", Sidestep: "aside", WalkStep: "walk",
    Shake: "shake",
}  # fmt: skip


def write_moves(path: Path, data: dict[str, Any]) -> None:
    """Write what `moves_data` returns. Raises FileError."""
    write_atomic(path, encode_json(json.dumps(data, ensure_ascii=False, indent=1) + "\n"))


def moves_data(
    plan: Plan, title: str, chart: str, section: tuple[float, float], bar: Bar | None = None
) -> dict[str, Any]:
    """Return the object described above as plain data, with the moves of a plan that begin in a section, seconds.

    bar : the bar behind the dancer, if any
    """
    start, end = section
    moves = [m for side, track in enumerate(plan.feet) for m in _foot_moves(track, _FEET[side])]
    moves += _hand_moves(plan.presses)
    moves += [_grip(bar, grip) for grip in plan.grips if bar is not None]
    moves.sort(key=lambda m: (m["start"], m["limb"]))
    return {
        "schema": SCHEMA,
        "title": title,
        "chart": chart,
        "start": _stand(plan, start),
        "moves": [m for m in moves if start <= m["start"] <= end],
        "turns": [
            {"start": _round(t.start), "end": _round(t.end), "yaw": _degrees(t.yaw)}
            for t in plan.turns
            if start <= t.start <= end
        ],
        "contacts": [_contact(c) for c in plan.contacts if start <= c.start <= end],
        "let_go": [
            {"second": _round(one.second), "column": one.column, "why": one.reason.name.lower()}
            for one in plan.dropped
            if start <= one.second <= end
        ],
    }


def _contact(contact: Contact) -> dict[str, Any]:
    return {
        "limb": Limb(contact.limb).name.lower(),
        "kind": StepKind(contact.kind).name.lower(),
        "part": None if contact.part == Part.WHOLE else Part(contact.part).name.lower(),
        "column": contact.column,
        "start": _round(contact.start),
        "end": _round(contact.end),
        "panel": _place(contact.panel),
    }


def _stand(plan: Plan, start: float) -> dict[str, Any]:
    """Return the places of the feet, and the yaw of feet and body, after all moves that began before `start`."""
    out: dict[str, Any] = {}
    for name, track in zip(_FEET, plan.feet, strict=True):
        at, yaw = track.start, track.start_yaw
        for move in track.moves:
            if _round(move.lift) < start:
                at, yaw = move.target, move.yaw
        out[name] = {"at": _place(at), "yaw": _degrees(yaw)}
    turned = [t.yaw for t in plan.turns if t.start < start]
    out["body"] = {"yaw": _degrees(turned[-1] if turned else 0.0)}
    return out


def _hand_moves(presses: tuple[Press, ...]) -> list[dict[str, Any]]:
    """Return the reaches to panels and the presses on them."""
    out: list[dict[str, Any]] = []
    last: dict[int, Press] = {}
    for p in presses:
        limb, before = ("left_hand", "right_hand")[p.side], last.get(p.side)
        begin = p.start - p.lead
        down = before is not None and begin <= before.end + 1e-6
        start = _place(before.target) if down and before is not None else None
        way = {"start": _round(begin), "end": _round(p.start), "from": start, "to": _place(p.target)}
        out.append({"limb": limb, "kind": "reach", **way})
        out.append(
            {"limb": limb, "kind": "press", "start": _round(p.start), "end": _round(p.end), "to": _place(p.target)}
        )
        last[p.side] = p
    return out


def _grip(bar: Bar, grip: Grip) -> dict[str, Any]:
    return {
        "limb": ("left_hand", "right_hand")[grip.side],
        "kind": "hold",
        "start": _round(grip.start),
        "end": _round(grip.end),
        "to": _place((grip.x, bar.behind)),
        "height": _round(bar.height),
        **({"across": True} if grip.across else {}),
    }


def _foot_moves(track: FootTrack, limb: str) -> list[dict[str, Any]]:
    out, place = [], track.start
    for move in track.moves:
        level = move.level if isinstance(move, WalkStep) else 0.0
        tuck = move.tuck if isinstance(move, Jump) else 0.0
        out.append(
            {
                "limb": limb,
                "kind": KINDS[type(move)],
                "start": _round(move.lift),
                "end": _round(move.land),
                "from": _place(place),
                "to": _place(move.target),
                "yaw": _degrees(move.yaw),
                "height": _round(move.height + tuck if isinstance(move, Swing) else 0.0),
                **({"level": _round(level)} if level else {}),
            }
        )
        place = move.target
    return out


def _round(value: float) -> float:
    return round(value, 6)


def _place(p: tuple[float, float]) -> list[float]:
    return [_round(p[0]), _round(p[1])]


def _degrees(yaw: float) -> float:
    return round(math.degrees(yaw), 3)
