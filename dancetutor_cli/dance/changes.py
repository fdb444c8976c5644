"""Numbers of the motion that change over a song (`settings.SettingsCourse`), and the mean of their states.

Each step is planned with the numbers of its time. The body's path is planned over the same steps once for each state,
and these paths are mixed while one state turns into the next one. This happens before any joint is turned, so feet and
palms touch the same places in all states. Then poses are solved with the numbers of each state, and mixed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from dancetutor_cli.dance.foot_path import Feet, FootPath
from dancetutor_cli.dance.physics.repin import AnkleTracks, feet_of, repinned
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.settings import WHOLE, Span, state_weights
from dancetutor_cli.dance.trajectory.height import Height
from dancetutor_cli.dance.trajectory.posture import Trajectory
from dancetutor_cli.dance.units import Array, Poses

_PATHS = {field.name for field in fields(Trajectory)} - {
    "times",
    "mass_height",
    "softened",
}  # arrays over time


@dataclass(frozen=True, slots=True)
class MeanHeight:
    """The mean of heights, each with the weight of its state."""

    heights: tuple[Height, ...]
    changes: tuple[Span, ...]

    def at(self, times: Array) -> Array:
        """Return the height (f,) at times (f,), seconds."""
        weights = state_weights(self.changes, times)
        return np.asarray(sum(weights[:, k] * one.at(times) for k, one in enumerate(self.heights)))


def mean_feet(feet: Sequence[Feet], weights: Array) -> Feet:
    """Return the mean of the feet of all states; weights (f, k). States have one plan, so feet stand together."""
    sides = []
    for paths in zip(*feet, strict=True):
        ball = np.einsum("fk,kfx->fx", weights, np.array([p.ball for p in paths]))
        turned = (np.array([getattr(path, name) for path in paths]) for name in ("yaw", "pitch"))
        yaw, pitch = (np.einsum("fk,kf->f", weights, one) for one in turned)
        sides.append(FootPath(ball, yaw, pitch, paths[0].down, paths[0].progress))
    return sides[0], sides[1]


def mean_of_states(skeleton: Skeleton, poses: Sequence[Poses], weights: Array) -> Poses:
    """Return the mean of poses that have the same feet, each with its weight (f, k); legs end in the feet."""
    rotations = quat.mean([p.rotations for p in poses], weights)
    root = np.einsum("fk,kfx->fx", weights, np.array([p.root for p in poses]))
    feet = [feet_of(skeleton, p.rotations, p.root) for p in poses]
    places = np.einsum("fk,kfsx->fsx", weights, np.array([f.places for f in feet]))
    turns = quat.mean([f.turns for f in feet], weights)
    mean = repinned(skeleton, Poses(rotations, root), AnkleTracks(places, turns))
    whole = weights.max(axis=1) >= WHOLE  # nothing is mixed in these frames
    for k, pose in enumerate(poses):
        own = whole & (weights[:, k] >= WHOLE)
        mean.rotations[own], mean.root[own] = pose.rotations[own], pose.root[own]
    return mean


def mean_body(bodies: Sequence[Trajectory], changes: Sequence[Span]) -> Trajectory:
    """Return the mean of the body's paths in all states, each with the weight of its state at the same even times."""
    first = bodies[0]
    weights = state_weights(changes, first.times)
    paths = {}
    for name in _PATHS:
        values = np.array([getattr(body, name) for body in bodies])
        paths[name] = np.einsum("fk,kf...->f...", weights, values)
    height = MeanHeight(tuple(body.mass_height for body in bodies), tuple(changes))
    softened = tuple(dict.fromkeys(what for body in bodies for what in body.softened))
    return replace(first, mass_height=height, softened=softened, **paths)
