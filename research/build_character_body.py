"""The dancer's body and clothes as signed distance functions, on the rest positions of `dance.rig.skeleton`.

Sections are drawn as an artist draws a front and a side view: (station, half width, depth to the front, depth to the
back, shift to the front, shift aside), all in metres. The dancer is 1.70 m tall and athletic. Head, hands and feet are
slightly larger than life, because that is clearer at 720p.
"""

from __future__ import annotations

import numpy as np
from build_character_sdf import (
    Shape,
    blend,
    both,
    carve,
    common,
    cone,
    ellipsoid,
    grow,
    half_space,
    near,
    stack,
    tube,
)

from dancetutor_cli.dance.rig.skeleton import dancer_skeleton

SKELETON = dancer_skeleton()
REST = dict(zip(SKELETON.names, SKELETON.rest, strict=True))
UP, FRONT = np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])
HIP, SHOULDER, WRIST = REST["l_hip"], REST["l_shoulder"], REST["l_radiocarpal"]
ARM = (REST["l_elbow"] - SHOULDER) / np.linalg.norm(REST["l_elbow"] - SHOULDER)
PALM = np.cross(ARM, FRONT)  # the way the palm looks: to the thigh

TORSO = [
    (0.828, 0.060, 0.052, 0.056, -0.004), (0.842, 0.098, 0.069, 0.074, -0.003), (0.860, 0.136, 0.082, 0.088, -0.004),
    (0.880, 0.160, 0.088, 0.096, -0.006), (0.920, 0.160, 0.087, 0.097, -0.010),
    (0.960, 0.147, 0.083, 0.088, -0.012), (1.000, 0.129, 0.078, 0.079, -0.014), (1.060, 0.112, 0.072, 0.073, -0.014),
    (1.100, 0.109, 0.071, 0.073, -0.014), (1.160, 0.114, 0.075, 0.077, -0.016), (1.220, 0.123, 0.079, 0.082, -0.018),
    (1.280, 0.131, 0.080, 0.086, -0.022), (1.330, 0.133, 0.075, 0.085, -0.026), (1.370, 0.122, 0.064, 0.076, -0.027),
    (1.400, 0.096, 0.053, 0.062, -0.025), (1.430, 0.056, 0.042, 0.048, -0.021), (1.465, 0.037, 0.035, 0.038, -0.014),
]  # fmt: skip
LEG = [
    (-0.110, 0.040, 0.045, 0.045, 0.000, 0.030), (-0.070, 0.062, 0.066, 0.068, -0.001, 0.014),
    (-0.030, 0.0735, 0.077, 0.080, -0.001, 0.003), (0.030, 0.0795, 0.0815, 0.087, -0.003),
    (0.100, 0.079, 0.081, 0.084, -0.001),
    (0.200, 0.069, 0.074, 0.072, 0.002), (0.300, 0.058, 0.063, 0.060, 0.006), (0.370, 0.0515, 0.055, 0.051, 0.009),
    (0.410, 0.0490, 0.053, 0.047, 0.010), (0.450, 0.0455, 0.047, 0.047, 0.006), (0.500, 0.0475, 0.045, 0.055, 0.000),
    (0.560, 0.0485, 0.042, 0.060, -0.004), (0.620, 0.0445, 0.038, 0.054, -0.007), (0.700, 0.0355, 0.032, 0.040, -0.012),
    (0.770, 0.0300, 0.030, 0.034, -0.017), (0.800, 0.0300, 0.031, 0.035, -0.018), (0.840, 0.0300, 0.031, 0.035, -0.018),
]  # fmt: skip
ARM_ROWS = [
    (-0.020, 0.040, 0.042, 0.042, 0.000), (0.040, 0.041, 0.041, 0.041, 0.000), (0.100, 0.038, 0.037, 0.038, 0.000),
    (0.180, 0.034, 0.034, 0.035, 0.000), (0.262, 0.0295, 0.031, 0.032, -0.001), (0.300, 0.031, 0.034, 0.032, 0.000),
    (0.340, 0.0305, 0.035, 0.031, 0.002), (0.400, 0.027, 0.030, 0.027, 0.005), (0.460, 0.0215, 0.025, 0.0225, 0.007),
    (0.492, 0.0190, 0.0240, 0.0215, 0.008), (0.520, 0.0170, 0.0270, 0.0240, 0.008),
]  # fmt: skip
SHIRT = [
    (0.972, 0.1535, 0.091, 0.102, -0.012), (1.000, 0.1450, 0.094, 0.096, -0.013), (1.060, 0.1270, 0.087, 0.087, -0.014),
    (1.100, 0.1220, 0.087, 0.085, -0.014), (1.160, 0.1230, 0.090, 0.086, -0.016), (1.220, 0.1300, 0.095, 0.090, -0.018),
    (1.280, 0.1370, 0.087, 0.093, -0.022), (1.330, 0.1390, 0.082, 0.092, -0.026), (1.370, 0.1280, 0.070, 0.083, -0.027),
    (1.400, 0.1020, 0.060, 0.069, -0.025), (1.430, 0.0660, 0.050, 0.057, -0.021), (1.465, 0.0500, 0.048, 0.050, -0.014),
]  # fmt: skip
SLEEVE = [
    (-0.030, 0.043, 0.045, 0.045, 0.0), (0.020, 0.0440, 0.0460, 0.0460, 0.0), (0.070, 0.0440, 0.0450, 0.0455, 0.0),
    (0.1015, 0.0460, 0.0464, 0.0468, 0.0), (0.1055, 0.0488, 0.0490, 0.0494, 0.0),
    (0.1175, 0.0492, 0.0494, 0.0498, 0.0), (0.128, 0.0480, 0.0482, 0.0486, 0.0),
]  # fmt: skip
SLEEVE_END, CUFF, HEM, ANKLE = 0.122, 0.1035, 0.976, 0.120  # the cuff is the sleeve's own turned-up end
SOCKS = (0.115, 0.395)  # bottom, inside the shoes, and top of the long socks that wear the feet's colours


def on_arm(along: float, aside: float = 0.0, front: float = 0.0, palm: float = 0.0) -> np.ndarray:
    """A point given along the arm from the shoulder, towards the thumb and towards the palm."""
    return SHOULDER + along * ARM + (front + aside) * FRONT + palm * PALM


def bust() -> Shape:
    return both(ellipsoid((0.054, 1.270, 0.043), (0.052, 0.052, 0.043)))


def shoulders(by: float = 0.0) -> Shape:
    return both(
        blend(
            0.03,
            cone((0.10, 1.366, -0.022), (0.158, 1.370, -0.015), 0.050 + by, 0.0425 + by),
            cone((0.030, 1.437, -0.024), (0.135, 1.387, -0.018), 0.030 + by, 0.036 + by),
        )
    )


def torso() -> Shape:
    """Pelvis to neck, without legs and arms."""
    seat = both(ellipsoid((0.072, 0.872, -0.058), (0.074, 0.078, 0.052)))
    gusset = ellipsoid((0, 0.817, -0.008), (0.030, 0.029, 0.052))  # no light comes through between the thighs
    return blend(0.03, blend(0.04, stack((0, 0, 0), UP, FRONT, TORSO), bust()), seat, gusset, shoulders())


def leg() -> Shape:
    """The left leg from hip to ankle."""
    return stack(HIP, -UP, FRONT, LEG)


def leggings() -> Shape:
    """Pelvis and both legs; the top is inside the shirt, the bottom inside the shoes."""
    pelvis = common(torso(), half_space((0, 1.035, 0), UP), 0.02)
    return common(blend(0.040, pelvis, both(leg())), half_space((0, 0.066, 0), -UP), 0.01)


# fingers, the first one first: knuckle along the hand and towards the thumb, lengths of the three bones, spread in
# degrees, radius. One joint bends all knuckles and one all middle joints: both are on a line square to none of them.
HAND = (
    (0.081, 0.0285, (0.0385, 0.023, 0.018), 3.5, 0.0100),
    (0.083, 0.0098, (0.0405, 0.026, 0.019), 1, 0.0103),
    (0.079, -0.0092, (0.0385, 0.024, 0.018), -2, 0.0099),
    (0.073, -0.0270, (0.0345, 0.017, 0.015), -5, 0.0089),
)
WRIST_ALONG, WRIST_AHEAD = 0.492, 0.008  # from the shoulder
THUMB = ((0.012, 0.022, 0.006), (0.038, 0.044, 0.014), (0.064, 0.053, 0.020), (0.089, 0.054, 0.023))


def finger_joints() -> tuple[list[float], list[float]]:
    """How far along the hand knuckles and middle joints are, of the last finger first."""
    return [along for along, *_ in HAND[::-1]], [along + 0.98 * bones[0] for along, _, bones, *_ in HAND[::-1]]


def fingers() -> Shape:
    """The left hand's four fingers, nearly straight and beside each other; what they do bends them."""
    rows: list[Shape] = []
    for k, (along, aside, bones, spread, radius) in enumerate(HAND):
        points, bend = [on_arm(WRIST_ALONG + along, aside + WRIST_AHEAD, palm=-0.002)], 6.0 + 3 * k
        for bone in bones:
            a, s = np.radians(bend), np.radians(spread)
            points.append(points[-1] + bone * (np.cos(a) * (np.cos(s) * ARM + np.sin(s) * FRONT) + np.sin(a) * PALM))
            bend += 13 + k
        rows.append(tube(points, [radius * f for f in (1.06, 1.0, 0.94, 0.82)], steps=3))
    return blend(0.0015, *rows)


def thumb() -> Shape:
    """The left thumb, at the side of the first finger, where it is at rest as well as on a loose fist."""
    points = [on_arm(WRIST_ALONG + a, f + WRIST_AHEAD, palm=n) for a, f, n in THUMB]
    return tube(points, [0.0165, 0.0142, 0.0115, 0.0090], steps=3)


def hand() -> Shape:
    """The left hand; thumb to the front, palm to the thigh."""
    palm: list[Shape] = []
    for along, aside, *_ in HAND:
        knuckle = on_arm(WRIST_ALONG + along, aside + WRIST_AHEAD, palm=-0.002)
        palm.append(cone(on_arm(WRIST_ALONG - 0.005, aside * 0.45 + WRIST_AHEAD), knuckle, 0.0155, 0.0125))
    at = WRIST_ALONG
    inner = cone(on_arm(at + 0.03, -0.012, palm=0.008), on_arm(at + 0.062, 0.010, palm=0.006), 0.012, 0.012)
    whole = blend(0.010, blend(0.014, *palm, inner), fingers(), thumb())
    return near(whole, (0.46, 0.86, -0.06), (0.68, 1.07, 0.10))


def arm() -> Shape:
    """The left arm and hand; its upper end is inside the sleeve."""
    upper = common(stack(SHOULDER, ARM, FRONT, ARM_ROWS), half_space(on_arm(0.028), -ARM), 0.02)
    return blend(0.016, upper, hand())


def shirt_cloth(ends: bool = False) -> Shape:
    """The shirt's cloth without hem and neckline, and without sleeve ends if not wanted.

    As endless cloth it gives the normals, which must not turn under at the edges.
    """
    first, last = SHIRT[0], SHIRT[-1]
    longer = [(0.90, *first[1:]), *SHIRT, (1.52, *last[1:])]
    sleeve = stack(SHOULDER, ARM, FRONT, [*SLEEVE, (0.20, *SLEEVE[-1][1:])])
    if ends:
        sleeve = common(sleeve, half_space(on_arm(SLEEVE_END), ARM), 0.004)
    sleeves = both(blend(0.03, sleeve, cone((0.10, 1.366, -0.022), SHOULDER - 0.003 * UP, 0.053, 0.0450)))
    body = blend(0.045, stack((0, 0, 0), UP, FRONT, longer), grow(bust(), 0.006))
    return blend(0.035, body, sleeves, shoulders(0.006))


def shirt() -> Shape:
    """A T-shirt: loose at the waist, scoop neck."""
    cloth = common(shirt_cloth(ends=True), half_space((0, HEM, 0), -UP), 0.004)
    return carve(cloth, neckline(), 0.003)


def neckline() -> Shape:
    """The opening of the shirt around the neck, lower in front."""
    return blend(
        0.03, ellipsoid((0, 1.470, -0.012), (0.070, 0.062, 0.068)), ellipsoid((0, 1.425, 0.045), (0.062, 0.052, 0.080))
    )


def chest_skin() -> Shape:
    """Neck and the skin the scoop neck shows."""
    chest = common(grow(torso(), -0.0005), half_space((0, 1.33, 0), -UP), 0.02)
    chest = common(chest, ellipsoid((0, 1.425, 0.035), (0.090, 0.095, 0.085)), 0.02)
    return blend(0.028, chest, cone((0, 1.42, -0.022), (0, 1.55, -0.006), 0.0390, 0.0335))


def shoe_upper() -> Shape:
    """A high-top sneaker in the foot's colour."""
    x = HIP[0]
    toe = ellipsoid((x + 0.001, 0.027, 0.110), (0.0405, 0.035, 0.064))
    middle = cone((x, 0.042, 0.075), (x, 0.070, -0.005), 0.0325, 0.035)
    heel = ellipsoid((x, 0.040, -0.030), (0.0335, 0.052, 0.042))
    rows = [
        (0.045, 0.036, 0.045, 0.046, -0.012),
        (0.09, 0.0385, 0.044, 0.044, -0.017),
        (0.142, 0.0425, 0.046, 0.048, -0.019),
    ]
    collar = common(stack((x, 0, 0), UP, FRONT, rows), half_space((0, 0.132, 0), (0, 1, -0.12)), 0.004)
    last = ellipsoid((x, 0.025, 0.040), (0.0350, 0.032, 0.105))
    whole = blend(0.03, blend(0.035, toe, middle), heel, collar, last)
    hollow = ellipsoid((x, 0.148, -0.019), (0.0365, 0.026, 0.040))
    return common(carve(whole, hollow, 0.004), half_space((0, 0.012, 0), -UP), 0.004)


def sock() -> Shape:
    """The visible part in the shoe's opening if no leg is drawn, as from above."""
    return ellipsoid((HIP[0], 0.124, -0.019), (0.0365, 0.0070, 0.0400))


def figure() -> Shape:
    """The whole bare body with a plain head, for the mannequin."""
    skull = blend(
        0.05,
        ellipsoid((0, 1.622, -0.005), (0.078, 0.092, 0.094)),
        cone((0, 1.545, 0.020), (0, 1.520, 0.050), 0.050, 0.028),
    )
    neck = cone((0, 1.42, -0.022), (0, 1.56, -0.006), 0.042, 0.037)
    legs = common(both(leg()), half_space((0, 0.066, 0), -UP), 0.01)
    whole_arm = blend(0.016, stack(SHOULDER, ARM, FRONT, ARM_ROWS), hand())
    return blend(0.03, torso(), legs, both(whole_arm), neck, skull)
