"""The parts of the dancer: surface, skinning, paint and colour of each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import build_character_body as body
import build_character_head as head
import build_character_heels as heels
import build_character_paint as paint
import build_character_trims as trims
import numpy as np
from build_character_bake import Paint
from build_character_loft import Lofted, joined
from build_character_mesh import Size, even, gradient, surface
from build_character_sdf import Array, Shape

Box = tuple[tuple[float, float, float], tuple[float, float, float]]
SHOES = "shoes"  # the mesh of soles, collars, laces and socks; other shoes stand in for it
Skin = str  # "heat" over the body, "foot", "braid", "jaw", or the one joint that holds the part


@dataclass(frozen=True)
class Part:
    """One part.

    make : its surface; skin : how it is held; density : texels a metre; paint : its colours
    mirror : modelled on the left, copied to the right; tint : the limb whose colour it wears instead of paint
    shade : how dark hollows are painted; ankles : it reaches into the shoes; mesh : what it is drawn with
    on : the cloth it lies on; what lies on one cloth bends as one
    socks : it ends in socks in the feet's colours, which are cut off it at these heights, bottom and top
    """

    name: str
    make: Callable[[], Lofted]
    skin: Skin
    density: float
    paint: Paint
    mirror: bool = False
    tint: str = ""
    shade: float = 0.22
    ankles: bool = False
    mesh: str = "body"
    on: Shape | None = None
    socks: tuple[float, float] | None = None


def of_shape(shape: Shape, box: Box, grid: float, size: Size) -> Callable[[], Lofted]:
    """A maker of the shape's mesh."""
    return lambda: surface(shape, *box, grid, size)


def leggings_mesh() -> Lofted:
    """The leggings, with normals that pass over the fold between the legs."""
    leg = ramp(
        [0.09, 0.14, 0.40, 0.44, 0.53, 0.57, 0.75, 0.85, 1.0],
        [0.016, 0.0205, 0.0260, 0.0180, 0.0180, 0.0265, 0.0272, 0.0220, 0.030],
        lambda p: p[:, 1],
    )

    shape = body.leggings()
    points, _, triangles = surface(shape, (-0.20, 0.05, -0.16), (0.20, 1.05, 0.12), 0.006, fine_between_legs(leg))
    normals = softer(gradient(shape, points, 0.006), gradient(shape, points, 0.035), 0.7)
    x, y, z = (points - [0, 0.810, 0]).T
    fold = np.exp(-((x / 0.055) ** 4) - (y / 0.055) ** 4) * np.clip(0.3 + z / 0.03, 0, 1)
    level = np.stack([1 - 0.5 * fold, 1 - fold * (normals[:, 1] < 0), np.ones_like(fold)], axis=1)
    return points, calm_hips(points, unit(normals * level)), triangles


def calm_hips(points: Array, normals: Array) -> Array:
    """Normals of the leggings' upper part that look up by the same angle at all heights: no patches of light on belly
    and hips.
    """
    level = normals.copy()
    level[:, 1] = 0.10 + 0.15 * normals[:, 1]
    return softer(normals, unit(level), 0.9 * np.interp(points[:, 1], [0.70, 0.82], [0.0, 1.0]))


def fine_between_legs(size: Size) -> Size:
    """The sizes given, smaller where the thighs part: there neighbours go with different legs."""

    def both(p: Array) -> Array:
        fork = np.linalg.norm((p - [0, 0.790, 0]) / [0.03, 0.03, 0.06], axis=1)
        return np.minimum(size(p), np.interp(fork, [1.0, 1.8], [0.0100, 0.0272]))

    return both


def shirt_mesh() -> Lofted:
    """The shirt, with normals that do not turn under at its edges; finer at the neckline."""
    neck = body.neckline()
    edge = ramp([0.008, 0.03], [0.0125, 0.0245], lambda p: np.minimum(np.abs(neck(p)), np.abs(p[:, 1] - body.HEM)))
    shoulder = ramp([0.060, 0.085], [0.0175, 0.0245], lambda p: np.linalg.norm(p * _on_left(p) - body.SHOULDER, axis=1))
    cuff = ramp(
        [0.058, 0.070], [0.0115, 0.0245], lambda p: np.linalg.norm(p * _on_left(p) - body.on_arm(0.114), axis=1)
    )
    points, _, triangles = surface(
        body.shirt(),
        (-0.32, 0.96, -0.14),
        (0.32, 1.46, 0.14),
        0.005,
        lambda p: np.minimum(np.minimum(edge(p), cuff(p)), shoulder(p)),
    )
    normals = softer(gradient(body.shirt_cloth(), points), gradient(body.shirt_cloth(), points, 0.040), 0.85)
    normals = lit_from_the_side(points, normals)
    bowl = np.abs(neck(points)) < 0.002
    normals[bowl] = -gradient(neck, points[bowl])
    return points, normals, triangles


def lit_from_the_side(points: Array, normals: Array) -> Array:
    """Normals of the shirt's body that all look a little up: shade runs down her side, not across chest and belly."""
    x, y, _ = points.T
    body = np.clip((0.150 - np.abs(x)) / 0.03, 0, 1) * np.interp(y, [1.28, 1.40], [1.0, 0.0])
    level = normals.copy()
    level[:, 1] = 0.32 + 0.25 * normals[:, 1]
    return softer(normals, unit(level), 0.9 * body)


def _on_left(p: Array) -> Array:
    """Signs (n, 3) that take points to her left side."""
    return np.stack([np.sign(p[:, 0]), np.ones(len(p)), np.ones(len(p))], axis=1)


def arm_mesh(size: Size) -> Lofted:
    """The arm, its hand lit and outlined as one: at publishing size each finger or tendon by itself is a speckle."""
    shape = body.arm()
    points, normals, triangles = surface(shape, (0.15, 0.84, -0.07), (0.67, 1.39, 0.09), 0.0032, size)
    along = _along_arm(points)
    normals = softer(normals, gradient(shape, points, 0.030), 0.85 * np.clip((along - 0.47) / 0.03, 0, 1))
    return (
        points,
        softer(normals, gradient(shape, points, 0.014), 0.6 * np.clip((along - 0.58) / 0.03, 0, 1)),
        triangles,
    )


def face_mesh() -> Lofted:
    """The head, with calm normals in the face."""
    shape = head.head()
    points, _, triangles = surface(shape, (-0.11, 1.45, -0.13), (0.11, 1.76, 0.14), 0.003, _face_first)
    return points, round_face(points, gradient(shape, points, 0.003)), triangles


def ramp(keys: list[float], sizes: list[float], of: Callable[[Array], Array]) -> Size:
    """Edge lengths that follow a measure along the part."""
    return lambda p: np.interp(of(p), keys, sizes)


def _along_arm(p: Array) -> Array:
    return np.asarray((p - body.SHOULDER) @ body.ARM)


def _face_first(p: Array) -> Array:
    """Fine in the face, coarse under the hair."""
    face = np.linalg.norm((p - [0, 1.555, 0.075]) / [0.065, 0.05, 0.05], axis=1)
    return np.interp(face, [0.5, 1.3, 2.2], [0.0066, 0.0095, 0.0200])


def round_face(points: Array, normals: Array) -> Array:
    """Normals of the face turned towards those of a ball, so that drawn light falls on it in large calm areas."""
    ball = unit(points - [0, 1.500, -0.030])
    share = 0.75 * np.clip((points[:, 2] - 0.0) / 0.05, 0, 1) * np.clip(1 - (points[:, 2] - 0.096) / 0.006, 0.6, 1)
    return softer(normals, ball, share)


def locks_mesh() -> Lofted:
    """The fringe and side locks, their outer sides lit as one head of hair."""
    points, normals, triangles = joined(*head.locks())
    ball = unit(points - [0, 1.620, 0.0])
    return points, softer(normals, ball, 0.7 * np.clip(1.5 * (normals * ball).sum(1), 0, 1)), triangles


def softer(normals: Array, calm: Array, share: Array | float) -> Array:
    """Unit normals turned by a share, (n,) or one for all, towards calmer ones."""
    return unit(normals + np.reshape(share, (-1, 1)) * (calm - normals))


def unit(vectors: Array) -> Array:
    """Vectors (n, 3) at length 1."""
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


def surfaces() -> dict[str, Callable[[], Lofted]]:
    """Makers of the parts that are modelled with distance functions: shape, box, grid, edge length."""
    arm = ramp(
        [0.0, 0.20, 0.24, 0.29, 0.33, 0.44, 0.50, 0.57, 0.63, 0.65],
        [0.022, 0.0195, 0.0150, 0.0150, 0.0195, 0.0160, 0.0112, 0.0079, 0.0074, 0.0062],
        _along_arm,
    )
    hairline = ramp([-0.02, 0.045], [0.0195, 0.0108], lambda p: p[:, 2])
    shoe_box = ((0.02, -0.01, -0.10), (0.16, 0.16, 0.21))
    braid_box = ((-0.05, 1.18, -0.20), (0.05, 1.68, -0.08))
    return {
        "arm": lambda: arm_mesh(arm),
        "neck": of_shape(body.chest_skin(), ((-0.12, 1.31, -0.13), (0.12, 1.58, 0.12)), 0.004, even(0.0185)),
        "hair": of_shape(head.hair(), ((-0.14, 1.45, -0.19), (0.14, 1.79, 0.16)), 0.004, hairline),
        "braid": of_shape(head.braid(), braid_box, 0.0025, even(0.0116)),
        "shoe": of_shape(body.shoe_upper(), shoe_box, 0.003, even(0.0140)),
    }


def parts() -> list[Part]:
    """All parts of the dancer, in the order in which they are written."""
    made, cloth = surfaces(), body.shirt_cloth()
    return [
        Part("leggings", leggings_mesh, "heat", 470, paint.leggings, shade=0.0, ankles=True, socks=body.SOCKS),
        Part("shirt", shirt_mesh, "heat", 660, paint.shirt, shade=0.10, on=cloth),
        Part("shirt trim", lambda: joined(trims.hem(), trims.collar()), "heat", 400, paint.trim, on=cloth),
        Part("arm", made["arm"], "heat", 560, paint.arm, mirror=True),
        Part("neck", made["neck"], "heat", 450, paint.skin),
        Part("head", face_mesh, "jaw", 1750, paint.face),
        Part("hair", made["hair"], "skullbase", 700, paint.hair),
        Part("locks", locks_mesh, "skullbase", 800, paint.hair),
        Part("braid", made["braid"], "braid", 700, paint.braid),
        Part("hair ties", trims.hair_ties, "braid", 400, paint.trim),
        *_limb_parts(made["shoe"]),
        Part("laces", trims.laces, "foot", 300, paint.rubber, mirror=True, mesh=SHOES),
        Part("left eye", lambda: eye(1), "l_eyeball_joint", 2200, paint.eye(1), shade=0.0, mesh="eyes"),
        Part("right eye", lambda: eye(-1), "r_eyeball_joint", 2200, paint.eye(-1), shade=0.0, mesh="eyes"),
        Part("lid", lambda: lid(True), "eyelid_joint", 1300, paint.lid, mirror=True, shade=0.0, mesh="eyelids"),
        Part("lower lid", lambda: lid(False), "skullbase", 1300, paint.lid, mirror=True, shade=0.0),
    ]


def _limb_parts(shoe: Callable[[], Lofted]) -> list[Part]:
    """The parts in the limbs' colours, and the rest of the shoe."""
    return [
        Part("shoe", shoe, "foot", 0, paint.plain, mirror=True, tint="foot"),
        Part("wristband", trims.wristband, "heat", 0, paint.plain, mirror=True, tint="hand"),
        Part("shoe collar", trims.shoe_collar, "foot", 300, paint.rubber, mirror=True, mesh=SHOES),
        Part("sole", trims.sole, "foot", 400, paint.rubber, mirror=True, mesh=SHOES),
        Part("sock", _sock(), "foot", 200, paint.sock, mirror=True, shade=0.0, mesh=SHOES),
    ]


def heel_parts() -> list[Part]:
    """The shoes of `--gait heels`, which replace the parts called shoe or `SHOES`."""
    box = ((0.02, -0.01, -0.10), (0.16, 0.16, 0.21))
    upper = of_shape(heels.upper(), box, 0.0025, even(0.0125))
    return [
        Part("shoe", upper, "foot", 0, paint.plain, mirror=True, tint="foot"),
        Part("shoe collar", trims.shoe_collar, "foot", 300, paint.rubber, mirror=True, mesh=SHOES),
        Part("sole", heels.sole, "foot", 400, paint.leather, mirror=True, shade=0.0, mesh=SHOES),
        Part("sock", _sock(), "foot", 200, paint.sock, mirror=True, shade=0.0, mesh=SHOES),
    ]


def _sock() -> Callable[[], Lofted]:
    return of_shape(body.sock(), ((0.04, 0.11, -0.07), (0.14, 0.14, 0.03)), 0.003, even(0.020))


def mannequin_parts() -> list[Part]:
    """A plain figure that shows the pose: one skin with its joints marked, and the limbs' colours."""
    fine = ramp([0.30, 0.50, 0.56, 0.62], [0.0215, 0.0150, 0.0095, 0.0078], lambda p: np.abs(p[:, 0]))
    make = of_shape(body.figure(), ((-0.68, 0.05, -0.18), (0.68, 1.76, 0.16)), 0.0055, fine_between_legs(fine))
    figure = Part("figure", make, "heat", 700, paint.figure, shade=0.0, ankles=True, socks=body.SOCKS)
    return [figure, *_limb_parts(surfaces()["shoe"])]


def lid(upper: bool) -> Lofted:
    """The left upper or lower lid with its lashes."""
    points, normals, triangles = joined(*head.lid(upper))
    if not upper:
        normals = softer(normals, np.array([[0.1, 0.5, 0.86]]), np.clip(2 * normals[:, 2], 0, 0.8))
    return points + head.EYE, normals, triangles


def eye(side: int) -> Lofted:
    """The left (1) or right (-1) eyeball."""
    points, normals, triangles = head.ball(head.EYE_RADIUS, 16, 11)
    normals = softer(
        normals, np.array([[0.0, 0.5, 0.87]]), np.clip(2 * normals[:, 2], 0, 0.8)
    )  # white is white all over
    return points + head.EYE * [side, 1, 1], normals, triangles
