"""The page of a capture: its own skeleton beside the dancer who follows it, with the distance of each point."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.smoothing import low_pass, sample_path
from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.scene.follow import FOCAL, FOLLOWED_BELOW, FULL_RED, TARGET_HEIGHT, floor_under
from dancetutor_cli.film.scene.scene import PANEL, Scene
from dancetutor_cli.page.content import pack_body, pack_motion, pack_stage
from dancetutor_cli.page.document import Blob, document

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.dance.motion import Motion

RATE = 60.0  # keys a second of points and skeleton
STEP = 1e-3  # step of the rounded coordinates of points and skeleton, metres


@dataclass(frozen=True, slots=True)
class CaptureContent:
    """The content of the page, at the keys (f,) of the output.

    title : the capture's name; motion : the output, for `character`'s joints
    names : (p,), names of the points; before, after : (f, p, 3), their places on input and output, metres
    parents, skeleton : (j,), -1 for none, and (f, j, 3), the places of the capture's own joints, metres
    """

    title: str
    character: Character
    motion: Motion
    names: tuple[str, ...]
    before: Array
    after: Array
    parents: NDArray[np.int32]
    skeleton: Array


def capture_page(content: CaptureContent) -> bytes:
    """Return the page as an HTML file."""
    motion, character = content.motion, content.character
    blob = Blob()
    floor, times = floor_under(motion.root), motion.times
    scene = Scene(character, floor)
    at = times[0] + np.arange(int(np.ceil((times[-1] - times[0]) * RATE)) + 1) / RATE
    doc: dict[str, Any] = {
        "language": "",
        "words": {"title": content.title, "badge": ""},
        "pad": {"panels": floor.panels.tolist(), "width": PANEL},
        "look": asdict(scene.look),
        "stage": pack_stage(scene),
        "body": pack_body(blob, character, None, -scene.look.stage.pad_height),
        "motions": [pack_motion(blob, motion, "motion0")],
        "clock": {"rate": RATE, "keys": len(at), "start": float(times[0]), "end": float(times[-1]), "step": STEP},
        "parents": content.parents.tolist(),
        "points": list(content.names),
        "far": FULL_RED,
        "camera": {"focal": FOCAL, "height": TARGET_HEIGHT},
    }
    slow = low_pass(sample_path(motion.root, times, at), RATE, FOLLOWED_BELOW)
    tracks = {"skeleton": content.skeleton, "before": content.before, "after": content.after}
    for name, places in (*((name, sample_path(track, times, at)) for name, track in tracks.items()), ("way", slow)):
        blob.add(name, np.rint(places.reshape(len(at), -1) / STEP).T, "i4", 2)
    doc["arrays"] = blob.index
    return document(doc, blob, kind="capture")
