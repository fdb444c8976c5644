"""The paint of the dancer: colours as functions of the place on the body, evaluated for every texel."""

from __future__ import annotations

import build_character_head as head
import numpy as np
from build_character_bake import Paint
from build_character_body import ARM, CUFF, HEM, SHOULDER, SLEEVE_END, SOCKS
from build_character_sdf import Array, spline


def colour(code: str) -> Array:
    return np.array([int(code[i : i + 2], 16) for i in (1, 3, 5)]) / 255


SKIN, BLUSH, SHADE = colour("#f8c9a8"), colour("#ee7f7a"), colour("#e0a083")
HAIR, HAIR_DEEP, HAIR_SHINE = colour("#b8366e"), colour("#7d1f55"), colour("#f08bb0")
WHITE, INDIGO, PINK, VIOLET = colour("#f7f5fa"), colour("#5c55bd"), colour("#e0457f"), colour("#6d55cf")
LINE, LASH, BROW = colour("#7a2f3c"), colour("#35182c"), colour("#8c2b5a")


def over(base: Array, paint: Array, cover: Array) -> Array:
    """`paint` over `base` where cover is 1."""
    return base + (paint - base) * np.clip(cover, 0, 1)[:, None]


def inside(distance: Array, soft: float = 0.0006) -> Array:
    """1 where distance < 0, with a soft edge of about two texels."""
    t = np.clip(0.5 - distance / (2 * soft), 0, 1)
    return np.asarray(t * t * (3 - 2 * t))


def fill(p: Array, c: Array) -> Array:
    return np.tile(c, (len(p), 1))


def stroke(p: Array, points: list[tuple[float, float]], widths: list[float]) -> Array:
    """Distance to a brush stroke drawn in the (x, y) of p."""
    line, width = spline(points, 6), spline(widths, 6)
    best = np.full(len(p), 1e9)
    for i in range(len(line) - 1):
        axis = line[i + 1] - line[i]
        t = np.clip((p[:, :2] - line[i]) @ axis / (axis @ axis), 0, 1)
        d = np.linalg.norm(p[:, :2] - line[i] - t[:, None] * axis, axis=1)
        best = np.minimum(best, d - (width[i] + (width[i + 1] - width[i]) * t))
    return best


def plain(p: Array, n: Array) -> Array:
    return fill(p, np.ones(3))


def rubber(p: Array, n: Array) -> Array:
    base = fill(p, WHITE)
    return over(base, colour("#cfcbd8"), inside(np.abs(p[:, 1] - 0.0065) - 0.0012) * (np.abs(n[:, 1]) < 0.7))


def leather(p: Array, n: Array) -> Array:
    return fill(p, colour("#efeaf4"))


def sock(p: Array, n: Array) -> Array:
    return fill(p, colour("#dcd8e8"))


def trim(p: Array, n: Array) -> Array:
    return fill(p, PINK)


def skin(p: Array, n: Array) -> Array:
    return fill(p, SKIN)


def arm(p: Array, n: Array) -> Array:
    """Skin, rosier at the elbow's point and the finger tips."""
    s = (p - SHOULDER) @ ARM
    rosy = 0.30 * np.clip((s - 0.585) / 0.07, 0, 1) + 0.16 * np.exp(-(((s - 0.262) / 0.03) ** 2)) * (n[:, 2] < 0)
    return over(fill(p, SKIN), BLUSH, rosy)


def face(p: Array, n: Array) -> Array:
    """Skin with blush, brows and an open smile."""
    p = head.drawn(p)
    q = np.stack([np.abs(p[:, 0]), p[:, 1]], axis=1)
    front = p[:, 2] > 0.02
    base = fill(p, SKIN)
    blush = np.exp(-(((q[:, 0] - 0.046) / 0.016) ** 2) - ((q[:, 1] - 1.5480) / 0.0105) ** 2)
    base = over(base, BLUSH, 0.42 * blush * front)
    base = over(base, BLUSH, 0.30 * np.exp(-((p - [0, 1.5585, 0.1015]) ** 2).sum(1) / 0.006**2))
    socket = np.linalg.norm((q - [0.037, 1.592]) / [1.0, 0.85], axis=1)
    base = over(base, SHADE, 0.35 * inside(socket - 0.034, 0.010) * front)
    brow = stroke(
        q, [(0.0175, 1.6275), (0.030, 1.6315), (0.046, 1.6310), (0.0590, 1.6250)], [0.0020, 0.0028, 0.0024, 0.0008]
    )
    base = over(base, BROW, inside(brow) * front)
    return _smile(base, p, front)


def _smile(base: Array, p: Array, front: Array) -> Array:
    x, y, half = p[:, 0], p[:, 1] - 1.5330, 0.0290
    t = np.clip(np.abs(x) / half, 0, 1.5)
    top = 0.0098 * t**2
    low = -0.0125 + 0.0223 * t**2
    depth = np.maximum(y - top, low - y) * 0.85
    mouth = np.where(t < 1.0, depth, np.maximum(depth, np.abs(x) - half))
    base = over(
        base,
        colour("#e58d84"),
        0.45 * inside(np.where(t < 0.8, np.maximum(low - 0.0040 + 0.002 * t - y, y - low), 1), 0.0012) * front,
    )
    base = over(base, LINE, inside(mouth - 0.0016) * front)
    base = over(base, colour("#9c2f45"), inside(mouth + 0.0003) * front)
    base = over(base, colour("#e5677a"), inside(np.maximum(mouth + 0.0004, y - low - 0.0038)) * front)
    return over(base, WHITE, inside(np.maximum(mouth + 0.0005, top - 0.0056 - y)) * front)


def lid(p: Array, n: Array) -> Array:
    """Dark lashes; the lid's skin with a touch of eye shadow at the edge."""
    q = p - head.EYE
    radius = np.linalg.norm(q, axis=1)
    elevation = np.degrees(np.arctan2(q[:, 1], q[:, 2]))
    upper = elevation > 0
    base = over(fill(p, SKIN), colour("#d9718f"), 0.55 * np.clip(1 - (elevation - head.LID_EDGE) / 32, 0, 1) * upper)
    edge = np.where(upper, np.abs(elevation - head.LID_EDGE) - 4.0, np.abs(elevation - head.LOWER_EDGE) - 1.2)
    lash = inside(edge, 0.6) * np.where(upper, 1, 0.0)
    rope = (radius > head.EYE_RADIUS + np.where(upper, 0.00215, 0.00135)) & (edge < 8)
    return over(over(base, LASH, lash), LASH, rope * np.where(upper, 1.0, 0.35))


def eye(side: int) -> Paint:
    """White, a large green iris, pupil, two lights; drawn by direction, so that it turns with the eyeball."""

    def paint(p: Array, n: Array) -> Array:
        d = (p - head.EYE * [side, 1, 1]) / head.EYE_RADIUS
        angle = np.degrees(np.arctan2(np.hypot(d[:, 0], d[:, 1]), d[:, 2]))
        base = over(fill(p, colour("#fbfaff")), colour("#c9c4dc"), np.clip((d[:, 1] - 0.30) / 0.3, 0, 1) * 0.8)
        up = np.clip(d[:, 1] / 0.52 * 0.5 + 0.5, 0, 1)
        iris = over(fill(p, colour("#6fe0a0")), colour("#15694f"), up**0.8)
        turn = np.arctan2(d[:, 1], d[:, 0])
        rays = 0.5 + 0.5 * np.sin(turn * 17) * np.sin(turn * 29 + 1)
        iris = over(iris, colour("#b6f5c8"), 0.25 * rays * inside(np.abs(angle - 18) - 5, 3))
        iris = over(iris, colour("#0c3b34"), inside(28.4 - angle, 1.2))
        base = over(base, iris, inside(angle - 31.0, 0.7))
        base = over(
            base,
            colour("#0d1f24"),
            inside(np.degrees(np.arctan2(np.hypot(d[:, 0], d[:, 1] * 0.92), d[:, 2])) - 14, 0.8),
        )
        for x, y, size in ((0.155, 0.215, 7.2), (-0.16, -0.20, 3.8)):
            way = np.array([x, y, np.sqrt(1 - x * x - y * y)])
            base = over(
                base,
                np.ones(3),
                inside(
                    np.degrees(np.arccos(np.clip(d @ way / np.maximum(np.linalg.norm(d, axis=1), 1e-9), -1, 1))) - size,
                    0.7,
                ),
            )
        return base

    return paint


def hair(p: Array, n: Array) -> Array:
    """Strands that run back to the braid, deeper at the nape, a band of shine around the crown."""
    p = head.drawn(p)
    turn = np.arctan2(p[:, 0], p[:, 1] - 1.625)
    strands = 0.5 * np.sin(turn * 23 + 3 * np.sin(turn * 5)) + 0.5 * np.sin(turn * 41 + 2 * np.sin(turn * 9 + 1))
    base = over(
        fill(p, HAIR),
        HAIR_DEEP,
        0.22 * np.clip(strands, 0, 1) + 0.5 * np.clip((1.57 - p[:, 1]) / 0.06, 0, 1) * (p[:, 2] < 0.03),
    )
    shine = np.abs(n[:, 1] - 0.70 - 0.09 * strands) - 0.06  # torn by the strands: an even ring looks like a lid's edge
    strong = np.interp(p[:, 2], [-0.09, -0.02, 0.03], [0.10, 0.22, 0.50])
    return over(base, HAIR_SHINE, strong * inside(shine, 0.05) + 0.10 * np.clip(-strands, 0, 1))


def braid(p: Array, n: Array) -> Array:
    """Deep in the folds between strands, lighter on their backs."""
    t = np.clip((1.63 - p[:, 1]) / 0.42, 0, 1)
    line = head.braid_line(t)
    out = np.hypot(p[:, 0], p[:, 2] - line[:, 2])
    lines = np.sin(p[:, 1] * 900 + np.abs(p[:, 0]) * 1500)
    base = over(
        fill(p, HAIR), HAIR_DEEP, 0.8 * np.clip((0.021 - 0.008 * t - out) / 0.010, 0, 1) + 0.10 * np.clip(lines, 0, 1)
    )
    return over(base, HAIR_SHINE, 0.35 * np.clip((out - 0.024 + 0.008 * t) / 0.006, 0, 1))


def leggings(p: Array, n: Array) -> Array:
    """Indigo with a white and pink stripe down the outer side, a white rim above the socks."""
    axis = np.interp(p[:, 1], [0.1, 0.33, 0.49, 0.7, 0.9, 1.0], [-0.018, -0.010, 0.008, 0.0, -0.008, -0.012])
    outer = np.abs(p[:, 0]) > 0.09
    side = p[:, 2] - axis
    base = fill(p, INDIGO)
    base = over(base, colour("#433d98"), inside(np.abs(side) - 0.019, 0.001) * outer)
    base = over(base, WHITE, inside(np.abs(side - 0.006) - 0.0045, 0.001) * outer)
    base = over(base, PINK, inside(np.abs(side + 0.006) - 0.0045, 0.001) * outer)
    return over(base, WHITE, inside(p[:, 1] - SOCKS[1] - 0.013, 0.001))


def shirt(p: Array, n: Array) -> Array:
    """A raglan shirt: white body, indigo sleeves, a dance arrow on the chest and a larger one on the back."""
    base = fill(p, WHITE)
    x = np.abs(p[:, 0])
    seam = (x - 0.068) * 0.86 + (p[:, 1] - 1.435) * 0.36 + 0.012
    base = over(base, INDIGO, inside(-seam, 0.001))
    base = over(base, PINK, inside(np.abs(seam) - 0.0022, 0.001))
    along = (np.stack([x, p[:, 1], p[:, 2]], axis=1) - SHOULDER) @ ARM
    sleeve = (x > 0.17).astype(float)
    base = over(base, PINK, inside(CUFF - along, 0.001) * sleeve)
    base = over(base, colour("#3a3486"), inside(SLEEVE_END - 0.002 - along, 0.001) * sleeve)  # the opening's inside
    front = p[:, 2] > 0
    for y, size, where in ((1.150, 0.056, front), (1.160, 0.066, ~front)):
        d = arrow(np.stack([x, p[:, 1] - y], axis=1) / size) * size
        fade = np.clip((p[:, 1] - y) / size * 0.5 + 0.5, 0, 1)[:, None]
        base = over(base, VIOLET + (PINK - VIOLET) * fade, inside(d, 0.001) * where)
        base = over(base, WHITE, inside(np.abs(d + 0.10 * size) - 0.020 * size, 0.001) * where)
    return over(base, colour("#e3deed"), 0.8 * np.clip((HEM + 0.05 - p[:, 1]) / 0.05, 0, 1) * (x < 0.2))


def arrow(q: Array) -> Array:
    """Distance to an upward dance arrow of unit half size; q (n, 2) with x >= 0."""
    x, y = q[:, 0], q[:, 1]
    bars = np.maximum(np.abs(x + y - 0.66) * 0.7071 - 0.24, (x - 0.95 - 0.35 * (y + 0.2)) * 0.9)
    bars = np.maximum(bars, x - 0.92)
    stem = np.maximum(x - 0.24, np.maximum(y - 0.6, -0.95 - y))
    return np.minimum(bars, stem)


def figure(p: Array, n: Array) -> Array:
    """Pale grey, dark bands at the joints, a visor that shows where the head looks."""
    base = fill(p, colour("#d9dce6"))
    x, y = np.abs(p[:, 0]), p[:, 1]
    along = (np.stack([x, y, p[:, 2]], axis=1) - SHOULDER) @ ARM
    on_arm = (x > 0.17) & (along > 0.03)
    bands = [np.where(on_arm, np.abs(along - s), 1.0) for s in (0.045, 0.262)]
    bands += [np.where(on_arm, 1.0, np.abs(y - h)) for h in (0.485, 1.075, 1.475)]
    for d in bands:
        base = over(base, colour("#6f7690"), inside(d - 0.006, 0.001))
    visor = np.maximum(np.abs(y - 1.590) - 0.017, 0.045 - p[:, 2])
    return over(base, colour("#454b63"), inside(visor, 0.001))
