"""The dancer's head and hair as signed distance functions, and her eyes and lids as lofted spheres.

The face is drawn friendly and young: large eyes set low, short round jaw, small nose. The eyes are spheres on the
eyeball joints; the upper lid is a slice of a slightly larger sphere that turns about the eyelid joint's x axis, so
she blinks when it turns.
"""

from __future__ import annotations

import numpy as np
from build_character_body import REST
from build_character_loft import Lofted, rope
from build_character_sdf import Array, Shape, blend, both, carve, cone, ellipsoid, scaled, tube

EYE = REST["l_eyeball_joint"]
EYE_RADIUS = 0.0367
LID_EDGE, LOWER_EDGE = 34.0, -32.0  # degrees of elevation on the eyeball; the lid closes by their difference
LARGER, ABOUT = 1.08, np.array([0.0, 1.53, 0.0])  # the head is drawn at life size and then made larger
BRAID = [REST[f"braid{k}"] for k in (1, 2, 3, 4)]
BRAID_TIP = np.array([0.0, 1.205, -0.153])


def cranium() -> Shape:
    return ellipsoid((0, 1.624, -0.008), (0.0835, 0.0900, 0.0965))


def drawn(p: Array) -> Array:
    """Places on the enlarged head as they were drawn."""
    return ABOUT + (p - ABOUT) / LARGER


def head() -> Shape:
    """Skull, face and nose, without the neck."""
    face = ellipsoid((0, 1.573, 0.020), (0.0725, 0.0665, 0.0680))
    jaw = cone((0, 1.540, 0.020), (0, 1.5090, 0.0575), 0.0530, 0.0205)
    cheeks = both(ellipsoid((0.036, 1.5480, 0.044), (0.030, 0.026, 0.034)))
    skull = blend(0.040, cranium(), face, jaw)
    skull = blend(0.030, skull, cheeks)
    rim = both(ellipsoid((0.0640, 1.5860, 0.0420), (0.0210, 0.0330, 0.0300)))  # the outer corners of the eyes
    skull = blend(0.020, skull, rim)
    nose = cone((0, 1.574, 0.0865), (0, 1.5595, 0.0955), 0.0040, 0.0066)
    sockets = both(ellipsoid((0.0365, 1.5860, 0.0920), (0.0250, 0.0215, 0.0270)))
    return scaled(carve(blend(0.014, skull, nose), sockets, 0.005), ABOUT, LARGER)  # the hair covers her ears


def below_the_lip(p: Array) -> Array:
    """How far places of the face go with the jaw, (n,) 0 to 1: from the upper lip's line downwards, not the throat."""
    x, y, z = drawn(p).T
    down = np.clip((1.5345 + 0.0070 * np.minimum(np.abs(x) / 0.0245, 1.2) ** 2 - y) / 0.0125, 0, 1)
    front = np.clip((z - 0.015) / 0.045, 0, 1)
    return np.asarray(down**2 * (3 - 2 * down) * front**2 * (3 - 2 * front))


def hair() -> Shape:
    """The close hair: it thins to nothing at the hairline, so that no wall stands on the forehead."""
    crown = ellipsoid((0, 1.634, -0.028), (0.0850, 0.0905, 0.0860))  # a dome: from behind a flat top looks like a lid
    skull = blend(0.03, cranium(), crown, ellipsoid((0, 1.612, -0.034), (0.0830, 0.0840, 0.0790)))
    face = blend(
        0.05, ellipsoid((0, 1.560, 0.120), (0.0800, 0.1080, 0.120)), ellipsoid((0, 1.495, 0.030), (0.10, 0.060, 0.095))
    )
    gathered = cone((0, 1.640, -0.060), (0, 1.630, -0.115), 0.062, 0.026)

    def close(p: Array) -> Array:
        t = np.clip(face(p) / 0.040, 0, 1)
        return skull(p) - (-0.004 + 0.018 * t * t * (3 - 2 * t))

    tuft = ellipsoid((0, 1.685, 0.030), (0.074, 0.0415, 0.062))  # fills the fringe from behind
    return scaled(blend(0.03, close, gathered, tuft), ABOUT, LARGER)


def locks() -> list[Lofted]:
    """The fringe, swept from a parting on her left, and a lock beside each cheek; each ends in a point."""
    fringe = [
        [(0.030, 1.700, 0.000), (-0.010, 1.711, 0.054), (-0.044, 1.689, 0.083), (-0.071, 1.658, 0.074)],
        [(0.028, 1.700, 0.010), (0.006, 1.707, 0.069), (-0.026, 1.689, 0.0965), (-0.054, 1.661, 0.0985)],
        [(0.030, 1.698, 0.020), (0.018, 1.699, 0.080), (-0.004, 1.686, 0.1020), (-0.024, 1.665, 0.1060)],
        [(0.026, 1.700, 0.000), (0.046, 1.701, 0.053), (0.062, 1.679, 0.069), (0.079, 1.652, 0.061)],
        [(0.026, 1.698, 0.020), (0.040, 1.695, 0.079), (0.056, 1.679, 0.0930), (0.066, 1.656, 0.0880)],
    ]
    tips = [
        (-0.088, 1.618, 0.052),
        (-0.072, 1.632, 0.083),
        (-0.042, 1.645, 0.101),
        (0.088, 1.614, 0.046),
        (0.078, 1.631, 0.072),
    ]
    widths = [(0.020, 0.028, 0.028, 0.023), (0.020, 0.028, 0.028, 0.019), (0.016, 0.023, 0.022, 0.015)]
    widths += [(0.020, 0.025, 0.026, 0.021), (0.016, 0.023, 0.022, 0.014)]
    out = [
        _larger(rope([*points, tip], [*width, 0.0018], 7, 3, np.array([*points, tip]) - [0, 1.61, 0], 0.5))
        for points, tip, width in zip(fringe, tips, widths, strict=True)
    ]
    for side in (1, -1):
        points = np.array(
            [
                (0.072, 1.672, 0.028),
                (0.0880, 1.622, 0.038),
                (0.0900, 1.572, 0.042),
                (0.0840, 1.526, 0.049),
                (0.0735, 1.484, 0.060),
            ]
        )
        out.append(
            _larger(rope(points * [side, 1, 1], [0.018, 0.0185, 0.0155, 0.0110, 0.0015], 7, 2, (side, 0, 0.3), 0.55))
        )
    return out


def _larger(part: Lofted) -> Lofted:
    return ABOUT + (part[0] - ABOUT) * LARGER, part[1], part[2]


def braid_line(t: Array) -> Array:
    """Centre line of the braid, t = 0 at the head to 1 at the tip."""
    knots = np.array([BRAID[0] + (0, 0.004, -0.006), BRAID[1] + (0, 0, 0.002), BRAID[2], BRAID[3], BRAID_TIP])
    at = np.array([0.0, 0.27, 0.52, 0.77, 1.0])
    return np.stack([np.interp(t, at, knots[:, k]) for k in range(3)], axis=1)


def braid() -> Shape:
    """Three strands woven as a real braid: each runs a figure of eight, a third of the way apart."""
    t = np.linspace(0.03, 0.90, 120)
    line = braid_line(t)
    width = np.interp(t, [0, 0.1, 0.35, 0.9], [0.011, 0.0150, 0.0155, 0.0095])
    strands = []
    for k in range(3):
        a = 2 * np.pi * (t * 5.6 + k / 3)
        points = line + np.stack([np.sin(a) * width, np.zeros_like(a), np.sin(2 * a) * width * 0.55], axis=1)
        strands.append(_chain(points, width * 0.98))
    tuft = tube(braid_line(np.array([0.90, 0.94, 0.98, 1.0])), [0.009, 0.0165, 0.011, 0.002], steps=4)
    return blend(0.0015, *strands, tuft)


def _chain(points: Array, radii: Array) -> Shape:
    """Capsules from point to point, looked for only near each height."""

    def distance(p: Array) -> Array:
        best = np.full(len(p), 0.05)
        for i in range(len(points) - 1):
            near = np.abs(p[:, 1] - points[i, 1]) < 0.03
            q = p[near]
            axis = points[i + 1] - points[i]
            t = np.clip((q - points[i]) @ axis / (axis @ axis), 0, 1)
            d = np.sqrt(((q - points[i] - t[:, None] * axis) ** 2).sum(1)) - (radii[i] + (radii[i + 1] - radii[i]) * t)
            best[near] = np.minimum(best[near], d)
        return best

    return distance


def lid(upper: bool) -> list[Lofted]:
    """A lid of the left eye around the eye's centre: the skin, and its line of lashes."""
    if upper:
        shell = slice_of_sphere(EYE_RADIUS + 0.0020, LID_EDGE, 125, 13, 5)
        line, thick, edge = (
            np.linspace(-62, 71, 9),
            [0.0008, 0.0013, 0.0018, 0.0022, 0.0025, 0.0027, 0.0028, 0.0026, 0.0010],
            LID_EDGE,
        )
    else:
        shell = slice_of_sphere(EYE_RADIUS + 0.0012, LOWER_EDGE - 36, LOWER_EDGE, 13, 3)
        line, thick, edge = (
            np.linspace(-20, 66, 7),
            [0.0005, 0.0007, 0.0009, 0.0010, 0.0011, 0.0011, 0.0006],
            LOWER_EDGE,
        )
    s, e = np.radians(line), np.radians(edge)
    radius = EYE_RADIUS + (0.0026 if upper else 0.0014) + (np.maximum(line - 50, 0) / 21 * 0.004 if upper else 0)
    way = np.stack([np.sin(s), np.cos(s) * np.sin(e), np.cos(s) * np.cos(e)], axis=1)
    return [shell, rope(way * np.reshape(radius, (-1, 1)), thick, 4, 1)]


def slice_of_sphere(radius: float, edge: float, back: float, columns: int, rows: int) -> tuple[Array, Array, Array]:
    """A closed shell between two half great circles through the +-x poles: positions, normals, triangles.

    edge, back : elevation in degrees of the front and the rear border; the shell is 2 mm thick.
    """
    across = np.radians(np.linspace(-88, 88, columns))
    up = np.radians(np.linspace(edge, back, rows))
    s, e = np.meshgrid(across, up)
    direction = np.stack([np.sin(s), np.cos(s) * np.sin(e), np.cos(s) * np.cos(e)], axis=-1).reshape(-1, 3)
    n = len(direction)
    points = np.concatenate([direction * radius, direction * (radius - 0.002)])
    normals = np.concatenate([direction, -direction])
    faces = []
    for i in range(rows - 1):
        for k in range(columns - 1):
            a, b, c, d = i * columns + k, i * columns + k + 1, (i + 1) * columns + k, (i + 1) * columns + k + 1
            faces += [(a, b, d), (a, d, c), (n + a, n + d, n + b), (n + a, n + c, n + d)]
    border = [*range(columns), *range(2 * columns - 1, rows * columns, columns)]
    border += [*range(rows * columns - 2, (rows - 1) * columns - 1, -1), *range((rows - 2) * columns, 0, -columns)]
    for a, b in zip(border, [*border[1:], border[0]], strict=True):
        faces += [(a, n + a, n + b), (a, n + b, b)]
    return points, normals, np.array(faces)


def ball(radius: float, columns: int, rows: int) -> tuple[Array, Array, Array]:
    """A sphere whose pole looks to +Z: positions, normals, triangles."""
    polar = np.radians(np.concatenate([np.linspace(0, 75, rows - 5), np.linspace(90, 180, 5)]))[1:-1]
    turn = np.linspace(0, 2 * np.pi, columns, endpoint=False)
    rings = [
        np.stack([np.sin(a) * np.cos(turn), np.sin(a) * np.sin(turn), np.full(columns, np.cos(a))], axis=1)
        for a in polar
    ]
    normals = np.concatenate([*rings, [[0, 0, 1.0], [0, 0, -1.0]]])
    faces, top, low = [], len(normals) - 2, len(normals) - 1
    for k in range(columns):
        j = (k + 1) % columns
        faces += [(top, k, j), (low, (len(rings) - 1) * columns + j, (len(rings) - 1) * columns + k)]
        for i in range(len(rings) - 1):
            a, b, c, d = i * columns + k, i * columns + j, (i + 1) * columns + k, (i + 1) * columns + j
            faces += [(a, c, d), (a, d, b)]
    return normals * radius, normals, np.array(faces)
