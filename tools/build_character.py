"""Build the dancer of the package: rounded lofted parts skinned to the skeleton (first version)."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from dancetutor_cli.character.model import Character, Material, Mesh
from dancetutor_cli.character.reader import vertex_normals
from dancetutor_cli.colours import limb_colours
from dancetutor_cli.formats.glb import write_glb
from dancetutor_cli.rig.skeleton import dancer_skeleton

OUT = Path(__file__).resolve().parent.parent / "dancetutor_cli/character/data/dancer.glb"
SK = dancer_skeleton()
REST = {n: p for n, p in zip(SK.names, SK.rest)}
SWATCH = {
    "skin": "#f0b890",
    "hair": "#b5386b",
    "top": "#f4f1f7",
    "leggings": "#3b3470",
    "white": "#ffffff",
    "iris": "#3c8a5a",
    "dark": "#2a1c2c",
    "lip": "#d0606a",
    "lfoot": "",
    "rfoot": "",
    "lhand": "",
    "rhand": "",
}


def tube(points, radii, weights, side=(1, 0, 0), flat=1.0, n=16):
    """Loft circles (x across, times flat in depth) along points; weights one dict per ring."""
    points, rings = np.asarray(points, float), []
    for i, p in enumerate(points):
        t = points[min(i + 1, len(points) - 1)] - points[max(i - 1, 0)]
        t /= np.linalg.norm(t)
        u = np.asarray(side, float) - np.dot(side, t) * t
        u /= np.linalg.norm(u)
        v = np.cross(t, u)
        a = np.linspace(0, 2 * np.pi, n, endpoint=False)
        r = np.atleast_1d(radii[i])
        rx, rz = (r[0], r[-1] * (flat if len(r) == 1 else 1))
        rings.append(p + np.cos(a)[:, None] * u * rx + np.sin(a)[:, None] * v * rz)
    pos = np.concatenate([*rings, points[:1], points[-1:]])
    tri, m = [], len(points)
    for i in range(m - 1):
        for k in range(n):
            a, b, c, d = i * n + k, i * n + (k + 1) % n, (i + 1) * n + k, (i + 1) * n + (k + 1) % n
            tri += [(a, b, d), (a, d, c)]
    tri += [(m * n, (k + 1) % n, k) for k in range(n)]
    tri += [(m * n + 1, (m - 1) * n + k, (m - 1) * n + (k + 1) % n) for k in range(n)]
    w = [weights[i] for i in range(m) for _ in range(n)] + [weights[0], weights[-1]]
    return pos, np.array(tri), w


def limb(names, radii, ends=(0.0, 0.0), steps=10, **kw):
    """A tube through joints, blending weights within 25 % of a bone around each joint."""
    pts = [REST.get(n, n) if isinstance(n, str) else np.asarray(n, float) for n in names[0]]
    out_p, out_r, out_w = [], [], []
    bones = names[1]
    for i in range(len(pts) - 1):
        for s in np.linspace(0, 1, steps, endpoint=i == len(pts) - 2):
            out_p.append(pts[i] * (1 - s) + pts[i + 1] * s)
            out_r.append(np.asarray(radii[i]) * (1 - s) + np.asarray(radii[i + 1]) * s)
            prev = np.clip(0.5 - s / 0.4, 0, 1) if i > 0 else 0
            nxt = np.clip((s - 0.8) / 0.4, 0, 1) if i < len(bones) - 1 else 0
            w = {bones[i]: 1 - prev - nxt}
            if prev:
                w[bones[i - 1]] = w.get(bones[i - 1], 0) + prev
            if nxt:
                w[bones[i + 1]] = w.get(bones[i + 1], 0) + nxt
            out_w.append(w)
    # rounded ends
    for end in (0, 1):
        if not ends[end]:
            continue
        i = -end
        d = out_p[i] - out_p[i + (1 if end == 0 else -1)]
        d /= np.linalg.norm(d)
        base_p, base_r, base_w = out_p[i], np.asarray(out_r[i]), out_w[i]
        for a in (0.5, 0.8, 0.97):
            p, r = base_p + d * ends[end] * a, base_r * np.sqrt(1 - a * a)
            if end:
                out_p.append(p), out_r.append(r), out_w.append(base_w)
            else:
                out_p.insert(0, p), out_r.insert(0, r), out_w.insert(0, base_w)
    return tube(out_p, out_r, out_w, **kw)


def ball(centre, radii, joint, n=20):
    a = np.linspace(-np.pi / 2, np.pi / 2, 14)[1:-1]
    c = np.asarray(centre, float)
    r = np.asarray(radii, float)
    pts = [c + (0, r[1] * np.sin(x), 0) for x in a]
    return tube(pts, [(r[0] * np.cos(x), r[2] * np.cos(x)) for x in a], [{joint: 1}] * len(a), n=n)


def parts():
    yield (
        "top",
        limb(
            (
                ["HumanoidRoot", "vl5", "vt10", "vt4", (0, 1.40, -0.02), "vc4"],
                ["HumanoidRoot", "vl5", "vt10", "vt4", "vt4"],
            ),
            [(0.15, 0.1), (0.125, 0.09), (0.125, 0.095), (0.145, 0.105), (0.13, 0.08), (0.05, 0.05)],
            (0.03, 0.02),
            6,
            n=24,
        ),
    )
    yield "skin", limb((["vc4", "skullbase", (0, 1.6, 0.005)], ["vc4", "skullbase"]), [0.05, 0.045, 0.06], (0.03, 0))
    yield "skin", ball((0, 1.595, 0.005), (0.082, 0.112, 0.092), "skullbase")
    yield "hair", ball((0, 1.622, -0.018), (0.094, 0.105, 0.098), "skullbase")
    yield (
        "hair",
        limb(
            (["braid1", "braid2", "braid3", "braid4", (0, 1.19, -0.155)], ["braid1", "braid2", "braid3", "braid4"]),
            [0.03, 0.03, 0.028, 0.025, 0.012],
            (0.02, 0.02),
        ),
    )
    yield (
        "leggings",
        limb(
            ([(0, 1.0, -0.01), (0, 0.86, -0.005)], ["HumanoidRoot"]), [(0.135, 0.095), (0.15, 0.105)], (0, 0.04), n=24
        ),
    )
    yield "lip", ball((0, 1.535, 0.088), (0.02, 0.004, 0.006), "skullbase")
    for s, x in (("l", 1), ("r", -1)):
        e = REST[f"{s}_elbow"] - REST[f"{s}_shoulder"]
        w = REST[f"{s}_radiocarpal"]
        d = e / np.linalg.norm(e)
        yield (
            "leggings",
            limb(
                ([f"{s}_hip", f"{s}_knee", f"{s}_talocrural"], [f"{s}_hip", f"{s}_knee"]),
                [0.085, 0.055, 0.038],
                (0.05, 0.02),
            ),
        )
        yield (
            "skin",
            limb(
                ([f"{s}_shoulder", f"{s}_elbow", f"{s}_radiocarpal"], [f"{s}_shoulder", f"{s}_elbow"]),
                [0.043, 0.035, 0.026],
                (0.03, 0.01),
                side=(0, 0, 1),
            ),
        )
        yield (
            "top",
            limb(
                (
                    [
                        REST[f"{s}_shoulder"] - (0.03 * x, -0.01, 0),
                        REST[f"{s}_shoulder"],
                        REST[f"{s}_shoulder"] + d * 0.11,
                    ],
                    ["vt4", f"{s}_shoulder"],
                ),
                [0.055, 0.056, 0.05],
                (0.03, 0.005),
                side=(0, 0, 1),
            ),
        )
        yield (
            "skin",
            limb(
                ([w, w + d * 0.17], [f"{s}_radiocarpal"]), [(0.03, 0.018), (0.03, 0.012)], (0.01, 0.01), side=(0, 0, 1)
            ),
        )
        yield (
            f"{s}hand",
            limb(([w - d * 0.05, w - d * 0.01], [f"{s}_elbow"]), [0.034, 0.034], (0.005, 0.005), 3, side=(0, 0, 1)),
        )
        a = REST[f"{s}_talocrural"]
        for colour, y, h, g in ((f"{s}foot", 0.032, 0.034, 0.0), ("white", 0.011, 0.0109, 0.004)):
            yield (
                colour,
                limb(
                    (
                        [(a[0], y, -0.045), (a[0], y, 0.097), (a[0] + 0.004 * x, y * 0.8 if h > 0.02 else y, 0.15)],
                        [f"{s}_talocrural", f"{s}_metatarsal"],
                    ),
                    [(0.034 + g, h), (0.044 + g, h), (0.038 + g, h * (0.78 if h > 0.02 else 1))],
                    (0.03 + g, 0.035 + g),
                    8,
                ),
            )
        yield (
            f"{s}foot",
            limb(([a - (0, 0.03, 0), a + (0, 0.02, 0)], [f"{s}_talocrural"]), [0.042, 0.042], (0, 0.008), 3),
        )
        eye = REST[f"{s}_eyeball_joint"]
        yield "white", ball(eye, (0.03,) * 3, f"{s}_eyeball_joint")
        yield "iris", ball(eye + (0, -0.001, 0.0155), (0.0165, 0.0165, 0.0165), f"{s}_eyeball_joint")
        yield "dark", ball(eye + (0, -0.001, 0.0245), (0.009, 0.010, 0.009), f"{s}_eyeball_joint")
        yield "skin", ball(eye + (0, 0.0145, -0.006), (0.031, 0.0185, 0.031), f"{s}_eyelid_joint")
        yield (
            "hair",
            limb(
                (
                    [eye + (-0.018 * x, 0.037, 0.022), eye + (0, 0.042, 0.026), eye + (0.02 * x, 0.036, 0.018)],
                    ["skullbase"] * 2,
                ),
                [0.003, 0.004, 0.002],
                (0.003, 0.003),
                4,
            ),
        )


def build() -> Character:
    limbs = limb_colours()
    colours = {k: tuple(int(v[i : i + 2], 16) for i in (1, 3, 5)) for k, v in SWATCH.items() if v}
    colours |= dict(lfoot=limbs.left_foot, rfoot=limbs.right_foot, lhand=limbs.left_hand, rhand=limbs.right_hand)
    names = list(colours)
    atlas = np.full((64, 64, 4), 255, np.uint8)
    for i, n in enumerate(names):
        atlas[16 * (i // 4) : 16 * (i // 4) + 16, 16 * (i % 4) : 16 * (i % 4) + 16, :3] = colours[n]
    material = Material("dancer", (1, 1, 1, 1), atlas)
    P, N, U, T, J, W, at = [], [], [], [], [], [], 0
    for name, (pos, tri, weights) in parts():
        a, b, c = (pos[tri[:, k]] for k in range(3))
        volume = np.sum(np.cross(b - a, c - a) * (a - pos.mean(0)))
        tri = tri if volume > 0 else tri[:, ::-1]
        nrm = vertex_normals(pos, tri)
        P.append(pos), N.append(nrm / np.maximum(np.linalg.norm(nrm, axis=1, keepdims=True), 1e-12)), T.append(tri + at)
        at += len(pos)
        i = names.index(name)
        U.append(np.tile([(i % 4 + 0.5) / 4, (i // 4 + 0.5) / 4], (len(pos), 1)))
        for w in weights:
            pairs = sorted(w.items(), key=lambda x: -x[1])[:4]
            pairs += [(pairs[0][0], 0.0)] * (4 - len(pairs))
            J.append([SK.index(p[0]) for p in pairs]), W.append([p[1] for p in pairs])
    W = np.array(W, np.float32)
    inv = np.tile(np.eye(4), (len(SK.names), 1, 1))
    inv[:, :3, 3] = -SK.rest
    mesh = Mesh(
        "dancer",
        np.concatenate(P).astype(np.float32),
        np.concatenate(N).astype(np.float32),
        np.concatenate(U).astype(np.float32),
        np.concatenate(T).astype(np.int32),
        np.array(J, np.uint16),
        W / W.sum(1, keepdims=True),
        material,
    )
    return Character("dancer", SK, (mesh,), inv)


if __name__ == "__main__":
    write_glb(OUT, build())
    print(OUT, OUT.stat().st_size)
