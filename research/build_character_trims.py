"""Lofted trims of the dancer: ribbing over the rims of her clothes, wristbands, soles, laces, hair ties."""

from __future__ import annotations

import build_character_body as body
import build_character_head as head
import numpy as np
from build_character_body import FRONT, HIP, PALM, UP, on_arm
from build_character_loft import Lofted, band, joined, loft, rope, section
from build_character_mesh import gradient
from build_character_sdf import Array, Shape, spline

RIGHT = np.array([1.0, 0.0, 0.0])


def hem() -> Lofted:
    curve, out, _ = section(body.shirt_cloth(), (0, body.HEM + 0.005, -0.012), RIGHT, FRONT, 36)
    return band(curve, out, 0.026, 0.0070)


def collar() -> Lofted:
    curve = _neck_curve(30)
    normal = gradient(body.shirt_cloth(), curve)
    outside = gradient(body.neckline(), curve)  # away from the neck: the ribbing leans onto the shirt
    across = np.cross(np.roll(curve, -1, 0) - np.roll(curve, 1, 0), normal)
    lean = 0.22 * np.sign((across * outside).sum())
    return band(curve, normal, 0.018, 0.0075, lean=float(lean))


def _neck_curve(count: int) -> Array:
    """Where the neckline leaves the surface of the shirt: Newton steps in the half plane of each angle."""
    shirt, neck = body.shirt_cloth(), body.neckline()
    turn = np.linspace(0, 2 * np.pi, count, endpoint=False)
    ray = np.stack([np.sin(turn), np.zeros(count), np.cos(turn)], axis=1)
    r, y = np.full(count, 0.075), 1.432 - 0.035 * np.cos(turn)

    def both(r: Array, y: Array) -> Array:
        p = np.array([0, 0, -0.008]) + r[:, None] * ray + y[:, None] * UP
        return np.stack([shirt(p), neck(p)], axis=1)

    for _ in range(60):
        f, h = both(r, y), 1e-4
        jr, jy = (both(r + h, y) - f) / h, (both(r, y + h) - f) / h
        det = jr[:, 0] * jy[:, 1] - jr[:, 1] * jy[:, 0]
        det = np.where(np.abs(det) < 0.05, 0.05 * np.sign(det + 1e-9), det)
        r = r - np.clip((f[:, 0] * jy[:, 1] - f[:, 1] * jy[:, 0]) / det, -0.004, 0.004)
        y = y - np.clip((jr[:, 0] * f[:, 1] - jr[:, 1] * f[:, 0]) / det, -0.004, 0.004)
    return np.round(np.array([0, 0, -0.008]) + r[:, None] * ray + y[:, None] * UP, 7)


def wristband() -> Lofted:
    curve, out, _ = section(body.arm(), on_arm(0.447, 0.007), PALM, FRONT, 18, 0.06)
    return band(curve, out, 0.040, 0.0105)


def shoe_collar() -> Lofted:
    """The padded rim of the shoe."""
    x = HIP[0]
    tilt = np.array([0.0, 0.12, 1.0]) / np.hypot(1, 0.12)
    curve, out, _ = section(body.shoe_upper(), (x, 0.1235, -0.019), RIGHT, tilt, 22, 0.09)
    return band(curve - 0.002 * out, out, 0.016, 0.0095, lean=-0.1)


def outline() -> Array:
    """The shoe from below: x from its middle and z, (n, 2)."""
    out = [
        (0.0000, 0.1830), (0.0200, 0.1760), (0.0345, 0.1600), (0.0425, 0.1380), (0.0465, 0.1100), (0.0465, 0.0820),
        (0.0450, 0.0500), (0.0435, 0.0150), (0.0430, -0.0200), (0.0405, -0.0450), (0.0315, -0.0650), (0.0165, -0.0765),
        (0.0000, -0.0790),
    ]  # fmt: skip
    inner = [(-w * (1.03 if z > 0.06 else 0.98), z) for w, z in out[-2:0:-1]]
    return spline([*out, *inner, out[0]], 1)[:-1]


def sole() -> Lofted:
    """White rubber with a flat bottom on y = 0, higher at the toe, where it is the shoe's cap."""
    x, ring = HIP[0], outline()
    z = ring[:, 1]
    toe = np.clip((z - 0.115) / 0.055, 0, 1) ** 1.3
    rise = np.clip((z - 0.12) / 0.06, 0, 1) ** 2 * 0.004
    high = 0.0235 + 0.011 * toe
    rings = []
    for scale, y in (
        (0.93, 0.0 * z),
        (0.985, 0.0015 + rise * 0.3),
        (1.0, 0.006 + rise),
        (1.0, high - 0.003),
        (0.985, high),
        (0.90, high + 0.0005),
    ):
        centre = np.array([0.0, 0.05])
        flat = centre + (ring - centre) * scale
        rings.append(np.stack([x + flat[:, 0], np.broadcast_to(y, len(z)), flat[:, 1]], axis=1))
    return loft([*rings, around(body.shoe_upper(), ring + np.array([x, 0.0]), high + 0.002)])


def around(shape: Shape, ring: Array, y: Array) -> Array:
    """The line where a sole meets the upper: along each ray from the middle, 2 mm outside its surface."""
    middle = np.array([HIP[0], 0.05])
    low, high = np.zeros(len(ring)), np.ones(len(ring))
    length = np.linalg.norm(ring - middle, axis=1)
    for _ in range(40):
        mid = (low + high) / 2
        p = middle + mid[:, None] * (ring - middle)
        inside = shape(np.stack([p[:, 0], y, p[:, 1]], axis=1)) < 0
        low, high = np.where(inside, mid, low), np.where(inside, high, mid)
    flat = middle + np.round(np.minimum(low + 0.0022 / length, 0.985), 7)[:, None] * (ring - middle)
    return np.stack([flat[:, 0], y, flat[:, 1]], axis=1)


def laces() -> Lofted:
    """Four laces over the instep and a bow, laid on the upper's surface."""
    x, parts = HIP[0], []
    shape = body.shoe_upper()
    for z, w in ((0.088, 0.017), (0.070, 0.018), (0.053, 0.019), (0.038, 0.019)):
        points = []
        for aside in (-1.0, -0.5, 0.0, 0.5, 1.0):
            p = np.array([x + aside * w, 0.05, z - 0.004 * abs(aside)])
            low, high = 0.02, 0.16
            for _ in range(40):
                mid = (low + high) / 2
                low, high = (mid, high) if shape(np.array([[p[0], mid, p[2]]]))[0] < 0 else (low, mid)
            points.append([p[0], round(low, 7) + 0.0012, p[2]])
        parts.append(rope(points, [0.0026, 0.0032, 0.0032, 0.0032, 0.0026], 4, 1, UP))
    return joined(*parts)


def hair_ties() -> Lofted:
    """The band at the head and the one above the braid's tip."""
    out = []
    for t, radius, width in ((0.020, 0.0265, 0.020), (0.898, 0.0115, 0.016)):
        here, after = head.braid_line(np.array([t, t + 0.02]))
        along = (after - here) / np.linalg.norm(after - here)
        across = np.cross(along, RIGHT)
        a = np.linspace(0, 2 * np.pi, 10, endpoint=False)[:, None]
        out_way = np.cos(a) * RIGHT + np.sin(a) * across
        out.append(band(here + radius * out_way, out_way, width, 0.010 if radius > 0.02 else 0.007))
    return joined(*out)
