"""A film of a motion without a chart: the character on a bare floor, alone or beside the input."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageDraw

from dancetutor_cli.dance.motion import sample
from dancetutor_cli.dance.rig.body import joint_matrices
from dancetutor_cli.dance.smoothing import low_pass, sample_path
from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.media.encoder import Encoding, encode_segment, join_segments
from dancetutor_cli.film.overlay.text import font
from dancetutor_cli.film.scene import renderer
from dancetutor_cli.film.scene.camera import Camera
from dancetutor_cli.film.scene.follow import EYE, FOCAL, FOLLOWED_BELOW, FULL_RED, TARGET_HEIGHT, floor_under
from dancetutor_cli.film.scene.scene import FrameState, Scene
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.ffmpeg import EncoderError

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.dance.motion import Motion
    from dancetutor_cli.film.picture import Frame

SIZE, FPS = (720, 720), 30
NEAR_COLOUR, FAR_COLOUR = np.array([0, 158, 115]), np.array([213, 0, 0])
INK, PAPER = (20, 20, 20), (255, 255, 255)


@dataclass(frozen=True, slots=True)
class Comparison:
    """A comparison of a motion with its input, by p points over the motion's keys (f,).

    given : the input, for the same character and times; names : (p,), names of the points
    before, after : (f, p, 3), places of the points on the input and on the motion, metres
    """

    given: Motion
    names: tuple[str, ...]
    before: Array
    after: Array


@contextmanager
def work_folder(output: Path) -> Iterator[Path]:
    """Make a hidden folder for unfinished files, which is always removed afterwards.

    The folder is beside the output, so that the last step is a rename, and so that a full or read-only disk is found at
    once.
    """
    try:
        folder = TemporaryDirectory(
            prefix=f".{output.name}.", suffix=".part", dir=output.parent, ignore_cleanup_errors=True
        )
    except OSError as error:
        raise FileError(output, f"cannot be written: {error.strerror}") from error
    try:
        with folder as name:
            yield Path(name)
    except EncoderError as error:
        raise FileError(output, str(error)) from error
    except OSError as error:
        if error.filename is None:  # from a write to an open file of this program
            raise FileError(output, f"cannot be written: {error.strerror or error}") from error
        raise


def write_motion_film(path: Path, character: Character, motion: Motion, comparison: Comparison | None = None) -> int:
    """Write an .mp4 and return its number of frames. Raises FileError or UnavailableError, and then leaves no file.

    comparison : the input to show on the left, and the points whose distances to draw; None for the motion alone
    """
    count = max(1, int((motion.times[-1] - motion.times[0]) * FPS) + 1)
    size = SIZE if comparison is None else (2 * SIZE[0], SIZE[1])
    encoding = Encoding("mp4", size, FPS, "good")
    with work_folder(path) as folder:
        part, whole = folder / f"part{encoding.format.segment}", folder / "film.mp4"
        encode_segment(frames(character, motion, count, comparison), encoding, part)
        join_segments([part], encoding, None, folder, whole)
        whole.replace(path)
    return count


def frames(character: Character, motion: Motion, count: int, comparison: Comparison | None = None) -> Iterator[Frame]:
    """Draw the first `count` pictures of the film."""
    times = motion.times[0] + np.arange(count) / FPS
    poses = [sample(one, times) for one in ((motion,) if comparison is None else (comparison.given, motion))]
    scene = Scene(character, floor_under(np.concatenate([root for _, root in poses])))
    draws = [renderer.create(scene, SIZE, "good", "cpu") for _ in poses]
    slow = low_pass(poses[0][1], FPS, FOLLOWED_BELOW)
    nobody = np.zeros(scene.panels)
    joints = [joint_matrices(character.skeleton, *pose) for pose in poses]
    for k in range(count):
        x, z = float(slow[k, 0]), float(slow[k, 2])
        target = (x, TARGET_HEIGHT, z)
        camera = Camera((x + float(EYE[0]), TARGET_HEIGHT + float(EYE[1]), z + float(EYE[2])), target, FOCAL)
        shown = [
            draw.frame(FrameState(own[k], camera, nobody, nobody.astype(np.int64)))
            for draw, own in zip(draws, joints, strict=True)
        ]
        yield shown[0] if comparison is None else _compared(shown, camera, comparison, motion.times, times[k : k + 1])
    for draw in draws:
        draw.close()


def _compared(shown: list[Frame], camera: Camera, comparison: Comparison, keys: Array, at: Array) -> Frame:
    """Draw input and output in one picture, with a line on the output from each point's place on the input."""
    image = Image.fromarray(np.concatenate(shown, axis=1))
    draw, letters = ImageDraw.Draw(image), font(None, 20)
    before, after = (sample_path(points, keys, at)[0] for points in (comparison.before, comparison.after))
    apart = 100.0 * np.linalg.norm(after - before, axis=1)
    here, there = (camera.project(points, SIZE)[:, :2] + [SIZE[0], 0] for points in (before, after))
    for k in np.argsort(apart).tolist():
        share = min(float(apart[k]) / FULL_RED, 1.0)
        colour = tuple(int(c) for c in NEAR_COLOUR + share * (FAR_COLOUR - NEAR_COLOUR))
        (x, y), radius = there[k], 3.0 + 5.0 * share
        draw.line((*map(float, here[k]), float(x), float(y)), fill=colour, width=3)
        draw.ellipse((x - radius, y - radius, x + radius, y + radius), fill=colour, outline=PAPER)
    far = int(np.argmax(apart))
    words = f"output: {comparison.names[far]} {apart[far]:.1f} cm from the input, mean {apart.mean():.1f} cm"
    for x, text in ((16, "input"), (SIZE[0] + 16, words)):
        draw.text((x, 12), text, fill=INK, font=letters, stroke_width=2, stroke_fill=PAPER)
    return np.asarray(image)
