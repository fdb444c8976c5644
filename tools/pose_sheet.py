"""Draw a character in poses that are hard on a skin: build/pose_sheet.png.

Usage: python tools/pose_sheet.py [CHARACTER.glb] [OUT.png] [sheet|faces|close|bar|from above]
It has its own small rasteriser, so that the skin can be judged before and without the renderers of the program.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import yaml
from numba import njit
from PIL import Image, ImageDraw

if TYPE_CHECKING:  # tools/before_after.py draws these poses with an earlier commit's package, too
    from dancetutor_cli.character.mesh import Character

ROOT = Path(__file__).resolve().parent.parent
SAMPLES = 3
BACKGROUND = (58, 56, 78)
LIGHT = np.array([0.35, 0.75, 0.56])


@dataclass(frozen=True)
class Cell:
    """One picture. turns : joint -> (axis, degrees) list; eye, target : camera, metres."""

    label: str
    turns: dict[str, list[tuple[str, float]]] = field(default_factory=dict)
    heading: float = 0.0
    target: tuple[float, float, float] = (0.0, 0.86, 0.0)
    distance: float = 3.3
    rise: float = 0.35


def cells(group: str) -> list[Cell]:
    """The pictures of a group of poses.yaml, such as "sheet"."""
    rows = yaml.safe_load((ROOT / "tools" / "poses.yaml").read_text("utf-8"))[group]
    return [
        Cell(
            row["label"],
            {
                joint: [(axis, float(degrees)) for axis, degrees in turns]
                for joint, turns in row.get("turns", {}).items()
            },
            float(row["camera"]["heading"]),
            tuple(row["camera"]["at"]),
            float(row["camera"]["from"]),
            float(row["camera"]["rise"]),
        )
        for row in rows
    ]


def posed(character: Character, turns: dict[str, list[tuple[str, float]]]) -> np.ndarray:
    """Skin matrices (j, 4, 4) with the named joints turned about world axes at rest, first turn first."""
    skeleton = character.skeleton
    world = np.empty((len(skeleton.names), 4, 4))
    for j, p in enumerate(skeleton.parents):
        local = np.eye(4)
        local[:3, 3] = skeleton.offsets[j]
        for axis, degrees in turns.get(skeleton.names[j], []):
            a = np.radians(degrees)
            i, k = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
            turn = np.eye(4)
            turn[[i, k, i, k], [i, k, k, i]] = np.cos(a), np.cos(a), -np.sin(a), np.sin(a)
            local[:3, :3] = turn[:3, :3] @ local[:3, :3]
        world[j] = local if p < 0 else world[p] @ local
    return world @ character.inverse_bind


class _Shape(NamedTuple):
    """A mesh as it is seen: places on the picture (v, 2), depth (v,), normals (v, 3), texture places, triangles."""

    xy: np.ndarray
    z: np.ndarray
    normal: np.ndarray
    uv: np.ndarray
    triangles: np.ndarray


class _Paint(NamedTuple):
    """What it is coloured with: texture, colour, and the directions to the light and to the eye."""

    texture: np.ndarray
    color: np.ndarray
    light: np.ndarray
    eye_dir: np.ndarray


@njit(cache=True)
def _draw(shape, paint, depth, out):
    xy, z, normal, uv, triangles = shape
    texture, color, light, eye_dir = paint
    h, w = depth.shape
    th, tw = texture.shape[0], texture.shape[1]
    for t in range(len(triangles)):
        a, b, c = triangles[t]
        area = (xy[b, 0] - xy[a, 0]) * (xy[c, 1] - xy[a, 1]) - (xy[c, 0] - xy[a, 0]) * (xy[b, 1] - xy[a, 1])
        if area >= 0 or min(z[a], z[b], z[c]) < 0.05:
            continue
        x0 = max(0, int(np.floor(min(xy[a, 0], xy[b, 0], xy[c, 0]))))
        x1 = min(w - 1, int(np.ceil(max(xy[a, 0], xy[b, 0], xy[c, 0]))))
        y0 = max(0, int(np.floor(min(xy[a, 1], xy[b, 1], xy[c, 1]))))
        y1 = min(h - 1, int(np.ceil(max(xy[a, 1], xy[b, 1], xy[c, 1]))))
        for y in range(y0, y1 + 1):
            for x in range(x0, x1 + 1):
                px, py = x + 0.5, y + 0.5
                wa = ((xy[b, 0] - px) * (xy[c, 1] - py) - (xy[c, 0] - px) * (xy[b, 1] - py)) / area
                wb = ((xy[c, 0] - px) * (xy[a, 1] - py) - (xy[a, 0] - px) * (xy[c, 1] - py)) / area
                wc = 1 - wa - wb
                if wa < 0 or wb < 0 or wc < 0:
                    continue
                wa, wb, wc = wa / z[a], wb / z[b], wc / z[c]
                d = 1 / (wa + wb + wc)
                if d >= depth[y, x]:
                    continue
                depth[y, x] = d
                wa, wb, wc = wa * d, wb * d, wc * d
                nx = wa * normal[a, 0] + wb * normal[b, 0] + wc * normal[c, 0]
                ny = wa * normal[a, 1] + wb * normal[b, 1] + wc * normal[c, 1]
                nz = wa * normal[a, 2] + wb * normal[b, 2] + wc * normal[c, 2]
                n = np.sqrt(nx * nx + ny * ny + nz * nz) + 1e-12
                lit = (nx * light[0] + ny * light[1] + nz * light[2]) / n
                face = (nx * eye_dir[0] + ny * eye_dir[1] + nz * eye_dir[2]) / n
                ramp = min(1.0, max(0.0, (lit + 0.12) / 0.3))
                shade = 0.66 + 0.34 * ramp * ramp * (3 - 2 * ramp)
                rim = max(0.0, 1 - max(0.0, face)) ** 4 * 0.25
                u = (wa * uv[a, 0] + wb * uv[b, 0] + wc * uv[c, 0]) * tw - 0.5
                v = (wa * uv[a, 1] + wb * uv[b, 1] + wc * uv[c, 1]) * th - 0.5
                ui, vi = int(np.floor(u)), int(np.floor(v))
                fu, fv = u - ui, v - vi
                i0, i1 = min(max(ui, 0), tw - 1), min(max(ui + 1, 0), tw - 1)
                j0, j1 = min(max(vi, 0), th - 1), min(max(vi + 1, 0), th - 1)
                for k in range(3):
                    top = texture[j0, i0, k] * (1 - fu) + texture[j0, i1, k] * fu
                    low = texture[j1, i0, k] * (1 - fu) + texture[j1, i1, k] * fu
                    value = (top * (1 - fv) + low * fv) * color[k]
                    out[y, x, k] = min(255.0, value * shade + rim * 255)


def picture(character: Character, cell: Cell, width: int, height: int) -> Image.Image:
    """Draw one cell, supersampled, with a dark outline where depth jumps."""
    w, h = width * SAMPLES, height * SAMPLES
    skin = posed(character, cell.turns)
    a = np.radians(cell.heading)
    back = np.array([np.sin(a), cell.rise, np.cos(a)])
    back /= np.linalg.norm(back)
    right = np.cross([0, 1, 0], back)
    right /= np.linalg.norm(right)
    up = np.cross(back, right)
    view = np.stack([right, up, back])
    eye = np.array(cell.target) + back * cell.distance
    light = view.T @ (LIGHT / np.linalg.norm(LIGHT))
    light = light / np.linalg.norm(light)
    depth = np.full((h, w), 1e9)
    out = np.empty((h, w, 3))
    out[:] = BACKGROUND
    focal = 1.75 * h
    for mesh in character.meshes:
        m = np.einsum("vk,vkij->vij", mesh.weights, skin[mesh.joints])
        world = np.einsum("vij,vj->vi", m[:, :3, :3], mesh.positions) + m[:, :3, 3]
        normal = np.einsum("vij,vj->vi", m[:, :3, :3], mesh.normals)
        p = (world - eye) @ view.T
        z = -p[:, 2]
        zz = np.maximum(z, 1e-3)
        xy = np.stack([w / 2 + focal * p[:, 0] / zz, h / 2 - focal * p[:, 1] / zz], axis=1)
        texture = mesh.material.texture
        if texture is None:
            texture = np.full((1, 1, 4), 255, np.uint8)
        shape = _Shape(xy, z, normal, mesh.uv.astype(np.float64), mesh.triangles)
        _draw(shape, _Paint(texture, np.array(mesh.material.base_color[:3]), light, back), depth, out)
    _outline(depth, out)
    small = out.reshape(height, SAMPLES, width, SAMPLES, 3).mean(axis=(1, 3))
    return Image.fromarray(np.clip(small, 0, 255).astype(np.uint8))


def _outline(depth: np.ndarray, out: np.ndarray) -> None:
    near = depth.copy()
    for dy, dx in ((0, 2), (2, 0), (0, -2), (-2, 0)):
        near = np.minimum(near, np.roll(depth, (dy, dx), (0, 1)))
    edge = depth - near > 0.03
    out[edge] *= 0.25


def sheet(character: Character, pictures: list[Cell], columns: int, width: int, height: int) -> Image.Image:
    """All cells in a grid, each with its label."""
    rows = -(-len(pictures) // columns)
    page = Image.new("RGB", (columns * width, rows * height), BACKGROUND)
    for i, cell in enumerate(pictures):
        x, y = i % columns * width, i // columns * height
        page.paste(picture(character, cell, width, height), (x, y))
        ImageDraw.Draw(page).text((x + 6, y + 4), cell.label, fill=(220, 220, 230))
    return page


def main(arguments: list[str]) -> None:
    """Draw what the arguments name; by default the pose sheet of the package's dancer."""
    from dancetutor_cli.character.gltf import read_character

    data = ROOT / "dancetutor_cli/character/data/dancer.glb"
    character = read_character(Path(arguments[0]) if arguments else data)
    target = Path(arguments[1]) if len(arguments) > 1 else ROOT / "build" / "pose_sheet.png"
    group = arguments[2] if len(arguments) > 2 else "sheet"
    target.parent.mkdir(parents=True, exist_ok=True)
    size = (360, 460) if group == "sheet" else (400, 400)
    sheet(character, cells(group), 4, *size).save(target)
    print(target)


if __name__ == "__main__":
    main(sys.argv[1:])
