"""A baked motion in a style: through the ragdoll, and the braid again, for its head now moves otherwise."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from dancetutor_cli.motion.baked import Motion
from dancetutor_cli.physics.hair import add_hair

if TYPE_CHECKING:
    from dancetutor_cli.motion.settings import MotionSettings
    from dancetutor_cli.physics.distances import Distances
    from dancetutor_cli.physics.pipeline import Wishes


@dataclass(frozen=True, slots=True)
class Styled:
    """The motion, and how far its ragdoll was from what it followed; None where there was none."""

    motion: Motion
    distances: Distances | None = None


def styled(motion: Motion, style: str | None, settings: MotionSettings, wishes: Wishes | None = None) -> Styled:
    """A motion of the project's dancer in a style by name or file; None leaves it alone and loads no engine.

    wishes : what shall befall her in it
    Raises what `physics.pipeline` raises.
    """
    if style is None:
        return Styled(motion)
    from dancetutor_cli.physics.pipeline import Wishes, through_ragdoll
    from dancetutor_cli.physics.style import load_style

    passed = through_ragdoll(motion, load_style(style), wishes or Wishes())
    add_hair(motion.skeleton, motion.times, passed.motion.rotations, passed.motion.root, settings.hair)
    return Styled(passed.motion, passed.distances)
