"""The work of `retarget`: a captured motion and a character in, the character's motion out, through the ragdoll."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.character.characters import body_of, load_character
from dancetutor_cli.character.humanoid import humanoid_of
from dancetutor_cli.character.onto_skeleton import onto
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.physics.blend import load_choice
from dancetutor_cli.dance.physics.captured import on_body, upright
from dancetutor_cli.dance.physics.hair import add_hair
from dancetutor_cli.dance.physics.pipeline import through_ragdoll
from dancetutor_cli.dance.physics.ragdoll import bones_of, place_points, points_of
from dancetutor_cli.dance.physics.tuning import tuning_of
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.run.errors import DancetutorError, FileError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.dance.physics.blend import Blend
    from dancetutor_cli.dance.physics.captured import CapturedMotion
    from dancetutor_cli.dance.physics.pipeline import RagdollOptions, RagdollResult
    from dancetutor_cli.dance.quality.figures import MotionReport
    from dancetutor_cli.dance.rig.skeleton import Skeleton
    from dancetutor_cli.dance.units import Array


@dataclass(frozen=True, slots=True)
class RetargetTask:
    """The user's options of `retarget`. file : file of the motion

    style : as `dance.physics.blend.load_choice` takes it; options : corrections, pushes, trips
    """

    file: Path
    character: str
    style: str
    options: RagdollOptions


@dataclass
class Retargeting:
    """The results of a task, made when they are first needed. All members may raise DancetutorError.

    source : the file's motion, of the rig's joints (a Motion) or of joints of its own (see `formats.captured`)
    """

    task: RetargetTask
    source: Motion | CapturedMotion

    @cached_property
    def character(self) -> Character:
        """The character that moves."""
        return load_character(self.task.character)

    @cached_property
    def body(self) -> Skeleton:
        """The rig's joints in the character's proportions."""
        return body_of(self.character.skeleton)

    @cached_property
    def input_on_body(self) -> Motion:
        """The file's motion on the body, before any physics."""
        if isinstance(self.source, Motion):
            return onto(self.source, self.body)
        return on_body(self.source, self._captured_joints(self.source), self.body)

    @cached_property
    def input_figure(self) -> tuple[NDArray[np.int32], Array]:
        """Parents (j,) and places (f, j, 3) in metres of the file's own skeleton, hips where `input_on_body` has them.

        Over y, looking to +Z, in proportion to the body's legs, at the keys of `input_on_body`.
        """
        motion = self.input_on_body
        hips = world_transforms(motion.skeleton, motion.rotations, motion.root)[0]
        if isinstance(self.source, Motion):
            return motion.skeleton.parents, hips
        joints = self._captured_joints(self.source)
        places = upright(self.source, joints, self.body)
        ours = hips[:, [motion.skeleton.index(f"{s}_hip") for s in "lr"]].mean(axis=1)
        theirs = places[:, [joints[f"{s}_hip"] for s in "lr"]].mean(axis=1)
        return self.source.parents, places + (ours - theirs)[:, None]

    def _captured_joints(self, captured: CapturedMotion) -> dict[str, int]:
        """Return the captured joint of each of the rig's joints that the file has."""
        rig_joint_of = humanoid_of(self.task.file, captured.names, captured.parents).joints()
        return {joint: node for node, joint in rig_joint_of.items()}

    @cached_property
    def blend(self) -> Blend:
        """The style or styles, with springs and densities of the body."""
        blend = load_choice(self.task.style).blend()
        styles = blend.styles
        if "limits" not in self.task.options.corrections:
            styles = tuple(replace(style, limits=False) for style in styles)
        if self.body.offsets.tobytes() != dancer_skeleton().offsets.tobytes():
            styles = tuple(map(tuning_of(self.body).of, styles))
        return replace(blend, styles=styles)

    @cached_property
    def ragdoll_result(self) -> RagdollResult:
        """The result of the ragdoll, on the body."""
        try:
            passed = through_ragdoll(self.input_on_body, self.blend, self.task.options)
        except FileError:
            raise
        except DancetutorError as error:
            raise FileError(self.task.file, str(error)) from error
        motion = passed.motion
        add_hair(motion.skeleton, motion.times, motion.rotations, motion.root, default_settings().hair)
        return passed

    @cached_property
    def output_on_character(self) -> Motion:
        """The ragdoll's motion for the character's skeleton."""
        return onto(self.ragdoll_result.motion, self.character.skeleton)

    @cached_property
    def input_on_character(self) -> Motion:
        """The file's motion, before any physics, for the character's skeleton."""
        return onto(self.input_on_body, self.character.skeleton)

    def point_paths(self) -> tuple[tuple[str, ...], Array, Array]:
        """Return the names of the p retargeting points, and their places (f, p, 3) at the keys of input and output.

        They are the points of the style with the largest weight.
        """
        before, after = self.input_on_body, self.ragdoll_result.motion
        bones = bones_of(self.body)
        styles, _ = self.blend.within(after.times)  # the largest weight comes first
        points = tuple(p for p in points_of(self.body, bones, styles[0]) if not p.extra)
        given, made = (place_points(self.body, bones, points, m.rotations, m.root) for m in (before, after))
        return tuple(p.name for p in points), given, made

    @property
    def title(self) -> str:
        """The title for people: the name of the file."""
        return self.task.file.stem

    def report(self) -> MotionReport:
        """Return the quality of the motion on the body, its faults before and after, and the ragdoll's distances."""
        from dancetutor_cli.dance.quality.report import fault_figures, report, with_distances

        passed = self.ragdoll_result
        whole = report(passed.motion)
        faults = fault_figures(self.input_on_body, passed.motion, passed.plants)
        curves = {name: (t, v) for name, (t, v) in whole.curves.items() if len(v) and np.isfinite(v).any()}
        whole = replace(whole, figures=(*whole.figures, *faults), curves=curves)
        plain = not set(self.task.options.corrections) - {"limits"}
        whole = with_distances(whole, passed.distances, self.task.style if plain else None)
        return replace(whole, curves=whole.curves | self._point_curves())

    def _point_curves(self) -> dict[str, tuple[Array, Array]]:
        """Return curves over the keys, of input and output (f, 2): speeds of retargeting points, turns of bones."""
        names, *paths = self.point_paths()
        motions, times = (self.input_on_body, self.ragdoll_result.motion), self.input_on_body.times
        speeds = [100.0 * np.linalg.norm(np.gradient(path, times, axis=0), axis=2) for path in paths]
        out = {f"speed of {name}, cm/s": np.stack([s[:, k] for s in speeds], axis=1) for k, name in enumerate(names)}
        for bone in bones_of(self.body):
            turns = [np.linalg.norm(quat.to_vector(m.rotations[:, bone.joint]), axis=1) for m in motions]
            out[f"angle of {bone.name}, degrees"] = np.degrees(np.stack(turns, axis=1))
        return {name: (times, values) for name, values in out.items()}
