"""Motion as numpy arrays in one .npz file: what other programs read without a 3D library.

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
| ground | (5,) | if she leaves the pad: its corners x0, z0, x1, z1, and how much lower the floor is |
| bar | (3,) | with a bar: height, z behind the pad, radius of the rail |
| bar_spans | (k, 2) | x from and to of its pieces |
| grip_start, grip_end, grip_side, grip_x | (g,) | seconds; 0 left hand, 1 right; where its palm is on the rail |
| grip_across | (g,) | 1 where it has crossed over before her |

A reader must survive added arrays.
"""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from dancetutor_cli.errors import FileError
from dancetutor_cli.files import write_atomic
from dancetutor_cli.motion.baked import Bar, Contact, Grip, Ground, Motion
from dancetutor_cli.play.let_go import LetGo
from dancetutor_cli.play.unplayable import Why
from dancetutor_cli.rig.skeleton import Skeleton

SCHEMA = 1
_ARRAYS = ("schema", "names", "parents", "offsets", "fps", "times", "rotations", "root")
_CONTACTS = ("start", "end", "limb", "column", "kind", "part", "row", "panel")
_GRIPS = {"start": "f8", "end": "f8", "side": "i1", "x": "f8", "across": "i1"}
_LET_GO = {"second": "f8", "row": "i4", "column": "i4", "why": "i1"}
_CONTACT_TYPES = {"limb": "i1", "kind": "i1", "part": "i1", "column": "i4", "row": "i4"}


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
        values = np.array([getattr(c, name) for c in motion.contacts], dtype=_CONTACT_TYPES.get(name, "f8"))
        arrays[f"contact_{name}"] = values.reshape(-1, 2) if name == "panel" else values
    if motion.bar is not None:
        arrays |= _bar_arrays(motion.bar, motion.grips)
    if motion.let_go:
        for name, kind in _LET_GO.items():
            arrays[f"let_go_{name}"] = np.array([getattr(one, name) for one in motion.let_go], dtype=kind)
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
    for name, kind in _GRIPS.items():
        out[f"grip_{name}"] = np.array([getattr(g, name) for g in grips], dtype=kind)
    return out


def _bar(arrays: dict[str, Any]) -> tuple[Bar | None, tuple[Grip, ...]]:
    if "bar" not in arrays or "bar_spans" not in arrays:
        return None, ()
    height, behind, radius = (float(v) for v in arrays["bar"])
    spans = tuple((float(low), float(high)) for low, high in arrays["bar_spans"])
    none = np.zeros(len(arrays.get("grip_start", ())))  # files of before hands crossed over do not say so
    columns = [arrays.get(f"grip_{name}", none) for name in _GRIPS]
    grips = tuple(
        Grip(float(a), float(b), int(side), float(x), bool(over)) for a, b, side, x, over in zip(*columns, strict=True)
    )
    return Bar(height, behind, radius, spans), grips


def read_npz(path: Path) -> Motion:
    """Read a motion. Raises FileError for a file that is not one, or of a newer schema."""
    try:
        with np.load(path, allow_pickle=False) as data:
            arrays = {name: data[name] for name in data.files}
    except OSError as error:
        raise FileError(path, error.strerror or "not an .npz file") from None
    except (ValueError, zipfile.BadZipFile, EOFError):
        raise FileError(path, "not an .npz file of a motion") from None
    for name in (*_ARRAYS, *(f"contact_{n}" for n in _CONTACTS)):
        if name not in arrays:
            raise FileError(path, f"not a motion: array '{name}' is missing")
    if int(arrays["schema"]) != SCHEMA:
        raise FileError(path, f"written in schema {int(arrays['schema'])}; this program reads {SCHEMA}")
    skeleton = Skeleton(tuple(str(n) for n in arrays["names"]), arrays["parents"], arrays["offsets"])
    contacts = [
        Contact(
            start=float(arrays["contact_start"][i]),
            end=float(arrays["contact_end"][i]),
            panel=(float(arrays["contact_panel"][i, 0]), float(arrays["contact_panel"][i, 1])),
            **{n: int(arrays[f"contact_{n}"][i]) for n in _CONTACT_TYPES},
        )
        for i in range(len(arrays["contact_start"]))
    ]
    fps, times = float(arrays["fps"]), arrays["times"]
    parts = (times, arrays["rotations"], arrays["root"], tuple(contacts))
    return Motion(skeleton, fps, *parts, *_bar(arrays), _ground(arrays), let_go=_let_go(arrays))


def _let_go(arrays: dict[str, Any]) -> tuple[LetGo, ...]:
    columns = [arrays.get(f"let_go_{name}", np.zeros(0)) for name in _LET_GO]
    return tuple(LetGo(float(s), int(r), int(c), Why(int(w))) for s, r, c, w in zip(*columns, strict=True))


def _zipped(arrays: dict[str, Any]) -> bytes:
    """As numpy.savez_compressed, but with a fixed date, so that the same motion gives the same bytes."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=4) as archive:
        for name, array in arrays.items():
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, np.asanyarray(array), allow_pickle=False)
            archive.writestr(
                zipfile.ZipInfo(f"{name}.npy", (1980, 1, 1, 0, 0, 0)), buffer.getvalue(), zipfile.ZIP_DEFLATED
            )
    return out.getvalue()
