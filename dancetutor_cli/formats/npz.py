"""Motion as numpy arrays in one .npz file, which other programs read without a 3D library.

Schema 1, all metres, seconds and local unit quaternions (w, x, y, z); f frames, j joints, c contacts:

| array | shape | meaning |
| --- | --- | --- |
| schema | () | 1 |
| names | (j,) | H-Anim joint names |
| parents | (j,) int32 | index of the parent, -1 for the root, parents first |
| offsets | (j, 3) | rest position relative to the parent |
| fps | () | nominal frames per second |
| times | (f,) | seconds of the music; regular at fps plus extra keys at contacts |
| rotations | (f, j, 4) | local rotations |
| root | (f, 3) | position of joint 0 in the world |
| contact_start, contact_end | (c,) | seconds; the limb presses its panel from start to end |
| contact_limb | (c,) int8 | 0 left foot, 1 right foot, 2 left hand, 3 right hand |
| contact_column, contact_row | (c,) int32 | note column, row of the play |
| contact_kind | (c,) int8 | 1 tap, 2 lift, 3 hold, 4 roll head, 5 tap of a roll |
| contact_part | (c,) int8 | 0 whole foot, 1 heel, 2 toe |
| contact_panel | (c, 2) | (x, z) of the panel's centre in the world |
| let_go_second, let_go_row, let_go_column, let_go_why | (k,) | notes nobody plays; 0 limbs, 1 leap, 2 hand |
| ground | (5,) | if the dancer leaves the pad: its corners x0, z0, x1, z1, and how much lower the floor is |
| bar | (3,) | with a bar: height, z behind the pad, radius of the rail |
| bar_spans | (k, 2) | x from and to of its pieces |
| grip_start, grip_end, grip_side, grip_x | (g,) | seconds; 0 left hand, 1 right; where its palm is on the rail |
| grip_across | (g,) | 1 where it has crossed over in front of the body |

A reader must survive added arrays. `FIELDS` is the table by which a file is read.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from dancetutor_cli.dance.motion import Bar, Contact, Grip, Ground, Motion
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.feet.preset import DropReason
from dancetutor_cli.feet.unplayable import DroppedNote
from dancetutor_cli.formats.npz_arrays import Field, read_arrays
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.files import write_atomic

SCHEMA = 1
_FAR = 1e5  # metres and seconds: a day of music
_MOST_RATE = 1000.0  # frames per second
_INDEX = 2**31 - 1
_UNIT = 1e-3  # allowed difference between a rotation's length and 1
_CONTACTS = {
    "start": Field("float", ("c",), -_FAR, _FAR),
    "end": Field("float", ("c",), -_FAR, _FAR),
    "limb": Field("integer", ("c",), 0, 3),
    "column": Field("integer", ("c",), 0, 1000),
    "kind": Field("integer", ("c",), 1, 5),
    "part": Field("integer", ("c",), 0, 2),
    "row": Field("integer", ("c",), -1, _INDEX),
    "panel": Field("float", ("c", 2), -_FAR, _FAR),
}
_GRIPS = {
    "start": Field("float", ("g",), -_FAR, _FAR, required=False),
    "end": Field("float", ("g",), -_FAR, _FAR, required=False),
    "side": Field("integer", ("g",), 0, 1, required=False),
    "x": Field("float", ("g",), -_FAR, _FAR, required=False),
    "across": Field("integer", ("g",), 0, 1, required=False),
}
_DROPPED = {
    "second": Field("float", ("k",), -_FAR, _FAR, required=False),
    "row": Field("integer", ("k",), -1, _INDEX, required=False),
    "column": Field("integer", ("k",), 0, 1000, required=False),
    "why": Field("integer", ("k",), min(DropReason), max(DropReason), required=False),
}
_ATTRIBUTES = {"why": "reason"}  # attributes of `DroppedNote` with other names than in the file
FIELDS: Mapping[str, Field] = {
    "schema": Field("integer", (), 0, _INDEX),
    "names": Field("string", ("j",)),
    "parents": Field("integer", ("j",), -1, 10_000),
    "offsets": Field("float", ("j", 3), -_FAR, _FAR),
    "fps": Field("float", (), 0.01, _MOST_RATE),
    "times": Field("float", ("f",), -_FAR, _FAR),
    "rotations": Field("float", ("f", "j", 4), -2.0, 2.0),
    "root": Field("float", ("f", 3), -_FAR, _FAR),
    **{f"contact_{name}": field for name, field in _CONTACTS.items()},
    **{f"let_go_{name}": field for name, field in _DROPPED.items()},
    "ground": Field("float", (5,), -_FAR, _FAR, required=False),
    "bar": Field("float", (3,), -_FAR, _FAR, required=False),
    "bar_spans": Field("float", ("s", 2), -_FAR, _FAR, required=False),
    **{f"grip_{name}": field for name, field in _GRIPS.items()},
}
_TYPES = {"start": "f8", "end": "f8", "panel": "f8", "x": "f8", "second": "f8", "column": "i4", "row": "i4"}  # else i1


def write_npz(path: Path, motion: Motion) -> None:
    """Write a motion, atomically and with the same bytes for the same motion. Raises FileError."""
    arrays: dict[str, Any] = {
        "schema": np.array(SCHEMA),
        "names": np.array(motion.skeleton.names),
        "parents": motion.skeleton.parents,
        "offsets": motion.skeleton.offsets,
        "fps": np.array(motion.fps),
        "times": motion.times,
        "rotations": motion.rotations,
        "root": motion.root,
    }
    for name in _CONTACTS:
        values = np.array([getattr(c, name) for c in motion.contacts], dtype=_TYPES.get(name, "i1"))
        arrays[f"contact_{name}"] = values.reshape(-1, 2) if name == "panel" else values
    if motion.bar is not None:
        arrays |= _bar_arrays(motion.bar, motion.grips)
    if motion.dropped:
        for name in _DROPPED:
            column = [getattr(one, _ATTRIBUTES.get(name, name)) for one in motion.dropped]
            arrays[f"let_go_{name}"] = np.array(column, dtype=_TYPES.get(name, "i1"))
    if motion.ground is not None:
        arrays["ground"] = np.array([*motion.ground.low, *motion.ground.high, motion.ground.drop])
    write_atomic(path, _zipped(arrays))


def _ground(arrays: dict[str, Any]) -> Ground | None:
    if "ground" not in arrays:
        return None
    x0, z0, x1, z1, drop = (float(v) for v in arrays["ground"])
    return Ground((x0, z0), (x1, z1), drop)


def _bar_arrays(bar: Bar, grips: tuple[Grip, ...]) -> dict[str, Any]:
    out: dict[str, Any] = {
        "bar": np.array([bar.height, bar.behind, bar.radius]),
        "bar_spans": np.array(bar.spans, dtype=np.float64).reshape(-1, 2),
    }
    for name in _GRIPS:
        out[f"grip_{name}"] = np.array([getattr(g, name) for g in grips], dtype=_TYPES.get(name, "i1"))
    return out


def _bar(arrays: dict[str, Any]) -> tuple[Bar | None, tuple[Grip, ...]]:
    if "bar" not in arrays or "bar_spans" not in arrays:
        return None, ()
    height, behind, radius = (float(v) for v in arrays["bar"])
    spans = tuple((float(low), float(high)) for low, high in arrays["bar_spans"])
    none = np.zeros(len(arrays.get("grip_start", ())))  # older files do not have this array of grips
    columns = [arrays.get(f"grip_{name}", none) for name in _GRIPS]
    grips = tuple(
        Grip(float(a), float(b), int(side), float(x), bool(over)) for a, b, side, x, over in zip(*columns, strict=True)
    )
    return Bar(height, behind, radius, spans), grips


def read_npz(path: Path) -> Motion:
    """Read a motion. Raises FileError if the file is not a motion, is broken, or has a newer schema."""
    arrays = read_arrays(path, FIELDS)
    if int(arrays["schema"]) != SCHEMA:
        raise FileError(path, f"written in schema {int(arrays['schema'])}; this program reads {SCHEMA}")
    skeleton = _skeleton(path, arrays)
    _check_motion(path, arrays)
    contacts = [
        Contact(
            start=float(arrays["contact_start"][i]),
            end=float(arrays["contact_end"][i]),
            panel=(float(arrays["contact_panel"][i, 0]), float(arrays["contact_panel"][i, 1])),
            **{n: int(arrays[f"contact_{n}"][i]) for n in ("limb", "kind", "part", "column", "row")},
        )
        for i in range(len(arrays["contact_start"]))
    ]
    fps, times = float(arrays["fps"]), arrays["times"]
    parts = (times, arrays["rotations"], arrays["root"], tuple(contacts))
    return Motion(skeleton, fps, *parts, *_bar(arrays), _ground(arrays), dropped=_dropped(arrays))


def _skeleton(path: Path, arrays: dict[str, Any]) -> Skeleton:
    names, parents = tuple(str(name) for name in arrays["names"]), arrays["parents"]
    if not names or len(set(names)) < len(names):
        raise FileError(path, "array 'names' must name each joint, and none twice")
    if parents[0] != -1 or (parents[1:] < 0).any() or (parents >= np.arange(len(names))).any():
        raise FileError(
            path, "array 'parents' must have -1 for the first joint only, and parents before their children"
        )
    return Skeleton(names, parents, arrays["offsets"])


def _check_motion(path: Path, arrays: dict[str, Any]) -> None:
    """Check that times increase and rotations are unit quaternions."""
    if not len(arrays["times"]):
        raise FileError(path, "has no frame; a motion needs at least two")
    if (np.diff(arrays["times"]) <= 0).any():
        raise FileError(path, "array 'times' must grow from frame to frame")
    if abs(np.linalg.norm(arrays["rotations"], axis=-1) - 1.0).max() > _UNIT:
        raise FileError(path, "array 'rotations' must hold unit quaternions (w, x, y, z)")


def _dropped(arrays: dict[str, Any]) -> tuple[DroppedNote, ...]:
    none = np.zeros(len(arrays.get("let_go_second", ())))
    columns = [arrays.get(f"let_go_{name}", none) for name in _DROPPED]
    return tuple(DroppedNote(float(s), int(r), int(c), DropReason(int(w))) for s, r, c, w in zip(*columns, strict=True))


def _zipped(arrays: dict[str, Any]) -> bytes:
    """Return a zip as of numpy.savez_compressed, but with a fixed date, so that equal motions give equal bytes."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=4) as archive:
        for name, array in arrays.items():
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, np.asanyarray(array), allow_pickle=False)
            archive.writestr(
                zipfile.ZipInfo(f"{name}.npy", (1980, 1, 1, 0, 0, 0)), buffer.getvalue(), zipfile.ZIP_DEFLATED
            )
    return out.getvalue()
