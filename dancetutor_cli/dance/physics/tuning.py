"""Springs and densities for a new body, by a short search on a standard clip."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.physics.blend import Blend
from dancetutor_cli.dance.physics.pipeline import through_ragdoll
from dancetutor_cli.dance.physics.ragdoll import NOMINAL, bones_of
from dancetutor_cli.dance.physics.simulation import DEVIATION, LARGEST, MEAN
from dancetutor_cli.dance.physics.style import NEUTRAL, PARTS, Spring, Style, load_style
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import PARTS as MASSES
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.run.errors import DancetutorError, FileError
from dancetutor_cli.run.files import write_atomic
from dancetutor_cli.run.reading import config_path, read_json
from dancetutor_cli.run.trust import kept_folder

# Densities give each part its share of the mass of a person. Then the search finds the frequency and the damping of all
# springs with which the ragdoll follows the clip most closely, by the goals of one-on-one simulation.

FREQUENCIES, DAMPINGS = (24.0, 28.0, 32.0, 36.0, 40.0), (0.4, 0.5, 0.65)
STURDY = 22.0  # kg/m^2: a body's mass is this times the square of its height
DENSITIES = (400.0, 3000.0)  # allowed kg/m^3 of a part
SCHEMA = b"1"  # changes with the form of a stored tuning
OVER_SKULL = 0.17  # metres from the joint of the skull to the crown
_ROUND = 0.6  # seconds of one swing of the standard clip


@dataclass(frozen=True, slots=True)
class Tuning:
    """The changes of a style for a body. stretch : factor of all frequencies; damping : factor of all dampings

    density : by part, kg/m^3 where the style has 1000
    """

    stretch: float
    damping: float
    density: Mapping[str, float]

    def of(self, style: Style) -> Style:
        """Return the style for this body."""
        springs, points = (
            {
                name: Spring(
                    (s.frequency[0] * self.stretch, s.frequency[1] * self.stretch, s.frequency[2] * self.stretch),
                    (s.damping[0] * self.damping, s.damping[1] * self.damping, s.damping[2] * self.damping),
                )
                for name, s in given.items()
            }
            for given in (style.springs, style.points)
        )
        density = {part: value * self.density[part] / NOMINAL for part, value in style.density.items()}
        return replace(style, springs=springs, points=points, density=density)

    def as_json(self) -> dict[str, Any]:
        """Return the tuning as plain data."""
        return asdict(self)

    @classmethod
    def from_json(cls, data: Any) -> Tuning | None:
        """Return the tuning in plain data; None if the data is not a tuning."""
        try:
            density = {part: float(data["density"][part]) for part in PARTS}
            values = (float(data["stretch"]), float(data["damping"]), *density.values())
        except (KeyError, TypeError, ValueError):
            return None
        return cls(values[0], values[1], density) if all(0 < v < 1e5 for v in values) else None


def tuning_of(body: Skeleton) -> Tuning:
    """Return the springs and densities of a body, stored by an earlier run or by a short search.

    They depend on the body and on the style `neutral`.
    """
    digest = hashlib.sha256(body.offsets.round(6).tobytes())
    digest.update(config_path(f"styles/{NEUTRAL}.yaml").read_bytes() + SCHEMA)
    folder = kept_folder("bodies")
    path = None if folder is None else folder / f"{digest.hexdigest()[:32]}.json"
    if path is not None:
        with suppress(FileError):
            found = Tuning.from_json(read_json(path))
            if found is not None:
                return found
    tuning = search_tuning(body, load_style(NEUTRAL))
    if path is not None:
        with suppress(OSError, FileError):
            write_atomic(path, json.dumps(tuning.as_json(), indent=1).encode())
    return tuning


def search_tuning(body: Skeleton, neutral: Style) -> Tuning:
    """Search the tuning. body : named as the rig's; raises DancetutorError if the ragdoll follows with no springs at
    all.
    """
    density, clip = _densities(body), standard_clip(body)
    base = neutral.springs["chest"]
    best: tuple[float, Tuning] | None = None
    for damping in (base.damping[0], *(d for d in DAMPINGS if d != base.damping[0])):
        stretches = FREQUENCIES if best is None else (best[1].stretch * base.frequency[0],)
        for frequency in stretches:
            tuning = Tuning(frequency / base.frequency[0], damping / base.damping[0], density)
            score = _score(clip, tuning.of(neutral))
            if best is None or score < best[0]:
                best = score, tuning
    assert best is not None
    if not np.isfinite(best[0]):
        raise DancetutorError("no ragdoll of this body can follow the motion; use another character")
    return best[1]


def _score(clip: Motion, style: Style) -> float:
    """Return the worst of the three figures in parts of its goal; infinite if the simulation fails."""
    try:
        mean, deviation, largest = through_ragdoll(clip, Blend.of(style)).distances.worst
    except DancetutorError:
        return float("inf")
    return max(mean / MEAN, deviation / DEVIATION, largest / LARGEST)


def _densities(body: Skeleton) -> dict[str, float]:
    """Return kg/m^3 with which each part weighs its share (de Leva's) of a sturdy person of this height."""
    height = float(body.rest[body.index("skullbase")][1]) + OVER_SKULL
    own: dict[str, float] = dict.fromkeys(PARTS, 0.0)
    for bone in bones_of(body):
        own[bone.part] += bone.mass
    part_of = {bone.name: bone.part for bone in bones_of(body)}
    wanted: dict[str, float] = dict.fromkeys(PARTS, 0.0)
    total = 0.0
    for name, share, _ in MASSES:
        times = 2 if name.startswith("l_") else 1
        wanted[part_of[name]] += share * times
        total += share * times
    mass = STURDY * height**2
    wanted["clavicles"], wanted["spine"] = 0.05 * total, wanted["spine"] - 0.05 * total  # de Leva has both in the trunk
    return {p: float(np.clip(NOMINAL * mass * wanted[p] / total / own[p], *DENSITIES)) for p in PARTS}


def standard_clip(body: Skeleton) -> Motion:
    """Return a clip of treading just over the floor: knees, arms, forearms, trunk and head swing at different paces."""
    fps, seconds = 60, 2.4
    t = np.arange(round(seconds * fps) + 1) / fps
    w = 2 * np.pi * t / (2 * _ROUND)
    rotations = np.zeros((len(t), len(body.names), 4))
    rotations[..., 0] = 1
    x, y, z = np.eye(3)

    def turn(name: str, axis: Any, degrees: Any) -> None:
        j = body.index(name)
        rotations[:, j] = quat.multiply(rotations[:, j], quat.from_axis_angle(axis, np.radians(degrees)))

    for s, sign in (("l", 1), ("r", -1)):
        bend = 45 + 40 * np.sin(w) * sign
        turn(f"{s}_hip", x, -bend / 2)
        turn(f"{s}_knee", x, bend)
        turn(f"{s}_talocrural", x, -bend / 2)
        turn(f"{s}_shoulder", x, 25 * sign * np.sin(w))
        turn(f"{s}_elbow", np.cross(body.offsets[body.index(f"{s}_elbow")], z), 40 + 25 * np.sin(1.3 * w))
    turn("vl5", y, 12 * np.sin(w))
    turn("vt10", x, 8 + 6 * np.sin(2 * w))
    turn("skullbase", y, 25 * np.sin(0.7 * w))
    root = body.rest[0] + np.column_stack((0.05 * np.sin(w / 2), 0.02 * np.sin(2 * w) + 0.025, 0.03 * np.cos(w / 2)))
    return Motion(body, float(fps), t, rotations, root, ())
