"""Draw the dancer as films draw her, large: eight sides and twelve poses, one file each and a contact sheet.

Usage: python tools/character_sheet.py [OUT_FOLDER] [CHARACTER.glb] [GROUP,...]
Groups are those of poses.yaml, as "bar,from above"; without, eight sides at rest and the twelve poses of "sheet" that
move.
tools/pose_sheet.py judges the skin by itself; this one shows it with the light, shadows and outline of the videos.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
from PIL import Image
from pose_sheet import ROOT, Cell, cells, posed

from dancetutor_cli.character.characters import load_character
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.scene import renderer
from dancetutor_cli.film.scene.camera import Camera
from dancetutor_cli.film.scene.scene import FrameState, Scene

SIZE = (620, 1000)
STILL = ("front", "back", "side", "three quarters", "back three quarters")
FOCAL = 1.75  # as tools/pose_sheet.py


def camera(cell: Cell) -> Camera:
    """The cell's camera as the film's renderer takes it."""
    a = math.radians(cell.heading)
    back = np.array([math.sin(a), cell.rise, math.cos(a)])
    at = np.array(cell.target)
    eye = at + back / np.linalg.norm(back) * cell.distance
    x, y, z = (float(v) for v in eye)
    return Camera((x, y, z), (float(at[0]), float(at[1]), float(at[2])), FOCAL)


def sides() -> list[Cell]:
    """Eight headings around her, standing."""
    arms = {"l_shoulder": [("z", -30.0)], "r_shoulder": [("z", 30.0)]}
    return [Cell(f"{turn} degrees", arms, float(turn)) for turn in range(0, 360, 45)]


def main(arguments: list[str]) -> None:
    """Write the pictures into a folder; by default build/character."""
    folder = Path(arguments[0]) if arguments else ROOT / "build" / "character"
    folder.mkdir(parents=True, exist_ok=True)
    character = load_character(arguments[1] if len(arguments) > 1 else "dancer")
    groups = arguments[2].split(",") if len(arguments) > 2 else []
    asked = [cell for group in groups for cell in cells(group)]
    asked = asked or [*sides(), *(cell for cell in cells("sheet") if cell.label not in STILL)]
    scene = Scene(character, load_pad("dance-single"))
    drawn = renderer.create(scene, SIZE, "good", "cpu")
    dark = np.zeros(scene.panels)
    pictures = []
    for cell in asked:
        joints = posed(character, cell.turns) @ np.linalg.inv(character.inverse_bind)
        frame = drawn.frame(FrameState(joints, camera(cell), dark, dark.astype(np.int64)))
        picture = Image.fromarray(frame.copy())
        picture.save(folder / f"{cell.label.replace(' ', '_').replace(',', '').replace('/', '_')}.png")
        pictures.append(picture)
    columns = 5 if len(pictures) > 8 else 4
    page = Image.new("RGB", (columns * SIZE[0], -(-len(pictures) // columns) * SIZE[1]))
    for k, picture in enumerate(pictures):
        page.paste(picture, (k % columns * SIZE[0], k // columns * SIZE[1]))
    page.save(folder / "sheet.png")
    print(folder / "sheet.png")


if __name__ == "__main__":
    main(sys.argv[1:])
